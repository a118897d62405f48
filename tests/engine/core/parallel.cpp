#include "engine/core/parallel.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <cfenv>
#include <chrono>
#include <csetjmp>
#include <csignal>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "engine/core/elementary.h"
#include "engine/core/stop.h"

namespace shatterbox::core {

TEST_CASE("chunks cover every index once and do not depend on the number of threads") {
  std::vector<std::set<std::pair<std::size_t, std::size_t>>> all;
  for (const int threads : {1, 2, 4, 7}) {
    set_thread_count(threads);
    CHECK(thread_count() == threads);
    for (const std::size_t count :
         {std::size_t{0}, std::size_t{1}, std::size_t{63}, std::size_t{64}, std::size_t{1001}}) {
      std::vector<int> visits(count, 0);
      std::set<std::pair<std::size_t, std::size_t>> chunks;
      std::mutex mutex;
      parallel_chunks(count, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ++visits[i];
        const std::lock_guard lock(mutex);
        chunks.emplace(begin, end);
      });
      for (const int v : visits) CHECK(v == 1);
      CHECK(chunks.size() == (count + 63) / 64);
      for (const auto& [begin, end] : chunks) {
        CHECK(begin % 64 == 0);
        CHECK(end - begin <= 64);
      }
    }
  }
  set_thread_count(0);
  CHECK(thread_count() >= 1);
}

TEST_CASE("a loop gives the same bits on any number of threads") {
  std::vector<std::vector<double>> results;
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    std::vector<double> values(5000);
    parallel_for(values.size(), 16, [&](std::size_t i) {
      double sum = 0.0;
      for (int k = 1; k < 50; ++k) sum += sin(static_cast<double>(i) * k) / k;
      values[i] = sum;
    });
    results.push_back(values);
  }
  set_thread_count(0);
  CHECK(results[0] == results[1]);
  CHECK(results[0] == results[2]);
}

TEST_CASE("what a claim is true of is found in ascending order") {
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{64}, std::size_t{1000}}) {
      std::vector<int> expected;
      for (std::size_t i = 0; i < count; ++i)
        if (i * i % 7 == 2) expected.push_back(static_cast<int>(i));
      CHECK(find_where(count, 64, [](std::size_t i) { return i * i % 7 == 2; }) == expected);
    }
  }
  set_thread_count(0);
}

TEST_CASE("a loop inside a loop ends, and a grain of zero counts as one") {
  set_thread_count(2);
  std::atomic<int> visits{0};
  parallel_for(8, 1, [&](std::size_t) { parallel_for(8, 0, [&](std::size_t) { ++visits; }); });
  set_thread_count(0);
  CHECK(visits == 64);
}

TEST_CASE("what a chunk throws leaves its loop, and a question is asked on every thread of it") {
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    CHECK_THROWS_AS(parallel_for(100, 1, [](std::size_t i) { i == 40 ? throw Stopped() : void(); }), Stopped);
    std::atomic<int> asked = 0, worked = 0;
    const StopQuestion question = [&asked] { return ++asked > 50; };
    const auto work = [&] {
      const StopScope scope(&question);
      parallel_for(1000, 1, [&](std::size_t) { ++worked; });
    };
    CHECK_THROWS_AS(work(), Stopped);
    CHECK(worked == 50);
    CHECK_NOTHROW(parallel_for(10, 1, [](std::size_t) { stop_if_asked(); }));  // the scope is over
  }
  set_thread_count(0);
}

TEST_CASE("a loop within a loop is whole, though another chunk of the outer one throws") {
  set_thread_count(3);
  for (int round = 0; round < 20; ++round) {
    std::atomic<int> broken = 0;
    CHECK_THROWS_AS(parallel_for(8, 1,
                                 [&](std::size_t i) {
                                   if (i == 5) throw Stopped();
                                   std::atomic<int> inner = 0;
                                   parallel_for(200, 1, [&](std::size_t) { ++inner; });
                                   broken += inner == 200 ? 0 : 1;
                                 }),
                    Stopped);
    CHECK(broken == 0);
  }
  set_thread_count(0);
}

namespace {

thread_local sigjmp_buf before_trap;

void leave_trap(int) {
  siglongjmp(before_trap, 1);
}

/// Whether `work` traps on this thread.
template <class Work>
bool does_trap(const Work& work) {
  const int traps = fegetexcept();
  if (sigsetjmp(before_trap, 1) != 0) {
    feenableexcept(traps);  // a handler runs without
    return true;
  }
  work();
  return false;
}

/// Of a division by zero, the root of a negative number and an overflow, how many trap on this thread.
int count_traps() {
  static volatile double zero = 0.0, great = 1e300;
  int traps = does_trap([] { [[maybe_unused]] const volatile double x = 1.0 / zero; }) ? 1 : 0;
  traps += does_trap([] { [[maybe_unused]] const volatile double x = zero / zero; }) ? 1 : 0;
  traps += does_trap([] { [[maybe_unused]] const volatile double x = great * great; }) ? 1 : 0;
  return traps;
}

}  // namespace

TEST_CASE("what is no number traps on every thread of a loop") {
  using Clock = std::chrono::steady_clock;
  struct sigaction act = {}, old = {};
  act.sa_handler = leave_trap;
  REQUIRE(sigaction(SIGFPE, &act, &old) == 0);
  set_thread_count(3);
  std::mutex mutex;
  std::set<std::thread::id> seen;
  std::atomic<int> traps = 0;
  std::atomic<std::size_t> threads = 0;
  // Each chunk waits for another thread, so that a machine that is busy does not do all on one.
  const auto patience = Clock::now() + std::chrono::seconds(20);
  parallel_for(12, 1, [&](std::size_t) {
    traps += count_traps();
    {
      const std::lock_guard lock(mutex);
      seen.insert(std::this_thread::get_id());
      threads = seen.size();
    }
    while (threads < 2 && Clock::now() < patience) std::this_thread::yield();
  });
  set_thread_count(0);
  sigaction(SIGFPE, &old, nullptr);
  CHECK(threads >= 2);
  CHECK(traps == 3 * 12);
}

}  // namespace shatterbox::core
