// Parallel loops whose result does not depend on the number of threads: fixed chunks, disjoint outputs, no
// reduction. Two back-ends: oneTBB, or std::jthread for the thread sanitizer (which cannot see into Debian's
// TBB).
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace shatterbox::core {

/// Calls body(begin, end) on chunks of at most `grain` indices that cover [0, count); chunk borders depend on
/// count and grain only. The chunks run in any order, possibly at once: each must write only what is its own.
/// What one throws leaves the loop, when the chunks that were begun have ended; others are not begun then.
/// Before each, `stop_if_asked` (stop.h).
void parallel_chunks(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Calls body(i) for each i in [0, count), `grain` indices to a task.
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, const Body& body) {
  parallel_chunks(count, grain, [&body](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// The numbers in [0, count) of which `claim(i)` is true, ascending; `grain` of them are asked in a task.
template <class Claim>
std::vector<int> find_where(std::size_t count, std::size_t grain, const Claim& claim) {
  std::vector<std::vector<int>> found((count + grain - 1) / grain);
  parallel_chunks(count, grain, [&](std::size_t begin, std::size_t end) {
    std::vector<int>& own = found[begin / grain];
    for (std::size_t i = begin; i < end; ++i)
      if (claim(i)) own.push_back(static_cast<int>(i));
  });
  std::vector<int> all;
  for (const std::vector<int>& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

/// Sets the number of threads for all loops of the process; 0 means one a core. Results never depend on it.
void set_thread_count(int count);

/// The number of threads in use.
int thread_count();

}  // namespace shatterbox::core
