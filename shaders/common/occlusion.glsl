// Ambient occlusion at a full-size pixel from the smaller one: the four nearest, less where the depth differs.
#include "common/frame.glsl"
layout(binding = 3) uniform usampler2D occlusion_map;  // half floats: share of sky seen; 1 / view depth times the target's

float sky_seen(vec2 pixel, float view_depth) {
  vec2 h = pixel * (1.0 / float(OCCLUSION_SCALE)) - 0.5;
  vec2 base = floor(h);
  vec2 f = h - base;
  uvec4 words = textureGather(occlusion_map, (base + 1.0) / vec2(textureSize(occlusion_map, 0)));
  vec4 w = vec4((1.0 - f.x) * f.y, f.x * f.y, f.x * (1.0 - f.y), (1.0 - f.x) * (1.0 - f.y));  // the gather's order
  vec2 a = unpackHalf2x16(words.x), b = unpackHalf2x16(words.y), c = unpackHalf2x16(words.z), d = unpackHalf2x16(words.w);
  // How much nearer or farther each is, as a share.
  vec4 off = abs(vec4(a.y, b.y, c.y, d.y) * (view_depth / target_distance.w) - 1.0);
  w /= 0.02 + 20.0 * off;
  return (dot(w, vec4(a.x, b.x, c.x, d.x)) + 1e-4) / (dot(w, vec4(1.0)) + 1e-4);
}
