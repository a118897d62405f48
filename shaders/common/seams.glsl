// Where two bodies meet in one plane, as bricks do, or two pieces along a crack that has hardly opened, there is a joint
// narrower than a sample: a line of shade, one sample wide.
#include "common/specks.glsl"
const float kShade = 0.3;
const float kJoint = 0.03;  // m: of wider samples a joint, with what is worn off and lies in it, is but a part

float joint_light(float z) { return 1.0 - kShade * min(1.0, kJoint / sample_width_at(z)); }

// Between a sample and those to the right of it and above.
float seam_light(ivec2 at) {
  vec2 size = vec2(textureSize(seen_map, 0));
  uvec4 paints = textureGather(seen_map, vec2(at + 1) / size, 1);  // above, across, aside, at
  int ways = !is_crack(paints.w) && (paints.x != paints.w || paints.z != paints.w) ? 2 : 0;
  float light = 1.0;
  for (int i = 0; i < ways; ++i) {
    ivec2 next = at + ivec2(1 - i, i);
    uvec4 here = texelFetch(seen_map, at, 0), there = texelFetch(seen_map, next, 0);
    float depth = texelFetch(seen_depth, at, 0).x, depth_there = texelFetch(seen_depth, next, 0).x;
    float near = view_depth_of(depth), far = view_depth_of(depth_there);
    vec3 n = unpack_normal(here.x);
    vec3 way = ray_at((vec2(next) + 0.5) / float(SIDE)) * far - ray_at((vec2(at) + 0.5) / float(SIDE)) * near;
    // Where no body is seen, nothing is said of paint.
    bool is_other = max(depth, depth_there) < 1.0 && there.y != here.y && !is_crack(there.y);
    bool is_seam = is_other && dot(n, unpack_normal(there.x)) > 0.97 && abs(dot(n, way)) < 0.5 * sample_width_at(near);
    light = is_seam ? joint_light(near) : light;
  }
  return light;
}

// Of a speck at a sample, for which a place beside it is seen: of a crack within one body nothing is to be told.
float speck_light(ivec2 at, ivec2 place) {
  float light = 1.0;
  int looks = place != at ? 1 : 0;
  for (int i = 0; i < looks; ++i)
    light = texelFetch(seen_map, place, 0).y == texelFetch(seen_map, 2 * at - place, 0).y
                ? 1.0
                : joint_light(view_depth_of(texelFetch(seen_depth, place, 0).x));
  return light;
}
