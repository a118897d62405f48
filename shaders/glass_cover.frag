// Where glass is seen before all bodies, written as depth: 0 nowhere, 0.3 faces alone, 0.6 rims too, 1 faces behind faces.
// The costly glass.frag skips blocks of pixels by it.
#include "common/paint.glsl"
#include "common/samples.glsl"
layout(binding = 7) uniform sampler2D opaque_depth;
layout(binding = 9) uniform sampler2D rim_depth;
layout(binding = 10) uniform sampler2D behind_depth;
void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * SIDE;
  vec4 walls = depths_at(opaque_depth, first);
  bool is_rim = any(lessThan(depths_at(rim_depth, first), walls));
  bool is_face = any(lessThan(depths_at(seen_depth, first), walls));
  bool is_behind = any(lessThan(depths_at(behind_depth, first), walls));
  gl_FragDepth = is_behind ? 1.0 : is_rim ? 0.6 : is_face ? 0.3 : 0.0;
}
