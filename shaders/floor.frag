// Floor and backdrop. NO_SHADOW, NO_OCCLUSION: for tiles that they cannot reach.
#include "common/floor.glsl"
#include "common/paint.glsl"
layout(location = 0) out vec4 colour;
void main() {
  vec2 pixel = gl_FragCoord.xy;
  colour = vec4(tone_map(floor_light(pixel, ray_at(pixel))), 1.0);
}
