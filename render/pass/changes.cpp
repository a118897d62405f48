#include "render/pass/changes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

namespace shatterbox::render::pass {
namespace {

constexpr float kBodyPixels = 1.0F;    // as Tiles marks bodies: rounding
constexpr float kSpeckPixels = 1.0F;   // a crack's sample is taken for what is beside it
constexpr float kBeyondPixels = 2.0F;  // lines at the picture's border may begin outside
constexpr float kShadowPixels =
    20.0F;  // a tile about shadows, as Tiles marks them, and what lies between dimmings
// Of the map's texels across: how far from its shadow a caster has a say. Solids: two and a half tiles, since
// the search for casters is blended between tiles that know of their neighbours. Glass: four taps about the
// place, in half the size.
constexpr float kSolidTexels = 44.0F, kGlassTexels = 7.0F;
constexpr std::size_t kMostPairs =
    20000;  // of changed casters and what they may shade: beyond, all is lit again
constexpr std::ptrdiff_t kMostOccluders = 64;
// Occlusion reaches farther by its blur, and by where its pixels lie, in its own pixels.
constexpr float kOcclusionTail = 6.0F;
constexpr float kLeastReach = 8.0F;  // pixels: its samples keep this distance from each other

FrameBlock without_shadow(const FrameBlock& block) {
  FrameBlock out = block;
  out.shadow_from_world = glm::mat4(0.0F);
  out.shadow_texel = out.shadow_on_floor = glm::vec4(0.0F);
  out.sun_radiance.w = 0.0F;
  return out;
}

bool is_same(const FrameBlock& a, const FrameBlock& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

struct Box {
  glm::vec3 least, most;
};

Box box_of(std::span<const glm::vec3> points) {
  Box box{points[0], points[0]};
  for (const glm::vec3& point : points) {
    box.least = glm::min(box.least, point);
    box.most = glm::max(box.most, point);
  }
  return box;
}

// From when to when, in metres along `way`, a box on its way touches the receiver; none if it never does.
// margin: m, of world.
std::optional<std::pair<float, float>> find_meeting(const Corners& moving, glm::vec3 way,
                                                    const Item& receiver, float margin) {
  const glm::mat4 body_from_world = glm::inverse(receiver.world_from_body);
  const float scale = 1.0F / std::max(glm::length(glm::vec3(receiver.world_from_body[0])), 1e-12F);
  const auto in_body = [&](Corners corners) {
    for (glm::vec3& corner : corners.at) corner = glm::vec3(body_from_world * glm::vec4(corner, 1.0F));
    return box_of(corners.at);
  };
  const Box a = in_body(moving), b = in_body(receiver.box_world);
  const glm::vec3 speed = glm::mat3(body_from_world) * way;
  float from = -1e30F, to = 1e30F;
  for (int k = 0; k < 3; ++k) {
    const float low = b.least[k] - a.most[k] - margin * scale, high = b.most[k] - a.least[k] + margin * scale;
    if (std::abs(speed[k]) < 1e-6F * scale) {
      if (low > 0.0F || high < 0.0F) return std::nullopt;
      continue;
    }
    const float t0 = low / speed[k], t1 = high / speed[k];
    from = std::max(from, std::min(t0, t1));
    to = std::min(to, std::max(t0, t1));
  }
  if (from > to) return std::nullopt;
  return std::pair(from, to);
}

}  // namespace

Changes::Changes(int width, int height, int occlusion_scale)
    : grid_(width, height), occlusion_scale_(static_cast<float>(occlusion_scale)) {}

void Changes::forget() {
  block_.reset();
}

void Changes::mark_all(bool is_all) {
  for (Marks* marks : {&bodies_, &glass_, &occluded_, &ceased_, &lit_}) {
    marks->is_all = is_all;
    marks->count = 0;
    if (!is_all) marks->tiles.assign(grid_.count(), 0);
  }
}

void Changes::mark(std::span<const glm::vec3> points, float margin_pixels, Marks& marks) const {
  if (marks.is_all) return;
  const std::optional<Outline> outline = grid_.find_outline(points, *block_, kBeyondPixels);
  if (outline) grid_.each(*outline, margin_pixels, [&marks](std::size_t tile) { marks.tiles[tile] = 1; });
}

void Changes::add(const std::vector<char>& tiles, Marks& marks) {
  if (marks.is_all) return;
  for (std::size_t i = 0; i < tiles.size(); ++i) marks.tiles[i] = std::max(marks.tiles[i], tiles[i]);
}

// Beyond three quarters it is cheaper to draw all.
void Changes::settle(Marks& marks) const {
  if (marks.is_all) return;
  marks.count = static_cast<int>(std::count(marks.tiles.begin(), marks.tiles.end(), 1));
  marks.is_all = 4 * static_cast<std::size_t>(marks.count) > 3 * marks.tiles.size();
}

// By tile, how many pixels away what is there looks for what occludes it, as occlusion.frag does: by the
// nearest floor or body in it or in tiles about it.
void Changes::find_reach(const MeshStore& meshes) {
  const FrameBlock& block = *block_;
  std::vector<float> nearness(grid_.count(), 0.0F);  // one over metres
  const float drop = block.ground_place.x - block.eye_exposure.y;
  const auto floor_nearness = [&](int x, int y) {
    const glm::vec2 at = glm::vec2(x, y) * static_cast<float>(kTileSide);
    const glm::vec2 s = at * glm::vec2(block.viewport.z, block.viewport.w) * 2.0F - 1.0F;
    const float slope = block.view_forward.y + s.x * block.view_right.y + s.y * block.view_up.y;
    return drop == 0.0F ? 0.0F : block.ground_place.w * slope / drop;
  };
  for (int y = 0; y < grid_.down(); ++y) {
    for (int x = 0; x < grid_.across(); ++x) {
      nearness[grid_.index(x, y)] = std::max({0.0F, floor_nearness(x, y), floor_nearness(x + 1, y),
                                              floor_nearness(x, y + 1), floor_nearness(x + 1, y + 1)});
    }
  }
  for (const Item& item : meshes.items()) {
    if (!item.is_on_screen || item.is_glass) continue;
    float least = 1e30F;
    for (const glm::vec3& corner : item.box_world.at) {
      least =
          std::min(least, glm::dot(corner - glm::vec3(block.eye_exposure), glm::vec3(block.view_forward)));
    }
    const float here = 1.0F / std::max(least, 1e-9F);
    const std::optional<Outline> outline = grid_.find_outline(item.box_world.at, block);
    if (!outline) continue;
    grid_.each(*outline, kBodyPixels,
               [&](std::size_t tile) { nearness[tile] = std::max(nearness[tile], here); });
  }
  reach_.assign(grid_.count(), 0.0F);
  const float pixels = 0.5F * block.occlusion_scale.w / block.view_ray.y * block.viewport.y;
  for (std::size_t tile = 0; tile < reach_.size(); ++tile) {
    grid_.each_about(tile, [&](std::size_t other) {
      const float samples = std::min(pixels * nearness[other], 0.25F * block.viewport.y);
      reach_[tile] = std::max({reach_[tile], samples, kLeastReach});
    });
  }
}

// What finds the body among its samples, or finds it gone.
void Changes::mark_occlusion(const Item& item) {
  if (occluded_.is_all) return;
  const std::optional<Outline> seen = grid_.find_outline(item.box_world.at, *block_);
  if (!seen) return;
  const float side = static_cast<float>(kTileSide), tail = kOcclusionTail * occlusion_scale_;
  for (int y = 0; y < grid_.down(); ++y) {
    for (int x = 0; x < grid_.across(); ++x) {
      const std::size_t tile = grid_.index(x, y);
      const glm::vec2 least = glm::vec2(x, y) * side - (reach_[tile] + tail);
      const glm::vec2 most = glm::vec2(x + 1, y + 1) * side + (reach_[tile] + tail);
      if (glm::any(glm::lessThan(most, seen->least)) || glm::any(glm::greaterThan(least, seen->most)))
        continue;
      occluded_.tiles[tile] = 1;
    }
  }
  // Where the floor begins or ceases to look for it at all.
  if (const std::optional<Corners> floor = find_occluded_floor(item.box_world, *block_)) {
    mark(floor->at, kOcclusionPixels + tail, ceased_);
  }
  mark(item.box_world.at, kBodyPixels + tail, ceased_);
}

// The two ways across the sun's rays that a caster has a say along, m.
std::array<glm::vec3, 2> Changes::find_margins(bool is_glass) const {
  const glm::mat3 across = glm::transpose(glm::mat3(block_->shadow_from_world));
  const float texels = is_glass ? kGlassTexels : kSolidTexels;
  return {glm::normalize(across[0]) * (texels * block_->shadow_texel.x),
          glm::normalize(across[1]) * (texels * block_->shadow_texel.y)};
}

// On the floor, and on each body that the caster's box meets on its way along the sun's rays.
void Changes::mark_shadow(const Item& caster, const MeshStore& meshes) {
  if (lit_.is_all || block_->sun_radiance.w == 0.0F) return;
  const std::array<glm::vec3, 2> margins = find_margins(caster.is_glass);
  const glm::vec3 sun(block_->sun);
  std::vector<glm::vec3> points;
  const auto add_wide = [&](glm::vec3 p, auto&& land) {
    for (int i = 0; i < 4; ++i) {
      points.push_back(land(p + ((i & 1) ? margins[0] : -margins[0]) + ((i & 2) ? margins[1] : -margins[1])));
    }
  };
  if (block_->ground_place.w > 0.0F) {
    // Where taps find the caster, which may lie below the floor.
    const auto on_floor = [&](glm::vec3 p) {
      return p - sun * ((p.y - block_->ground_place.x) / std::max(sun.y, 1e-3F));
    };
    for (const glm::vec3& corner : caster.box_world.at) add_wide(corner, on_floor);
    mark(points, kShadowPixels, lit_);
  }
  const float margin = glm::length(margins[0]) + glm::length(margins[1]);
  for (const Item& receiver : meshes.items()) {
    if (!receiver.is_on_screen) continue;
    // Clear glass is not shaded, and other glass by no glass.
    if (receiver.is_glass && (caster.is_glass || !receiver.is_cloudy)) continue;
    auto meeting = find_meeting(caster.box_world, -sun, receiver, margin);
    if (!meeting) continue;
    // Taps for solids follow the receiver's plane, and may find casters behind it; those for glass stay
    // before it.
    if (caster.is_glass) meeting->first = std::max(meeting->first, -2.0F * (caster.radius + margin));
    if (meeting->first > meeting->second) continue;
    points.clear();
    for (const float way : {meeting->first, meeting->second}) {
      for (const glm::vec3& corner : caster.box_world.at) {
        add_wide(corner - sun * way, [](glm::vec3 p) { return p; });
      }
    }
    const std::optional<Outline> swept = grid_.find_outline(points, *block_, kBeyondPixels);
    const std::optional<Outline> seen = grid_.find_outline(receiver.box_world.at, *block_, kBeyondPixels);
    if (!swept || !seen) continue;
    const TileSpan span = grid_.span_of(*swept, kBodyPixels);
    grid_.each(*seen, kBodyPixels, [&](std::size_t tile) {
      const int x = static_cast<int>(tile) % grid_.across(), y = static_cast<int>(tile) / grid_.across();
      const bool is_in_box = x >= span.left && x <= span.right && y >= span.bottom && y <= span.top;
      if (is_in_box && grid_.touches(*swept, x, y, kBodyPixels)) lit_.tiles[tile] = 1;
    });
  }
}

void Changes::mark_item(const Item& item, const MeshStore& meshes) {
  if (item.is_on_screen) {
    mark(item.box_world.at, kBodyPixels + kSpeckPixels, item.is_glass ? glass_ : bodies_);
    if (!item.is_glass) mark_occlusion(item);
  }
  if (item.casts_shadow) mark_shadow(item, meshes);
}

// Occlusion differs only where it is looked for; what is about such a tile may look up its edge.
void Changes::spread_occlusion(const std::vector<char>& near_marks) {
  if (occluded_.is_all) return;
  for (std::size_t i = 0; i < near_marks.size(); ++i) {
    if (near_marks[i] == 0) occluded_.tiles[i] = 0;
    occluded_.tiles[i] = std::max(occluded_.tiles[i], ceased_.tiles[i]);
  }
  if (lit_.is_all) return;
  for (std::size_t tile = 0; tile < lit_.tiles.size(); ++tile) {
    if (occluded_.tiles[tile] == 0) continue;
    grid_.each_about(tile, [this](std::size_t other) { lit_.tiles[other] = 1; });
  }
}

void Changes::find(const MeshStore& meshes, const FrameBlock& block, const std::vector<char>& near_marks,
                   const std::vector<char>& changed_marks) {
  const bool is_view_kept = block_ && is_same(without_shadow(*block_), without_shadow(block));
  const bool is_light_kept =
      is_view_kept && is_same(*block_, block) && pattern_kinds_ == meshes.pattern_kinds();
  block_ = block;
  pattern_kinds_ = meshes.pattern_kinds();
  mark_all(!is_view_kept);
  if (!is_view_kept) return;
  std::vector<const Item*> changed;
  for (const Item& item : meshes.gone()) changed.push_back(&item);
  for (const Item& item : meshes.items()) {
    if (!item.is_as_before) changed.push_back(&item);
  }
  const auto occluders = std::count_if(
      changed.begin(), changed.end(), [](const Item* item) { return item->is_on_screen && !item->is_glass; });
  lit_.is_all = !is_light_kept || changed.size() * meshes.items().size() > kMostPairs;
  occluded_.is_all = occluders > kMostOccluders;
  if (occluders > 0 && !occluded_.is_all) find_reach(meshes);
  for (const Item* item : changed) mark_item(*item, meshes);
  add(changed_marks, lit_);
  spread_occlusion(near_marks);
  for (Marks* marks : {&bodies_, &glass_, &occluded_}) {
    settle(*marks);
    if (marks->is_all) lit_.is_all = true;
    add(marks->tiles, lit_);
  }
  settle(lit_);
}

bool Changes::touches(const Item& item) const {
  const Marks& marks = item.is_glass ? glass_ : bodies_;
  if (marks.is_all) return true;
  const std::optional<Outline> outline = grid_.find_outline(item.box_world.at, *block_, kBeyondPixels);
  bool is_touched = false;
  if (outline) {
    grid_.each(*outline, kBodyPixels,
               [&](std::size_t tile) { is_touched = is_touched || marks.tiles[tile] != 0; });
  }
  return is_touched;
}

}  // namespace shatterbox::render::pass
