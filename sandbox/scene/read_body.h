// The tables [[material]], [[pair]], [[body]] and [[event]] of a scene.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sandbox/scene/scene_description.h"
#include "sandbox/scene/table_reader.h"

namespace shatterbox::sandbox::scene {

/// The number of the material of that name in `scene`, taking presets in as they are used; -1 with a problem
/// at `place` if there is none.
int find_material(const std::string& name, const Place& place, SceneDescription& scene, Problems& problems);

/// The number of the body of that name; -1 if there is none.
int find_body(const SceneDescription& scene, const std::string& name);

/// Of all bodies, in their order.
std::vector<std::string> body_names(const SceneDescription& scene);

/// Whom a text names: a body with all its copies, or one of them, "name[2]". None, with a problem, if there
/// is no such.
std::optional<BodyRef> read_body_ref(TableReader& reader, const TomlValue& value,
                                     const SceneDescription& scene);

/// All keys of a [[material]] but its name and what it is like.
std::vector<std::string> material_keys();

void read_material(const TomlValue& table, std::size_t index, SceneDescription& scene, Problems& problems);
void read_pair(const TomlValue& table, SceneDescription& scene, Problems& problems);

/// Adds a body. `name` is the one to use where the table gives none. An inline body of an event is
/// `is_held_back`.
void read_body(const TomlValue& table, const std::string& name, bool is_held_back, SceneDescription& scene,
               Problems& problems);

/// After all bodies: events refer to them.
void read_event(const TomlValue& table, std::size_t index, SceneDescription& scene, Problems& problems);

/// A colour, "#rrggbb" or [r, g, b] from 0 to 1 (sRGB).
std::optional<Vec3> read_colour(TableReader& reader, const std::string& key);

/// Turns about x, then y, then z.
Quat turn_by(const Vec3& degrees);

/// The keys `motion`, `velocity`, `path` and their like, after the form, support, position and rotation of
/// `body` were read.
void read_motion(TableReader& reader, const std::string& kind, BodyEntry& body);

/// The key `repeat` of a body: its copies.
Repeat read_repeat(TableReader& reader);

/// Copies of a body, at most.
inline constexpr int kMostCopies = 100000;

}  // namespace shatterbox::sandbox::scene
