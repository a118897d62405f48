#include "sandbox/report/text_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

namespace shatterbox::sandbox::report {

std::string write_text(const std::string& path, const std::string& text) {
  const std::string part = path + ".part";
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    return fmt::format("{} cannot be written: it is no plain file", path);
  errno = 0;
  {
    std::ofstream stream(part, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream) return fmt::format("{} cannot be written: {}", path, std::strerror(errno));
  }
  std::error_code code;
  std::filesystem::rename(part, path, code);
  if (code) return fmt::format("{} cannot be written: {}", path, code.message());
  return {};
}

std::string read_text(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace shatterbox::sandbox::report
