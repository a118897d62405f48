// Who makes the GL contexts of this process: OSMesa, or EGL without a surface. Both are Mesa's llvmpipe and
// draw the same bits.
#pragma once
#include <cstdint>
#include <string>

namespace shatterbox::render {

enum class BackEnd : std::uint8_t {
  usual,  // OSMesa where this program was built with it, else EGL
  osmesa,
  egl,
};

// Why this program has no such back-end, and how to mend it; empty if it has.
std::string back_end_fault(BackEnd back_end);

}  // namespace shatterbox::render
