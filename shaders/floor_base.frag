// The empty floor before its backdrop.
#include "common/floor.glsl"
#include "common/paint.glsl"
noperspective in vec4 corner;
layout(location = 0) out vec4 colour;
void main() {
  vec4 parts = floor_at(corner, ray_at(gl_FragCoord.xy));
  colour = vec4(tone_map(parts.rgb + parts.a * (floor_sun.rgb + floor_sky.rgb)), 1.0);
}
