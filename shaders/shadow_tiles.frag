// Each tile's least and greatest depth, and the mean of what was drawn there.
layout(binding = 0) uniform sampler2D depth_map;  // 0..1, 1 where nothing is
layout(location = 0) out vec2 bounds;             // least, greatest
layout(location = 1) out vec2 casters;            // depth times cover, cover
void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * SHADOW_TILE;
  float least = 1.0, greatest = 0.0;
  vec2 sum = vec2(0.0);
  for (int y = 0; y < SHADOW_TILE; ++y) {
    for (int x = 0; x < SHADOW_TILE; ++x) {
      float d = texelFetch(depth_map, first + ivec2(x, y), 0).x;
      least = min(least, d);
      greatest = max(greatest, d);
      sum += d < 1.0 ? vec2(d, 1.0) : vec2(0.0);
    }
  }
  bounds = vec2(least, greatest);
  casters = sum / float(SHADOW_TILE * SHADOW_TILE);
}
