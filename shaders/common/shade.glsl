// Light from a painted surface towards the eye: sun, sky, soft boxes; linear.
#include "common/light.glsl"
#include "common/shadow.glsl"
#include "common/occlusion.glsl"
#include "common/paint.glsl"

// A glaze mirrors a twentieth: of lamps as bright as lamps are, not as a mirror may show them, that is still a light.
const float kCoatLamps = 2.2;

// pixel: gl_FragCoord.xy.
vec3 shade(Surface s, vec2 pixel) {
  vec3 n = s.normal;
  vec3 v = normalize(eye_exposure.xyz - s.position);
  float n_dot_v = max(dot(n, v), 1e-3);
  vec3 l = sun.xyz;
  float n_dot_l = max(dot(n, l), 0.0);
  vec3 h = normalize(l + v);
  float n_dot_h = max(dot(n, h), 0.0);
  float v_dot_h = max(dot(v, h), 0.0);
  vec3 r = 2.0 * dot(n, v) * n - v;

  vec3 sunlight = sun_radiance.rgb * sun_seen(s.position, n);
  float sky = sky_seen(pixel, s.view_depth);
  float sky_mirrored = clamp(sky * 1.5 - 0.3, 0.06, 1.0);

  vec3 f0 = mix(vec3(0.04), s.colour, s.metalness);
  vec3 diffuse = s.colour * (1.0 - s.metalness);
  vec2 share = reflected_share(n_dot_v, s.roughness);
  vec3 mirrored = f0 * share.x + share.y;

  // Light that bounced in the surface's own hollow: occlusion takes the paint's tint instead of going grey.
  vec3 sky_tinted = sky / (1.0 - 0.6 * s.colour * (1.0 - sky));
  vec3 light = diffuse * (sunlight * n_dot_l + ambient(n) * sky_tinted * (1.0 - share.y));
#if PATTERNS & 1024  // something in the picture is a mirror
  vec3 below = mirrored_floor(s.position, r, s.roughness);
  float dull = smoothstep(0.1, 0.3, max(s.roughness, 1.0 - s.metalness));
  below = mix(below, ground_radiance.rgb, dull);
  // The floor that a mirror shows has its dark foot already.
  float base_mirrored = mix(1.0, sky_mirrored, max(dull, smoothstep(-0.25, 0.0, r.y)));
#else
  float base_mirrored = sky_mirrored;
  vec3 below = ground_radiance.rgb;
#endif
#ifdef PREVIEW  // one look at the surroundings instead of two
  bool is_coated = s.coat > 0.3;
  vec3 around = surroundings(r, is_coated ? s.coat_roughness : s.roughness, below, is_coated ? kCoatLamps : 1.0);
  vec3 around_base = around;
#else
  vec3 around = surroundings(r, s.coat_roughness, ground_radiance.rgb, kCoatLamps);
  vec3 around_base = surroundings(r, s.roughness, below, 1.0);
#endif
  light += mirrored * around_base * base_mirrored;
  light += sunlight * glint(n_dot_l, n_dot_v, n_dot_h, s.roughness) * f0;

  float coat = max(s.coat, 0.0) * schlick(0.05, n_dot_v);
  light *= 1.0 - coat;
  light += coat * around * sky_mirrored;
  light += sunlight * max(s.coat, 0.0) * schlick(0.05, v_dot_h) * glint(n_dot_l, n_dot_v, n_dot_h, s.coat_roughness);
  return light;
}
