#include "engine/geometry/solid_punch.h"

#include <algorithm>
#include <iterator>

#include "engine/core/index.h"
#include "engine/core/stop.h"
#include "engine/geometry/solid_contacts.h"
#include "engine/geometry/solid_cutter.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kPlaneSnap = 1e-6;          // of cuts that are to stay planes: see SolidCutter
constexpr std::int16_t kMostPlanes = 32767;  // that have a number

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

/// False if no corner of the cells is outside of the half space.
bool cuts_any(const SolidComplex& complex, const std::vector<int>& cells, const PunchSide& side) {
  return std::any_of(cells.begin(), cells.end(), [&](int cell) {
    bool is_within = true;
    for_each_corner(complex, cell, [&](const Vec3& corner) {
      if (side.normal.dot(corner) > side.offset) is_within = false;
    });
    return !is_within;
  });
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

Punched punch_out(SolidComplex& complex, const std::vector<PunchRegion>& regions, std::vector<int> groups,
                  int tag, Walls walls) {
  Punched out;
  out.region_of.assign(complex.cells.size(), -1);
  std::vector<int> near;  // cells of groups that have regions
  for (Size c = 0; c < groups.size(); ++c)
    if (groups[c] >= 0) near.push_back(static_cast<int>(c));
  SolidCutter cutter(complex, walls == Walls::plane ? kPlaneSnap : SolidCutter::kUsualSnap);
  SolidCut cut;
  cut.id = tag;
  std::int16_t planes = 0;
  cut.node_values.resize(complex.elements->mesh.positions.size());
  for (Size r = 0; r < regions.size(); ++r) {
    const PunchRegion& region = regions[r];
    const auto is_free = [&](int c) {
      return groups[at(c)] == region.group && out.region_of[at(c)] < 0 && may_reach(complex, c, region.sides);
    };
    std::vector<int> inside;
    std::copy_if(near.begin(), near.end(), std::back_inserter(inside), is_free);
    for (const PunchSide& side : region.sides) {
      core::stop_if_asked();
      if (!cuts_any(complex, inside, side)) continue;
      if (walls == Walls::plane) cut.plane = planes < kMostPlanes ? planes++ : std::int16_t{-1};
      for (const int c : inside)
        for (const int node : complex.elements->mesh.tetrahedra[at(complex.cells[at(c)].element)])
          cut.node_values[at(node)] =
              side.normal.dot(complex.elements->mesh.positions[at(node)]) - side.offset;
      cut.cells = std::move(inside);
      cutter.cut(cut);
      const Size before = groups.size();
      groups.resize(complex.cells.size(), region.group);
      out.region_of.resize(complex.cells.size(), -1);
      // What is beyond this plane is not cut by the next ones.
      inside.clear();
      const auto take = [&](int c) {
        if (cutter.side_of(c) < 0) inside.push_back(c);
      };
      std::for_each(cut.cells.begin(), cut.cells.end(), take);
      for (Size c = before; c < groups.size(); ++c) {
        near.push_back(static_cast<int>(c));
        take(static_cast<int>(c));
      }
    }
    for (const int c : inside) out.region_of[at(c)] = static_cast<int>(r);
  }
  settle(complex);
  out.volumes.assign(regions.size(), 0.0);
  for (Size c = 0; c < complex.cells.size(); ++c)
    if (out.region_of[c] >= 0) out.volumes[at(out.region_of[c])] += complex.cells[c].volume;
  for (SolidFacet& facet : complex.facets) {
    if (facet.parts[0] >= 0 || facet.cells[0] < 0 || facet.cells[1] < 0) continue;
    if (out.region_of[at(facet.cells[0])] != out.region_of[at(facet.cells[1])]) {
      if (facet.kind == FacetKind::crack && facet.tag != tag) continue;  // stood open before
      // Where a plane lies on one that was cut before, its facets are there already.
      facet.kind = FacetKind::crack;
      facet.tag = tag;
      out.wall_area += facet_area_vector(complex, facet).norm();
    } else if (facet.kind == FacetKind::crack && facet.tag == tag) {
      facet.kind = FacetKind::grain;
      facet.tag = -1;
      facet.plane = -1;
    }
  }
  return out;
}

}  // namespace shatterbox::geometry
