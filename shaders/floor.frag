// The floor where a body darkens it: what floor_base.frag kept, under shadow and occlusion. NO_SHADOW: for tiles that no
// shadow reaches.
#include "common/floor.glsl"
#include "common/paint.glsl"
#ifdef PREVIEW
#include "common/dimming.glsl"
#else
#include "common/shadow.glsl"
#include "common/occlusion.glsl"
#endif
layout(binding = 8) uniform sampler2D floor_map;  // floor_base.frag's parts
layout(location = 0) out vec4 colour;
void main() {
  vec2 pixel = gl_FragCoord.xy;
  vec3 ray = ray_at(pixel);
  float z = floor_depth(ray);
  vec4 parts = texelFetch(floor_map, ivec2(pixel), 0);
#ifdef PREVIEW
  vec2 dimming = dimming_at(pixel, z, false);
#elif defined(NO_SHADOW)
  vec2 dimming = vec2(sky_seen(pixel, z), 1.0);
#else
  vec2 dimming = vec2(sky_seen(pixel, z), sun_seen(eye_exposure.xyz + ray * min(z, 1e6), vec3(0.0, 1.0, 0.0)));
#endif
  colour = vec4(tone_map(parts.rgb + parts.a * (floor_sun.rgb * dimming.y + floor_sky.rgb * dimming.x)), 1.0);
}
