// The same over each tile's eight neighbours too: as far as a disc of taps may reach.
layout(binding = 0) uniform sampler2D tile_bounds;
layout(binding = 1) uniform sampler2D tile_casters;
layout(location = 0) out vec2 bounds;
layout(location = 1) out vec2 casters;
void main() {
  ivec2 last = textureSize(tile_bounds, 0) - 1;
  ivec2 here = ivec2(gl_FragCoord.xy);
  bounds = vec2(1.0, 0.0);
  casters = vec2(0.0);
  for (int i = 0; i < 9; ++i) {
    ivec2 shift = ivec2(i % 3, i / 3) - 1;
    ivec2 at = clamp(here + shift, ivec2(0), last);
    vec2 b = texelFetch(tile_bounds, at, 0).xy;
    bounds = vec2(min(bounds.x, b.x), max(bounds.y, b.y));
    float weight = (shift.x == 0 ? 2.0 : 1.0) * (shift.y == 0 ? 2.0 : 1.0);
    casters += weight / 16.0 * texelFetch(tile_casters, at, 0).xy;
  }
}
