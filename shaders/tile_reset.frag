// The same value all over rectangles of a whole-numbered target.
layout(location = 4) uniform int value;
layout(location = 0) out uint kept;
void main() { kept = uint(value); }
