// A linked pair of shaders from the texts built into the binary.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "render/gpu/handle.h"

namespace shatterbox::render::gpu {

void delete_program(unsigned name);

class Program {
 public:
  Program() = default;
  // Names as in shaders/: "surface.vert"; an empty fragment name draws depth only. `defines` are lines such
  // as "TAPS 16". Throws std::runtime_error with the compiler's words.
  Program(std::string_view vertex, std::string_view fragment, const std::vector<std::string>& defines = {});
  void use() const;
  unsigned name() const { return handle_.get(); }  // 0: none
  // Uniforms of the program in use.
  static void set(int location, int value);
  static void set(int location, float value);

 private:
  Handle<delete_program> handle_;
};

}  // namespace shatterbox::render::gpu
