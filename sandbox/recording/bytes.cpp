#include "sandbox/recording/bytes.h"

#include <algorithm>
#include <cmath>

namespace shatterbox::sandbox::recording {

void add_bytes(core::Hash& hash, const void* bytes, std::size_t count) {
  for (std::size_t i = 0; i < count; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, static_cast<const char*>(bytes) + i, std::min<std::size_t>(8, count - i));
    hash.add(word);
  }
}

void ByteWriter::count(std::uint64_t number) {
  for (; number >= 128; number >>= 7U) bytes_ += static_cast<char>(128U | (number & 127U));
  bytes_ += static_cast<char>(number);
}

const char* ByteReader::next(std::size_t count) {
  if (count > bytes_.size()) throw Unreadable("it ends too early");
  const char* const begin = bytes_.data();
  bytes_.remove_prefix(count);
  return begin;
}

std::uint64_t ByteReader::count() {
  std::uint64_t number = 0;
  for (unsigned shift = 0; shift < 63; shift += 7) {
    const auto byte = static_cast<std::uint8_t>(*next(1));
    number |= static_cast<std::uint64_t>(byte & 127U) << shift;
    if (byte < 128) return number;
  }
  throw Unreadable("a number without an end");
}

std::size_t ByteReader::count_of(std::size_t bytes_each) {
  const std::uint64_t number = count();
  if (number > bytes_.size() / bytes_each) throw Unreadable("it has more to tell than bytes to tell it");
  return static_cast<std::size_t>(number);
}

void ByteReader::operator()(std::string& text) {
  const std::size_t size = count_of(1);
  text.assign(next(size), size);
}

void ByteReader::check_finite(const float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    if (!std::isfinite(values[i])) throw Unreadable("a number that is not finite");
}

}  // namespace shatterbox::sandbox::recording
