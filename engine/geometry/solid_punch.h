// Punches a convex part out of a solid's complex: the part that lies in all of some half spaces. A plane's
// field is linear, so the cut is the planes themselves whatever the elements, however large.
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

struct Punched {
  std::vector<char> is_inside;  // |cells| after it: 1 for those that are punched out
  double volume = 0.0;          // m3, of these
  double wall_area = 0.0;       // m2: facets between them and the others, now cracks with the tag
};

/// Parts what of `cells` lies in all half spaces from the others; only the wall between them is a crack, what
/// the planes cut beyond it holds together. The complex is settled, before and after.
Punched punch_out(SolidComplex& complex, const std::vector<PunchSide>& sides, std::vector<int> cells,
                  int tag);

}  // namespace shatterbox::geometry
