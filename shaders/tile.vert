// Rectangles of the picture, in pixels from below, at a depth chosen for the test against cover.frag. Those whose first
// square of 16 x 16 pixels does not need what the program draws vanish.
#include "common/frame.glsl"
layout(std430, binding = 2) readonly buffer Tiles { uvec4 tiles[]; };  // left, bottom, right, top
layout(location = 1) uniform float tile_depth;
#ifdef IF_OCCLUDED
layout(binding = 9) uniform sampler2D sky_tiles;
#endif
#ifdef IF_NEEDED
layout(location = 2) uniform int least_need;
layout(location = 3) uniform int most_need;
layout(binding = 12) uniform usampler2D need_map;  // as dimming_tiles.frag writes it
#endif
#ifdef FLOOR
#include "common/floor.glsl"
#include "common/paint.glsl"
noperspective out vec4 corner;
#endif
void main() {
  int vertex = gl_VertexID % 6;  // of two triangles; instances would cost llvmpipe more
  uvec4 t = tiles[gl_VertexID / 6];
#ifdef IF_OCCLUDED
  if (texelFetch(sky_tiles, ivec2(t.xy) / 16, 0).x > 0.994) t = uvec4(0u);
#endif
#ifdef IF_NEEDED
  int need = int(texelFetch(need_map, ivec2(t.xy) / 16, 0).x);
  if (need < least_need || need > most_need) t = uvec4(0u);
#endif
  bool is_left = vertex == 0 || vertex == 2 || vertex == 3, is_low = vertex < 2 || vertex == 4;
  vec2 p = vec2(is_left ? t.x : t.z, is_low ? t.y : t.w);
#ifdef FLOOR
  corner = floor_corner(p, ray_at(p));
#endif
  gl_Position = vec4(p * viewport.zw * 2.0 - 1.0, 2.0 * tile_depth - 1.0, 1.0);
}
