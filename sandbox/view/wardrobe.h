// What each body of a scene looks like: for pictures and for export alike.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "engine/body/body.h"
#include "render/frame/frame.h"
#include "sandbox/scene/build_world.h"
#include "sandbox/scene/scene_description.h"

namespace shatterbox::sandbox::view {

class Wardrobe {
 public:
  /// Both must outlive it.
  Wardrobe(const scene::SceneDescription& scene, const scene::BuiltScene& built)
      : scene_(scene), built_(built) {}

  /// The looks of a body, or of what it is a piece of, by geometry::Part.
  const std::vector<render::Look>& looks_of(body::BodyId id);

  /// A look "hidden" is for walls that would stand before the camera.
  bool is_hidden(body::BodyId id) const;

 private:
  /// The body of the scene that it is, or is a part of.
  body::BodyId original_of(body::BodyId id) const;

  const scene::SceneDescription& scene_;
  const scene::BuiltScene& built_;
  std::map<body::BodyId, std::vector<render::Look>> looks_;  // by originals
};

/// A level plane is drawn as the ground.
bool is_drawn_as_ground(const body::Body& body);

/// The ground as it looks, at the height of the highest level plane; nothing where there is none, or none is
/// to be seen.
std::optional<render::Ground> find_ground(const scene::SceneDescription& scene,
                                          const scene::BuiltScene& built);

}  // namespace shatterbox::sandbox::view
