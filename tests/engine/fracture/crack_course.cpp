// Cracks in given stresses: they follow its directions as smoothly as it turns, and rings keep as far apart
// as they unload each other.
#include "engine/fracture/crack_tracer.h"

#include <catch2/catch.hpp>
#include <functional>

#include "engine/core/elementary.h"
#include "tests/engine/fracture/shapes.h"

using namespace shatterbox;

namespace {

/// A flat sheet under a stress that is given in its plane (xx, yy, xy, Pa).
class Sheet {
 public:
  Sheet(double width, double height, double edge, const std::function<Vec3(const Vec3&)>& field)
      : elements_(test::make_elements(geometry::make_pane(width, height, {edge, 0.3, 1}).value())),
        mesh_(geometry::make_shell_mesh(elements_)),
        planes_(*elements_) {
    std::vector<stress::CellStress> stresses;
    for (int t = 0; t < element_count(); ++t) {
      const fracture::ElementPlane& plane = planes_.of(t);
      const Vec3 s = field(plane.middle());
      Mat2 tensor;
      tensor << s.x(), s.z(), s.z(), s.y();
      const Mat2 turn = plane.frame.topLeftCorner<2, 2>();
      const Mat2 local = turn.transpose() * tensor * turn;
      stresses.push_back({Vec3(local(0, 0), local(1, 1), local(0, 1)), Vec3::Zero()});
    }
    stresses_ = stress::average_stresses(mesh_, geometry::find_cell_contacts(mesh_), stresses);
  }

  fracture::TracerSetup setup(int generation, const fracture::LoadCentre& load,
                              double thickness = 3e-4) const {
    fracture::TracerSetup setup;
    setup.planes = &planes_;
    setup.stresses = &stresses_;
    setup.material = &material_;
    setup.noise = &still_;
    setup.centres = {load};
    setup.thickness = thickness;
    setup.energy_budget = -1.0;
    setup.generation = generation;
    return setup;
  }

  fracture::Candidate candidate(const Vec3& p, double overload, int number, int piece = 0) const {
    for (int t = 0; t < element_count(); ++t) {
      const fracture::ElementPlane& plane = planes_.of(t);
      const Vec2 b = plane.weights(plane.flat_direction(p - plane.origin));
      if (b.minCoeff() > 0.0 && b.sum() < 1.0) return {t, b, overload, number, piece};
    }
    FAIL("no element there");
    return {};
  }

  const geometry::ShellMesh& mesh() const { return mesh_; }

 private:
  int element_count() const { return static_cast<int>(elements_->mesh.triangles.size()); }

  std::shared_ptr<const geometry::ShellElements> elements_;
  geometry::ShellMesh mesh_;
  fracture::ElementPlanes planes_;
  std::vector<stress::CellStress> stresses_;
  material::Material material_;
  fracture::PathNoise still_{1.0, 0.0, 1};
};

/// Places along x at which cracks cross the middle of a strip of 2 m x 10 cm that is pulled along x.
/// Flaws lie in turn in each of so many pieces.
std::vector<double> find_rings(int generation, double bending_length, int pieces = 1) {
  const Sheet strip(2.0, 0.1, 0.01, [](const Vec3&) { return Vec3(2e8, 0.0, 0.0); });
  fracture::ShellCutter cutter(strip.mesh());
  fracture::CrackTracer tracer(cutter, strip.setup(generation, {Vec3(-1.0, 0.0, 0.0), 0.05, bending_length}));
  std::vector<fracture::Candidate> candidates;
  for (int i = 0; i < 150; ++i)
    candidates.push_back(strip.candidate(Vec3(-0.5 + 0.01 * i, 0.0013, 0.0), 4.0, i, i % pieces));
  tracer.nucleate(candidates);
  std::vector<double> places;
  for (const fracture::CrackSegment& s : tracer.segments())
    if (s.ends[0].y() * s.ends[1].y() <= 0.0) places.push_back(0.5 * (s.ends[0] + s.ends[1]).x());
  std::sort(places.begin(), places.end());
  return places;
}

std::pair<double, double> least_and_greatest_gap(const std::vector<double>& places) {
  double least = 1e300, greatest = 0.0;
  for (std::size_t i = 1; i < places.size(); ++i) {
    least = std::min(least, places[i] - places[i - 1]);
    greatest = std::max(greatest, places[i] - places[i - 1]);
  }
  return {least, greatest};
}

}  // namespace

TEST_CASE("in a stress that pulls away from a point cracks are smooth circles about it, and close") {
  const Vec3 centre(0.03, -0.02, 0.0);
  const Sheet sheet(1.0, 1.0, 0.034, [&](const Vec3& p) {
    const Vec3 n = (p - centre).normalized();
    return Vec3(1e8 * n.x() * n.x(), 1e8 * n.y() * n.y(), 1e8 * n.x() * n.y());
  });
  for (const double radius : {0.2, 0.3, 0.4}) {
    fracture::ShellCutter cutter(sheet.mesh());
    fracture::CrackTracer tracer(cutter, sheet.setup(1, {centre, 0.05, 0.0}));
    tracer.nucleate({sheet.candidate(centre + Vec3(radius, 0.0, 0.0), 4.0, 0)});
    double length = 0.0, half = 0.0, square = 0.0, worst_radius = 0.0;
    for (const fracture::CrackSegment& s : tracer.segments()) {
      const Vec3 along = s.ends[1] - s.ends[0];
      const Vec3 out = 0.5 * (s.ends[0] + s.ends[1]) - centre;
      length += along.norm();
      worst_radius = std::max(worst_radius, std::abs(out.norm() - radius));
      if (out.x() > 0.0 || along.norm() < 1e-4) continue;  // on the other half the ends turn to meet
      const double sine = along.dot(out) / (along.norm() * out.norm());
      half += along.norm();
      square += along.norm() * sine * sine;
    }
    INFO(radius << ": length " << length << ", angle " << std::sqrt(square / half) << ", radius off by "
                << worst_radius);
    CHECK(tracer.open_tips().empty());
    CHECK(length == Approx(2.0 * core::kPi * radius).epsilon(0.03));
    CHECK(worst_radius < 0.03 * radius);
    CHECK(std::sqrt(square / half) < 0.06);
  }
}

TEST_CASE("a crack turns over some thicknesses: what the stress does from element to element is smoothed") {
  core::Random random(7, 1);
  const Sheet sheet(1.0, 1.0, 0.03, [&](const Vec3&) {
    const double angle = random.uniform(-0.8, 0.8);  // of the pull, from x
    const double c = std::cos(angle), s = std::sin(angle);
    return Vec3(1e8 * c * c, 1e8 * s * s, 1e8 * c * s);
  });
  const auto find_kinks = [&](double thickness) {
    fracture::ShellCutter cutter(sheet.mesh());
    fracture::CrackTracer tracer(cutter, sheet.setup(0, {Vec3(-0.5, 0.0, 0.0), 0.05, 0.0}, thickness));
    std::vector<fracture::Candidate> candidates;
    for (int i = 0; i < 8; ++i) candidates.push_back(sheet.candidate(Vec3(-0.4 + 0.1 * i, 0.0, 0.0), 1e4, i));
    tracer.nucleate(candidates);
    double square = 0.0;
    int count = 0;
    for (std::size_t i = 1; i < tracer.segments().size(); ++i) {
      const auto& [from, to] = tracer.segments()[i - 1].ends;
      const auto& [begin, end] = tracer.segments()[i].ends;
      if (begin != to || !((to - from).norm() > 2e-3) || !((end - begin).norm() > 2e-3)) continue;
      const double sine = (to - from).normalized().cross((end - begin).normalized()).norm();
      square += sine * sine;
      ++count;
    }
    REQUIRE(count > 50);
    return std::sqrt(square / count);
  };
  const double thin = find_kinks(3e-4), thick = find_kinks(1e-2);
  INFO("kinks " << thin << " and " << thick);
  CHECK(thick < 0.5 * thin);
}

TEST_CASE("a ring unloads its strip as far as bending reaches, a first crack only its shielded length") {
  // Length 0.1 m, overload 4: shielded are 0.5 x 0.1 m, or less where the load is nearer than 0.2 m.
  const auto [first_least, first_greatest] = least_and_greatest_gap(find_rings(0, 1e3));
  CHECK(first_least > 0.0499);
  CHECK(first_greatest < 0.08);
  const auto [flat_least, flat_greatest] = least_and_greatest_gap(find_rings(1, 1e3));
  CHECK(flat_least > 0.1499);
  CHECK(flat_greatest < 0.18);
  const auto [curved_least, curved_greatest] = least_and_greatest_gap(find_rings(1, 0.01));
  CHECK(curved_least == first_least);
  CHECK(curved_greatest == first_greatest);
  const auto alone = find_rings(1, 1e3), side_by_side = find_rings(1, 1e3, 2);
  CHECK(side_by_side.size() + 1 >= 2 * alone.size());  // nothing is unloaded beyond a crack
}
