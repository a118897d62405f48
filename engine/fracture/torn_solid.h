// What tears and is dented in one hit: a solid with open cracks on elements of its own (solid_copies.h), so
// that the dent opens them.
#pragma once

#include <memory>
#include <vector>

#include "engine/fracture/decide_solid.h"
#include "engine/fracture/solid_model.h"
#include "engine/geometry/solid_copies.h"

namespace shatterbox::fracture {

struct TornSolid {
  std::shared_ptr<const geometry::SolidComplex> source;  // settled, with the cracks
  geometry::CopiedSolid copied;
  std::shared_ptr<const SolidModel> model;  // of the copy
  double area = 0.0;                        // m2, of the cracks (one face)
};

/// Whether material stands on both sides of a crack of a settled complex.
bool has_open_cracks(const geometry::SolidComplex& complex);

/// Whether it is on copies: its tears are open.
bool is_torn(const SolidSubject& subject);

/// `mesh`: the degrees of freedom of `source`. `clamped`: held vertices of its element mesh.
std::shared_ptr<const TornSolid> make_torn(std::shared_ptr<const geometry::SolidComplex> source,
                                           const geometry::SolidMesh& mesh,
                                           const stress::SolidProperties& properties,
                                           const std::vector<int>& clamped);

/// A displacement of the source's mesh (|dof|, m) as one of the model's.
VecX carry(const TornSolid& torn, const VecX& displacement);

/// The moves of the copies' vertices (m) as those of what they are copies of: their mean; and back.
std::vector<Vec3> as_of_sources(const TornSolid& torn, const std::vector<Vec3>& moves);
std::vector<Vec3> as_of_copies(const TornSolid& torn, const std::vector<Vec3>& moves);

/// The subject that has the source, on the copies: with its flaws, its grains and its support.
SolidSubject on_copies(const SolidSubject& subject, const std::shared_ptr<const TornSolid>& torn);

}  // namespace shatterbox::fracture
