// Owns one GL name: move-only, deleted with its context current.
#pragma once
#include <utility>

namespace shatterbox::render::gpu {

template <void (*Delete)(unsigned)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(unsigned name) : name_(name) {}
  ~Handle() { reset(); }
  Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    if (this != &other) {
      reset();
      name_ = std::exchange(other.name_, 0);
    }
    return *this;
  }
  unsigned get() const { return name_; }

 private:
  void reset() {
    if (name_ != 0) Delete(std::exchange(name_, 0));
  }
  unsigned name_ = 0;
};

}  // namespace shatterbox::render::gpu
