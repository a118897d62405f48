#include "engine/stress/first_frequency.h"

#include "engine/core/elementary.h"
#include "engine/core/random.h"
#include "engine/core/symmetric_eigen.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;

constexpr int kVectors = 4;

/// Of stiff x = w heavy x, where heavy has no null space: with heavy = L L^T, what L^-1 stiff L^-T has. The
/// vectors' products by `heavy` are those of units.
core::SymmetricEigen solve_ritz(const Eigen::Matrix4d& stiff, const Eigen::Matrix4d& heavy) {
  Eigen::Matrix4d root = Eigen::Matrix4d::Zero(), inverse = Eigen::Matrix4d::Zero();
  for (int j = 0; j < kVectors; ++j) {
    for (int i = j; i < kVectors; ++i) {
      double left = heavy(i, j);
      for (int k = 0; k < j; ++k) left -= root(i, k) * root(j, k);
      root(i, j) = i == j ? core::sqrt(left) : left / root(j, j);
    }
  }
  for (int j = 0; j < kVectors; ++j) {
    for (int i = j; i < kVectors; ++i) {
      double left = i == j ? 1.0 : 0.0;
      for (int k = j; k < i; ++k) left -= root(i, k) * inverse(k, j);
      inverse(i, j) = left / root(i, i);
    }
  }
  core::SymmetricEigen ritz = core::symmetric_eigen(Eigen::Matrix4d(inverse * stiff * inverse.transpose()));
  ritz.vectors = Eigen::Matrix4d(inverse.transpose() * Eigen::Matrix4d(ritz.vectors));
  return ritz;
}

}  // namespace

FrequencyEstimate first_frequency(
    const ShellStructure& structure,
    const std::function<std::vector<VecX>(const std::vector<const VecX*>&)>& precondition, int steps) {
  const VecX& mass = structure.mass;
  core::Random random(1, 0);
  std::vector<VecX> basis(kVectors, VecX::Zero(mass.size()));
  for (VecX& x : basis) {
    for (Eigen::Index i = 0; i < structure.vertex_dofs; ++i) x(i) = random.uniform(-1.0, 1.0);
    structure.restrict_to_active(x);
  }
  FrequencyEstimate frequency;
  for (int iteration = 0; iteration < steps; ++iteration) {
    std::vector<VecX> loads;
    std::vector<const VecX*> pointers;
    for (const VecX& x : basis) loads.push_back(mass.cwiseProduct(x));
    for (const VecX& load : loads) pointers.push_back(&load);
    basis = precondition(pointers);
    for (VecX& x : basis) {
      const double norm = core::sqrt(x.dot(mass.cwiseProduct(x)));
      if (!(norm > 0.0)) return {};
      x /= norm;
    }
    Eigen::Matrix4d stiff, heavy;
    for (Size j = 0; j < kVectors; ++j) pointers[j] = &basis[j];
    const std::vector<VecX> products = structure.multiply_stiffness(pointers);
    for (Size j = 0; j < kVectors; ++j) {
      const VecX& product = products[j];
      const VecX momentum = mass.cwiseProduct(basis[j]);
      for (Size i = 0; i < kVectors; ++i) {
        stiff(static_cast<int>(i), static_cast<int>(j)) = basis[i].dot(product);
        heavy(static_cast<int>(i), static_cast<int>(j)) = basis[i].dot(momentum);
      }
    }
    // The first step of a small body may leave fewer than four independent vectors.
    heavy.diagonal() *= 1.0 + 1e-12;
    const core::SymmetricEigen ritz = solve_ritz(stiff, heavy);
    frequency = {ritz.values(0), frequency.squared};
    if (iteration + 1 == steps) break;
    std::vector<VecX> turned(kVectors, VecX::Zero(mass.size()));
    for (Size j = 0; j < kVectors; ++j)
      for (Size i = 0; i < kVectors; ++i)
        turned[j] += ritz.vectors(static_cast<int>(i), static_cast<int>(j)) * basis[i];
    basis = std::move(turned);
    if (iteration > 2 &&
        std::abs(frequency.squared - frequency.previous) < 5e-3 * std::abs(frequency.squared))
      break;
  }
  return frequency;
}

}  // namespace shatterbox::stress
