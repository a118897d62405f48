#include "render/pass/shadow.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

namespace shatterbox::render::pass {
namespace {

constexpr float kFarTargets =
    2.5F;  // times as far as the target: what is beyond casts too small a shadow to be missed
constexpr float kPlaces = 16.0F;  // the map's place moves in such parts of its size
constexpr float kTakenByClear = 0.25F, kTakenByTint = 0.6F;
constexpr int kTile = 16;  // texels; a disc of taps stays within one tile of its centre

struct SunBox {
  glm::vec3 least{std::numeric_limits<float>::max()}, most{std::numeric_limits<float>::lowest()};
  void add(glm::vec3 p, float radius = 0.0F) {
    least = glm::min(least, p - radius);
    most = glm::max(most, p + radius);
  }
};

// Rows: across, along, away from the sun.
glm::mat3 sun_from_world(glm::vec3 sun) {
  const glm::vec3 helper =
      std::abs(sun.y) < 0.99F ? glm::vec3(0.0F, 1.0F, 0.0F) : glm::vec3(1.0F, 0.0F, 0.0F);
  const glm::vec3 right = glm::normalize(glm::cross(helper, sun));
  return glm::transpose(glm::mat3(right, glm::cross(sun, right), -sun));
}

// Only shadows that can be seen matter: the view's cone, to where the ground is mostly faded, in the sun's
// frame.
SunBox find_seen(const FrameBlock& block, const glm::mat3& sun_frame) {
  const float far = kFarTargets * block.target_distance.w;
  const glm::mat4 world_from_clip = glm::inverse(block.clip_from_world);
  SunBox box;
  const glm::vec3 eye(block.eye_exposure);
  box.add(sun_frame * eye);
  for (int i = 0; i < 4; ++i) {
    const glm::vec4 p = world_from_clip * glm::vec4((i & 1) ? 1 : -1, (i & 2) ? 1 : -1, 0.0F, 1.0F);
    box.add(sun_frame * (eye + far * glm::normalize(glm::vec3(p) / p.w - eye)));
  }
  return box;
}

// The next of a geometric row of sizes: a map's scale changes rarely.
float step_up(float size) {
  return std::exp2(std::ceil(std::log2(size) * 6.0F) / 6.0F);
}

// Of the sun's light: a quarter by clear glass, and what its tint keeps back. The darkest tells for all.
float find_share_of_glass(const Frame& frame) {
  const glm::vec3 luminance(0.2126F, 0.7152F, 0.0722F);
  float share = kTakenByClear;
  for (const Draw& draw : frame.draws) {
    if (!draw.casts_shadow) continue;
    for (const Look& look : draw.looks) {
      const float kept_back = 1.0F - glm::dot(luminance, look.outside);
      if (look.transmission > 0.0F) share = std::max(share, kTakenByClear + kTakenByTint * kept_back);
    }
  }
  return std::min(share, 1.0F);
}

// A total order; those that are equal draw the same.
template <typename Caster>
bool is_before(const Caster& a, const Caster& b) {
  if (a.mesh != b.mesh) return a.mesh < b.mesh;
  return std::memcmp(&a.world_from_body, &b.world_from_body, sizeof a.world_from_body) < 0;
}

}  // namespace

// Until something casts, the least that can be bound stands for the maps; no shader looks into it.
ShadowPass::ShadowPass(int map_size) : map_size_(map_size) {
  make_maps(kTile);
}

void ShadowPass::make_maps(int size) {
  const int tiles = size / kTile;
  depth_compared_ = gpu::Texture(size, size, GL_DEPTH_COMPONENT32F, gpu::Filter::compare);
  glass_compared_ = gpu::Texture(size / 2, size / 2, GL_DEPTH_COMPONENT32F, gpu::Filter::compare);
  tile_bounds_ = gpu::Texture(tiles, tiles, GL_RG32F, gpu::Filter::nearest);
  tile_casters_ = gpu::Texture(tiles, tiles, GL_RG32F, gpu::Filter::nearest);
  near_bounds_ = gpu::Texture(tiles, tiles, GL_RG32F, gpu::Filter::nearest);
  near_casters_ = gpu::Texture(tiles, tiles, GL_RG32F, gpu::Filter::linear);
  map_ = gpu::Framebuffer({}, &depth_compared_);
  glass_map_ = gpu::Framebuffer({}, &glass_compared_);
  tiles_ = gpu::Framebuffer({&tile_bounds_, &tile_casters_}, nullptr);
  near_ = gpu::Framebuffer({&near_bounds_, &near_casters_}, nullptr);
}

double ShadowPass::bytes() const {
  if (!has_maps()) return 0.0;
  constexpr double kDepth = 4.0, kPair = 8.0;  // bytes a texel
  double sum = 0.0;
  for (const gpu::Texture* map : {&depth_compared_, &glass_compared_})
    sum += kDepth * map->width() * map->height();
  for (const gpu::Texture* map : {&tile_bounds_, &tile_casters_, &near_bounds_, &near_casters_})
    sum += kPair * map->width() * map->height();
  return sum;
}

void ShadowPass::fit(const Frame& frame, const MeshStore& meshes, FrameBlock& block) const {
  const glm::mat3 sun_frame = sun_from_world(glm::vec3(block.sun));
  SunBox casters;
  for (const Item& item : meshes.items()) {
    if (item.casts_shadow) casters.add(sun_frame * item.centre_world, item.radius);
  }
  const SunBox seen = find_seen(block, sun_frame);
  const glm::vec2 least = glm::max(glm::vec2(casters.least), glm::vec2(seen.least));
  const glm::vec2 most = glm::min(glm::vec2(casters.most), glm::vec2(seen.most));
  const bool is_needed =
      frame.lights.casts_shadow && frame.lights.sun_strength > 0.0F && glm::all(glm::lessThan(least, most));
  if (!is_needed) {
    block.shadow_from_world = glm::mat4(1.0F);
    block.shadow_texel = glm::vec4(1.0F, 1.0F, 1.0F, static_cast<float>(kTile));
    return;
  }
  const auto texels = static_cast<float>(map_size_);
  // Two tiles of margin keep the discs inside.
  const glm::vec3 margin(2.0F * kTile / texels, 2.0F * kTile / texels, 0.01F);
  const glm::vec3 from(least, casters.least.z), to(most, std::min(casters.most.z, seen.most.z));
  glm::vec3 origin, extent;
  for (int k = 0; k < 3; ++k) {
    extent[k] = step_up(std::max(to[k] - from[k], 1e-6F) / (1.0F - 2.0F * margin[k] - 1.0F / kPlaces));
    const float place = extent[k] / kPlaces;
    origin[k] = std::floor((from[k] - margin[k] * extent[k]) / place) * place;
  }
  glm::mat4 texture_from_sun(1.0F);
  for (int k = 0; k < 3; ++k) {
    texture_from_sun[k][k] = 1.0F / extent[k];
    texture_from_sun[3][k] = -origin[k] / extent[k];
  }
  block.shadow_from_world = texture_from_sun * glm::mat4(sun_frame);
  block.shadow_texel = glm::vec4(extent.x / texels, extent.y / texels, extent.z, static_cast<float>(kTile));
  block.sun_radiance.w = 1.0F;
  const bool has_glass = std::any_of(meshes.items().begin(), meshes.items().end(),
                                     [](const Item& item) { return item.casts_shadow && item.is_glass; });
  const float taken = has_glass ? find_share_of_glass(frame) : 0.0F;
  // As common/shadow.glsl does for any normal, but without bias: the floor is not in the map.
  const glm::vec3 m = sun_frame[1];
  const float depth_part = (m.z < 0.0F ? -1.0F : 1.0F) * std::max(std::abs(m.z), 0.12F);
  const glm::vec2 slope = -glm::vec2(m) / depth_part * glm::vec2(extent) / extent.z;
  block.shadow_on_floor = glm::vec4(slope, 0.0F, taken);
}

ShadowPass::Part ShadowPass::find_changed(const Drawn& drawn, const Drawn& wanted, int map_size) {
  if (wanted.place != drawn.place) return {0, 0, map_size, map_size};
  std::vector<Caster> changed;
  std::set_symmetric_difference(drawn.casters.begin(), drawn.casters.end(), wanted.casters.begin(),
                                wanted.casters.end(), std::back_inserter(changed), is_before<Caster>);
  glm::vec2 least(1.0F), most(0.0F);
  for (const Caster& caster : changed) {
    least = glm::min(least, caster.least);
    most = glm::max(most, caster.most);
  }
  const auto texel = [map_size](float share, int shift) {
    return std::clamp(static_cast<int>(std::floor(share * static_cast<float>(map_size))) + shift, 0,
                      map_size);
  };
  return {texel(least.x, -1), texel(least.y, -1), texel(most.x, 2), texel(most.y, 2)};
}

ShadowPass::Part ShadowPass::draw_casters(const MeshStore& meshes, const FrameBlock& block, bool is_glass,
                                          Drawn& drawn) const {
  Drawn wanted{{}, block.shadow_from_world};
  std::vector<std::pair<const Item*, Caster>> casters;  // near to far
  for (const Item& item : meshes.items()) {
    if (!item.casts_shadow || item.is_glass != is_glass) continue;
    Caster caster{item.stored_id, item.world_from_body, glm::vec2(1e9F), glm::vec2(-1e9F)};
    for (const glm::vec3& corner : item.box_world.at) {
      const glm::vec2 place(block.shadow_from_world * glm::vec4(corner, 1.0F));
      caster.least = glm::min(caster.least, place);
      caster.most = glm::max(caster.most, place);
    }
    casters.emplace_back(&item, caster);
    wanted.casters.push_back(caster);
  }
  std::sort(wanted.casters.begin(), wanted.casters.end(), is_before<Caster>);
  const gpu::Framebuffer& map = is_glass ? glass_map_ : map_;
  const Part changed = find_changed(drawn, wanted, map.width());
  drawn = std::move(wanted);
  if (changed.is_empty()) return changed;
  map.bind();
  glEnable(GL_SCISSOR_TEST);
  glScissor(changed.left, changed.bottom, changed.right - changed.left, changed.top - changed.bottom);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glClearDepth(1.0);
  glClear(GL_DEPTH_BUFFER_BIT);
  meshes.bind_vertices();
  depth_.use();
  const glm::vec2 margin(1.0F / static_cast<float>(map.width()));
  const glm::vec2 least = glm::vec2(changed.left, changed.bottom) * margin - margin;
  const glm::vec2 most = glm::vec2(changed.right, changed.top) * margin + margin;
  for (const auto& [item, caster] : casters) {
    if (glm::any(glm::greaterThan(caster.least, most)) || glm::any(glm::lessThan(caster.most, least)))
      continue;
    meshes.draw(*item, meshes.shadow_part(*item));
  }
  glDisable(GL_SCISSOR_TEST);
  return changed;
}

// The tiles of what changed, and one more all about them.
void ShadowPass::reduce(const Part& changed) {
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_SCISSOR_TEST);
  const auto scissor = [&changed](int wider) {
    const int left = changed.left / kTile - wider, bottom = changed.bottom / kTile - wider;
    const int right = (changed.right - 1) / kTile + 1 + wider, top = (changed.top - 1) / kTile + 1 + wider;
    glScissor(std::max(left, 0), std::max(bottom, 0), right - std::max(left, 0), top - std::max(bottom, 0));
  };
  tiles_.bind();
  scissor(0);
  reduce_.use();
  // The comparing texture is read plainly here.
  glTextureParameteri(depth_compared_.name(), GL_TEXTURE_COMPARE_MODE, GL_NONE);
  depth_compared_.bind(0);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glTextureParameteri(depth_compared_.name(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  near_.bind();
  scissor(1);
  spread_.use();
  tile_bounds_.bind(0);
  tile_casters_.bind(1);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_SCISSOR_TEST);
}

void ShadowPass::run(const MeshStore& meshes, const FrameBlock& block) {
  if (!has_maps()) {
    make_maps(map_size_);
    depth_ = gpu::Program("shadow.vert", "");
    reduce_ = gpu::Program("full_screen.vert", "shadow_tiles.frag", {"SHADOW_TILE " + std::to_string(kTile)});
    spread_ = gpu::Program("full_screen.vert", "shadow_spread.frag");
  }
  const Part changed = draw_casters(meshes, block, false, drawn_solids_);
  if (!changed.is_empty()) reduce(changed);
  if (block.shadow_on_floor.w > 0.0F) draw_casters(meshes, block, true, drawn_glass_);
}

void ShadowPass::bind() const {
  depth_compared_.bind(0);
  near_bounds_.bind(1);
  near_casters_.bind(2);
  glass_compared_.bind(11);
}

}  // namespace shatterbox::render::pass
