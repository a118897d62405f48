// Solids cut open to show their level sets: the half towards the eye is left out, and on the plane through
// the middle every point has the colour of its distance to the surface.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "engine/body/shape.h"
#include "engine/geometry/level_set.h"
#include "render/frame/mesh.h"

namespace shatterbox::sandbox::view {

/// Where a slice lies, in body space: across an axis of the body, and which half is left out.
struct SliceSide {
  int axis = 2;
  bool leaves_out_above = true;  // the half with the greater coordinates
};

/// The side that the eye (body space) looks at.
SliceSide side_towards(const Vec3& eye);

struct Slice {
  std::shared_ptr<const render::Mesh> mesh;
  std::shared_ptr<const std::vector<float>> distances;  // mm, at its vertices; negative inside
};

/// `id` as render::Mesh wants it.
Slice make_slice(const body::Shape& shape, const geometry::LevelSet& set, const SliceSide& side,
                 std::uint64_t id);

/// A solid's level set and the slices of it that were shown.
class SliceShelf {
 public:
  /// Made at the first call; null where the solid is too small for the grid of the whole.
  const geometry::LevelSet* level_set(const body::Shape& shape, const geometry::LevelSetSpace& space);
  const Slice& slice(const body::Shape& shape, const SliceSide& side, std::uint64_t& next_id);
  double bytes() const { return set_ ? set_->bytes() : 0.0; }

 private:
  bool is_asked_ = false;
  std::shared_ptr<const geometry::LevelSet> set_;
  std::array<Slice, 6> slices_;
};

}  // namespace shatterbox::sandbox::view
