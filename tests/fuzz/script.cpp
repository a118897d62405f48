// Any bytes as a script that plays on a scene.
#include <sys/mman.h>
#include <unistd.h>

#include "sandbox/scene/read_scene.h"
#include "tests/fuzz/target.h"

using namespace shatterbox::sandbox;

int fuzz::run_one(std::string_view bytes) {
  constexpr const char* kScene =
      "[[body]]\nkind = \"plane\"\n[[body]]\nname = \"ball\"\nkind = \"sphere\"\n[[body]]\nname = \"pane\"\n"
      "kind = \"shell\"\nshape = \"pane\"\nwidth = 1\nheight = 1\n";
  const int file = memfd_create("script", 0);
  require(file >= 0 && write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
          "a file in memory");
  scene::Problems problems;
  const auto description =
      scene::read_scene(kScene, "fuzz.toml", {{}, "/proc/self/fd/" + std::to_string(file)}, problems);
  close(file);
  require(description.has_value() == problems.empty(), "a scene or problems");
  (void)scene::describe(problems);
  return 0;
}
