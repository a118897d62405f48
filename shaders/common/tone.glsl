// From scene light to display light (linear; the target encodes sRGB). Up to kShoulder nothing is changed, so that
// paint keeps its colour; above, light is compressed and slowly bleached.
#include "common/frame.glsl"
const float kShoulder = 0.72;
vec3 tone_map(vec3 radiance) {
  vec3 c = radiance * eye_exposure.w;
  float peak = max(c.r, max(c.g, c.b));
  int turns = peak > kShoulder ? 1 : 0;
  for (int i = 0; i < turns; ++i) {  // a loop, since llvmpipe skips those where no pixel of eight wants them
    float room = 1.0 - kShoulder;
    float over = peak - kShoulder;
    float pressed = kShoulder + room * over / (over + room);
    c = mix(c * (pressed / peak), vec3(pressed), over / (over + 2.5));
  }
  return c;
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
