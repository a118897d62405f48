// Whom a joint, an event or the camera means: a body of the scene, or one of its copies ("name[2]").
#pragma once

#include <compare>

namespace shatterbox::sandbox::scene {

struct BodyRef {
  int body = -1;  // number in SceneDescription::bodies; below zero: nobody
  int copy = -1;  // of its repeat, from 0; -1: all

  bool includes(int other_body, int other_copy) const {
    return body == other_body && (copy < 0 || copy == other_copy);
  }
  auto operator<=>(const BodyRef&) const = default;
};

}  // namespace shatterbox::sandbox::scene
