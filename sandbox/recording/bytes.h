// Values as bytes and back: what a recording is made of. Low bytes first, floats as IEEE 754 has them, counts
// in as few bytes as they need. Writer and reader are called alike, so that one list of fields serves both.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/core/hash.h"

namespace shatterbox::sandbox::recording {

static_assert(std::endian::native == std::endian::little, "values are copied as they lie in memory");

/// Bytes that cannot be what they should be: says why not.
struct Unreadable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Adds bytes to a hash, eight at a time.
void add_bytes(core::Hash& hash, const void* bytes, std::size_t count);

/// What is copied as it lies in memory: it has no padding.
template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_same_v<T, glm::vec3> || std::is_same_v<T, glm::uvec3>;

class ByteWriter {
 public:
  template <Plain T>
  void operator()(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void operator()(const std::string& text) {
    count(text.size());
    bytes_ += text;
  }
  /// Seven bits a byte, the low ones first.
  void count(std::uint64_t number);
  template <class Choice>
  void choice(const Choice& value, Choice /*last*/) {
    bytes_ += static_cast<char>(value);
  }
  /// Whether it is there; its contents follow if so.
  template <class T>
  void presence(const std::optional<T>& value) {
    (*this)(value.has_value());
  }
  template <Plain T>
  void array(const std::vector<T>& values) {
    count(values.size());
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }

  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Throws Unreadable where the bytes end too early, and for what is none of the values it should be; numbers
/// that are not finite are none.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <Plain T>
  void operator()(T& value) {
    std::memcpy(&value, next(sizeof value), sizeof value);
    check(&value, 1);
  }
  void operator()(bool& value) {
    std::uint8_t byte = 0;
    choice(byte, std::uint8_t{1});
    value = byte != 0;
  }
  void operator()(std::string& text);
  std::uint64_t count();
  void count(std::uint64_t& number) { number = count(); }
  /// One of those up to `last`.
  template <class Choice>
  void choice(Choice& value, Choice last) {
    const auto byte = static_cast<std::uint8_t>(*next(1));
    if (byte > static_cast<std::uint8_t>(last)) throw Unreadable("a choice that there is not");
    value = static_cast<Choice>(byte);
  }
  template <class T>
  void presence(std::optional<T>& value) {
    bool is_there = false;
    (*this)(is_there);
    if (is_there)
      value.emplace();
    else
      value.reset();
  }
  template <Plain T>
  void array(std::vector<T>& values) {
    values.resize(count_of(sizeof(T)));
    if (!values.empty())
      std::memcpy(values.data(), next(values.size() * sizeof(T)), values.size() * sizeof(T));
    check(values.data(), values.size());
  }
  /// A count of things of which each takes at least so many bytes that are still there.
  std::size_t count_of(std::size_t bytes_each);

  bool is_at_end() const { return bytes_.empty(); }

 private:
  /// The next bytes; throws if there are not so many.
  const char* next(std::size_t count);
  template <Plain T>
  static void check(const T* values, std::size_t count) {
    if constexpr (std::is_same_v<T, glm::vec3>)
      check_finite(reinterpret_cast<const float*>(values), 3 * count);
    else if constexpr (std::is_same_v<T, float>)
      check_finite(values, count);
  }
  static void check_finite(const float* values, std::size_t count);

  std::string_view bytes_;  // not read yet
};

}  // namespace shatterbox::sandbox::recording
