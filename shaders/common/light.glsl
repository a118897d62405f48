// Sun, sky, soft boxes: analytic, world space, linear. Reflection is GGX; [KarisUE4]'s fit stands for its integral.
#include "common/frame.glsl"

const float kWall = 0.16;  // a wall's light as a share of the ceiling's sky

// Radiance of the surroundings from direction d, blurred as a surface of that roughness sees it: a studio, whose walls are
// dark and whose ceiling is bright. Metal is known by such contrasts, and looks like paper where all around is alike.
// below: what comes from the floor. lamps: of the soft boxes; 1 as the picture's tones hold them.
vec3 surroundings(vec3 d, float roughness, vec3 below, float lamps) {
  float soft = 0.05 + 0.9 * roughness;
  vec3 sky = sky_radiance.rgb * mix(kWall, 0.95, smoothstep(0.1 - soft, 0.85 + soft, d.y));
  vec3 light = mix(below, sky, smoothstep(-soft, soft, d.y));
  float edge = 0.05 + 1.4 * roughness * roughness + 0.25 * roughness;
  for (int i = 0; i < 2; ++i) {
    float towards = dot(d, box_axis[i].xyz);
    vec2 p = abs(vec2(dot(d, box_right[i].xyz), dot(d, box_up[i].xyz))) / max(towards, 0.02);
    vec2 half_size = vec2(box_right[i].w, box_up[i].w);
    vec2 inside = 1.0 - smoothstep(half_size - edge * 0.5, half_size + edge, p);
    float thinned = half_size.x * half_size.y / ((half_size.x + 0.3 * edge) * (half_size.y + 0.3 * edge));
    vec2 q = p / (half_size + edge);
    float paler = 1.0 - 0.45 * min(dot(q, q), 1.6);  // towards its rim
    light += lamps * sky_radiance.w * box_axis[i].w * thinned * paler * inside.x * inside.y * step(0.0, towards);
  }
  return light;
}

vec3 surroundings(vec3 d, float roughness) { return surroundings(d, roughness, ground_radiance.rgb, 1.0); }

// The floor as a mirror at p sees it along d: its boards or squares, dark at the mirror's own foot, and fading into the
// walls. It is known where nothing else is, so it is no more than that: other bodies and their shadows are not in it.
vec3 mirrored_floor(vec3 p, vec3 d, float roughness) {
  if (ground_place.w == 0.0) return ground_radiance.rgb;
  float away = max(p.y - ground_place.x, 0.0) / max(-d.y, 0.02);  // m
  vec2 at = p.xz + away * d.xz;
  float share = 1.0;
  if (ground_colour.w > 0.0) {
    float blur = away * (0.004 + 0.3 * roughness) / ground_colour.w;  // in boards or squares
    vec2 cell = at / ground_colour.w;
    float sharp = clamp(1.0 - 1.6 * blur, 0.0, 1.0);
    if (glow_centre.w == 1.0) {
      vec2 s = (abs(fract(cell * 0.5) - 0.5) - 0.25) * 2.0;
      vec2 side = clamp(s / max(2.0 * blur, 1e-3) + 0.5, 0.0, 1.0) * 2.0 - 1.0;
      share = 1.0 + 0.3 * side.x * side.y * sharp;
    }
    if (glow_centre.w == 2.0) {
      float edge = 0.5 - abs(fract(cell.y) - 0.5), seam = 0.012 + blur;
      share = 1.0 + sharp * (0.28 * (fract(43.7 * sin(12.9 * floor(cell.y))) - 0.5)) -
              0.65 * (0.012 / seam) * (1.0 - smoothstep(0.0, seam, edge));
    }
  }
  float foot = 0.3 + 0.7 * away / (away + 0.6 * occlusion_scale.w);
  float far = away / (away + 1.2 * target_distance.w);
  return mix(share * (floor_sun.rgb * foot * foot + floor_sky.rgb * foot), kWall * sky_radiance.rgb, far);
}

// Irradiance / pi from sky, ground and soft boxes on a matt surface.
vec3 ambient(vec3 normal) {
  vec3 light = mix(ground_radiance.rgb, sky_radiance.rgb, 0.5 + 0.5 * normal.y);
  float box = max(dot(normal, box_axis[0].xyz) * 0.5 + 0.5, 0.0) * box_axis[0].w;
  float rim = max(dot(normal, box_axis[1].xyz) * 0.5 + 0.5, 0.0) * box_axis[1].w;
  return light + sky_radiance.w * (0.035 * box + 0.05 * rim);
}

// Share of reflected surroundings: f0 * x + y.
vec2 reflected_share(float n_dot_v, float roughness) {
  vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a = min(r.x * r.x, exp2(-9.28 * n_dot_v)) * r.x + r.y;
  return vec2(-1.04, 1.04) * a + r.zw;
}

// GGX with a cheap visibility term, times n.l, without Fresnel.
float glint(float n_dot_l, float n_dot_v, float n_dot_h, float roughness) {
  float a2 = roughness * roughness;
  a2 = max(a2 * a2, 2e-5);
  float d = n_dot_h * n_dot_h * (a2 - 1.0) + 1.0;
  float k = roughness * roughness * 0.5;
  float visible = 0.25 / ((n_dot_l * (1.0 - k) + k) * (n_dot_v * (1.0 - k) + k));
  return min(a2 / (kPi * d * d) * visible * n_dot_l, 60.0);
}

float schlick(float f0, float cosine) {
  float x = 1.0 - cosine;
  float x2 = x * x;
  return f0 + (1.0 - f0) * x2 * x2 * x;
}
