// Sun, sky, soft boxes: analytic, world space, linear. Reflection is GGX; [KarisUE4]'s fit stands for its integral.
#include "common/frame.glsl"

// Radiance of the surroundings from direction d, blurred as a surface of that roughness sees it: a studio, whose walls are
// dark and whose ceiling is bright. Metal is known by such contrasts, and looks like paper where all around is alike.
vec3 surroundings(vec3 d, float roughness) {
  float soft = 0.05 + 0.9 * roughness;
  vec3 sky = sky_radiance.rgb * mix(0.16, 0.95, smoothstep(0.1 - soft, 0.85 + soft, d.y));
  vec3 light = mix(ground_radiance.rgb, sky, smoothstep(-soft, soft, d.y));
  float edge = 0.05 + 1.4 * roughness * roughness + 0.25 * roughness;
  for (int i = 0; i < 2; ++i) {
    float towards = dot(d, box_axis[i].xyz);
    vec2 p = abs(vec2(dot(d, box_right[i].xyz), dot(d, box_up[i].xyz))) / max(towards, 0.02);
    vec2 half_size = vec2(box_right[i].w, box_up[i].w);
    vec2 inside = 1.0 - smoothstep(half_size - edge * 0.5, half_size + edge, p);
    float thinned = half_size.x * half_size.y / ((half_size.x + 0.3 * edge) * (half_size.y + 0.3 * edge));
    vec2 q = p / (half_size + edge);
    float paler = 1.0 - 0.45 * min(dot(q, q), 1.6);  // towards its rim
    light += sky_radiance.w * box_axis[i].w * thinned * paler * inside.x * inside.y * step(0.0, towards);
  }
  return light;
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
