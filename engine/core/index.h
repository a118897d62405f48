// Feature numbers are int; containers are asked with std::size_t.
#pragma once

#include <cstddef>

namespace shatterbox::core {

constexpr std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace shatterbox::core
