// Mean over 4 x 4 pixels of about the same depth: exactly the period of the turning pattern.
#include "common/frame.glsl"
layout(binding = 0) uniform sampler2D raw;  // share seen, view depth
layout(location = 0) out uint seen_depth;  // as common/occlusion.glsl reads it
void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(raw, 0) - 1;
  float z = texelFetch(raw, here, 0).y;
  vec2 sum = vec2(0.0);
  for (int y = -2; y < 2; ++y) {
    for (int x = -2; x < 2; ++x) {
      vec2 s = texelFetch(raw, clamp(here + ivec2(x, y), ivec2(0), last), 0).xy;
      float weight = max(1.0 - abs(s.y - z) / z * 12.0, 1e-3);
      sum += weight * vec2(s.x, 1.0);
    }
  }
  seen_depth = packHalf2x16(vec2(sum.x / sum.y, target_distance.w / z));
}
