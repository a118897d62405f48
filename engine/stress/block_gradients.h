// Conjugate gradients on K + shift M with a preconditioner of two levels, block Jacobi and rigid
// clusters: the solver of solids. At the
// accuracy that a strength asks for it costs what one back-substitution of a ready factor would, and nothing
// is factored. Sums are made in fixed chunks: the same bits for any number of threads and for any company of
// loads.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/vec.h"
#include "engine/stress/block_rows.h"
#include "engine/stress/coarse_modes.h"

namespace shatterbox::stress {

/// A vertex whose displacement stays within a subspace.
struct VertexHold {
  int vertex = 0;
  Mat3 allowed = Mat3::Zero();  // projector onto it; zero: clamped
};

/// What conjugate gradients ask of a matrix beside its rows.
struct BlockSystem {
  const BlockRows* rows = nullptr;
  const std::vector<float>* single = nullptr;  // entries of the rows in single precision; null: not made
  std::vector<double> inertia;                 // |V|: shift times mass, added on the diagonal; empty for none
  std::vector<double> inverse;  // |V| x 9: of the blocks on the diagonal, within what holds allow
  std::vector<int> hold_of;     // |V|: into holds, -1 for free vertices
  std::vector<VertexHold> holds;
  const CoarseModes* coarse = nullptr;               // second level, used where it has a factor
  std::optional<CoarseModes::Factor> coarse_factor;  // for this shift
  /// Takes out of a residual (|dof|) what the singular matrix cannot answer; empty for none.
  std::function<void(VecX&)> project;
};

/// Fills `inverse`; rows without stiffness or with nothing allowed get zeros.
void invert_diagonal(BlockSystem& system);

struct GradientSettings {
  double tolerance = 2e-3;  // of the residual, relative to the (projected) load
  int most_iterations = 1000;
};

struct GradientResult {
  VecX x, image;          // |dof|; image: (K + shift M) x within what holds allow
  double residual = 0.0;  // |b - image| / |b|, computed anew from x
  int iterations = 0;
  bool is_converged = false;
};

/// Answers to loads (|dof| each), each by itself; four share one pass over the matrix. `guesses` (as many, or
/// none; empty ones tell nothing): answers to loads alike, to begin with. Where the tolerance allows it the
/// work is done in single precision, twice as fast; what that leaves is checked, and done again where it is
/// too much.
std::vector<GradientResult> solve_by_gradients(const BlockSystem& system, std::span<const VecX> loads,
                                               const GradientSettings& settings,
                                               std::span<const VecX> guesses = {});

}  // namespace shatterbox::stress
