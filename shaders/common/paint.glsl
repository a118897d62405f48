// From the geometry pass's samples to surfaces with paint on them.
#include "common/frame.glsl"
#ifndef PATTERNS
#define PATTERNS 0
#endif
layout(binding = 4) uniform usampler2D seen_map;    // as surface.frag packs it
layout(binding = 5) uniform sampler2D seen_depth;   // 0..1, 1 where nothing is
layout(binding = 6) uniform sampler2D paint_table;  // four texels a row, 256 rows abreast

struct Surface {
  vec3 position, normal;  // world, m
  float view_depth;       // m
  vec3 colour;
  float roughness, metalness, coat, coat_roughness, transmission;
};

float view_depth_of(float depth) { return occlusion_scale.y / (occlusion_scale.z - depth); }

// World-space step for one metre of view depth at a place of the picture (pixels from below).
vec3 ray_at(vec2 pixel) {
  vec2 s = pixel * viewport.zw * 2.0 - 1.0;
  return view_forward.xyz + s.x * view_right.xyz + s.y * view_up.xyz;
}

vec3 unpack_normal(uint word) {
  vec2 e = unpackSnorm2x16(word);
  vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
  float t = max(-n.z, 0.0);
  n.xy -= vec2(n.x < 0.0 ? -t : t, n.y < 0.0 ? -t : t);
  return normalize(n);
}

bool is_crack(uint paint) { return (paint >> 31) != 0u; }

float covered(float d, float width) { return clamp(0.5 - d / width, 0.0, 1.0); }

float cell_noise(vec3 cell) {
  uvec3 c = uvec3(ivec3(cell)) * uvec3(1597334673u, 3812015801u, 2798796415u);
  uint h = (c.x ^ c.y ^ c.z) * 1597334673u;
  h ^= h >> 15;
  h *= 2246822519u;
  return float(h >> 8) * (1.0 / 16777216.0);
}

#if PATTERNS & 240
// Smooth, 0 to 1, a grain about 1 across.
float grains(vec3 p) {
  vec3 cell = floor(p), f = p - cell;
  vec3 w = f * f * (3.0 - 2.0 * f);
  vec4 near = vec4(cell_noise(cell), cell_noise(cell + vec3(1, 0, 0)), cell_noise(cell + vec3(0, 1, 0)),
                   cell_noise(cell + vec3(1, 1, 0)));
  vec4 far = vec4(cell_noise(cell + vec3(0, 0, 1)), cell_noise(cell + vec3(1, 0, 1)), cell_noise(cell + vec3(0, 1, 1)),
                  cell_noise(cell + vec3(1, 1, 1)));
  vec4 c = mix(near, far, w.z);
  vec2 d = mix(c.xy, c.zw, w.y);
  return mix(d.x, d.y, w.x);
}
#endif

// The share of the pattern's colour; p in pattern sizes, width of a pixel there.
float pattern_share(int kind, vec3 p, float width) {
#if PATTERNS & 2
  if (kind == 1) {  // rings and diamonds
    float y = abs(p.y);
    float ring = abs(y - 0.42) - 0.06;
    float around = atan(p.z, p.x) * (24.0 / (2.0 * kPi));
    float diamond = abs(fract(around) - 0.5) * 0.55 + y - 0.21;
    return max(covered(ring, width), covered(diamond, width));
  }
#endif
#if PATTERNS & 4
  if (kind == 2) {  // speckle
    vec3 cell = floor(p);
    float size = cell_noise(cell + 17.0);
    vec3 shift = vec3(cell_noise(cell), cell_noise(cell + 5.0), size) - 0.5;
    return 0.85 * covered(length(fract(p) - 0.5 - 0.4 * shift) - 0.32 * size, max(width, 0.02));
  }
#endif
#if PATTERNS & 16
  if (kind == 4) {  // clouds; grains finer than a pixel become their mean
    vec3 shown = clamp(vec3(1.5, 1.5, 1.5) - 1.5 * width * vec3(1.0, 4.3, 17.0), 0.0, 1.0);
    // Grains lie askew: cells along the faces of a block would be seen as squares.
    const mat3 askew = mat3(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);
    const mat3 athwart = mat3(0.49, -0.73, 0.48, 0.48, 0.68, 0.56, -0.73, -0.05, 0.68);
    vec3 n = vec3(grains(askew * p), grains(p * askew * 4.3 + 7.0), grains(athwart * p * 17.0 + 3.0)) - 0.5;
    return smoothstep(-0.24, 0.24, dot(n, shown * vec3(0.46, 0.38, 0.2)));
  }
#endif
#if PATTERNS & 224
  if (kind >= 5 && kind <= 7) {  // wood along x, y or z: of rings about a heart far off, askew to the sides, and fibres
    p = kind == 5 ? p : kind == 6 ? p.yzx : p.zxy;
    float sway = grains(vec3(0.06 * p.x, 0.35 * p.yz)) + 0.3 * grains(vec3(0.3 * p.x, 1.1 * p.yz + 9.0));
    float ring = fract(length(p.yz - vec2(97.3, 131.9)) + 1.1 * sway);
    float late = smoothstep(0.25, 0.85, ring) * smoothstep(1.0, 0.93, ring);  // slowly darker, then at once pale
    float fibre = grains(vec3(0.5 * p.x, 14.0 * p.yz));
    vec3 shown = clamp(1.5 - 1.5 * width * vec3(2.0, 14.0, 0.7), 0.0, 1.0);
    return clamp(0.4 + shown.z * 0.3 * (sway - 0.65) + shown.x * 0.75 * (late - 0.4) + shown.y * 0.35 * (fibre - 0.5), 0.0, 1.0);
  }
#endif
  vec3 s = (abs(fract(p * 0.5) - 0.5) - 0.25) * 2.0;  // checker
  vec3 side = clamp(s / width + 0.5, 0.0, 1.0) * 2.0 - 1.0;
  return 0.5 + 0.5 * side.x * side.y * side.z;
}

// Blue, teal, yellow, red: rises in lightness, told apart by the colour-blind. Mirrored in render/pass/overlay.cpp.
vec3 heat_colour(float t) {
  vec3 low = mix(vec3(0.02, 0.05, 0.25), vec3(0.03, 0.36, 0.48), smoothstep(0.0, 0.35, t));
  vec3 mid = mix(low, vec3(0.88, 0.72, 0.12), smoothstep(0.3, 0.7, t));
  return mix(mid, vec3(0.75, 0.04, 0.02), smoothstep(0.68, 1.0, t));
}

// A hue of its own for each group.
vec3 group_colour(float t) {
  vec3 hue = clamp(abs(fract(t + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
  return mix(vec3(0.26), hue * hue, 0.62) * (0.55 + 0.35 * fract(t * 61.0));
}

// The surface of a sample (in samples) whose place in the picture is `pixel`.
Surface surface_at(uvec4 seen, float depth, vec2 pixel) {
  Surface s;
  s.view_depth = view_depth_of(depth);
  s.position = eye_exposure.xyz + ray_at(pixel) * s.view_depth;
  s.normal = unpack_normal(seen.x);
  ivec2 row = ivec2(int(seen.y & 255u) * 4, int(seen.y << 1 >> 9));
  vec4 paint = texelFetch(paint_table, row, 0);                    // colour, roughness
  vec4 finish = texelFetch(paint_table, row + ivec2(1, 0), 0);     // metalness, coat, its roughness, transmission
  s.colour = paint.rgb;
  s.roughness = paint.a;
  s.metalness = finish.x;
  s.coat = finish.y;
  s.coat_roughness = finish.z;
  s.transmission = finish.w;
#if PATTERNS & 1023  // bits by kind; 1024: mirrors. llvmpipe runs both sides of a branch: a program has only the kinds that the frame shows
  vec4 pattern = texelFetch(paint_table, row + ivec2(2, 0), 0);    // colour, kind + metalness / 2; 8: heat map, 9: groups
  if (pattern.a >= 1.0) {
    vec4 place = texelFetch(paint_table, row + ivec2(3, 0), 0);    // centre, size
    vec2 xy = unpackHalf2x16(seen.z), z_scalar = unpackHalf2x16(seen.w);
    vec3 v = normalize(eye_exposure.xyz - s.position);
    float width = s.view_depth * view_ray.y * 2.0 * viewport.w / place.w / max(dot(s.normal, v), 0.25);
    int kind = int(pattern.a);
#if (PATTERNS & 1023) == 256
    s.colour = heat_colour(z_scalar.y);
#else
    float share = kind >= 8 ? 0.0 : pattern_share(kind, (vec3(xy, z_scalar.x) - place.xyz) / place.w, width);
    s.colour = mix(s.colour, pattern.rgb, share);
    s.metalness = mix(s.metalness, fract(pattern.a) * 2.0, share);
#if PATTERNS & 16
    s.transmission *= kind == 4 ? 1.0 - 0.75 * share : 1.0;  // clouded ice
#endif
#if PATTERNS & 256
    s.colour = kind == 8 ? heat_colour(z_scalar.y) : s.colour;
#endif
#if PATTERNS & 512
    s.colour = kind == 9 ? group_colour(z_scalar.y) : s.colour;
#endif
#endif
  }
#endif
  return s;
}
