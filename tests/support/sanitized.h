// Sizes of costly tests: under the sanitizers everything takes some ten times as long.
#pragma once

namespace shatterbox::test {

#ifdef SHATTERBOX_SANITIZED
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

/// `usual`, or `fewer` under the sanitizers. Only for more of the same: what fewer still reach is every
/// branch.
constexpr long how_many(long usual, long fewer) {
  return kIsSanitized ? fewer : usual;
}

}  // namespace shatterbox::test
