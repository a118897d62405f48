// A matt floor that takes shadow and occlusion and fades into the backdrop.
#include "common/frame.glsl"
#include "common/light.glsl"
#include "common/shadow.glsl"
#include "common/occlusion.glsl"
#include "common/tone.glsl"
in vec3 position_world;
layout(location = 0) out vec4 colour;
void main() {
  vec3 n = vec3(0.0, 1.0, 0.0);
  vec3 base = ground_colour.rgb;
  if (ground_colour.w > 0.0) {
    vec2 p = position_world.xz / ground_colour.w;
    vec2 s = abs(fract(p * 0.5) - 0.5) - 0.25;
    vec2 side = clamp(s / max(fwidth(p) * 0.5, vec2(1e-5)) + 0.5, 0.0, 1.0) * 2.0 - 1.0;
    base *= 0.86 + 0.14 * side.x * side.y;
  }
  float sky = sky_seen(gl_FragCoord.xy, 1.0 / gl_FragCoord.w);
  vec3 light = base * (sun_radiance.rgb * max(sun.y, 0.0) * sun_seen(position_world, n) + ambient(n) * sky);
  vec3 to_eye = eye_exposure.xyz - position_world;
  float away = length(position_world.xz - target_distance.xz);
  float fade = smoothstep(ground_place.y, ground_place.z, away);
  vec3 backdrop = backdrop_at(gl_FragCoord.xy);
  colour = vec4(tone_map(mix(light, backdrop, fade)), 1.0);
}
