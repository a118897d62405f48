// The least share of sky seen in each 16 x 16 pixels of the picture and a little around them: where it is nearly whole
// the floor needs no occlusion.
#include "common/frame.glsl"
layout(binding = 0) uniform usampler2D occlusion_map;
layout(location = 0) out float least;
void main() {
  const int kAcross = 16 / OCCLUSION_SCALE + 3;
  vec2 texel = 1.0 / vec2(textureSize(occlusion_map, 0));
  ivec2 first = ivec2(gl_FragCoord.xy) * 16 / OCCLUSION_SCALE - 1;
  least = 1.0;
  for (int y = 0; y < kAcross; y += 2) {
    for (int x = 0; x < kAcross; x += 2) {  // four about a corner at once
      uvec4 words = textureGather(occlusion_map, vec2(first + ivec2(x, y) + 1) * texel);
      for (int k = 0; k < 4; ++k) least = min(least, unpackHalf2x16(words[k]).x);
    }
  }
}
