// What a world has made of its optional parts: how many, and how many bytes. What a scene does not need is
// not there: its count is zero.
#pragma once

#include <string>
#include <vector>

namespace shatterbox::world {

struct PartCount {
  std::string part;  // "shell_stiffness", ...: always all of them, in one order
  long count = 0;
  double bytes = 0.0;  // of the arrays, not of what holds them
};

}  // namespace shatterbox::world
