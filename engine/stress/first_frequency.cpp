#include "engine/stress/first_frequency.h"

#include <Eigen/Eigenvalues>

#include "engine/core/elementary.h"
#include "engine/core/random.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;

}  // namespace

FrequencyEstimate first_frequency(
    const ShellStructure& structure,
    const std::function<std::vector<VecX>(const std::vector<const VecX*>&)>& precondition, int steps) {
  constexpr int kVectors = 4;
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
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix4d> ritz(stiff, heavy);
    frequency = {ritz.eigenvalues()(0), frequency.squared};
    if (iteration + 1 == steps) break;
    std::vector<VecX> turned(kVectors, VecX::Zero(mass.size()));
    for (Size j = 0; j < kVectors; ++j)
      for (Size i = 0; i < kVectors; ++i)
        turned[j] += ritz.eigenvectors()(static_cast<int>(i), static_cast<int>(j)) * basis[i];
    basis = std::move(turned);
    if (iteration > 2 &&
        std::abs(frequency.squared - frequency.previous) < 5e-3 * std::abs(frequency.squared))
      break;
  }
  return frequency;
}

}  // namespace shatterbox::stress
