// Acts that last: hands that hold bodies and go their ways, and gravity on its way to another value.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "sandbox/scene/build_world.h"
#include "sandbox/scene/event_description.h"

namespace shatterbox::sandbox::script {

class Forces {
 public:
  // Each gives a sentence why it could not be done, or nothing. `who`: whom the hand holds.
  std::string grab(const scene::Grab& grab, scene::BodyRef who, scene::BuiltScene& built);
  std::string carry(const scene::Carry& carry, scene::BodyRef who, const scene::BuiltScene& built);
  std::string release(scene::BodyRef who, scene::BuiltScene& built);
  void change(const scene::Gravity& gravity, const world::World& world);

  /// Leads hands and gravity to where they are to be after the coming step.
  void advance(world::World& world);

 private:
  /// Smoothly from one to the other, s of the world.
  struct Way {
    double begin = 0.0, duration = 0.0;
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();
    Vec3 at(double time) const;
    bool is_over(double time) const { return time >= begin + duration; }
  };
  struct Held {
    int hand = 0;
    Vec3 place = Vec3::Zero();  // m
    std::optional<Way> way;
  };

  std::map<scene::BodyRef, Held> held_;
  std::optional<Way> gravity_;
};

}  // namespace shatterbox::sandbox::script
