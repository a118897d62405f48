// Bodies. A pixel has SIDE x SIDE samples; it is shaded once, or twice where its samples see two surfaces: those like
// the first that sees one, and the rest. Blended over the floor by the share of samples that see a body.
#include "common/shade.glsl"
#include "common/tone.glsl"
layout(location = 0) out vec4 colour;

void main() {
  vec2 pixel = gl_FragCoord.xy;
  ivec2 first = ivec2(pixel) * SIDE;
  vec3 ray = ray_at(pixel);
  float drop = ground_place.x - eye_exposure.y;
  float behind = ground_place.w * ray.y * drop > 0.0 ? drop / ray.y * 1.001 : 1e9;
  uvec4 seen = uvec4(0u), other_seen = uvec4(0u);
  float depth = 1.0, other_depth = 1.0, z = 1.0, own = 0.0, others = 0.0;
  vec2 place = pixel, other_place = pixel;
  vec3 n = vec3(0.0);
  for (int i = 0; i < SIDE * SIDE; ++i) {
    ivec2 shift = ivec2(i % SIDE, i / SIDE);
    float d = texelFetch(seen_depth, first + shift, 0).x;
    uvec4 s = texelFetch(seen_map, first + shift, 0);
    float here = view_depth_of(d);
    vec3 normal = unpack_normal(s.x);
    vec2 at = floor(pixel) + (vec2(shift) + 0.5) / float(SIDE);
    bool is_body = d < 1.0 && here < behind;
    bool alike = own == 0.0 || (s.y == seen.y && abs(here - z) < 0.02 * z && dot(normal, n) > 0.9);
    bool is_own = is_body && alike, is_other = is_body && !alike;
    bool is_first = is_own && own == 0.0;
    seen = is_first ? s : seen;
    depth = is_first ? d : depth;
    place = is_first ? at : place;
    z = is_first ? here : z;
    n = is_first ? normal : n;
    other_seen = is_other ? s : other_seen;
    other_depth = is_other ? d : other_depth;
    other_place = is_other ? at : other_place;
    own += is_own ? 1.0 : 0.0;
    others += is_other ? 1.0 : 0.0;
  }
  vec3 sum = vec3(0.0);
  int turns = others > 0.0 ? 2 : 1;
  for (int turn = 0; turn < turns; ++turn) {
    Surface s = surface_at(turn == 0 ? seen : other_seen, min(turn == 0 ? depth : other_depth, 0.9999999),
                           turn == 0 ? place : other_place);
    sum += (turn == 0 ? own : others) * tone_map(shade(s, pixel));
  }
  float all = max(own + others, 1.0);
  colour = vec4(sum / all, (own + others) / float(SIDE * SIDE));
}
