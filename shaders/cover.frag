// Whether none (0), all (0.5) or some (1) of each pixel's samples see a body, written as depth: the light passes skip blocks
// of pixels by it.
#include "common/paint.glsl"
#include "common/samples.glsl"
void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * SIDE;
  vec3 ray = ray_at(gl_FragCoord.xy);
  float drop = ground_place.x - eye_exposure.y;
  float behind = ground_place.w * ray.y * drop > 0.0 ? drop / ray.y * 1.001 : 1e9;
  float sum = 0.0;
  vec4 depths = depths_at(seen_depth, first);
  for (int i = 0; i < SIDE * SIDE; ++i) {
    float depth = depths[i];
    sum += depth < 1.0 && view_depth_of(depth) < behind ? 1.0 / float(SIDE * SIDE) : 0.0;
  }
  gl_FragDepth = sum == 0.0 ? 0.0 : sum == 1.0 ? 0.5 : 1.0;
}
