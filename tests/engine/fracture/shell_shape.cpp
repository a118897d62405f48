// The shape that a hit leaves a sheet in: what is bent keeps its length, what cannot fit stretches, and both
// take their energy.
#include "engine/fracture/shell_shape.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "engine/core/index.h"
#include "engine/geometry/mass_properties.h"
#include "tests/engine/fracture/steel_sheet.h"

using namespace shatterbox;
using namespace shatterbox::fracture;

namespace {

constexpr double kThickness = 1e-3;  // m

/// One curvature (1/m) in all elements for which `is_in` (of their middles).
template <class IsIn>
stress::SheetFlow flow_of(const ShellSubject& subject, const Mat2& curvature, const IsIn& is_in) {
  stress::SheetFlow flow;
  for (const geometry::ShellCell& cell : subject.mesh->cells) {
    const geometry::ShellElements& elements = *subject.mesh->elements;
    const Vec3 middle = geometry::position_in_element(elements, cell.element, Vec2(1.0 / 3.0, 1.0 / 3.0));
    const Mat2 turn = geometry::facet_frame(elements, cell.element).topLeftCorner<2, 2>();
    const Mat2 local = is_in(middle) ? Mat2(turn.transpose() * curvature * turn) : Mat2(Mat2::Zero());
    flow.strains.push_back({Vec3::Zero(), Vec3(local(0, 0), local(1, 1), local(0, 1))});
    flow.works.push_back(local.norm() * cell.area * subject.material.yield * kThickness * kThickness / 4.0);
    flow.work += flow.works.back();
  }
  return flow;
}

double area_after(const ShellSubject& subject, const ShellShape& shape, double share = 1.0) {
  geometry::TriangleMesh mesh = subject.mesh->elements->mesh;
  const std::vector<Vec3> moves = moves_at(shape, share);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) mesh.positions[v] += moves[v];
  return geometry::surface_area(mesh) / geometry::surface_area(subject.mesh->elements->mesh);
}

double depth_of(const ShellShape& shape) {
  double depth = 0.0;
  for (const Vec3& move : moves_at(shape, 1.0)) depth = std::max(depth, move.norm());
  return depth;
}

}  // namespace

TEST_CASE("shell shape: a strip that is bent by two radians is an arc of its length and its area") {
  constexpr double kBend = 4.0, kLength = 0.5;  // 1/m, m
  const ShellSubject subject = test::steel_sheet(
      test::make_elements(geometry::make_pane(kLength, 0.1, {0.02, 0.3, 1}).value()), kThickness);
  Mat2 curvature = Mat2::Zero();
  curvature(0, 0) = kBend;
  const stress::SheetFlow flow = flow_of(subject, curvature, [](const Vec3&) { return true; });
  const ShellShape shape = find_shell_shape(subject, flow, flow.work);
  CHECK_FALSE(shape.is_cut);
  CHECK(shape.work == Approx(flow.work).epsilon(0.03));
  for (const double share : {0.1, 0.37, 0.5, 0.9, 1.0})
    CHECK(area_after(subject, shape, share) == Approx(1.0).margin(0.005));
  const std::vector<Vec3> moves = moves_at(shape, 1.0);
  const auto& positions = subject.mesh->elements->mesh.positions;
  Vec3 ends[2] = {Vec3::Zero(), Vec3::Zero()};
  int counts[2] = {0, 0};
  for (std::size_t v = 0; v < positions.size(); ++v)
    for (int side = 0; side < 2; ++side)
      if (std::abs(positions[v].x() - (side - 0.5) * kLength) < 1e-9) {
        ends[side] += positions[v] + moves[v];
        ++counts[side];
      }
  const double bend = kBend * shape.work / flow.work;
  const double chord = 2.0 / bend * std::sin(0.5 * bend * kLength);
  CHECK((ends[1] / counts[1] - ends[0] / counts[0]).norm() == Approx(chord).epsilon(0.02));
}

TEST_CASE("shell shape: a dish in a held plate stretches it, and what that takes goes off its depth") {
  const auto elements = test::make_pane(0.3, 0.012);
  std::vector<int> border;
  for (std::size_t v = 0; v < elements->mesh.positions.size(); ++v)
    if (elements->mesh.positions[v].cwiseAbs().maxCoeff() > 0.15 - 1e-9)
      border.push_back(static_cast<int>(v));
  const ShellSubject subject = test::steel_sheet(elements, kThickness, border);
  const stress::SheetFlow flow =
      flow_of(subject, 4.0 * Mat2::Identity(), [](const Vec3& middle) { return middle.norm() < 0.04; });
  double last = 0.0;
  for (const double energy : {1.0, 5.0, 20.0}) {
    const ShellShape shape = find_shell_shape(subject, flow, energy);
    const double depth = depth_of(shape);
    CAPTURE(energy, depth);
    CHECK(shape.work <= energy * (1.0 + 1e-12));
    CHECK(shape.work > 0.9 * energy);
    CHECK(depth > 1.2 * last);
    CHECK(area_after(subject, shape) > 1.0);
    last = depth;
  }
}

TEST_CASE("shell shape: without energy there is no dent, and never more than the sheet can bear") {
  const ShellSubject subject = test::steel_sheet(test::make_pane(0.3, 0.02), kThickness);
  const stress::SheetFlow flow =
      flow_of(subject, 4.0 * Mat2::Identity(), [](const Vec3& middle) { return middle.norm() < 0.06; });
  CHECK(depth_of(find_shell_shape(subject, flow, 0.0)) == 0.0);
  const ShellShape torn = find_shell_shape(subject, flow, 1e7);
  CHECK(torn.work < 1e7);
  CHECK(depth_of(torn) < 1.0);
}
