#include "engine/geometry/solid_punch.h"

#include <algorithm>

#include "engine/core/index.h"
#include "engine/core/stop.h"
#include "engine/geometry/solid_contacts.h"
#include "engine/geometry/solid_cutter.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

template <class Visit>
void for_each_corner(const SolidComplex& complex, int cell, const Visit& visit) {
  const SolidPart& part = complex.cells[at(cell)];
  for (int f = 0; f < part.facet_count; ++f) {
    const SolidFacet& facet = complex.facets[at(complex.cell_facets[at(part.first_facet + f)] / 2)];
    for (int k = 0; k < facet.side_count; ++k)
      visit(complex.position(complex.side_begin(complex.sides_of(facet)[k])));
  }
}

/// False if all corners are outside of one of the half spaces.
bool may_reach(const SolidComplex& complex, int cell, const std::vector<PunchSide>& sides) {
  for (const PunchSide& side : sides) {
    bool is_beyond = true;
    for_each_corner(complex, cell, [&](const Vec3& corner) {
      if (side.normal.dot(corner) <= side.offset) is_beyond = false;
    });
    if (is_beyond) return false;
  }
  return true;
}

double distance_squared(const SolidComplex& complex, int cell, const Vec3& place) {
  double nearest = 1e300;
  for_each_corner(complex, cell,
                  [&](const Vec3& corner) { nearest = std::min(nearest, (corner - place).squaredNorm()); });
  return nearest;
}

}  // namespace

std::vector<int> find_punch_cells(const SolidComplex& complex, const std::vector<PunchSide>& sides,
                                  const Vec3& place) {
  const Size count = complex.cells.size();
  std::vector<char> reaches(count, 0);
  int first = -1;
  double nearest = 1e300;
  for (Size c = 0; c < count; ++c) {
    if (!may_reach(complex, static_cast<int>(c), sides)) continue;
    reaches[c] = 1;
    const double distance = distance_squared(complex, static_cast<int>(c), place);
    if (distance >= nearest) continue;
    nearest = distance;
    first = static_cast<int>(c);
  }
  if (first < 0) return {};
  std::vector<std::vector<int>> neighbours(count);
  for (const SolidContact& contact : find_solid_contacts(complex)) {
    if (!reaches[at(contact.cell_a)] || !reaches[at(contact.cell_b)]) continue;
    neighbours[at(contact.cell_a)].push_back(contact.cell_b);
    neighbours[at(contact.cell_b)].push_back(contact.cell_a);
  }
  std::vector<int> found{first};
  reaches[at(first)] = 0;
  for (Size i = 0; i < found.size(); ++i)
    for (const int next : neighbours[at(found[i])]) {
      if (!reaches[at(next)]) continue;
      reaches[at(next)] = 0;
      found.push_back(next);
    }
  std::sort(found.begin(), found.end());
  return found;
}

Punched punch_out(SolidComplex& complex, const std::vector<PunchSide>& sides, std::vector<int> cells,
                  int tag) {
  SolidCutter cutter(complex);
  for (const PunchSide& side : sides) {
    core::stop_if_asked();
    SolidCut cut;
    cut.id = tag;
    for (const Vec3& node : complex.elements->mesh.positions)
      cut.node_values.push_back(side.normal.dot(node) - side.offset);
    cut.cells = std::move(cells);
    cutter.cut(cut);
    // What is beyond this plane is not cut by the next ones.
    cells.clear();
    for (Size c = 0; c < complex.cells.size(); ++c)
      if (cutter.side_of(static_cast<int>(c)) < 0) cells.push_back(static_cast<int>(c));
  }
  settle(complex);
  Punched out;
  out.is_inside.assign(complex.cells.size(), 0);
  for (const int c : cells) {
    out.is_inside[at(c)] = 1;
    out.volume += complex.cells[at(c)].volume;
  }
  for (SolidFacet& facet : complex.facets) {
    if (facet.parts[0] >= 0 || facet.cells[0] < 0 || facet.cells[1] < 0) continue;
    if (out.is_inside[at(facet.cells[0])] != out.is_inside[at(facet.cells[1])]) {
      if (facet.kind == FacetKind::crack && facet.tag != tag) continue;  // stood open before
      // Where a plane lies on one that was cut before, its facets are there already.
      facet.kind = FacetKind::crack;
      facet.tag = tag;
      out.wall_area += facet_area_vector(complex, facet).norm();
    } else if (facet.kind == FacetKind::crack && facet.tag == tag) {
      facet.kind = FacetKind::grain;
      facet.tag = -1;
    }
  }
  return out;
}

}  // namespace shatterbox::geometry
