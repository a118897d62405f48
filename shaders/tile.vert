// Rectangles of the picture, in pixels from below, at a depth chosen for the test against cover.frag. IF_DIMMED: only
// those whose first square of 16 x 16 pixels has occlusion; the others vanish.
#include "common/frame.glsl"
layout(std430, binding = 2) readonly buffer Tiles { uvec4 tiles[]; };  // left, bottom, right, top
layout(location = 0) uniform int first_tile;
layout(location = 1) uniform float tile_depth;
#ifdef IF_DIMMED
layout(binding = 9) uniform sampler2D sky_tiles;
#endif
void main() {
  uvec4 t = tiles[first_tile + gl_InstanceID];
#ifdef IF_DIMMED
  if (texelFetch(sky_tiles, ivec2(t.xy) / 16, 0).x > 0.994) t = uvec4(0u);
#endif
  vec2 p = vec2((gl_VertexID & 1) == 0 ? t.x : t.z, (gl_VertexID & 2) == 0 ? t.y : t.w);
  gl_Position = vec4(p * viewport.zw * 2.0 - 1.0, 2.0 * tile_depth - 1.0, 1.0);
}
