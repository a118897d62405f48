// Thin glass over what is drawn (dual-source blending): its faces mirror the surroundings and tint what is behind; its
// broken rims gather light and show through the faces, bright and a little green. Samples that see none, or glass behind a
// body, keep what is there. RIMS: for pixels with rims, and faces or not; otherwise with faces alone.
#include "common/light.glsl"
#include "common/paint.glsl"
#include "common/samples.glsl"
#include "common/tone.glsl"
layout(binding = 7) uniform sampler2D opaque_depth;  // 0..1
#ifdef RIMS
layout(binding = 8) uniform usampler2D rim_map;      // as seen_map, of rims and crack lines only
layout(binding = 9) uniform sampler2D rim_depth;
#endif
layout(location = 0, index = 0) out vec4 added;
layout(location = 0, index = 1) out vec4 kept;

// Tall windows around the room, each of four panes: what clear glass is known by. Linear, as a share of the sky.
float room_windows(vec3 d) {
  float along = abs(fract(atan(d.z, d.x) * (9.0 / (2.0 * kPi)) + 0.6) - 0.5);  // 0 at a window's middle
  float up = d.y * inversesqrt(max(dot(d.xz, d.xz), 1e-6));
  float wide = smoothstep(0.36, 0.33, along) * smoothstep(0.010, 0.022, along);
  float high = smoothstep(-0.16, -0.10, up) * smoothstep(1.05, 0.85, up) * smoothstep(0.006, 0.014, abs(up - 0.14));
  return wide * high * (0.4 + 0.6 * clamp(2.0 * up + 0.3, 0.0, 1.0));
}

void add_face(Surface s, float weight, inout vec3 add, inout vec3 keep) {
  vec3 v = normalize(eye_exposure.xyz - s.position);
  float n_dot_v = clamp(abs(dot(s.normal, v)), 0.05, 1.0);
  vec3 r = 2.0 * dot(s.normal, v) * s.normal - v;
  float once = schlick(0.04, n_dot_v);
  float mirror = 2.0 * once / (1.0 + once);  // both faces
  vec3 light = surroundings(r, s.roughness) + sky_radiance.rgb * (sky_radiance.w * 2.4 * room_windows(r));
  // A pane is flat: it shows one small part of a lamp, all over. Pressed, so that it stays a film over what is behind.
  light /= 1.0 + 0.5 * max(light.r, max(light.g, light.b));
  vec3 h = normalize(sun.xyz + v);
  float n_dot_l = max(dot(s.normal, sun.xyz), 0.0);
  vec3 glance = sun_radiance.rgb * glint(n_dot_l, n_dot_v, max(dot(s.normal, h), 0.0), max(s.roughness, 0.12)) * 0.008;
  vec3 haze = s.colour * ambient(s.normal) * (0.04 + (1.0 - s.transmission));
  add += weight * (mirror * light + glance + haze);
  // The way through is longer at a slant; as an exponent of the tint that is 1 to 4, by squaring.
  float slant = min(1.0 / n_dot_v, 4.0) - 1.0;
  vec3 tint = s.colour * mix(vec3(1.0), s.colour * s.colour * s.colour, slant / 3.0);
  keep -= weight * (1.0 - s.transmission * (1.0 - mirror) * tint);
}

// Light that entered the faces comes out at a rim, from wherever it came.
void add_rim(Surface s, float weight, inout vec3 add, inout vec3 keep) {
  vec3 v = normalize(eye_exposure.xyz - s.position);
  vec3 r = 2.0 * dot(s.normal, v) * s.normal - v;
  vec3 gathered = ambient(s.normal) * 0.6 + sun_radiance.rgb * (0.04 + 0.5 * dot(s.normal, sun.xyz) * dot(s.normal, sun.xyz));
  bool is_crack = s.roughness > 0.1;
  vec3 light = s.colour * (is_crack ? vec3(1.0) : vec3(0.18, 0.42, 0.33)) * gathered + 0.1 * surroundings(r, 0.15);
  float through = is_crack ? 0.3 : 0.45;
  add += weight * light * keep;
  keep *= 1.0 - weight * (1.0 - through);
}

// Of each pixel's samples: the share that `depths` has before the walls, and the last of them (-1: none).
float cover(vec4 depths, vec4 walls, out int last) {
  last = -1;
  float share = 0.0;
  for (int i = 0; i < SIDE * SIDE; ++i) {
    bool is_seen = depths[i] < walls[i];
    last = is_seen ? i : last;
    share += is_seen ? 1.0 / float(SIDE * SIDE) : 0.0;
  }
  return share;
}

// The surface of the pixel's sample i in a layer.
Surface layer_surface(usampler2D map, vec4 depths, ivec2 first, int i) {
  ivec2 at = sample_shift(max(i, 0));
  vec2 place = floor(gl_FragCoord.xy) + (vec2(at) + 0.5) / float(SIDE);
  return surface_at(texelFetch(map, first + at, 0), min(depths[max(i, 0)], 0.9999), place);
}

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * SIDE;
  vec4 walls = depths_at(opaque_depth, first), depths = depths_at(seen_depth, first);
  int face, rim;
  float faces = cover(depths, walls, face);
  vec3 add = vec3(0.0), keep = vec3(1.0);
  add_face(layer_surface(seen_map, depths, first, face), faces, add, keep);
#ifdef RIMS
  vec4 rim_depths = depths_at(rim_depth, first);
  float rims = cover(rim_depths, walls, rim);
  add_rim(layer_surface(rim_map, rim_depths, first, rim), rims, add, keep);
#endif
  added = vec4(tone_map(add), 1.0);
  kept = vec4(keep, 1.0);
}
