// Punches convex parts out of a solid's complex: what lies in all of some half spaces. A plane's field is
// linear, so the cut is the planes themselves whatever the elements, however large.
#pragma once

#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/solid_complex.h"

namespace shatterbox::geometry {

/// The half space normal . x <= offset.
struct PunchSide {
  Vec3 normal = Vec3::UnitX();  // of any length
  double offset = 0.0;          // m, times that length
};

/// Cells (ascending) that may reach into all half spaces and hang together there with the one nearest to
/// `place`. Settled complex.
std::vector<int> find_punch_cells(const SolidComplex& complex, const std::vector<PunchSide>& sides,
                                  const Vec3& place);

/// A convex part of the material of one group: what lies in all of these half spaces.
struct PunchRegion {
  std::vector<PunchSide> sides;
  int group = 0;
};

struct Punched {
  std::vector<int> region_of;   // |cells| after it: the region that each is in, or -1
  std::vector<double> volumes;  // m3, of each region
  double wall_area = 0.0;       // m2: facets between a region and others, now cracks with the tag
};

/// How a piece's surface has the walls: with the vertices of the elements that they go through, along which
/// they can bend, or as the planes that they are.
enum class Walls { by_element, plane };

/// Parts regions, which do not overlap, from all else and from each other; only the walls between them are
/// cracks, what the planes cut beyond them holds together. `groups` (|cells|): whose material each cell is;
/// below zero: nobody's. The complex is settled, before and after.
Punched punch_out(SolidComplex& complex, const std::vector<PunchRegion>& regions, std::vector<int> groups,
                  int tag, Walls walls = Walls::by_element);

}  // namespace shatterbox::geometry
