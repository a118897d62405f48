// The paint at a point and its light: shared by the opaque and the glass pass.
#include "common/frame.glsl"
#include "common/light.glsl"
#include "common/shadow.glsl"
#include "common/occlusion.glsl"
#include "common/tone.glsl"

in vec3 position_world;
in vec3 normal_world;
in vec3 pattern_place;             // pattern space over pattern size, about its centre
in float scalar;                   // in the overlay's unit
flat in vec4 paint;                // colour, roughness
flat in vec4 finish;               // metalness, clear coat, its roughness, transmission
flat in vec4 pattern_paint;        // colour, metalness
flat in ivec2 pattern_overlay;     // pattern kind; 1 if the heat map is shown here

struct Paint {
  vec3 colour;
  float roughness, metalness, coat, coat_roughness;
};

// 1 inside where d < 0, one pixel soft.
float covered(float d) {
  float w = max(fwidth(d), 1e-5);
  return clamp(0.5 - d / w, 0.0, 1.0);
}

float cell_noise(vec3 cell) {
  uvec3 c = uvec3(ivec3(cell)) * uvec3(1597334673u, 3812015801u, 2798796415u);
  uint h = (c.x ^ c.y ^ c.z) * 1597334673u;
  h ^= h >> 15;
  h *= 2246822519u;
  return float(h >> 8) * (1.0 / 16777216.0);
}

// The share of the pattern's colour.
float pattern_share(int kind, vec3 p) {
  if (kind == 1) {  // rings and diamonds
    float y = abs(p.y);
    float ring = abs(y - 0.42) - 0.06;
    float around = atan(p.z, p.x) * 24.0 / (2.0 * kPi);
    float diamond = abs(fract(around) - 0.5) * 0.55 + y - 0.21;
    float seam = smoothstep(0.2, 0.4, abs(fract(around + 0.5) - 0.5));
    return max(covered(ring), covered(diamond) * (1.0 - 0.0 * seam));
  }
  if (kind == 2) {  // speckle
    vec3 cell = floor(p);
    vec3 at = fract(p) - 0.5;
    float r = 0.32 * cell_noise(cell + 17.0);
    vec3 shift = vec3(cell_noise(cell), cell_noise(cell + 5.0), cell_noise(cell + 9.0)) - 0.5;
    return 0.85 * covered(length(at - 0.4 * shift) - r);
  }
  vec3 s = abs(fract(p * 0.5) - 0.5) - 0.25;  // checker
  vec3 w = max(fwidth(p) * 0.5, vec3(1e-5));
  vec3 side = clamp(s / w + 0.5, 0.0, 1.0) * 2.0 - 1.0;
  return 0.5 + 0.5 * side.x * side.y * side.z;
}

// Blue, teal, yellow, red: rises in lightness, told apart by the colour-blind. Mirrored in render/pass/overlay.cpp.
vec3 heat_colour(float t) {
  t = clamp(t, 0.0, 1.0);
  vec3 low = mix(vec3(0.02, 0.05, 0.25), vec3(0.03, 0.36, 0.48), smoothstep(0.0, 0.35, t));
  vec3 mid = mix(low, vec3(0.88, 0.72, 0.12), smoothstep(0.3, 0.7, t));
  return mix(mid, vec3(0.75, 0.04, 0.02), smoothstep(0.68, 1.0, t));
}

Paint paint_here() {
  Paint p = Paint(paint.rgb, paint.a, finish.x, finish.y, finish.z);
  if (pattern_overlay.x != 0) {
    float share = pattern_share(pattern_overlay.x, pattern_place);
    p.colour = mix(p.colour, pattern_paint.rgb, share);
    p.metalness = mix(p.metalness, pattern_paint.a, share);
  }
  if (pattern_overlay.y != 0) {
    p.colour = heat_colour((scalar - scalar_range.x) * scalar_range.y);
    p.roughness = 0.5;
    p.metalness = 0.0;
    p.coat *= 0.4;
  }
  return p;
}

// Light towards the eye. `through` scales what is diffuse (glass has little).
vec3 shade(Paint p, vec3 n, float diffuse_share) {
  vec3 to_eye = eye_exposure.xyz - position_world;
  vec3 v = normalize(to_eye);
  float n_dot_v = max(dot(n, v), 1e-3);
  vec3 l = sun.xyz;
  float n_dot_l = max(dot(n, l), 0.0);
  vec3 h = normalize(l + v);
  float n_dot_h = max(dot(n, h), 0.0);
  float v_dot_h = max(dot(v, h), 0.0);
  vec3 r = 2.0 * dot(n, v) * n - v;
  r.y = max(r.y, -0.98);

  vec3 sunlight = sun_radiance.rgb * (n_dot_l > 0.0 ? sun_seen(position_world, n) : 0.0);
  float sky = sky_seen(gl_FragCoord.xy, 1.0 / gl_FragCoord.w);
  float sky_mirrored = clamp(sky * 1.35 - 0.2, 0.08, 1.0);

  vec3 f0 = mix(vec3(0.04), p.colour, p.metalness);
  vec3 diffuse = p.colour * (1.0 - p.metalness) * diffuse_share;
  vec2 share = reflected_share(n_dot_v, p.roughness);
  vec3 mirrored = f0 * share.x + share.y;

  // Light that bounced off this surface's own hollow: occlusion is tinted by the paint instead of grey.
  vec3 sky_tinted = sky / (1.0 - 0.6 * p.colour * (1.0 - sky));
  vec3 light = diffuse * (sunlight * n_dot_l + ambient(n) * sky_tinted * (1.0 - share.y));
  light += mirrored * surroundings(r, p.roughness) * sky_mirrored;
  light += sunlight * glint(n_dot_l, n_dot_v, n_dot_h, p.roughness) * (f0 + (1.0 - f0) * schlick(0.0, v_dot_h));

  float coat = p.coat * schlick(0.05, n_dot_v);
  light *= 1.0 - coat;
  light += coat * surroundings(r, p.coat_roughness) * sky_mirrored;
  light += sunlight * p.coat * schlick(0.05, v_dot_h) * glint(n_dot_l, n_dot_v, n_dot_h, p.coat_roughness);
  return light;
}
