// A crack narrower than a sample is seen by one in many: dots and dashes along a line. Such a dot, between two samples of
// one surface and behind them, is taken for that surface: if it is alone or in a pair, or hardly behind.
#include "common/paint.glsl"

float sample_width_at(float z) { return z * view_ray.y * 2.0 / float(textureSize(seen_map, 0).y); }  // m

// Cracks among the eight about a sample that is one: those beside it count twice, two at corners three.
int cracks_about(ivec2 at, int turns) {
  vec2 texel = 1.0 / vec2(textureSize(seen_map, 0));
  uint all = 0u, corners = 0u;
  for (int i = 0; i < turns; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    uvec4 four = textureGather(seen_map, vec2(at + corner) * texel, 1) >> 31;
    all += four.x + four.y + four.z + four.w;
    corners += corner.y == 0 ? (corner.x == 0 ? four.w : four.z) : (corner.x == 0 ? four.x : four.y);
  }
  return int(all) - 4 + (corners > 1u ? 1 : 0);  // the sample itself is in all four
}

// Where to look for what is at a sample: there, or beside it. Loops, since llvmpipe skips those.
ivec2 without_speck(ivec2 at) {
  int turns = is_crack(texelFetch(seen_map, at, 0).y) ? 4 : 0;
  int cracks = cracks_about(at, turns);
  int ways = turns > 0 && cracks <= 5 ? 2 : 0;
  ivec2 place = at;
  for (int i = 0; i < ways; ++i) {
    ivec2 aside = ivec2(1 - i, i);
    uvec4 before = texelFetch(seen_map, at - aside, 0), after = texelFetch(seen_map, at + aside, 0);
    float a = view_depth_of(texelFetch(seen_depth, at - aside, 0).x);
    float b = view_depth_of(texelFetch(seen_depth, at + aside, 0).x);
    float depth = view_depth_of(texelFetch(seen_depth, at, 0).x);
    float sample_width = sample_width_at(depth);
    float behind = (depth - 0.5 * (a + b)) / sample_width;
    bool is_one = !is_crack(before.y) && !is_crack(after.y) && abs(a - b) < 20.0 * sample_width &&
                  dot(unpack_normal(before.x), unpack_normal(after.x)) > 0.9;
    place = is_one && behind > -0.2 && (cracks <= 2 || behind < 0.5) ? at - aside : place;
  }
  return place;
}
