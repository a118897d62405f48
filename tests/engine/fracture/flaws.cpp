// Flaws follow the Weibull law and belong to the surface, not to its triangles.
#include "engine/fracture/flaws.h"

#include <catch2/catch.hpp>

#include "engine/core/elementary.h"
#include "tests/engine/fracture/shapes.h"

using namespace shatterbox;

TEST_CASE("the number of flaws below a strength follows the Weibull law") {
  material::Material material;
  material.flaw_area = 1e-3;
  const auto elements = test::make_pane(1.0, 0.05);
  const fracture::FlawField field = fracture::draw_flaws(*elements, material, 7);
  for (const double share : {1.0, 1.5, 2.0}) {
    double count = 0.0;
    for (const fracture::Flaw& flaw : field.flaws) count += flaw.strength < share * material.strength;
    const double expected = core::pow(share, material.weibull_modulus) / material.flaw_area;
    CHECK(count == Approx(expected).margin(4.0 * core::sqrt(expected)));
  }
}

TEST_CASE("flaws are uniform by area on a sphere, whatever way it faces") {
  const auto elements = test::make_sphere(1.0, 0.1);
  const auto points = fracture::scatter_on_surface(*elements, 2000.0, 3);
  double area = 0.0;
  for (std::size_t t = 0; t < elements->mesh.triangles.size(); ++t)
    area += element_area(*elements, static_cast<int>(t));
  CHECK(static_cast<double>(points.size()) == Approx(2000.0 * area).epsilon(0.03));
  // Second moments of a uniform sphere: one third along each axis.
  Vec3 second = Vec3::Zero();
  for (const auto& p : points)
    second += position_in_element(*elements, p.element, p.barycentric).cwiseAbs2() /
              static_cast<double>(points.size());
  for (int i = 0; i < 3; ++i) CHECK(second[i] == Approx(1.0 / 3.0).epsilon(0.04));
}

TEST_CASE("a finer mesh of the same surface has the same flaws") {
  material::Material material;
  material.flaw_area = 1e-3;
  const auto pane_points = [&](double edge) {
    const auto elements = test::make_pane(0.3, edge);
    std::vector<std::array<double, 2>> found;
    for (const fracture::Flaw& f : fracture::draw_flaws(*elements, material, 5).flaws)
      found.push_back({f.strength, position_in_element(*elements, f.element, f.barycentric).x()});
    std::sort(found.begin(), found.end());
    return found;
  };
  const auto coarse = pane_points(0.03);
  const auto fine = pane_points(0.015);
  REQUIRE(coarse.size() == fine.size());
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    CHECK(coarse[i][0] == fine[i][0]);
    CHECK(coarse[i][1] == Approx(fine[i][1]).margin(1e-12));
  }
  // On a sphere the facets differ from each other by their sagitta: nearly all flaws are found again.
  const auto strengths = [&](double edge) {
    std::vector<double> found;
    for (const fracture::Flaw& f : fracture::draw_flaws(*test::make_sphere(0.04, edge), material, 5).flaws)
      found.push_back(f.strength);
    std::sort(found.begin(), found.end());
    return found;
  };
  const auto a = strengths(0.005);
  const auto b = strengths(0.0025);
  std::vector<double> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  CHECK(static_cast<double>(common.size()) > 0.93 * static_cast<double>(b.size()));
}

TEST_CASE("another seed gives other flaws, the same seed the same bits") {
  material::Material material;
  const auto elements = test::make_pane(0.5, 0.05);
  const auto a = fracture::draw_flaws(*elements, material, 1);
  const auto b = fracture::draw_flaws(*elements, material, 1);
  const auto c = fracture::draw_flaws(*elements, material, 2);
  REQUIRE(a.flaws.size() == b.flaws.size());
  for (std::size_t i = 0; i < a.flaws.size(); ++i) CHECK(a.flaws[i].strength == b.flaws[i].strength);
  CHECK(a.flaws.front().strength != c.flaws.front().strength);
}
