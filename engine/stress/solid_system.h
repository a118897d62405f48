// The linear system of a solid, K + s^2 M: made once a mesh (nothing is factored), then any number of loads
// from any number of threads. Balanced (s = 0, free bodies: inertia relief), supported (s = 0, clamped) or
// screened (s > 0: the displacement averaged over a window of 1 / s, exact for the waves that can run in it).
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/core/vec.h"
#include "engine/stress/solid_stiffness.h"
#include "engine/stress/solid_support.h"

namespace shatterbox::stress {

/// How a free part's rigid motions, which no stiffness answers, are dealt with.
enum class NullSpace : unsigned char {
  balanced,  // the load is relieved of them, weighted by mass: the time integral of a damped free body
  paper,     // [BHTF07] sec. V: X1 stays, X2 moves along X1 X2 only, X3 in the plane of the three. Of an
             // unbalanced load that leaves a false stress at the three points: a study's variant
};

struct SolidSystemOptions {
  SolidSupport support;
  NullSpace null_space = NullSpace::balanced;
  /// For `paper`: X1, X2, X3 of parts, virtual vertices not in line. A free part without gets its first
  /// three.
  std::vector<std::array<int, 3>> anchors;
};

struct SolidSolveSettings {
  double screening = 0.0;   // s, 1/s
  double tolerance = 2e-3;  // of the residual: what a strength asks for
  int most_iterations = 0;  // 0: a thousand, and more for large meshes
};

/// Answer to one load, SI units. If the load is an impulse (N s) read every unit times a second.
struct SolidSolution {
  VecX displacement;                // |dof|, m; of free parts without their rigid motion
  VecX rigid_displacement;          // |dof|, m: that motion, in a screened solve; else empty
  double compliance = 0.0;          // load . (both displacements), J (for a unit force: m/N)
  double elastic_compliance = 0.0;  // displacement . K displacement, J: twice the elastic energy
  double residual = 0.0;            // |b - A u| / |b|, of the balanced load; the worst of its parts
  int iterations = 0;               // of the part that took most
  std::string fault;                // why the displacement is no answer; empty if it is one
  bool is_evaluated() const { return fault.empty(); }
};

class SolidSystem {
 public:
  /// Fails, with a sentence, for a mesh without cells or whose support clamps all of it.
  static core::Result<std::shared_ptr<const SolidSystem>> make(
      std::shared_ptr<const SolidStiffness> stiffness, const geometry::SolidMesh& mesh,
      const SolidSystemOptions& options = {});
  ~SolidSystem();
  SolidSystem(const SolidSystem&) = delete;
  SolidSystem& operator=(const SolidSystem&) = delete;

  /// Solves for each load (|dof|, N). With s = 0 every connected part is first relieved of the rigid motion
  /// that its load causes and that its support allows (not with the paper's null space). Same bits whatever
  /// the number of loads or threads. Up to four loads cost little more than one. `guesses` (m; as many as
  /// loads, or none; empty ones tell nothing): displacements to begin with, of a body hardly another one.
  std::vector<SolidSolution> solve(const std::vector<VecX>& loads, const SolidSolveSettings& settings = {},
                                   const std::vector<VecX>& guesses = {}) const;
  SolidSolution solve(const VecX& load, const SolidSolveSettings& settings = {}) const;
  /// The load (|dof|, N) as the solve sees it with s = 0: b = J - M R R^T J.
  VecX balance(const VecX& load) const;

  /// Longest period of free (or supported) vibration, s, to about 1 %; computed at the first call, then kept.
  /// 0 if nothing can vibrate.
  double first_period() const;
  /// Period (s) of the vibration that a solution's displacement would be: by Rayleigh's quotient the first
  /// period of the solid, free or supported, is at least that long. Rigid motion does not count.
  double trial_period(const SolidSolution& solution) const;

  int dof_count() const;
  int part_count() const;  // connected parts of the mesh, each solved by itself
  /// |virtual vertices|: the part that each is of, numbered by their first vertices; -1 for none.
  const std::vector<int>& part_of_vertex() const;
  int rigid_mode_count() const;  // over all parts: 6 for each free one, fewer where supported
  const SolidStiffness& stiffness() const;
  double block_count() const;  // 3 x 3 blocks of the matrix, for benches

 private:
  struct State;
  explicit SolidSystem(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// load i . (both displacements) j in J (for unit forces: m/N), |loads| x |loads|, made symmetric.
Eigen::MatrixXd compliance_matrix(const std::vector<VecX>& loads,
                                  const std::vector<SolidSolution>& solutions);

}  // namespace shatterbox::stress
