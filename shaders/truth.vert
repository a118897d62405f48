// Geometry for numbers instead of looks: body space in (m), world normal, distance along the camera's axis (m) and id out.
#include "common/frame.glsl"
struct DrawRow {
  mat4 world_from_body;
  uvec4 rows;  // w: id
};
layout(std430, binding = 0) readonly buffer Draws { DrawRow draws[]; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 5) in uint draw;

out vec3 normal_world;
out float along_axis;
flat out uint id;

void main() {
  DrawRow row = draws[draw];
  vec4 place = row.world_from_body * vec4(position, 1.0);
  gl_Position = clip_from_world * place;
  normal_world = mat3(row.world_from_body) * normal;
  along_axis = dot(place.xyz - eye_exposure.xyz, view_forward.xyz);
  id = row.rows.w;
}
