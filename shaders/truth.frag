// World normal (unit) and distance along the camera's axis (m) in one target, the id in another.
in vec3 normal_world;
in float along_axis;
flat in uint id;
layout(location = 0) out vec4 normal_depth;
layout(location = 1) out uint seen;
void main() {
  normal_depth = vec4(normalize(normal_world), along_axis);
  seen = id;
}
