#include "render/output/npz_file.h"

#include <array>

#include "render/output/deflate.h"
#include "render/output/whole_file.h"

namespace shatterbox::render {
namespace {

void put(std::string& out, std::uint32_t number, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>((number >> (8 * i)) & 255U);
}

// CRC-32 of zip files: polynomial 0xEDB88320, bits from below.
std::uint32_t find_crc(const std::string& bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> made{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = (value >> 1U) ^ ((value & 1U) != 0 ? 0xEDB88320U : 0U);
      made[i] = value;
    }
    return made;
  }();
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : bytes) crc = (crc >> 8U) ^ table[(crc ^ static_cast<unsigned char>(c)) & 255U];
  return ~crc;
}

// The array as numpy's own file: a header of text, of a length that is whole 64s, then the numbers.
std::string make_npy(const NpzArray& array) {
  std::string shape;
  for (const int side : array.shape) shape += std::to_string(side) + ", ";
  std::string header = "{'descr': '" + array.type + "', 'fortran_order': False, 'shape': (" + shape + "), }";
  header.append(63 - (10 + header.size()) % 64, ' ');
  header += '\n';
  std::string npy = "\x93NUMPY";
  npy += '\x01';
  npy += '\0';
  put(npy, static_cast<std::uint32_t>(header.size()), 2);
  return npy + header + array.bytes;
}

struct Entry {
  std::string name;
  std::uint32_t crc = 0, packed = 0, whole = 0, offset = 0;
};

// What the local header and the directory say of a file alike; no date, so that equal contents give equal
// files.
void put_entry(std::string& out, const Entry& entry) {
  put(out, 20, 2);  // version 2.0
  put(out, 0, 2);   // flags
  put(out, 8, 2);   // deflated
  put(out, 0, 2);   // time
  put(out, 33, 2);  // 1 January 1980
  put(out, entry.crc, 4);
  put(out, entry.packed, 4);
  put(out, entry.whole, 4);
  put(out, static_cast<std::uint32_t>(entry.name.size()), 2);
  put(out, 0, 2);  // nothing more
}

std::string make_zip(std::span<const NpzArray> arrays) {
  std::string zip, directory;
  for (const NpzArray& array : arrays) {
    const std::string npy = make_npy(array), packed = deflate(npy);
    const Entry entry{array.name + ".npy", find_crc(npy), static_cast<std::uint32_t>(packed.size()),
                      static_cast<std::uint32_t>(npy.size()), static_cast<std::uint32_t>(zip.size())};
    put(zip, 0x04034b50, 4);
    put_entry(zip, entry);
    zip += entry.name + packed;
    put(directory, 0x02014b50, 4);
    put(directory, 20, 2);
    put_entry(directory, entry);
    put(directory, 0, 2);  // no comment
    put(directory, 0, 4);  // disk 0, no text
    put(directory, 0, 4);
    put(directory, entry.offset, 4);
    directory += entry.name;
  }
  const auto count = static_cast<std::uint32_t>(arrays.size());
  const auto offset = static_cast<std::uint32_t>(zip.size());
  zip += directory;
  put(zip, 0x06054b50, 4);
  put(zip, 0, 4);
  put(zip, count, 2);
  put(zip, count, 2);
  put(zip, static_cast<std::uint32_t>(directory.size()), 4);
  put(zip, offset, 4);
  put(zip, 0, 2);
  return zip;
}

}  // namespace

Status write_npz(const std::filesystem::path& path, std::span<const NpzArray> arrays) {
  return write_whole_file(path, make_zip(arrays));
}

}  // namespace shatterbox::render
