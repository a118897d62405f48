// From scene light to display light (linear; the target encodes sRGB). Up to kShoulder nothing is changed, so that
// paint keeps its colour; above, light is compressed and slowly bleached.
#include "common/frame.glsl"
const float kShoulder = 0.72;
vec3 tone_map(vec3 radiance) {
  vec3 c = radiance * eye_exposure.w;
  float peak = max(c.r, max(c.g, c.b));
  float room = 1.0 - kShoulder;
  float over = max(peak - kShoulder, 0.0);
  float pressed = min(peak, kShoulder) + room * over / (over + room);
  c *= pressed / max(peak, 1e-6);
  float bleach = over / (over + 2.5);
  return mix(c, vec3(pressed), bleach);
}

// The backdrop at a pixel (gl_FragCoord.xy, from below).
vec3 backdrop_at(vec2 pixel) {
  vec2 s = pixel * viewport.zw;
  vec3 c = mix(backdrop_bottom.rgb, backdrop_top.rgb, smoothstep(0.25, 1.0, s.y));
  vec2 g = (pixel - glow_centre.xy) * glow_centre.z;
  c *= 1.0 + backdrop_top.w * exp2(-2.0 * dot(g, g));
  vec2 v = (s - 0.5) * 2.0;
  c *= 1.0 - backdrop_bottom.w * 0.5 * smoothstep(0.3, 2.0, dot(v, v));
  return c;
}
