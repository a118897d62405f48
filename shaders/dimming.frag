// At the corner that each four pixels share, how much of sky and sun the floor there sees, bodies before it or not.
// NO_SHADOW: for tiles that no shadow reaches.
#include "common/paint.glsl"
#include "common/floor.glsl"
#include "common/shadow.glsl"
#include "common/occlusion.glsl"
#include "common/dimming.glsl"
layout(location = 0) out uint dimming;
void main() {
  vec2 pixel = floor(gl_FragCoord.xy) * 2.0 + 1.0;
  vec3 ray = ray_at(pixel);
  float z = min(floor_depth(ray), 1e6);
#ifdef NO_SHADOW
  dimming = pack_dimming(sky_seen(pixel, z), 1.0);
#else
  dimming = pack_dimming(sky_seen(pixel, z), sun_seen_by_floor(eye_exposure.xyz + ray * z));
#endif
}
