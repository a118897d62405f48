// What does not change while camera, lights and ground stay: the empty floor before its backdrop as a picture, and the
// parts from which floor.frag puts it together under shadow and occlusion.
#include "common/floor.glsl"
#include "common/paint.glsl"
layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 parts;  // rgb: the backdrop's share, linear; a: the floor's
void main() {
  vec2 pixel = gl_FragCoord.xy;
  parts = floor_parts(pixel, ray_at(pixel));
  colour = vec4(tone_map(parts.rgb + parts.a * (floor_sun.rgb + floor_sky.rgb)), 1.0);
}
