// Each tile's least and greatest depth, and the mean of what was drawn there.
layout(binding = 0) uniform sampler2D depth_map;  // 0..1, 1 where nothing is
layout(location = 0) out vec2 bounds;             // least, greatest
layout(location = 1) out vec2 casters;            // depth times cover, cover
void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * SHADOW_TILE;
  float least = 1.0, greatest = 0.0;
  vec2 sum = vec2(0.0);
  vec2 texel = 1.0 / vec2(textureSize(depth_map, 0));
  for (int y = 1; y < SHADOW_TILE; y += 2) {
    for (int x = 1; x < SHADOW_TILE; x += 2) {  // four texels about a corner at once
      vec4 d = textureGather(depth_map, vec2(first + ivec2(x, y)) * texel);
      vec2 low = min(d.xy, d.zw), high = max(d.xy, d.zw);
      least = min(least, min(low.x, low.y));
      greatest = max(greatest, max(high.x, high.y));
      vec4 is_there = vec4(lessThan(d, vec4(1.0)));
      sum += vec2(dot(d, is_there), dot(is_there, vec4(1.0)));
    }
  }
  bounds = vec2(least, greatest);
  casters = sum / float(SHADOW_TILE * SHADOW_TILE);
}
