// What single verbs of [[event]] say beside when they happen. Each declares its keys as known to the reader.
#pragma once

#include <string>

#include "sandbox/scene/scene_description.h"
#include "sandbox/scene/table_reader.h"

namespace shatterbox::sandbox::scene {

/// The number of the body that an event brings in: a named one (held back from now on), an inline table, or,
/// if there `has_default`, a steel ball of 30 mm radius. -1 with a problem if there is none.
int read_thrown_body(TableReader& reader, const std::string& event_name, bool has_default,
                     SceneDescription& scene);

/// Whom `key` names; nobody if it is absent, or, with a problem, names none.
BodyRef read_named_body(TableReader& reader, const std::string& key, const SceneDescription& scene);

/// Whom an event acts on; nobody, with a problem, if it names none.
BodyRef read_acted_body(TableReader& reader, const SceneDescription& scene);

Projectile read_projectile(TableReader& reader, const SceneDescription& scene);
Push read_push(TableReader& reader, int body, const SceneDescription& scene);

Gravity read_gravity(TableReader& reader);
Explosion read_explosion(TableReader& reader);
Grab read_grab(TableReader& reader, int body, const SceneDescription& scene);
Carry read_carry(TableReader& reader);

Speed read_speed(TableReader& reader);
/// `who`: takes the one to follow.
CameraChange read_camera_change(TableReader& reader, const SceneDescription& scene, BodyRef& who);
OverlayChange read_overlay_change(TableReader& reader);
Caption read_caption(TableReader& reader);

}  // namespace shatterbox::sandbox::scene
