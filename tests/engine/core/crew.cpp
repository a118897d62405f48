#include "engine/core/crew.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>
#include <vector>

#include "engine/core/parallel.h"
#include "engine/core/stop.h"

namespace shatterbox::core {

TEST_CASE("each loop of a crew has every index once, and ends before the next one begins") {
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    std::vector<unsigned long> cells(300, 1);
    Crew::run([&](Crew& crew) {
      for (int round = 0; round < 2000; ++round) {
        const std::size_t count = static_cast<std::size_t>(round) % cells.size();
        crew.loop(count, [&](std::size_t i) { cells[i] = 3 * cells[i] + static_cast<unsigned long>(round); });
      }
    });
    std::vector<unsigned long> expected(300, 1);
    for (int round = 0; round < 2000; ++round) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(round) % cells.size(); ++i)
        expected[i] = 3 * expected[i] + static_cast<unsigned long>(round);
    }
    CHECK(cells == expected);
  }
  set_thread_count(0);
}

TEST_CASE("threads that have nothing else to do help a crew") {
  set_thread_count(2);
  std::atomic<int> helped = 0;
  Crew::run([&](Crew& crew) {
    const auto leader = std::this_thread::get_id();
    const auto start = std::chrono::steady_clock::now();
    while (helped == 0 && std::chrono::steady_clock::now() - start < std::chrono::seconds(60))
      crew.loop(100, [&](std::size_t) { helped += std::this_thread::get_id() != leader ? 1 : 0; });
  });
  set_thread_count(0);
  CHECK(helped > 0);
}

TEST_CASE("a crew of one runs its loops by itself, and crews may run side by side") {
  int sum = 0;
  Crew alone;
  alone.loop(10, [&](std::size_t i) { sum += static_cast<int>(i); });
  CHECK(sum == 45);
  set_thread_count(3);
  std::vector<int> sums(40, 0);
  parallel_for(sums.size(), 1, [&](std::size_t k) {
    Crew::run([&](Crew& crew) {
      std::vector<int> parts(50, 0);
      for (int round = 0; round < 20; ++round) crew.loop(parts.size(), [&](std::size_t i) { ++parts[i]; });
      for (const int part : parts) sums[k] += part;
    });
  });
  set_thread_count(0);
  for (const int s : sums) CHECK(s == 1000);
}

TEST_CASE("a loop of a crew may be long") {
  set_thread_count(2);
  std::vector<int> cells(200000, 0);
  Crew::run([&](Crew& crew) { crew.loop(cells.size(), [&](std::size_t i) { ++cells[i]; }); });
  set_thread_count(0);
  long sum = 0;
  for (const int cell : cells) sum += cell;
  CHECK(sum == 200000);
}

TEST_CASE("what the leader of a crew throws leaves it, and the others with it") {
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    std::atomic<int> visits = 0;
    CHECK_THROWS_AS(Crew::run([&](Crew& crew) {
                      crew.loop(10, [&](std::size_t) { ++visits; });
                      throw Stopped();
                    }),
                    Stopped);
    CHECK(visits == 10);
  }
  set_thread_count(0);
}

}  // namespace shatterbox::core
