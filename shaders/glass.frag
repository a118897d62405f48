// Thin glass over what is drawn (dual-source blending): the faces behind others; its broken rims (RIMS), which gather light
// and show through the faces, bright and a little green; the nearest faces, which mirror the surroundings and tint what is behind.
// Samples that see none, or glass behind a body, keep what is there.
#include "common/light.glsl"
#include "common/paint.glsl"
#include "common/samples.glsl"
#include "common/tone.glsl"
layout(binding = 7) uniform sampler2D opaque_depth;  // 0..1
layout(location = 0, index = 0) out vec4 added;
layout(location = 0, index = 1) out vec4 kept;

#if PATTERNS & 2048  // something in the picture is cloudy
#include "common/shadow.glsl"
// How much light a face takes: what keeps the sun off is near, and keeps off some of the sky. Light goes through such a body:
// no face is dark because it is turned away.
float light_seen(Surface s, vec3 n) { return s.transmission < CLEAR ? sun_seen_past_bodies(s.position, n) : 1.0; }
const float kSkyInShadow = 0.6;
#endif

#ifndef RIMS
// Two tall windows in each wall of a square room, each of four panes: what clear glass is known by. As a share of the sky.
float room_windows(vec3 d) {
  bool is_x = abs(d.x) > abs(d.z);
  vec2 wall = vec2(is_x ? d.z : d.x, d.y) / max(max(abs(d.x), abs(d.z)), 1e-3);  // -1..1 across; height over the eye's
  float along = abs(abs(wall.x) - 0.46);
  float wide = smoothstep(0.37, 0.33, along) * smoothstep(0.010, 0.024, along);
  float high = smoothstep(-0.16, -0.10, wall.y) * smoothstep(1.05, 0.85, wall.y) * smoothstep(0.006, 0.016, abs(wall.y - 0.14));
  return wide * high * (0.4 + 0.6 * clamp(2.0 * wall.y + 0.3, 0.0, 1.0));
}

void add_face(Surface s, float weight, inout vec3 add, inout vec3 keep) {
  vec3 v = normalize(eye_exposure.xyz - s.position);
  vec3 n = dot(s.normal, v) < 0.0 ? -s.normal : s.normal;  // only one of a pane's two faces is drawn
  float n_dot_v = max(dot(n, v), 0.05);
  vec3 r = 2.0 * dot(n, v) * n - v;
  float once = schlick(0.04, n_dot_v);
  float mirror = 2.0 * once / (1.0 + once);  // both faces
  float sharp = 1.0 - smoothstep(0.05, 0.25, s.roughness);  // frosted glass mirrors no window
  vec3 light = surroundings(r, s.roughness) + sky_radiance.rgb * (sky_radiance.w * 3.0 * sharp * room_windows(r));
  // A pane is flat: it shows one small part of a lamp, all over. Pressed, so that it stays a film over what is behind.
  light /= 1.0 + 0.5 * max(light.r, max(light.g, light.b));
  vec3 h = normalize(sun.xyz + v);
  float n_dot_l = max(dot(n, sun.xyz), 0.0);
  vec3 glance = sun_radiance.rgb * glint(n_dot_l, n_dot_v, max(dot(n, h), 0.0), max(s.roughness, 0.12)) * 0.03;
  // What does not go through scatters, of the sun's light too, from whichever side it comes.
  float dull = 1.0 - s.transmission;
#if PATTERNS & 2048
  float lit = light_seen(s, dot(n, sun.xyz) < 0.0 ? -n : n);
  glance *= lit;
  dull *= mix(kSkyInShadow, 1.0, lit);
#endif
  vec3 haze = s.colour * (ambient(n) * (0.05 + dull) + sun_radiance.rgb * (0.22 * dull * (0.4 + abs(dot(n, sun.xyz)))));
  // The way through is longer at a slant; as an exponent of the tint that is 1 to 4, by squaring.
  float slant = min(1.0 / n_dot_v, 4.0) - 1.0;
  vec3 tint = s.colour * mix(vec3(1.0), s.colour * s.colour * s.colour, slant / 3.0);
  // Towards its outline the wall is seen lengthwise: what shines through comes from aside, out of the dark of the room or
  // from a lamp. By these lines clear glass is told from air on a pale ground.
  float bent = sharp * smoothstep(0.55, 0.15, dot(n, v));
  vec3 aside = tint * tint * surroundings(normalize(n - 0.4 * v), 0.2) * 0.3;
  add += weight * (mirror * light + glance + haze + bent * (1.0 - mirror) * s.transmission * aside);
  keep -= weight * (1.0 - s.transmission * (1.0 - mirror) * (1.0 - 0.9 * bent) * tint);
}

#else
// Light that entered the faces comes out at a rim, from wherever it came.
void add_rim(Surface s, float weight, inout vec3 add, inout vec3 keep) {
  vec3 v = normalize(eye_exposure.xyz - s.position);
  vec3 r = 2.0 * dot(s.normal, v) * s.normal - v;
  vec3 gathered = ambient(s.normal) * 0.6 + sun_radiance.rgb * (0.04 + 0.5 * dot(s.normal, sun.xyz) * dot(s.normal, sun.xyz));
  bool is_crack = s.coat < 0.0;
  vec3 light = s.colour * (is_crack ? vec3(1.0) : vec3(0.18, 0.42, 0.33)) * gathered + 0.1 * surroundings(r, 0.15);
  float through = is_crack ? 0.3 : 0.45;
  add += weight * light;
  keep *= 1.0 - weight * (1.0 - through);
}
#endif

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

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * SIDE;
  vec4 walls = depths_at(opaque_depth, first), depths = depths_at(seen_depth, first);
  int last;
  float share = cover(depths, walls, last);
  ivec2 at = sample_shift(max(last, 0));
  vec2 place = floor(gl_FragCoord.xy) + (vec2(at) + 0.5) / float(SIDE);
  Surface s = surface_at(texelFetch(seen_map, first + at, 0), min(depths[max(last, 0)], 0.9999), place);
  vec3 add = vec3(0.0), keep = vec3(1.0);
#ifdef RIMS
  add_rim(s, share, add, keep);
#else
  add_face(s, share, add, keep);
#endif
  added = vec4(tone_map(add), 1.0);
  kept = vec4(keep, 1.0);
}
