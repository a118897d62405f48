// Compression as in zip files and PNGs (RFC 1951). For npz_file.cpp.
#pragma once
#include <string>

namespace shatterbox::render {

std::string deflate(const std::string& bytes);

}  // namespace shatterbox::render
