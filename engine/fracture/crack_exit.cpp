#include "engine/fracture/crack_exit.h"

#include <algorithm>
#include <cmath>

#include "engine/core/index.h"

namespace shatterbox::fracture {
namespace {

using geometry::SideKind;
using Size = std::size_t;
using core::at;

constexpr double kSnap = 0.05;      // of an edge or of sqrt(2 area): vertices are passed by at this distance
constexpr double kJoin = 0.3;       // thicknesses: cuts nearer to each other than this become one
constexpr double kMostJoin = 0.25;  // of an edge: they do not where elements are so small

double edge_length(const geometry::ShellElements& elements, int edge) {
  const auto& ends = elements.topology.edges[at(edge)];
  return (elements.mesh.positions[at(ends[1])] - elements.mesh.positions[at(ends[0])]).norm();
}

}  // namespace

ExitFinder::ExitFinder(const ShellCutter& cutter, const ElementPlanes& planes, double thickness)
    : cutter_(cutter), planes_(planes), elements_(cutter.elements()), thickness_(thickness) {}

double ExitFinder::join_share(double length) const {
  return std::max(kSnap, std::min(kMostJoin, kJoin * thickness_ / length));
}

CrackExit ExitFinder::settle_on_edge(int cell_number, int side, double parameter) const {
  const CutCell& cell = cutter_.cell(cell_number);
  const int local_edge = cell.polygon[at(side)].side_id;
  CrackExit exit;
  exit.is_on_edge = true;
  exit.edge = elements_.topology.triangle_edges[at(cell.element)][at(local_edge)];
  const EdgeStretch stretch = cutter_.stretch(cell_number, side);
  // Cuts that reach an edge nearer than this to each other become one, and none passes a vertex.
  double q = std::min(std::max(parameter, kSnap), 1.0 - kSnap);
  double best = join_share(edge_length(elements_, exit.edge));
  double joined = -1.0;
  for (const double b : cutter_.breaks_of_edge(exit.edge))
    if (b >= stretch.begin && b <= stretch.end && std::abs(b - q) < best) {
      best = std::abs(b - q);
      joined = b;
    }
  if (joined >= 0.0) {
    q = joined;
    exit.has_met_cut = true;
  } else if (q <= stretch.begin || q >= stretch.end) {
    q = 0.5 * (stretch.begin + stretch.end);
  }
  exit.parameter = geometry::round_edge_parameter(q);
  exit.place.side = side;
  exit.place.barycentric = barycentric_on_edge(elements_, cell.element, local_edge, exit.parameter);
  for (int end = 0; end < 2; ++end) {
    const Size i = (at(side) + at(end)) % cell.polygon.size();
    if (cell.polygon[i].barycentric != exit.place.barycentric) continue;
    exit.place.is_corner = true;
    exit.place.side = static_cast<int>(i);
  }
  return exit;
}

CrackExit ExitFinder::settle_on_cut(int cell_number, int side, double share) const {
  const CutCell& cell = cutter_.cell(cell_number);
  const ElementPlane& plane = planes_.of(cell.element);
  const Size next = (at(side) + 1) % cell.polygon.size();
  const Vec2& from = cell.polygon[at(side)].barycentric;
  const Vec2& to = cell.polygon[next].barycentric;
  const double length = plane.flat(to - from).norm();
  const double snap = length > 0.0 ? join_share(plane.scale) * plane.scale / length : 1.0;
  CrackExit exit;
  exit.has_met_cut = true;
  exit.place.side = side;
  if (share < snap && share <= 0.5) {
    exit.place = {side, true, from};
  } else if (share > 1.0 - snap) {
    exit.place = {static_cast<int>(next), true, to};
  } else {
    exit.place.barycentric = from + share * (to - from);
  }
  return exit;
}

std::optional<CrackExit> ExitFinder::find_exit(int cell_number, int entry_side, const Vec2& start,
                                               const Vec2& heading) const {
  const CutCell& cell = cutter_.cell(cell_number);
  const ElementPlane& plane = planes_.of(cell.element);
  const Size n = cell.polygon.size();
  for (Size s = 0; s < n; ++s) {
    if (static_cast<int>(s) == entry_side) continue;
    const Vec2 to_begin = plane.flat(cell.polygon[s].barycentric) - start;
    const Vec2 to_end = plane.flat(cell.polygon[(s + 1) % n].barycentric) - start;
    const double before = cross(to_begin, heading);
    const double after = cross(heading, to_end);
    if (before < 0.0 || after < 0.0 || !(before + after > 0.0)) continue;
    if (to_begin.dot(heading) * after + to_end.dot(heading) * before <= 0.0) continue;  // behind
    const double share = before / (before + after);
    if (cell.polygon[s].side != SideKind::element_edge)
      return settle_on_cut(cell_number, static_cast<int>(s), share);
    const Vec2 place = cell.polygon[s].barycentric +
                       share * (cell.polygon[(s + 1) % n].barycentric - cell.polygon[s].barycentric);
    return settle_on_edge(cell_number, static_cast<int>(s),
                          edge_parameter(elements_, cell.element, cell.polygon[s].side_id, place));
  }
  return std::nullopt;
}

}  // namespace shatterbox::fracture
