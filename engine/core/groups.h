// Things sorted by the group that each belongs to, by counting.
#pragma once

#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace shatterbox::core {

class Groups {
 public:
  Groups() = default;

  /// Of things 0 to `things` - 1; group_of(thing) is below `groups`.
  template <class GroupOf>
  Groups(std::size_t groups, std::size_t things, const GroupOf& group_of)
      : first_(groups + 1, 0), things_(things) {
    for (std::size_t i = 0; i < things; ++i) ++first_[group_of(i) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < things; ++i) things_[next[group_of(i)]++] = i;
  }

  /// Those of a group, ascending.
  std::span<const std::size_t> of(std::size_t group) const {
    return std::span(things_).subspan(first_[group], first_[group + 1] - first_[group]);
  }

  std::size_t count_things() const { return things_.size(); }

 private:
  std::vector<std::size_t> first_, things_;
};

}  // namespace shatterbox::core
