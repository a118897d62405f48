// Edges of triangles, drawn as lines: those that no body hides; what is behind glass is seen.
#include "common/paint.glsl"
#include "common/samples.glsl"
layout(location = 0) uniform float light;  // 0 dark, 1 light
layout(location = 0) out vec4 colour;
void main() {
  vec4 walls = depths_at(seen_depth, ivec2(gl_FragCoord.xy) * SIDE);
  float wall = max(max(walls.x, walls.y), max(walls.z, walls.w));
  // An edge is nearer to its own face than a few thousandths of its distance.
  if (wall < 1.0 && view_depth_of(gl_FragCoord.z) > 1.003 * view_depth_of(wall)) discard;
  colour = vec4(vec3(light), 0.5);
}
