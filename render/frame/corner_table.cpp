#include "render/frame/corner_table.h"

#include <algorithm>

namespace shatterbox::render {

void CornerTable::read(const Mesh& mesh) {
  const std::size_t size = mesh.triangles.size() * 4;
  vertex_.resize(size);
  links_.resize(size);
  opposite_.assign(size, kNone);
  corner_of_.assign(mesh.positions.size(), kNone);
  counts_.assign(mesh.positions.size(), 0);
  newest_.assign(mesh.positions.size(), kNone);
  is_odd_.assign(mesh.positions.size(), 0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][static_cast<int>(k)];
      vertex_[4 * t + k] = v;
      corner_of_[v] = 4 * t + k;
      ++counts_[v];
    }
  }
  match_edges();
}

void CornerTable::match_edges() {
  for (std::uint32_t first = 0; first < vertex_.size(); first += 4) {
    for (std::uint32_t c = first; c < first + 3; ++c) {
      const std::uint32_t from = vertex_[next(c)], to = vertex_[previous(c)];
      const std::uint32_t lesser = std::min(from, to), greater = std::max(from, to);
      std::uint32_t earlier = newest_[lesser];
      while (earlier != kNone && links_[earlier].greater != greater) earlier = links_[earlier].older;
      if (earlier == kNone && from != to) {
        links_[c] = {greater, newest_[lesser]};
        newest_[lesser] = c;
      } else {
        pair_or_mark(c, earlier);
      }
    }
  }
}

void CornerTable::pair_or_mark(std::uint32_t c, std::uint32_t earlier) {
  if (earlier != kNone && opposite_[earlier] == kNone && vertex_[next(earlier)] == vertex_[previous(c)]) {
    opposite_[c] = earlier;
    opposite_[earlier] = c;
    return;
  }
  if (earlier != kNone) {
    if (opposite_[earlier] < kSeveral) opposite_[opposite_[earlier]] = kSeveral;
    opposite_[earlier] = kSeveral;
  }
  opposite_[c] = kSeveral;
  is_odd_[vertex_[next(c)]] = is_odd_[vertex_[previous(c)]] = 1;
}

// Where a walk does not come by all corners there are several fans.
bool CornerTable::find_odd(std::uint32_t v, Fan& fan) {
  if (is_odd_[v] == 0 && !(walk(v, fan) && fan.count == counts_[v])) is_odd_[v] = 1;
  return is_odd_[v] != 0;
}

bool CornerTable::walk(std::uint32_t v, Fan& fan) const {
  std::uint32_t start = corner_of_[v];
  fan.is_outline = false;
  for (;;) {
    std::uint32_t c = start;
    fan.count = 0;
    do {
      if (fan.count == Fan::kMost) return false;
      fan.corners[fan.count] = c;
      fan.around[fan.count++] = vertex_[next(c)];
      const std::uint32_t beyond = opposite_[next(c)];
      if (beyond >= kSeveral) {
        fan.around[fan.count] = vertex_[previous(c)];
        c = kNone;
        break;
      }
      c = next(beyond);
    } while (c != start);
    if (c == start || fan.is_outline) return true;
    // It has an end: once more, from its beginning.
    fan.is_outline = true;
    bool is_first = true;
    for (std::uint32_t at = opposite_[previous(start)]; at < kSeveral; at = opposite_[previous(start)]) {
      start = previous(at);
      is_first = false;
    }
    if (is_first) return true;
  }
}

// The triangle of the two corners goes; its other two edges become one.
void CornerTable::take_away(std::uint32_t corner_v, std::uint32_t corner_u) {
  const std::uint32_t beyond_v = opposite_[corner_v], beyond_u = opposite_[corner_u];
  if (beyond_v < kSeveral) opposite_[beyond_v] = beyond_u;
  if (beyond_u < kSeveral) opposite_[beyond_u] = beyond_v;
  const std::uint32_t third = (corner_v & ~3U) + (3 - (corner_v & 3U) - (corner_u & 3U));
  // Beyond u's far edge stand the third and what was v; beyond v's, the third and u.
  const bool u_follows = corner_u == next(corner_v);
  const std::uint32_t stays = beyond_u < kSeveral ? beyond_u : beyond_v;
  const bool is_beyond_u = beyond_u < kSeveral;
  const std::uint32_t one = next(stays), two = previous(stays);
  const bool third_is_two = is_beyond_u == u_follows;
  corner_of_[vertex_[third]] = third_is_two ? two : one;
  corner_of_[vertex_[corner_u]] = third_is_two ? one : two;
  for (std::uint32_t k = 0; k < 3; ++k) vertex_[(corner_v & ~3U) + k] = kNone;
}

void CornerTable::collapse(const Fan& fan, std::uint32_t v, std::size_t i) {
  const std::uint32_t u = fan.around[i];
  for (std::size_t k = 0; k < fan.count; ++k) vertex_[fan.corners[k]] = u;
  corner_of_[v] = kNone;
  if (i < fan.count) take_away(fan.corners[i], next(fan.corners[i]));
  if (i == 0 && fan.is_outline) return;
  const std::uint32_t before = fan.corners[(i > 0 ? i : fan.count) - 1];
  take_away(before, previous(before));
}

}  // namespace shatterbox::render
