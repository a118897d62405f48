// What is seen at each sample: normal (octahedral), row of paint, place in the pattern and scalar, packed in 16 bytes.
// As little work as can be: small triangles run this for whole blocks of pixels.
in vec3 normal_world;
in vec4 pattern_scalar;
flat in uint paint;
layout(location = 0) out uvec4 seen;
void main() {
  vec3 n = normal_world / (abs(normal_world.x) + abs(normal_world.y) + abs(normal_world.z) + 1e-9);
  vec2 folded = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  seen = uvec4(packSnorm2x16(n.z < 0.0 ? folded : n.xy), paint, packHalf2x16(pattern_scalar.xy),
               packHalf2x16(pattern_scalar.zw));
}
