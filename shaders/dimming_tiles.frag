// What each 16 x 16 pixels of floor need, and a little around them: 0 nothing, 1 dimming that changes slowly, 2 a shadow's
// edge.
layout(binding = 10) uniform usampler2D dimming_map;
layout(location = 0) out uint need;
void main() {
  vec2 first = floor(gl_FragCoord.xy) * 8.0;
  vec2 texel = 1.0 / vec2(textureSize(dimming_map, 0));
  uvec4 least_sun = uvec4(255u), most_sun = uvec4(0u), least_sky = uvec4(255u);
  for (int y = 0; y < 10; y += 2) {
    for (int x = 0; x < 10; x += 2) {
      uvec4 words = textureGather(dimming_map, (first + vec2(x, y)) * texel);
      uvec4 suns = words >> 8;
      least_sun = min(least_sun, suns);
      most_sun = max(most_sun, suns);
      least_sky = min(least_sky, words & 255u);
    }
  }
  uvec2 a = min(least_sun.xy, least_sun.zw), b = max(most_sun.xy, most_sun.zw), c = min(least_sky.xy, least_sky.zw);
  uint low = min(a.x, a.y), high = max(b.x, b.y);
  need = low < high ? 2u : low < 255u || min(c.x, c.y) < 254u ? 1u : 0u;
}
