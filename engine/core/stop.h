// Long work that can be asked to stop: who starts it says how to ask, and the loops that may take long ask,
// without a word of it in any signature between them.
#pragma once

#include <exception>
#include <functional>

namespace shatterbox::core {

/// Whether the work is to stop. Asked often, and from several threads at once.
using StopQuestion = std::function<bool()>;

/// What leaves the loops then. It never leaves the function that opened the scope.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped"; }
};

/// While it lives, `stop_if_asked` of this thread, and of those that work on its parallel loops, asks
/// `question`, which must outlive it; null or empty: nobody asks.
class StopScope {
 public:
  explicit StopScope(const StopQuestion* question);
  ~StopScope();
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

  /// The question of this thread, or null.
  static const StopQuestion* current();

 private:
  const StopQuestion* outer_;
};

/// Throws Stopped if there is a question and its answer is yes. Costs a few nanoseconds: for loops whose body
/// costs microseconds. Chunks of parallel loops ask by themselves.
void stop_if_asked();

}  // namespace shatterbox::core
