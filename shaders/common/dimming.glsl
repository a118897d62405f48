// Shares of sun and sky that the floor sees at each second pixel: dimming.frag writes what floor.frag looks up.
#include "common/frame.glsl"
layout(binding = 10) uniform usampler2D dimming_map;  // sky in bits 0-7, sun in 8-15

uint pack_dimming(float sky, float sun_share) { return uint(sky * 255.0 + 0.5) | uint(sun_share * 255.0 + 0.5) << 8; }

// x: sky, y: sun, at a full-size pixel: between the four nearest.
vec2 dimming_at(vec2 pixel) {
  vec2 h = pixel * 0.5 - 0.5;
  vec2 base = floor(h);
  vec2 f = h - base;
  uvec4 words = textureGather(dimming_map, (base + 1.0) / vec2(textureSize(dimming_map, 0)));
  vec4 w = vec4((1.0 - f.x) * f.y, f.x * f.y, f.x * (1.0 - f.y), (1.0 - f.x) * (1.0 - f.y));  // the gather's order
  return vec2(dot(w, vec4(words & 255u)), dot(w, vec4(words >> 8))) * (1.0 / 255.0);
}
