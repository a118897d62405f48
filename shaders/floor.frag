// The floor under shadow and occlusion: at each pixel (EXACT), or between those that dimming.frag looked at.
#include "common/floor.glsl"
#include "common/paint.glsl"
#ifdef EXACT
#include "common/shadow.glsl"
#include "common/occlusion.glsl"
#else
#include "common/dimming.glsl"
#endif
noperspective in vec4 corner;
layout(location = 0) out vec4 colour;
void main() {
  vec2 pixel = gl_FragCoord.xy;
  vec3 ray = ray_at(pixel);
  vec4 parts = floor_at(corner, ray, pixel);
#ifdef EXACT
  float z = min(floor_depth(ray), 1e6);
  vec2 dimming = vec2(sky_seen(pixel, z), sun_seen_by_floor(eye_exposure.xyz + ray * z));
#else
  vec2 dimming = dimming_at(pixel);
#endif
  colour = vec4(tone_map(parts.rgb + parts.a * (floor_sun.rgb * dimming.y + floor_sky.rgb * dimming.x)), 1.0);
}
