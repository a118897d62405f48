// The floor: four corners about the target, in world space.
#include "common/frame.glsl"
out vec3 position_world;
void main() {
  vec2 corner = vec2((gl_VertexID & 1) == 0 ? -1.0 : 1.0, (gl_VertexID & 2) == 0 ? 1.0 : -1.0);
  position_world = vec3(target_distance.x, ground_place.x, target_distance.z) +
                   ground_place.z * vec3(corner.x, 0.0, corner.y);
  gl_Position = clip_from_world * vec4(position_world, 1.0);
}
