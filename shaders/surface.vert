// Geometry: body space in (m), world normal and clip place out. Only what the light pass needs is handed on.
#include "common/frame.glsl"
struct DrawRow {
  mat4 world_from_body;
  uvec4 rows;  // first paint, number of looks, first scalar (all ones: none)
};
layout(std430, binding = 0) readonly buffer Draws { DrawRow draws[]; };
layout(std430, binding = 1) readonly buffer Scalars { float scalars[]; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 pattern;
layout(location = 3) in uint source;     // vertex of the mesh as given
layout(location = 4) in uint face_part;  // 0 outside, 1 inside, 2 crack; part in bits 8-15
layout(location = 5) in uint draw;  // the same for all of a draw; a uniform would cost llvmpipe more

out vec3 normal_world;
out vec4 pattern_scalar;  // pattern space, m; the scalar as a share of its range
flat out uint paint;      // row of the paint table; the highest bit is set on a crack's face

void main() {
  DrawRow row = draws[draw];
  gl_Position = clip_from_world * (row.world_from_body * vec4(position, 1.0));
  normal_world = mat3(row.world_from_body) * normal;
  float scalar = 0.0;
  if (row.rows.z != 0xffffffffu) {
    scalar = clamp((scalars[row.rows.z + source] - scalar_range.x) * scalar_range.y, 0.0, 1.0);
  }
  pattern_scalar = vec4(pattern, scalar);
  paint = row.rows.x + 3u * min(face_part >> 8, row.rows.y - 1u) + (face_part & 255u);
  if ((face_part & 255u) == 2u) paint |= 0x80000000u;
}
