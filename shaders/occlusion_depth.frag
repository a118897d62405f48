// View depth (m) of every OCCLUSION_SCALE-th pixel, bodies and floor, for the occlusion's samples.
#include "common/paint.glsl"
#include "common/floor.glsl"
layout(location = 0) out float view_depth;
void main() {
  vec2 pixel = gl_FragCoord.xy * float(OCCLUSION_SCALE);
  ivec2 at = min(ivec2(pixel) * SIDE, textureSize(seen_depth, 0) - 1);
  float depth = texelFetch(seen_depth, at, 0).x;
  float behind = min(floor_depth(ray_at(pixel)), 1e6);
  view_depth = depth < 1.0 ? min(view_depth_of(depth), behind) : behind;
}
