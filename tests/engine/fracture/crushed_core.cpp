// What is crushed about hits: the cells of one, of several that lie in each other, and of several apart.
#include "engine/fracture/crushed_core.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "engine/core/elementary.h"
#include "engine/fracture/split_shell.h"
#include "tests/engine/fracture/window.h"

using namespace shatterbox;

namespace {

/// The ball's blow, borne by so many points of a ring about its place.
fracture::ShellImpact spread(const fracture::ShellImpact& blow, int points, double ring) {
  fracture::ShellImpact impact = blow;
  impact.loads.clear();
  for (int i = 0; i < points; ++i) {
    fracture::ShellLoad load = blow.loads.front();
    const double angle = 2.0 * core::kPi * i / points;
    load.point_material += ring * Vec3(core::cos(angle), core::sin(angle), 0.0);
    load.effective_mass /= points;
    load.impulse /= points;
    impact.loads.push_back(load);
  }
  return impact;
}

fracture::Decision strike(const fracture::ShellImpact& impact) {
  fracture::Decision decision = fracture::decide_shell(test::make_window(3), impact);
  REQUIRE(decision.verdict.outcome == fracture::Outcome::broke);
  REQUIRE(decision.core_cells > 0);
  return decision;
}

std::vector<geometry::ShellMesh> pieces_of(const fracture::Decision& decision) {
  return fracture::split_shell(*decision.mesh, decision.contacts, {2e-4}).pieces;
}

/// Of all sides that are open, m: twice the length of the cracks.
double length_of_faces(const geometry::ShellMesh& mesh) {
  double length = 0.0;
  for (const geometry::ShellCell& cell : mesh.cells)
    for (int s = 0; s < cell.corner_count; ++s) {
      const auto corner = [&](int i) {
        return mesh.corners[static_cast<std::size_t>(cell.first_corner + i % cell.corner_count)];
      };
      if (corner(s).side != geometry::SideKind::crack) continue;
      length += (position_in_element(*mesh.elements, cell.element, corner(s + 1).barycentric) -
                 position_in_element(*mesh.elements, cell.element, corner(s).barycentric))
                    .norm();
    }
  return length;
}

}  // namespace

TEST_CASE("a blow that many points bear crushes no finer than one point does") {
  const fracture::ShellImpact blow = test::steel_ball(40.0);
  const fracture::Decision one = strike(blow);
  const std::size_t pieces = pieces_of(one).size();
  for (const double ring : {0.005, 0.02}) {
    const fracture::Decision many = strike(spread(blow, 8, ring));
    CHECK(many.core_cells < 1.5 * one.core_cells);
    CHECK(static_cast<double>(pieces_of(many).size()) < 2.0 * static_cast<double>(pieces));
  }
}

TEST_CASE("cells of a core go from crack to crack: none is a splinter") {
  const fracture::Decision decision = strike(test::steel_ball(40.0));
  double length = 0.0;
  for (const fracture::CrackSegment& segment : decision.segments)
    length += (segment.ends[1] - segment.ends[0]).norm();
  CHECK(length_of_faces(*decision.mesh) == Approx(2.0 * length).epsilon(1e-9));
  // Cells of four thicknesses, the least spacing of their seeds .75 of it: none is a splinter.
  const Vec3 hit(-0.05, 0.05, 0.0);
  int whole = 0;
  for (const geometry::ShellMesh& piece : pieces_of(decision)) {
    Vec3 middle = Vec3::Zero();
    for (const geometry::ShellCell& cell : piece.cells)
      middle += cell.area / total_area(piece) *
                position_in_element(*piece.elements, cell.element,
                                    piece.corners[static_cast<std::size_t>(cell.first_corner)].barycentric);
    if ((middle - hit).norm() > 0.1) continue;
    ++whole;
    CHECK(total_area(piece) > 0.1 * 0.016 * 0.016);
  }
  CHECK(whole > 20);
}

TEST_CASE("cores that share material are crushed together, others each by itself") {
  const auto elements = test::make_pane(1.0, 0.034);
  // Numbered by their seeds.
  const auto at = [](double x) { return fracture::CrushedCore{Vec3(x, 0.0, 0.0), 0.005, 0.008, 0.02, 1}; };
  const auto groups = [&](std::vector<fracture::CrushedCore> cores) {
    for (std::size_t i = 0; i < cores.size(); ++i) cores[i].seed = i;
    std::vector<std::vector<int>> numbers;
    for (const fracture::CoreGroup& group : fracture::group_cores(*elements, cores)) {
      numbers.emplace_back();
      for (const fracture::CrushedCore& core : group.cores)
        numbers.back().push_back(static_cast<int>(core.seed));
      CHECK(std::is_sorted(group.elements.begin(), group.elements.end()));
      CHECK(!group.elements.empty());
    }
    return numbers;
  };
  using Groups = std::vector<std::vector<int>>;
  CHECK(groups({}).empty());
  CHECK(groups({at(-0.4), at(0.4)}) == Groups{{0}, {1}});
  CHECK(groups({at(-0.4), at(0.01), at(-0.39), at(0.0)}) == Groups{{0, 2}, {1, 3}});
  // The last one is between two that were apart.
  CHECK(groups({at(-0.25), at(0.4), at(0.05), at(-0.1)}) == Groups{{0, 2, 3}, {1}});
}
