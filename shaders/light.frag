// Bodies. A pixel has SIDE x SIDE samples; it is shaded once, or twice where its samples see two surfaces: those like
// the first that sees one, and the rest. Blended over the floor by the share of samples that see a body, if cover.frag says
// that some do not.
#include "common/samples.glsl"
#include "common/shade.glsl"
#include "common/seams.glsl"
#include "common/tone.glsl"
layout(location = 0) out vec4 colour;

#if SIDE == 1
void main() {
  vec3 ray = ray_at(gl_FragCoord.xy);
  float drop = ground_place.x - eye_exposure.y;
  float behind = ground_place.w * ray.y * drop > 0.0 ? drop / ray.y * 1.001 : 1e9;
  ivec2 own = ivec2(gl_FragCoord.xy), at = without_speck(own);
  float depth = texelFetch(seen_depth, at, 0).x;
  Surface s = surface_at(texelFetch(seen_map, at, 0), min(depth, 0.9999999), vec2(at) + 0.5);
  if (s.view_depth >= behind) discard;
  float light = min(seam_light(own), speck_light(own, at));
  colour = vec4(tone_map(light * shade(s, gl_FragCoord.xy)), 1.0);
}
#else
void main() {
  vec2 pixel = gl_FragCoord.xy;
  ivec2 first = ivec2(pixel) * SIDE;
  vec3 ray = ray_at(pixel);
  float drop = ground_place.x - eye_exposure.y;
  float behind = ground_place.w * ray.y * drop > 0.0 ? drop / ray.y * 1.001 : 1e9;
  vec4 depths = depths_at(seen_depth, first);
  uvec4 normals = words_at(seen_map, first, 0), paints = words_at(seen_map, first, 1);
  float z = 1.0, own = 0.0, others = 0.0;
  int chosen = 0, other = 0;
  uint paint = 0u;
  vec3 n = vec3(0.0);
  for (int i = 0; i < SIDE * SIDE; ++i) {
    float here = view_depth_of(depths[i]);
    vec3 normal = unpack_normal(normals[i]);
    bool is_body = depths[i] < 1.0 && here < behind;
    bool alike = own == 0.0 || (paints[i] == paint && abs(here - z) < 0.02 * z && dot(normal, n) > 0.9);
    bool is_own = is_body && alike;
    bool is_first = is_own && own == 0.0;
    chosen = is_first ? i : chosen;
    paint = is_first ? paints[i] : paint;
    z = is_first ? here : z;
    n = is_first ? normal : n;
    other = is_body && !alike ? i : other;
    own += is_own ? 1.0 : 0.0;
    others += is_body && !alike ? 1.0 : 0.0;
  }
  if (own == 0.0) discard;
  // Of two surfaces one may be a speck.
  bool is_own_crack = is_crack(paints[chosen]);
  int lone = is_own_crack ? chosen : other;
  ivec2 lone_at = first + sample_shift(lone), seen_at = lone_at;
  int looks = others > 0.0 && is_crack(paints[lone]) && (is_own_crack ? own : others) <= 2.0 ? 1 : 0;
  for (int k = 0; k < looks; ++k) seen_at = without_speck(lone_at);
  if (seen_at != lone_at) {
    chosen = is_own_crack ? other : chosen;
    own += others;
    others = 0.0;
  }
  float light = speck_light(lone_at, seen_at);
  for (int i = 1; i < SIDE * SIDE; ++i) light = min(light, seam_light(first + ivec2(i & 1, i >> 1)));
  vec3 sum = vec3(0.0);
  int turns = others > 0.0 ? 2 : 1;
  for (int turn = 0; turn < turns; ++turn) {
    int i = turn == 0 ? chosen : other;
    ivec2 shift = sample_shift(i);
    vec2 place = floor(pixel) + (vec2(shift) + 0.5) / float(SIDE);
    float depth = texelFetch(seen_depth, first + shift, 0).x;
    Surface s = surface_at(texelFetch(seen_map, first + shift, 0), min(depth, 0.9999999), place);
    sum += (turn == 0 ? own : others) * tone_map(light * shade(s, pixel));
  }
  colour = vec4(sum / (own + others), (own + others) / float(SIDE * SIDE));
}
#endif
