// Depths of a pixel's SIDE x SIDE samples at once, in the order of sample_shift().
#include "common/frame.glsl"
#if SIDE == 2
ivec2 sample_shift(int i) { return ivec2((i + 1) >> 1 & 1, 1 - (i >> 1)); }  // textureGather's order
vec4 depths_at(sampler2D map, ivec2 first) {
  return textureGather(map, vec2(first + 1) / vec2(textureSize(map, 0)));
}
uvec4 words_at(usampler2D map, ivec2 first, const int channel) {
  vec2 corner = vec2(first + 1) / vec2(textureSize(map, 0));
  return channel == 0 ? textureGather(map, corner, 0) : textureGather(map, corner, 1);
}
#else
ivec2 sample_shift(int i) { return ivec2(0); }
vec4 depths_at(sampler2D map, ivec2 first) { return texelFetch(map, first, 0).xxxx; }
uvec4 words_at(usampler2D map, ivec2 first, const int channel) { return uvec4(texelFetch(map, first, 0)[channel]); }
#endif
