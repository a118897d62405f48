// Sun and sky at each second pixel, for previews: dimming.frag writes what light.frag and floor.frag look up.
#include "common/frame.glsl"

uint pack_dimming(float sky, float sun_share, bool is_body, float view_depth) {
  uint shares = uint(sky * 255.0 + 0.5) | uint(sun_share * 127.0 + 0.5) << 8 | (is_body ? 1u << 15 : 0u);
  return shares | packHalf2x16(vec2(0.0, view_depth / target_distance.w));
}

#ifdef PREVIEW
layout(binding = 10) uniform usampler2D dimming_map;

// Shares of sky and sun seen at a full-size pixel: the four nearest, bodies from bodies and floor from floor, less where
// the depth differs.
vec2 dimming_at(vec2 pixel, float view_depth, bool is_body) {
  ivec2 last = textureSize(dimming_map, 0) - 1;
  vec2 h = pixel * 0.5 - 0.5;
  ivec2 base = ivec2(floor(h));
  vec2 f = h - vec2(base);
  float z = min(view_depth / target_distance.w, 6e4);
  vec3 sum = vec3(1e-6);
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    uint word = texelFetch(dimming_map, clamp(base + corner, ivec2(0), last), 0).x;
    vec2 w = mix(1.0 - f, f, vec2(corner)) + 0.01;
    float other = ((word >> 15) & 1u) == (is_body ? 1u : 0u) ? 1.0 : 1e-3;
    float weight = w.x * w.y * other / (0.02 + abs(unpackHalf2x16(word).y - z) / z * 10.0);
    sum += weight * vec3(float(word & 255u) * (1.0 / 255.0), float((word >> 8) & 127u) * (1.0 / 127.0), 1.0);
  }
  return sum.xy / sum.z;
}
#endif
