// The factors of one shape, made when first asked for and shared by all copies of the body: one for s = 0 and
// one for each power of two of the screening s.
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "engine/core/result.h"
#include "engine/stress/shell_figures.h"
#include "engine/stress/shell_system.h"

namespace shatterbox::stress {

/// Nearest power of two of a screening s > 0 (in the logarithm): its exponent.
int quantise_screening(double screening);
/// 2^exponent, 1/s.
double screening_of(int exponent);

class ShellSystemCache {
 public:
  ShellSystemCache(std::shared_ptr<const ShellStiffness> stiffness,
                   std::shared_ptr<const geometry::ShellMesh> mesh, ShellSupport support = {});

  using System = core::Result<std::shared_ptr<const ShellSystem>>;

  /// The system with s = 0 (balanced where free, clamped where supported). Any thread; made once.
  const System& unscreened();
  /// The system with s = 2^exponent. Any thread; made once.
  const System& screened(int exponent);

  /// What all systems of the shape share. Any thread; made at the first call.
  const std::shared_ptr<const ShellStructure>& structure();

  /// What does not depend on a load. Any thread; made at the first call.
  const ShellFigures& figures();

  const geometry::ShellMesh& mesh() const { return *mesh_; }
  const ShellStiffness& stiffness() const { return *stiffness_; }
  const std::shared_ptr<const ShellStiffness>& shared_stiffness() const { return stiffness_; }
  const ShellSupport& support() const { return support_; }
  /// Number of systems made so far, and bytes of memory that they hold with what they share.
  int count() const;
  double bytes() const;
  /// Gives up the systems and what they share; they are made again when asked for. Not while anyone asks, or
  /// keeps a reference.
  void give_up();

 private:
  /// What give_up() gives up.
  struct Made {
    std::once_flag has_structure;
    std::shared_ptr<const ShellStructure> structure;
    std::map<int, System> systems;  // by exponent
  };

  const System& get(int key, double screening);

  std::shared_ptr<const ShellStiffness> stiffness_;
  std::shared_ptr<const geometry::ShellMesh> mesh_;
  ShellSupport support_;
  std::once_flag has_figures_;
  ShellFigures figures_;
  // Guards the systems, and is never held while one is made: a thread that waits inside a parallel loop may
  // pick up work that asks for the same system. Two threads that ask at once both make it, to the same bits,
  // and the first is kept.
  mutable std::mutex mutex_;
  std::unique_ptr<Made> made_ = std::make_unique<Made>();
};

}  // namespace shatterbox::stress
