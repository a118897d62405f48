// Principal values and directions of a symmetric 3 x 3 tensor by Jacobi's rotations: nothing but the four
// operations and square roots, so the same bits everywhere.
#pragma once

#include "engine/core/vec.h"

namespace shatterbox::stress {

struct PrincipalAxes {
  Vec3 values = Vec3::Zero();          // descending
  Mat3 directions = Mat3::Identity();  // columns, unit, right-handed
};

/// Of a symmetric tensor (its lower triangle is read). Where two values are one, any two directions that are
/// orthogonal are as good; which ones depends on the tensor alone.
PrincipalAxes find_principal_axes(const Mat3& tensor);

}  // namespace shatterbox::stress
