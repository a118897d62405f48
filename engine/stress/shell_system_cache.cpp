#include "engine/stress/shell_system_cache.h"

#include <cmath>
#include <limits>

#include "engine/core/elementary.h"

namespace shatterbox::stress {
namespace {

constexpr int kUnscreened = std::numeric_limits<int>::min();

}  // namespace

int quantise_screening(double screening) {
  // frexp and ldexp are exact: screening = fraction 2^exponent with fraction in [1/2, 1).
  int exponent = 0;
  const double fraction = std::frexp(screening, &exponent);
  return fraction * fraction < 0.5 ? exponent - 1 : exponent;
}

double screening_of(int exponent) {
  return std::ldexp(1.0, exponent);
}

ShellSystemCache::ShellSystemCache(std::shared_ptr<const ShellStiffness> stiffness,
                                   std::shared_ptr<const geometry::ShellMesh> mesh, ShellSupport support)
    : stiffness_(std::move(stiffness)), mesh_(std::move(mesh)), support_(std::move(support)) {}

const ShellSystemCache::System& ShellSystemCache::get(int key, double screening) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto kept = made_->systems.find(key); kept != made_->systems.end()) return kept->second;
  }
  System made = ShellSystem::make(structure(), screening);
  const std::lock_guard lock(mutex_);
  return made_->systems.emplace(key, std::move(made)).first->second;
}

const ShellSystemCache::System& ShellSystemCache::unscreened() {
  return get(kUnscreened, 0.0);
}

const ShellSystemCache::System& ShellSystemCache::screened(int exponent) {
  return get(exponent, screening_of(exponent));
}

const std::shared_ptr<const ShellStructure>& ShellSystemCache::structure() {
  std::call_once(made_->has_structure,
                 [this] { made_->structure = ShellStructure::make(stiffness_, *mesh_, support_); });
  return made_->structure;
}

const ShellFigures& ShellSystemCache::figures() {
  std::call_once(has_figures_, [this] { figures_ = make_shell_figures(*stiffness_, *mesh_); });
  return figures_;
}

int ShellSystemCache::count() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(made_->systems.size());
}

double ShellSystemCache::bytes() const {
  const std::lock_guard lock(mutex_);
  double sum = made_->structure ? made_->structure->bytes() : 0.0;
  for (const auto& [key, system] : made_->systems)
    if (system) sum += system.value()->bytes();
  return sum;
}

void ShellSystemCache::give_up() {
  made_ = std::make_unique<Made>();
}

}  // namespace shatterbox::stress
