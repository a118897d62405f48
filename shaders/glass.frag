// One layer of thin glass over what is drawn: mirrored light is added, what is behind is tinted (dual-source
// blending). Crack rims scatter: milky. Samples that see no glass, or glass behind a body, keep what is there.
#include "common/shade.glsl"
#include "common/tone.glsl"
layout(binding = 7) uniform sampler2D opaque_depth;  // 0..1
layout(binding = 8) uniform sampler2D near_depth;    // of the layer in front; only for the far one
layout(location = 0, index = 0) out vec4 added;
layout(location = 0, index = 1) out vec4 kept;

void main() {
  vec2 pixel = gl_FragCoord.xy;
  ivec2 first = ivec2(pixel) * SIDE;
  uvec4 seen = uvec4(0u), other_seen = uvec4(0u);
  float depth = 1.0, other_depth = 1.0, own = 0.0, others = 0.0;
  vec2 place = pixel, other_place = pixel;
  for (int i = 0; i < SIDE * SIDE; ++i) {
    ivec2 shift = ivec2(i % SIDE, i / SIDE);
    float d = texelFetch(seen_depth, first + shift, 0).x;
    uvec4 s = texelFetch(seen_map, first + shift, 0);
    bool is_seen = d > 0.0 && d < texelFetch(opaque_depth, first + shift, 0).x;
#ifdef FAR_LAYER
    is_seen = is_seen && d > texelFetch(near_depth, first + shift, 0).x + 1e-6;
#endif
    vec2 at = floor(pixel) + (vec2(shift) + 0.5) / float(SIDE);
    bool is_first = is_seen && (own == 0.0 || s.y == seen.y);
    bool is_other = is_seen && !is_first;
    if (is_first) { seen = s; depth = d; place = at; own += 1.0 / float(SIDE * SIDE); }
    if (is_other) { other_seen = s; other_depth = d; other_place = at; others += 1.0 / float(SIDE * SIDE); }
  }
  vec3 add = vec3(0.0), keep = vec3(1.0 - own - others);
  int turns = others > 0.0 ? 2 : own > 0.0 ? 1 : 0;
  for (int turn = 0; turn < turns; ++turn) {
    float weight = turn == 0 ? own : others;
    Surface s = surface_at(turn == 0 ? seen : other_seen, turn == 0 ? depth : other_depth,
                           turn == 0 ? place : other_place);
    float n_dot_v = max(dot(s.normal, normalize(eye_exposure.xyz - s.position)), 0.05);
    float mirror = 2.0 * schlick(0.04, n_dot_v);
    mirror = mirror / (1.0 + 0.5 * mirror);
    s.roughness = s.transmission > 0.9 ? 0.03 : s.roughness;
    add += weight * tone_map(shade(s, pixel, 1.0 - s.transmission));
    keep += weight * s.transmission * (1.0 - mirror) * pow(s.colour, vec3(0.5 + 0.5 / n_dot_v));
  }
  added = vec4(add, 1.0);
  kept = vec4(keep, 1.0);
}
