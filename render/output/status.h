// The result of something that can fail for reasons outside the program: ok, or a sentence.
#pragma once
#include <string>

namespace shatterbox::render {

struct [[nodiscard]] Status {
  std::string error;  // empty: fine
  bool ok() const { return error.empty(); }
  explicit operator bool() const { return ok(); }
};

}  // namespace shatterbox::render
