// The least share of sky seen in each 16 x 16 pixels of the picture and a little around them: where it is nearly whole
// the floor needs no occlusion.
#include "common/frame.glsl"
layout(binding = 0) uniform usampler2D occlusion_map;
layout(location = 0) out float least;
void main() {
  const int kAcross = 16 / OCCLUSION_SCALE + 3;
  ivec2 last = textureSize(occlusion_map, 0) - 1;
  ivec2 first = ivec2(gl_FragCoord.xy) * 16 / OCCLUSION_SCALE - 1;
  least = 1.0;
  for (int y = 0; y < kAcross; ++y) {
    for (int x = 0; x < kAcross; ++x) {
      uint word = texelFetch(occlusion_map, clamp(first + ivec2(x, y), ivec2(0), last), 0).x;
      least = min(least, unpackHalf2x16(word).x);
    }
  }
}
