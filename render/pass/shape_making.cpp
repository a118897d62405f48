#include "render/pass/shape_making.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <numeric>
#include <thread>

#include "render/frame/simplify.h"

namespace shatterbox::render::pass {
namespace {

constexpr std::size_t kWorthThreads = 4000;  // triangles: 3 ms of work; a thread costs a fiftieth of that

void make_one(WantedShape& wanted, Simplifier& simplifier) {
  wanted.shape =
      expand(wanted.tolerance ? simplifier.simplify(*wanted.mesh, *wanted.tolerance) : *wanted.mesh);
}

}  // namespace

void make_shapes(std::vector<WantedShape>& wanted) {
  std::vector<std::exception_ptr> faults(wanted.size());
  std::vector<std::size_t> order(wanted.size());  // large ones first, so that no thread is left with one
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&wanted](std::size_t a, std::size_t b) {
    return wanted[a].mesh->triangles.size() > wanted[b].mesh->triangles.size();
  });
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    Simplifier simplifier;
    for (std::size_t n = next++; n < order.size(); n = next++) {
      const std::size_t i = order[n];
      try {
        make_one(wanted[i], simplifier);
      } catch (...) {
        faults[i] = std::current_exception();
      }
    }
  };
  std::size_t triangles = 0;
  for (const WantedShape& each : wanted) triangles += each.mesh->triangles.size();
  std::vector<std::jthread> helpers;
  if (triangles >= kWorthThreads) {
    const std::size_t most = std::min<std::size_t>(std::thread::hardware_concurrency(), wanted.size());
    for (std::size_t i = 1; i < most; ++i) helpers.emplace_back(work);
  }
  work();
  helpers.clear();  // joins
  for (const std::exception_ptr& fault : faults)
    if (fault) std::rethrow_exception(fault);
}

}  // namespace shatterbox::render::pass
