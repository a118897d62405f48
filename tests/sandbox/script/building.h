// A world from a scene that tests have read.
#pragma once

#include <catch2/catch.hpp>
#include <optional>

#include "sandbox/scene/build_world.h"
#include "tests/sandbox/scene/reading.h"

namespace shatterbox::sandbox {

inline std::optional<scene::BuiltScene> build(const scene::Reading& reading) {
  INFO(reading.text);
  REQUIRE(reading.scene.has_value());
  scene::Problems problems;
  auto built = scene::build_world(*reading.scene, problems);
  INFO(scene::describe(problems));
  REQUIRE(built.has_value());
  return built;
}

}  // namespace shatterbox::sandbox
