#include "render/gpu/program.h"

#include <glad/gl.h>

#include <stdexcept>

#include "shaders/shader_text.h"

namespace shatterbox::render::gpu {

void delete_program(unsigned name) {
  glDeleteProgram(name);
}

namespace {

// The text with each line `#include "file"` replaced by that file, once.
std::string with_includes(std::string_view name, std::vector<std::string>& seen) {
  for (const std::string& known : seen) {
    if (known == name) return "";
  }
  seen.emplace_back(name);
  std::string_view text = shaders::find_shader(name);
  if (text.empty()) throw std::runtime_error("no shader named " + std::string(name));
  std::string out;
  constexpr std::string_view kWord = "#include \"";
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    const std::string_view line = text.substr(0, end + 1);
    if (line.starts_with(kWord)) {
      const std::size_t close = line.find('"', kWord.size());
      out += with_includes(line.substr(kWord.size(), close - kWord.size()), seen);
    } else {
      out += line;
    }
    text.remove_prefix(end + 1);
  }
  return out;
}

unsigned compile(unsigned kind, std::string_view name, const std::vector<std::string>& defines) {
  std::string text = "#version 450 core\n";
  for (const std::string& define : defines) text += "#define " + define + "\n";
  std::vector<std::string> seen;
  text += with_includes(name, seen);
  const GLuint shader = glCreateShader(kind);
  const char* start = text.c_str();
  glShaderSource(shader, 1, &start, nullptr);
  glCompileShader(shader);
  GLint ok = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == 0) {
    char words[2048] = {};
    glGetShaderInfoLog(shader, sizeof words, nullptr, words);
    glDeleteShader(shader);
    throw std::runtime_error("shader " + std::string(name) + ": " + words);
  }
  return shader;
}

}  // namespace

Program::Program(std::string_view vertex, std::string_view fragment, const std::vector<std::string>& defines)
    : handle_(glCreateProgram()) {
  const GLuint program = handle_.get();
  std::vector<GLuint> stages = {compile(GL_VERTEX_SHADER, vertex, defines)};
  if (!fragment.empty()) stages.push_back(compile(GL_FRAGMENT_SHADER, fragment, defines));
  for (GLuint stage : stages) glAttachShader(program, stage);
  glLinkProgram(program);
  for (GLuint stage : stages) {
    glDetachShader(program, stage);
    glDeleteShader(stage);
  }
  GLint ok = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok == 0) {
    char words[2048] = {};
    glGetProgramInfoLog(program, sizeof words, nullptr, words);
    throw std::runtime_error("shaders " + std::string(vertex) + " + " + std::string(fragment) + ": " + words);
  }
}

void Program::use() const {
  glUseProgram(handle_.get());
}

void Program::set(int location, int value) {
  glUniform1i(location, value);
}

void Program::set(int location, float value) {
  glUniform1f(location, value);
}

}  // namespace shatterbox::render::gpu
