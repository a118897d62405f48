// At each second pixel, the shares of sky and sun that the body or floor there sees.
#include "common/paint.glsl"
#include "common/floor.glsl"
#include "common/shadow.glsl"
#include "common/occlusion.glsl"
#include "common/dimming.glsl"
layout(location = 0) out uint dimming;
void main() {
  ivec2 at = min(ivec2(gl_FragCoord.xy) * 2, textureSize(seen_depth, 0) - 1);
  vec2 pixel = vec2(at) + 0.5;
  vec3 ray = ray_at(pixel);
  float behind = floor_depth(ray);
  float depth = texelFetch(seen_depth, at, 0).x;
  float z = view_depth_of(min(depth, 0.9999999));
  bool is_body = depth < 1.0 && z < behind * 1.001;
  vec3 normal = is_body ? unpack_normal(texelFetch(seen_map, at, 0).x) : vec3(0.0, 1.0, 0.0);
  z = is_body ? z : min(behind, 1e6);
  dimming = pack_dimming(sky_seen(pixel, z), sun_seen(eye_exposure.xyz + ray * z, normal), is_body, z);
}
