// Result<T>: a value, or a sentence that says why there is none. For bad input, never for our own faults.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace shatterbox::core {

/// Why something could not be done, in words for the person at the keyboard.
struct Error {
  std::string message;
};

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}
  Result(Error error) : value_(std::move(error)) {}

  bool ok() const { return std::holds_alternative<T>(value_); }
  explicit operator bool() const { return ok(); }

  /// The value; only when ok(): else throws std::logic_error with the reason.
  T& value() {
    if (!ok()) throw std::logic_error(error());
    return *std::get_if<T>(&value_);
  }
  const T& value() const {
    if (!ok()) throw std::logic_error(error());
    return *std::get_if<T>(&value_);
  }
  /// The reason; only when not ok().
  const std::string& error() const { return std::get<Error>(value_).message; }

 private:
  std::variant<T, Error> value_;
};

}  // namespace shatterbox::core
