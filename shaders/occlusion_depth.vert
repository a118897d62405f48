// Depth only, from the camera, at half size. position: body space, m.
#include "common/frame.glsl"
struct DrawRow {
  mat4 world_from_body;
  uvec4 looks_scalars;
};
layout(std430, binding = 0) readonly buffer Draws { DrawRow draws[]; };
layout(location = 0) in vec3 position;
layout(location = 0) uniform int draw;
void main() { gl_Position = clip_from_world * (draws[draw].world_from_body * vec4(position, 1.0)); }
