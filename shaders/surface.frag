// What is seen at each sample: normal (octahedral), row of paint, place in the pattern and scalar, packed in 16 bytes.
// As little work as can be: small triangles run this for whole blocks of pixels.
// BEHIND draws, of what lies behind the faces that were drawn before, the nearest.
in vec3 normal_world;
in vec4 pattern_scalar;
flat in uint paint;
layout(location = 0) out uvec4 seen;
#ifdef BEHIND
layout(binding = 5) uniform sampler2D nearest_depth;  // 0..1, of the faces
const float kSame = 1e-6;  // what this program and the one that drew those may round apart
#endif
void main() {
#ifdef BEHIND
  if (gl_FragCoord.z <= texelFetch(nearest_depth, ivec2(gl_FragCoord.xy), 0).r + kSame) discard;
#endif
  vec3 n = normal_world / (abs(normal_world.x) + abs(normal_world.y) + abs(normal_world.z) + 1e-9);
  vec2 folded = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  seen = uvec4(packSnorm2x16(n.z < 0.0 ? folded : n.xy), paint, packHalf2x16(pattern_scalar.xy),
               packHalf2x16(pattern_scalar.zw));
}
