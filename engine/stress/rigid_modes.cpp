#include "engine/stress/rigid_modes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "engine/core/bytes.h"
#include "engine/core/elementary.h"
#include "engine/core/index.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

using core::at;

/// Combinations of vectors with these `products` that are orthonormal, in columns; zero where what is left of
/// the square of a vector is below its `least`.
Mat6 orthonormal_combinations(const Mat6& products, const Vec6& least) {
  Mat6 combinations = Mat6::Zero();
  for (int i = 0; i < 6; ++i) {
    Vec6 direction = Vec6::Unit(i);
    for (int j = 0; j < i; ++j) {
      const Vec6 other = combinations.col(j);
      direction -= other.dot(products * direction) * other;
    }
    const double norm = direction.dot(products * direction);
    if (norm > least[i]) combinations.col(i) = direction / core::sqrt(norm);
  }
  return combinations;
}

}  // namespace

RigidModes::RigidModes(std::vector<int> part_of_dof, const std::vector<Vec3>& positions,
                       const std::vector<Vec3>& edge_directions, const VecX& mass,
                       const std::vector<char>& is_clamped)
    : mass_(mass), part_(std::move(part_of_dof)) {
  for (const int part : part_)
    if (at(part + 1) > part_mass_.size()) part_mass_.resize(at(part + 1), 0.0);
  const Size parts = part_mass_.size();
  modes_ = Modes::Zero(mass.size(), 6);
  std::vector<Vec3> centre(parts, Vec3::Zero()), low(parts), high(parts);
  std::vector<char> has_box(parts, 0);
  for (Size v = 0; v < positions.size(); ++v) {
    const int dof = 3 * static_cast<int>(v);
    if (part_[at(dof)] < 0) continue;
    const Size part = at(part_[at(dof)]);
    part_mass_[part] += mass(dof);
    centre[part] += mass(dof) * positions[v];
    low[part] = has_box[part] != 0 ? Vec3(low[part].cwiseMin(positions[v])) : positions[v];
    high[part] = has_box[part] != 0 ? Vec3(high[part].cwiseMax(positions[v])) : positions[v];
    has_box[part] = 1;
  }
  part_size_.resize(parts);
  for (Size part = 0; part < parts; ++part) {
    centre[part] /= part_mass_[part];
    part_size_[part] = core::sqrt((high[part] - low[part]).squaredNorm());
  }

  // Translations, and rotations about the centre of mass, scaled so that the part's size counts as one
  // radian's arm.
  std::vector<std::vector<int>> dofs(parts);
  for (Size v = 0; v < positions.size(); ++v) {
    const int dof = 3 * static_cast<int>(v);
    if (part_[at(dof)] < 0) continue;
    const Size part = at(part_[at(dof)]);
    const Vec3 arm = (positions[v] - centre[part]) / part_size_[part];
    for (int axis = 0; axis < 3; ++axis) {
      modes_(dof + axis, axis) = 1.0;
      for (int turn = 0; turn < 3; ++turn) modes_(dof + axis, 3 + turn) = Vec3::Unit(turn).cross(arm)(axis);
      dofs[part].push_back(dof + axis);
    }
  }
  for (Size e = 0; e < edge_directions.size(); ++e) {
    const int dof = 3 * static_cast<int>(positions.size()) + static_cast<int>(e);
    if (part_[at(dof)] < 0) continue;
    const Size part = at(part_[at(dof)]);
    modes_.block<1, 3>(dof, 3) = edge_directions[e].transpose() / part_size_[part];
    dofs[part].push_back(dof);
  }
  for (Size part = 0; part < parts; ++part) orthonormalise(dofs[part], is_clamped);
}

void RigidModes::orthonormalise(const std::vector<int>& dofs, const std::vector<char>& is_clamped) {
  Mat6 held = Mat6::Zero();
  for (const int dof : dofs)
    if (is_clamped[at(dof)] != 0) held += modes_.row(dof).transpose() * modes_.row(dof);
  if (const double scale = held.trace(); scale > 0.0) {
    const Eigen::SelfAdjointEigenSolver<Mat6> eigen(held);
    Mat6 free = eigen.eigenvectors();
    for (int i = 0; i < 6; ++i)
      if (!(eigen.eigenvalues()(i) < 1e-9 * scale)) free.col(i).setZero();
    combine(dofs, free);
    for (const int dof : dofs)
      if (is_clamped[at(dof)] != 0) modes_.row(dof).setZero();
  }
  // Gram and Schmidt on the six coefficients, and once more on what that gives, for the last digits: what is
  // then far from a unit was rounding, of a motion that moves nothing.
  Mat6 products = mass_product(dofs);
  combine(dofs, orthonormal_combinations(products, 1e-20 * products.diagonal()));
  products = mass_product(dofs);
  const Mat6 normal = orthonormal_combinations(products, Vec6::Constant(0.5));
  combine(dofs, normal);
  for (int i = 0; i < 6; ++i) mode_count_ += normal.col(i).isZero(0.0) ? 0 : 1;
}

/// R^T M R over some unknowns.
Eigen::Matrix<double, 6, 6> RigidModes::mass_product(const std::vector<int>& dofs) const {
  Mat6 product = Mat6::Zero();
  for (const int dof : dofs) {
    if (mass_(dof) == 0.0) continue;
    const double* const row = &modes_(dof, 0);
    for (int i = 0; i < 6; ++i) {
      const double weighted = mass_(dof) * row[i];
      for (int j = 0; j <= i; ++j) product(i, j) += weighted * row[j];
    }
  }
  return product.selfadjointView<Eigen::Lower>();
}

/// Of each unknown the row times `combinations`.
void RigidModes::combine(const std::vector<int>& dofs, const Mat6& combinations) {
  for (const int dof : dofs) modes_.row(dof) = (modes_.row(dof) * combinations).eval();
}

void RigidModes::remove_motion(VecX& x) const {
  std::vector<Vec6> amount(part_mass_.size(), Vec6::Zero());
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (const int part = part_[static_cast<Size>(i)]; part >= 0)
      amount[at(part)] += (mass_(i) * x(i)) * modes_.row(i).transpose();
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (const int part = part_[static_cast<Size>(i)]; part >= 0) x(i) -= modes_.row(i).dot(amount[at(part)]);
}

RigidModes::Amounts RigidModes::resultants(const VecX& b) const {
  Amounts amounts(part_mass_.size(), Vec6::Zero());
  for (Eigen::Index i = 0; i < b.size(); ++i)
    if (const int part = part_[static_cast<Size>(i)]; part >= 0 && b(i) != 0.0)
      amounts[at(part)] += b(i) * modes_.row(i).transpose();
  return amounts;
}

void RigidModes::subtract(VecX& b, const Amounts& amounts) const {
  std::vector<char> is_moved(amounts.size());
  for (Size part = 0; part < amounts.size(); ++part) is_moved[part] = !amounts[part].isZero(0.0);
  for (Eigen::Index i = 0; i < b.size(); ++i)
    if (const int part = part_[static_cast<Size>(i)]; part >= 0 && is_moved[at(part)] != 0)
      b(i) -= mass_(i) * modes_.row(i).dot(amounts[at(part)]);
}

double RigidModes::bytes() const {
  return core::bytes_in(mass_, part_, part_mass_, part_size_, modes_);
}

void RigidModes::balance(VecX& b) const {
  subtract(b, resultants(b));
}

}  // namespace shatterbox::stress
