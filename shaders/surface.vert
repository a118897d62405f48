// Body space in (m), world space out. The look is chosen here, once a vertex, and handed on flat.
#include "common/frame.glsl"
struct DrawRow {
  mat4 world_from_body;
  uvec4 looks_scalars;  // first look, number of looks, first scalar (all ones: none), colour index + 1 (0: none)
};
struct LookRow {
  vec4 outside, inside, crack;  // colour, roughness
  vec4 finish;                  // metalness, inside metalness, clear coat, its roughness
  vec4 pattern;                 // colour, metalness
  vec4 pattern_place;           // centre, size
  vec4 more;                    // transmission, pattern kind
};
layout(std430, binding = 0) readonly buffer Draws { DrawRow draws[]; };
layout(std430, binding = 1) readonly buffer Looks { LookRow looks[]; };
layout(std430, binding = 2) readonly buffer Scalars { float scalars[]; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 pattern;
layout(location = 3) in uint source;     // vertex of the mesh as given
layout(location = 4) in uint face_part;  // 0 outside, 1 inside, 2 crack; part in bits 8-15
layout(location = 0) uniform int draw;

out vec3 position_world;
out vec3 normal_world;
out vec3 pattern_place;
out float scalar;
flat out vec4 paint;
flat out vec4 finish;
flat out vec4 pattern_paint;
flat out ivec2 pattern_overlay;

// A colour of its own for each piece: hues by the golden ratio, two lightnesses.
vec3 piece_colour(uint index) {
  float hue = fract(float(index) * 0.61803399);
  vec3 c = clamp(abs(fract(hue + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
  return mix(vec3(0.32), c * c, 0.62) * ((index & 1u) == 0u ? 0.95 : 0.62);
}

void main() {
  DrawRow row = draws[draw];
  vec4 p = row.world_from_body * vec4(position, 1.0);
  position_world = p.xyz;
  normal_world = mat3(row.world_from_body) * normal;
  gl_Position = clip_from_world * p;

  uint face = face_part & 255u;
  LookRow look = looks[row.looks_scalars.x + min(face_part >> 8, row.looks_scalars.y - 1u)];
  paint = face == 0u ? look.outside : face == 1u ? look.inside : look.crack;
  float metalness = face == 0u ? look.finish.x : face == 1u ? look.finish.y : 0.0;
  float coat = face == 0u ? look.finish.z : face == 1u ? 0.5 * look.finish.z : 0.0;
  finish = vec4(metalness, coat, look.finish.w, look.more.x);
  pattern_paint = look.pattern;
  pattern_place = (pattern - look.pattern_place.xyz) / look.pattern_place.w;
  pattern_overlay = ivec2(face == 0u ? int(look.more.y) : 0, 0);
  scalar = 0.0;
  if (scalar_range.z == 1.0 && row.looks_scalars.z != 0xffffffffu) {
    scalar = scalars[row.looks_scalars.z + source];
    if (face != 2u) pattern_overlay = ivec2(0, 1);
  }
  if (scalar_range.z == 2.0 && row.looks_scalars.w != 0u) {
    vec3 own = piece_colour(row.looks_scalars.w - 1u);
    paint = vec4(face == 2u ? mix(own, vec3(0.9), 0.7) : own, 0.5);
    finish = vec4(0.0, 0.5 * finish.y, max(finish.z, 0.1), 0.0);
    pattern_overlay.x = 0;
  }
}
