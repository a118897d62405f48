// Arrays of numbers in one compressed file that numpy reads: np.load(file)["name"].
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "render/output/status.h"

namespace shatterbox::render {

struct NpzArray {
  std::string name;
  std::string type;  // numpy's: "<f4", "<f8", "<u4"
  std::vector<int> shape;
  std::string bytes;  // rows first
};

// An array of the bytes of `values`; its type must fit them.
template <class Value>
NpzArray make_array(std::string name, std::string type, std::vector<int> shape,
                    std::span<const Value> values) {
  const auto bytes = std::as_bytes(values);
  return {std::move(name), std::move(type), std::move(shape),
          std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size())};
}

// Writes it beside its name and renames it.
Status write_npz(const std::filesystem::path& path, std::span<const NpzArray> arrays);

}  // namespace shatterbox::render
