// What copies of one vertex or edge, on both sides of a crack, have in common.
#pragma once

#include <cstddef>
#include <vector>

namespace shatterbox::fracture {

/// Of each number in [0, count) the mean of the values of its copies, which `sources` tells; `zero` without.
template <class T, class ValueOf>
std::vector<T> mean_of_copies(const std::vector<int>& sources, std::size_t count, T zero,
                              const ValueOf& value_of) {
  std::vector<T> means(count, zero);
  std::vector<int> copies(count, 0);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const auto source = static_cast<std::size_t>(sources[i]);
    means[source] += value_of(static_cast<int>(i));
    ++copies[source];
  }
  for (std::size_t i = 0; i < count; ++i)
    if (copies[i] > 1) means[i] /= copies[i];
  return means;
}

}  // namespace shatterbox::fracture
