// The signed distance to a closed surface on a uniform grid, [BHTF07] sec. VII, [GBF03]: what each triangle
// gives to the nodes near it (triangle_patch.h), sides by the regions that the surface leaves of the grid,
// and farther away the nearest triangle handed on from node to node by sweeping [Tsai02].
#pragma once

#include <memory>
#include <vector>

#include "engine/core/result.h"
#include "engine/core/vec.h"
#include "engine/geometry/triangle_mesh.h"
#include "engine/geometry/triangle_patch.h"

namespace shatterbox::geometry {

/// What the grids of a body and of its pieces have in common. Material space: that of the unbroken body.
struct LevelSetSpace {
  double spacing = 0.0;  // m, between nodes, which stand at whole multiples of it
  std::shared_ptr<PatchCache> patches = std::make_shared<PatchCache>();
};

inline constexpr int kLevelSetCells = 48;
/// So many cells across an unbroken body of that size, m.
LevelSetSpace make_level_set_space(double size);
/// Pieces with fewer cells across their greatest side get no level set: the grid would not see their form.
inline constexpr double kLeastLevelSetCells = 6.0;

class LevelSet {
 public:
  /// Of a closed surface (positions in m, in material space less `material_from_body`). Fails with a sentence
  /// if there is none, or it is too small or too large for the grid.
  static core::Result<std::shared_ptr<const LevelSet>> make(const TriangleMesh& surface,
                                                            const Vec3& material_from_body,
                                                            const LevelSetSpace& space);

  /// m, at a point of material space, linear between the nodes; negative inside. Nodes within
  /// TrianglePatch::kReach are right to 3e-6 of the spacing, others to .2; beyond the grid it is more than it
  /// is.
  double distance(const Vec3& material) const;
  /// Its slope there (nearly of length one), which points outwards.
  Vec3 gradient(const Vec3& material) const;

  double spacing() const { return spacing_; }
  const GridPlace& low() const { return low_; }                 // of the first node
  const GridPlace& count() const { return count_; }             // of nodes along each axis; x runs fastest
  const std::vector<float>& values() const { return values_; }  // m
  double bytes() const;

 private:
  LevelSet() = default;

  double spacing_ = 0.0;  // m
  GridPlace low_{}, count_{};
  std::vector<float> values_;
};

}  // namespace shatterbox::geometry
