// How much memory lists hold.
#pragma once

namespace shatterbox::core {

/// Bytes of the items of vectors, matrices and the like.
template <class... Lists>
double bytes_in(const Lists&... lists) {
  return (0.0 + ... + (static_cast<double>(lists.size()) * static_cast<double>(sizeof(*lists.data()))));
}

}  // namespace shatterbox::core
