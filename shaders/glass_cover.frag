// Where glass is seen before all bodies, written as depth: 0 nowhere, 0.5 faces alone, 1 rims too. The costly glass.frag
// skips blocks of pixels by it.
#include "common/paint.glsl"
#include "common/samples.glsl"
layout(binding = 7) uniform sampler2D opaque_depth;
layout(binding = 9) uniform sampler2D rim_depth;
void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * SIDE;
  vec4 walls = depths_at(opaque_depth, first);
  bool is_rim = any(lessThan(depths_at(rim_depth, first), walls));
  bool is_face = any(lessThan(depths_at(seen_depth, first), walls));
  gl_FragDepth = is_rim ? 1.0 : is_face ? 0.5 : 0.0;
}
