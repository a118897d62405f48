// Many short loops in a row, as of sweeps over a large system: threads that come to help stay for all of
// them, for to call them anew for a loop of microseconds would cost more than the loop.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace shatterbox::core {

class Crew {
 public:
  /// Of one: loops run on this thread.
  Crew() : Crew(false) {}

  /// Calls lead(crew) on one of the threads that work on parallel loops. Until it returns, threads that have
  /// nothing else to do take part in the crew's loops; none may come, and nobody is waited for who does not.
  /// What `lead` throws leaves it.
  static void run(const std::function<void(Crew&)>& lead);

  /// For `lead` alone: calls body(i) for each i in [0, count), in any order, possibly at once: each must
  /// write only what is its own, and must not throw. `count` is below 2^32.
  template <class Body>
  void loop(std::size_t count, const Body& body) {
    if (!has_help_ || count < 2) {
      for (std::size_t i = 0; i < count; ++i) body(i);
      return;
    }
    share(count, {&body, [](const void* what, std::size_t i) { (*static_cast<const Body*>(what))(i); }});
  }

 private:
  struct Task {
    const void* body = nullptr;
    void (*call)(const void* body, std::size_t i) = nullptr;
  };

  explicit Crew(bool has_help) : has_help_(has_help) {}
  void share(std::size_t count, const Task& task);
  bool take(bool is_leader, std::size_t& index);
  void help();

  static constexpr std::size_t kLine = 64;  // bytes of memory that threads hand to each other at once

  const bool has_help_;
  Task task_;
  // What is left of the loop: the first index that nobody has taken, and the one behind the last. The leader
  // takes from the front and helpers from the back, so that each has much the same share every time.
  alignas(kLine) std::atomic<std::uint64_t> left_{0};
  alignas(kLine) std::atomic<std::size_t> done_{0};
  alignas(kLine) std::atomic<bool> has_ended_{false};
};

}  // namespace shatterbox::core
