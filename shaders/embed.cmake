# Writes OUT: a table of the shader texts (FILES, comma separated, inside FOLDER) as raw string literals.
string(REPLACE "," ";" FILES "${FILES}")
set(rows "")
foreach(name ${FILES})
  file(READ "${FOLDER}/${name}" text)
  string(APPEND rows "    {\"${name}\", R\"glsl(${text})glsl\"},\n")
endforeach()
file(WRITE "${OUT}" "// Generated from shaders/ by embed.cmake.
#include \"shaders/shader_text.h\"

namespace shatterbox::shaders {
namespace {
struct Row {
  std::string_view name, text;
};
constexpr Row kRows[] = {
${rows}};
}  // namespace

std::string_view find_shader(std::string_view name) {
  for (const Row& row : kRows) {
    if (row.name == name) return row.text;
  }
  return {};
}

}  // namespace shatterbox::shaders
")
