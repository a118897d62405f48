// Depth from the sun. position: body space, m.
#include "common/frame.glsl"
struct DrawRow {
  mat4 world_from_body;
  uvec4 rows;
};
layout(std430, binding = 0) readonly buffer Draws { DrawRow draws[]; };
layout(location = 0) in vec3 position;
layout(location = 5) in uint draw;  // the same for all of a draw; a uniform would cost llvmpipe more
void main() {
  vec3 p = (shadow_from_world * (draws[draw].world_from_body * vec4(position, 1.0))).xyz;
  gl_Position = vec4(p * 2.0 - 1.0, 1.0);
}
