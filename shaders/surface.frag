// Opaque surfaces: linear light in, display light out (the target encodes sRGB).
#include "common/look.glsl"
layout(location = 0) out vec4 colour;
void main() {
  colour = vec4(tone_map(shade(paint_here(), normalize(normal_world), 1.0)), 1.0);
}
