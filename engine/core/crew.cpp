#include "engine/core/crew.h"

#include <thread>

#include "engine/core/parallel.h"
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace shatterbox::core {
namespace {

constexpr int kPatience = 2000;  // looks before others are let on the processor

class Wait {
 public:
  void once() {
    if (++looks_ > kPatience) return std::this_thread::yield();
#if defined(__SSE2__)
    _mm_pause();
#endif
  }

 private:
  int looks_ = 0;
};

struct Left {
  std::uint64_t front, back;

  static Left of(std::uint64_t packed) { return {packed >> 32, packed & 0xffffffff}; }
  std::uint64_t packed() const { return front << 32 | back; }
};

}  // namespace

void Crew::run(const std::function<void(Crew&)>& lead) {
  const auto threads = static_cast<std::size_t>(thread_count());
  Crew crew(threads > 1);
  // Whoever has the first index leads. Others that come late find that all has ended.
  parallel_for(threads, 1, [&](std::size_t i) {
    if (i > 0) return crew.help();
    struct End {
      Crew& crew;
      ~End() { crew.has_ended_.store(true, std::memory_order_release); }
    } end{crew};
    lead(crew);
  });
}

bool Crew::take(bool is_leader, std::size_t& index) {
  std::uint64_t packed = left_.load(std::memory_order_acquire);
  while (true) {
    Left left = Left::of(packed);
    if (left.front >= left.back) return false;
    index = is_leader ? left.front++ : --left.back;
    // Whoever takes an index holds the loop open until it is done: what `task_` says is this loop's.
    if (left_.compare_exchange_weak(packed, left.packed(), std::memory_order_acq_rel,
                                    std::memory_order_acquire))
      return true;
  }
}

void Crew::share(std::size_t count, const Task& task) {
  task_ = task;
  done_.store(0, std::memory_order_relaxed);
  left_.store(Left{0, count}.packed(), std::memory_order_release);
  std::size_t own = 0;
  for (std::size_t i = 0; take(true, i); ++own) task_.call(task_.body, i);
  for (Wait wait; done_.load(std::memory_order_acquire) + own < count;) wait.once();
}

void Crew::help() {
  Wait wait;
  while (!has_ended_.load(std::memory_order_acquire)) {
    std::size_t i = 0;
    if (!take(false, i)) {
      wait.once();
      continue;
    }
    task_.call(task_.body, i);
    done_.fetch_add(1, std::memory_order_acq_rel);
    wait = Wait();
  }
}

}  // namespace shatterbox::core
