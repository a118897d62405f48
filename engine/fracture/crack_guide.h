// Where the cracks of one generation would run through one piece of a solid. A potential flows easily along
// the planes across the first principal stress and hardly through them; the level set through the place where
// a crack starts is the crack's surface. Departs from tracing from element to element: a stress field's
// planes seldom fit together to a surface, and a traced one crumples. As the potential of a source beside a
// sink has no other extremes, the surface is one sheet that parts the piece, meets free surfaces at right
// angles and goes straight on where the stress tells nothing. (J. Oliver, A. E. Huespe, E. Samaniego, E. W.
// V. Chaves track all cracks of a body by such potentials [OHSC04].)
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/tet_mesh.h"

namespace shatterbox::stress {
struct FrontTree;
}

namespace shatterbox::fracture {

/// An element of the piece, and how it conducts.
struct GuideElement {
  int element = 0;                     // of the mesh
  double volume = 0.0;                 // m3, of the piece's material in it
  Mat3 conduction = Mat3::Identity();  // symmetric, positive definite
};

/// Where a crack starts: at `place` (m) in `element`, across `normal` (unit).
struct GuideStart {
  int element = 0;
  Vec3 place = Vec3::Zero(), normal = Vec3::Zero();
};

/// Elimination trees of guides: of pieces of the same elements they are the same, one generation after the
/// other.
class GuideTrees {
 public:
  /// `vertex_rank` (|nodes of the mesh|): a good order of elimination (stress/elimination_order.h).
  explicit GuideTrees(const std::vector<int>& vertex_rank);

  std::shared_ptr<const stress::FrontTree> of(const geometry::TetMesh& mesh,
                                              const std::vector<GuideElement>& elements);

 private:
  std::vector<int> order_;  // |nodes|, first eliminated first
  std::shared_ptr<const stress::FrontTree> last_;
  std::vector<int> elements_of_last_;
};

class CrackGuide {
 public:
  /// `elements` hang together by faces and come ascending; `trees` are those of the mesh.
  CrackGuide(const geometry::TetMesh& mesh, std::vector<GuideElement> elements, GuideTrees& trees);
  ~CrackGuide();
  CrackGuide(CrackGuide&&) noexcept;

  /// For each start, which is in one of the piece's elements, by node of the mesh: zero at its place, growing
  /// along its normal there. Nodes near the surface are on it, so that cracks have fewer and wider faces:
  /// they have a positive value that is next to nothing. Exactly 0 where it is not known: at nodes of other
  /// elements, and where so little is left of it that its sign is rounding. Several at once cost less than
  /// one after the other, and are the same. Any thread.
  std::vector<std::vector<double>> potentials(std::span<const GuideStart> starts) const;

 private:
  struct Factor;
  std::vector<double> source_at(const GuideStart& start) const;
  std::vector<double> level(const GuideStart& start, const std::vector<double>& flow) const;

  const geometry::TetMesh& mesh_;
  std::vector<GuideElement> elements_;
  std::unique_ptr<Factor> factor_;
};

/// Puts nodes near the zero of a field (by node) on it, as potential() does: they get a positive value that
/// is next to nothing. Where `known` is 0, so is the field, and is not looked at.
void settle_near_nodes(const geometry::TetMesh& mesh, const std::vector<double>& known,
                       std::vector<double>& field);

/// The potential's conduction: across the planes normal to `across` (unit) by as much less as `sureness`
/// (0 to 1) says.
Mat3 guide_conduction(const Vec3& across, double sureness);

}  // namespace shatterbox::fracture
