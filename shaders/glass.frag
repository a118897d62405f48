// Thin glass: mirrored light is added, what is behind is tinted (dual-source blending). Crack rims scatter: milky.
#include "common/look.glsl"
layout(location = 0, index = 0) out vec4 added;
layout(location = 0, index = 1) out vec4 kept;
void main() {
  vec3 n = normalize(normal_world);
  vec3 v = normalize(eye_exposure.xyz - position_world);
  float n_dot_v = max(dot(n, v), 0.02);
  Paint p = paint_here();
  float clear = finish.w * (pattern_overlay.y != 0 ? 0.35 : 1.0);
  float is_rim = smoothstep(0.06, 0.18, paint.a);  // the two faces are polished, the rims are not
  clear *= 1.0 - 0.72 * is_rim;
  float mirror = 2.0 * schlick(0.04, n_dot_v);
  mirror = mirror / (1.0 + 0.5 * mirror);
  vec3 light = shade(p, n, 1.0 - clear);
  added = vec4(tone_map(light), 1.0);
  kept = vec4(clear * (1.0 - mirror) * pow(p.colour, vec3(0.6 + 0.4 / n_dot_v)), 1.0);
}
