// Rectangles of the picture, in pixels from below, at a depth chosen for the test against cover.frag.
#include "common/frame.glsl"
layout(std430, binding = 2) readonly buffer Tiles { uvec4 tiles[]; };  // left, bottom, right, top
layout(location = 0) uniform int first_tile;
layout(location = 1) uniform float tile_depth;
void main() {
  uvec4 t = tiles[first_tile + gl_InstanceID];
  vec2 p = vec2((gl_VertexID & 1) == 0 ? t.x : t.z, (gl_VertexID & 2) == 0 ? t.y : t.w);
  gl_Position = vec4(p * viewport.zw * 2.0 - 1.0, 2.0 * tile_depth - 1.0, 1.0);
}
