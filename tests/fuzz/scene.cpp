// Any bytes as a scene: a description, or problems that each say something.
#include "sandbox/scene/read_scene.h"
#include "tests/fuzz/target.h"

using namespace shatterbox::sandbox;

int fuzz::run_one(std::string_view bytes) {
  scene::Problems problems;
  const auto description = scene::read_scene(bytes, "fuzz.toml", {}, problems);
  require(description.has_value() == problems.empty(), "a scene or problems");
  for (const scene::Problem& problem : problems)
    require(!problem.message.empty(), "a problem says what it is");
  (void)scene::describe(problems);
  return 0;
}
