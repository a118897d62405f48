#include "engine/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "engine/core/stop.h"

#ifndef SHATTERBOX_JTHREAD
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#endif

namespace shatterbox::core {
namespace {

std::atomic<int> wanted_threads{0};

/// Asked once: each time the system reads it from files, some microseconds that every loop would pay.
int cores() {
  static const int count = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return count;
}

/// The chunks of one loop, run on whichever threads. What one throws is kept to the loop's end: oneTBB itself
/// would cancel with it the loops that other chunks are in the midst of, and these would return as if they
/// were done.
class Chunks {
 public:
  using Body = std::function<void(std::size_t, std::size_t)>;
  Chunks(std::size_t count, std::size_t grain, const Body& body)
      : count_(count),
        grain_(std::max<std::size_t>(grain, 1)),
        body_(body),
        question_(StopScope::current()) {}

  std::size_t size() const { return (count_ + grain_ - 1) / grain_; }

  void run(std::size_t chunk) {
    if (has_failed_) return;
    const StopScope scope(question_);
    try {
      stop_if_asked();
      body_(chunk * grain_, std::min(count_, (chunk + 1) * grain_));
    } catch (...) {
      const std::lock_guard lock(fault_lock_);
      if (!fault_) fault_ = std::current_exception();
      has_failed_ = true;
    }
  }

  void end() const {
    if (fault_) std::rethrow_exception(fault_);
  }

 private:
  std::size_t count_, grain_;
  const Body& body_;
  const StopQuestion* question_;  // of who began the loop
  std::atomic<bool> has_failed_{false};
  std::mutex fault_lock_;
  std::exception_ptr fault_;  // the first one
};

}  // namespace

int thread_count() {
  const int wanted = wanted_threads.load();
  return wanted > 0 ? wanted : cores();
}

#ifndef SHATTERBOX_JTHREAD

void set_thread_count(int count) {
  static std::unique_ptr<tbb::global_control> control;
  wanted_threads = count;
  control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<std::size_t>(thread_count()));
}

void parallel_chunks(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  Chunks chunks(count, grain, body);
  if (chunks.size() <= 1 || thread_count() == 1) {
    for (std::size_t c = 0; c < chunks.size(); ++c) chunks.run(c);
    return chunks.end();
  }
  // One task a chunk: blocked_range over chunk numbers, so that borders never follow TBB's own halving.
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, chunks.size(), 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t c = range.begin(); c < range.end(); ++c) chunks.run(c);
      },
      tbb::simple_partitioner());
  chunks.end();
}

#else

void set_thread_count(int count) {
  wanted_threads = count;
}

void parallel_chunks(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  Chunks chunks(count, grain, body);
  const std::size_t workers = std::min<std::size_t>(chunks.size(), static_cast<std::size_t>(thread_count()));
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t c = next++; c < chunks.size(); c = next++) chunks.run(c);
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < workers; ++i) threads.emplace_back(work);
    work();
  }
  chunks.end();
}

#endif

}  // namespace shatterbox::core
