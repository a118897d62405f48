// The floor where nothing darkens it and it has not begun to fade: one colour.
#include "common/tone.glsl"
layout(location = 0) out vec4 colour;
void main() { colour = vec4(tone_map(floor_sun.rgb + floor_sky.rgb), 1.0); }
