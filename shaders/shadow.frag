// Glass casts a thin shadow: one texel in four of each square, which the disc of taps blends.
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  if ((p.x & 1) != 0 || (p.y & 1) != ((p.x >> 1) & 1)) discard;
}
