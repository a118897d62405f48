// Behind everything.
#include "common/tone.glsl"
layout(location = 0) out vec4 colour;
void main() { colour = vec4(tone_map(backdrop_at(gl_FragCoord.xy)), 1.0); }
