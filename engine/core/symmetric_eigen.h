// Eigenvalues and eigenvectors of small symmetric matrices: a few lines where Eigen's solver for any size
// takes seconds to compile.
#pragma once

#include "engine/core/vec.h"

namespace shatterbox::core {

struct SymmetricEigen {
  VecX values;              // ascending
  Eigen::MatrixXd vectors;  // in columns, orthonormal
};

/// By Jacobi's rotations, to some units in the last place of the largest eigenvalue. Of `matrix` the lower
/// triangle counts. The time goes as the cube of the rows.
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

}  // namespace shatterbox::core
