// How much of the sun a point sees, from the shadow map. Most points are told lit or dark by the tiles alone; only
// those near an edge take taps, over a disc that grows with the distance to what casts the shadow [Fer05]. Glass has a
// map of its own, which takes a share of the light.
#include "common/frame.glsl"
layout(binding = 0) uniform sampler2DShadow shadow_map;
layout(binding = 1) uniform sampler2D shadow_tiles;    // x: least, y: greatest depth near the tile
layout(binding = 2) uniform sampler2D shadow_casters;  // x: depth times cover, y: cover; smooth between tiles
layout(binding = 11) uniform sampler2DShadow glass_map;

vec3 place_in_shadow(vec3 position_world) { return (shadow_from_world * vec4(position_world, 1.0)).xyz; }

// The share of light that glass lets through to p. slope, bias: as below. A loop, since llvmpipe skips those.
float through_glass(vec3 p, vec2 slope, float bias) {
  vec2 apart = vec2(0.75) / vec2(textureSize(glass_map, 0));
  int taps = shadow_on_floor.w > 0.0 ? 4 : 0;
  float depth = p.z - 3.0 * bias;
  float sum = 4.0;
  for (int i = 0; i < taps; ++i) {
    vec2 shift = apart * (vec2(i & 1, i >> 1) * 2.0 - 1.0);
    sum -= shadow_on_floor.w * (1.0 - texture(glass_map, vec3(p.xy + shift, min(depth + dot(slope, shift), 1.0))));
  }
  return sum * 0.25;
}

// p: place in the map, 0..1. slope: depth change per unit of the map along the receiver's plane, which is followed so
// that a lit plane never shades itself. bias: in depth, of a texel's width.
float sun_seen_past_bodies_at(vec3 p, vec2 slope, float bias, bool faces_away) {
  if (sun_radiance.w == 0.0) return 1.0;
  vec2 map_size = vec2(textureSize(shadow_map, 0));
  ivec2 tiles = textureSize(shadow_tiles, 0);
  vec2 tile = p.xy * vec2(tiles);
  vec2 bounds = texelFetch(shadow_tiles, clamp(ivec2(floor(tile)), ivec2(0), tiles - 1), 0).xy;
  bool inside = all(greaterThan(p.xy, vec2(0.0))) && all(lessThan(p.xy, vec2(1.0)));

  vec2 caster = texture(shadow_casters, p.xy).xy;
  float gap = max(p.z - caster.x / max(caster.y, 1e-4), 0.0) * shadow_texel.z;  // m
  float reach = gap * sun.w;                                                    // m, radius of the disc
  vec2 texel = 1.0 / map_size;
  vec2 radius = clamp(reach / shadow_texel.xy, vec2(SHADOW_TAPS < 8 ? 1.4 : 1.2), vec2(0.94 * shadow_texel.w)) * texel;
  float spread = dot(abs(slope), radius);
  bool lit = bounds.x >= 1.0 || p.z - bias - spread <= bounds.x;
  bool dark = faces_away || (bounds.y < 1.0 && p.z - bias - spread > bounds.y);
  // A small disc needs few taps: each blends four texels.
  float across = max(radius.x * map_size.x, radius.y * map_size.y);
  int most = clamp(int(4.0 * across), min(6, SHADOW_TAPS), SHADOW_TAPS);
  int taps = inside && !lit && !dark ? most : 0;
  float sum = 0.0;
  vec2 way = vec2(1.0, 0.0);  // golden-angle spiral
  const mat2 kTurn = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);
  for (int i = 0; i < taps; ++i) {
    vec2 shift = sqrt((float(i) + 0.5) / float(most)) * radius * way;
    way = kTurn * way;
    sum += texture(shadow_map, vec3(p.xy + shift, min(p.z - bias + dot(slope, shift), 1.0)));
  }
  return dark ? 0.0 : !inside || lit ? 1.0 : sum / float(most);
}

float sun_seen_at(vec3 p, vec2 slope, float bias, bool faces_away) {
  return sun_seen_past_bodies_at(p, slope, bias, faces_away) * through_glass(p, slope, bias);
}

// How depth changes along the plane of a receiver with this normal (world), x and y, and its bias, z: as above.
vec3 slope_and_bias(vec3 normal) {
  vec3 extent = vec3(shadow_texel.xy * vec2(textureSize(shadow_map, 0)), shadow_texel.z);  // m
  vec3 m = (mat3(shadow_from_world) * normal) * extent;  // unit, in the sun's frame; z away from it
  float depth_part = (m.z < 0.0 ? -1.0 : 1.0) * max(abs(m.z), 0.12);  // grazing planes are followed less far
  vec2 slope = -m.xy / depth_part * extent.xy / extent.z;
  float bias = dot(abs(slope), 1.0 / vec2(textureSize(shadow_map, 0))) +
               0.5 * max(shadow_texel.x, shadow_texel.y) / extent.z;
  return vec3(slope, bias);
}

// normal: of the receiver, world.
float sun_seen(vec3 position_world, vec3 normal) {
  vec3 plane = slope_and_bias(normal);
  return sun_seen_at(place_in_shadow(position_world), plane.xy, plane.z, dot(normal, sun.xyz) <= 0.0);
}

float sun_seen_past_bodies(vec3 position_world, vec3 normal) {
  vec3 plane = slope_and_bias(normal);
  return sun_seen_past_bodies_at(place_in_shadow(position_world), plane.xy, plane.z, false);
}

float sun_seen_by_floor(vec3 position_world) {
  return sun_seen_at(place_in_shadow(position_world), shadow_on_floor.xy, 0.0, sun.y <= 0.0);
}
