#include "render/pass/shadow.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace shatterbox::render::pass {
namespace {

constexpr int kTile = 16;  // texels; a disc of taps stays within one tile of its centre

struct Box {
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
Box find_seen(const FrameBlock& block, const glm::mat3& sun_frame) {
  const float far = 4.2F * block.target_distance.w;
  const glm::mat4 world_from_clip = glm::inverse(block.clip_from_world);
  Box box;
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

}  // namespace

ShadowPass::ShadowPass(int map_size)
    : depth_compared_(map_size, map_size, GL_DEPTH_COMPONENT32F, gpu::Filter::compare),
      glass_compared_(map_size / 2, map_size / 2, GL_DEPTH_COMPONENT32F, gpu::Filter::compare),
      tile_bounds_(map_size / kTile, map_size / kTile, GL_RG32F, gpu::Filter::nearest),
      tile_casters_(map_size / kTile, map_size / kTile, GL_RG32F, gpu::Filter::nearest),
      near_bounds_(map_size / kTile, map_size / kTile, GL_RG32F, gpu::Filter::nearest),
      near_casters_(map_size / kTile, map_size / kTile, GL_RG32F, gpu::Filter::linear),
      map_({}, &depth_compared_),
      glass_map_({}, &glass_compared_),
      tiles_({&tile_bounds_, &tile_casters_}, nullptr),
      near_({&near_bounds_, &near_casters_}, nullptr),
      depth_("shadow.vert", ""),
      reduce_("full_screen.vert", "shadow_tiles.frag", {"SHADOW_TILE " + std::to_string(kTile)}),
      spread_("full_screen.vert", "shadow_spread.frag"),
      map_size_(map_size) {}

void ShadowPass::fit(const Frame& frame, const MeshStore& meshes, FrameBlock& block) const {
  const glm::mat3 sun_frame = sun_from_world(glm::vec3(block.sun));
  Box casters;
  for (const Item& item : meshes.items()) {
    if (item.casts_shadow) casters.add(sun_frame * item.centre_world, item.radius);
  }
  const Box seen = find_seen(block, sun_frame);
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
  glm::vec3 origin, extent;
  for (int k = 0; k < 2; ++k) {
    // A margin of two tiles keeps the discs inside.
    extent[k] = step_up((most[k] - least[k]) * texels / (texels - 4.0F * kTile));
    const float texel = extent[k] / texels;
    origin[k] = std::floor((0.5F * (least[k] + most[k]) - 0.5F * extent[k]) / texel) * texel;
  }
  extent.z = step_up(1.02F * (casters.most.z - casters.least.z));
  origin.z = casters.least.z - 0.01F * extent.z;
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
  // As common/shadow.glsl does for any normal.
  const glm::vec3 m = sun_frame[1];
  const float depth_part = (m.z < 0.0F ? -1.0F : 1.0F) * std::max(std::abs(m.z), 0.12F);
  const glm::vec2 slope = -glm::vec2(m) / depth_part * glm::vec2(extent) / extent.z;
  const float bias = (std::abs(slope.x) + std::abs(slope.y)) / texels +
                     0.5F * std::max(extent.x, extent.y) / texels / extent.z;
  block.shadow_on_floor = glm::vec4(slope, bias, has_glass ? 1.0F : 0.0F);
}

bool ShadowPass::draw_casters(const MeshStore& meshes, const FrameBlock& block, bool is_glass,
                              Drawn& drawn) const {
  Drawn wanted{{}, block.shadow_from_world};
  for (const Item& item : meshes.items()) {
    if (item.casts_shadow && item.is_glass == is_glass) {
      wanted.casters.push_back({item.stored_id, item.world_from_body});
    }
  }
  if (wanted == drawn) return false;
  drawn = std::move(wanted);
  (is_glass ? glass_map_ : map_).bind();
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glClearDepth(1.0);
  glClear(GL_DEPTH_BUFFER_BIT);
  meshes.bind_vertices();
  depth_.use();
  for (const Item& item : meshes.items()) {
    if (item.casts_shadow && item.is_glass == is_glass) meshes.draw(item, meshes.shadow_part(item));
  }
  return true;
}

void ShadowPass::reduce() {
  glDisable(GL_DEPTH_TEST);
  tiles_.bind();
  reduce_.use();
  // The comparing texture is read plainly here.
  glTextureParameteri(depth_compared_.name(), GL_TEXTURE_COMPARE_MODE, GL_NONE);
  depth_compared_.bind(0);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glTextureParameteri(depth_compared_.name(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  near_.bind();
  spread_.use();
  tile_bounds_.bind(0);
  tile_casters_.bind(1);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void ShadowPass::run(const MeshStore& meshes, const FrameBlock& block) {
  if (draw_casters(meshes, block, false, drawn_solids_)) reduce();
  if (block.shadow_on_floor.w > 0.0F) draw_casters(meshes, block, true, drawn_glass_);
}

void ShadowPass::bind() const {
  depth_compared_.bind(0);
  near_bounds_.bind(1);
  near_casters_.bind(2);
  glass_compared_.bind(11);
}

}  // namespace shatterbox::render::pass
