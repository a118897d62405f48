// Mean over 4 x 4 pixels of about the same depth: exactly the period of the turning pattern.
#include "common/frame.glsl"
layout(binding = 0) uniform usampler2D raw;  // as occlusion.frag packs it
layout(location = 0) out uint seen_depth;   // the same
void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  vec2 texel = 1.0 / vec2(textureSize(raw, 0));
  float near = unpackHalf2x16(texelFetch(raw, here, 0).x).y;  // 1 / depth
  float away = 12.0 / near;
  vec2 sum = vec2(0.0);
  for (int i = 0; i < 4; ++i) {
    uvec4 words = textureGather(raw, vec2(here + ivec2(i & 1, i >> 1) * 2 - 1) * texel);
    for (int k = 0; k < 4; ++k) {
      vec2 s = unpackHalf2x16(words[k]);
      float weight = max(1.0 - abs(s.y - near) * away, 1e-3);
      sum += weight * vec2(s.x, 1.0);
    }
  }
  seen_depth = packHalf2x16(vec2(sum.x / sum.y, near));
}
