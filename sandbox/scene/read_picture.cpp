#include "sandbox/scene/read_picture.h"

#include <fmt/format.h>

#include "sandbox/scene/read_body.h"
#include "sandbox/scene/read_event.h"
#include "sandbox/scene/table_reader.h"

namespace shatterbox::sandbox::scene {

namespace {

const Range kFov = between(1.0, 150.0, "degrees");

void read_path(TableReader& reader, CameraEntry& camera, Problems& problems) {
  const TomlValue* path = reader.value("path");
  if (path == nullptr) return;
  if (!path->is_array() || path->items.empty() || !path->items.front().is_table()) {
    reader.add_problem(path->place,
                       fmt::format("path must be a list of keyframes, but is {}", kind_in_words(*path)),
                       "write path = [{at = 0, position = [..], target = [..]}, {at = 2, ...}]");
    return;
  }
  CameraKey last;
  last.position = camera.position.value_or(last.position);
  last.target = camera.target.value_or(last.target);
  last.fov = camera.fov;
  last.at = -1.0;
  for (std::size_t i = 0; i < path->items.size(); ++i) {
    TableReader key_reader(path->items[i], fmt::format("camera keyframe {}", i + 1), problems);
    CameraKey key = last;
    const auto at = key_reader.number("at", not_negative("s"));
    key.at = at.value_or(last.at + 1.0);
    if (!key_reader.has("at"))
      key_reader.add_problem(path->items[i].place, "a keyframe needs a time", "add at = 1.5");
    if (at && *at <= last.at) key_reader.add_problem_at("at", "keyframes must go forward in time");
    for (const char* needed : {"position", "target"}) {
      if (i > 0 || key_reader.has(needed) || reader.has(needed)) continue;
      key_reader.add_problem(path->items[i].place, fmt::format("the first keyframe needs a {}", needed),
                             fmt::format("add {} = [x, y, z] here or in [camera]", needed));
    }
    key.position = key_reader.vector("position", coordinate()).value_or(key.position);
    key.target = key_reader.vector("target", coordinate()).value_or(key.target);
    key.fov = key_reader.number("fov", kFov).value_or(key.fov);
    key_reader.finish();
    camera.path.push_back(key);
    last = key;
  }
}

void read_lens(TableReader& reader, SceneDescription& scene) {
  CameraEntry& camera = scene.camera;
  camera.shutter = reader.number("shutter", between(0.0, 1.0, "of a frame's time")).value_or(0.0);
  camera.aperture = reader.number("aperture", between(0.0, 1e3, "m")).value_or(0.0);
  if (camera.aperture <= 0.0) {
    reader.foreign({"focus"}, "without a lens everything is sharp: add aperture = 0.01");
  } else if (const TomlValue* focus = reader.value("focus"); focus != nullptr && focus->is_text()) {
    camera.focus = read_named_body(reader, "focus", scene);
  } else if (focus != nullptr) {
    if (const auto distance = reader.as_number(*focus, "focus", extent())) camera.focus = *distance;
  }
  if (camera.aperture <= 0.0 && camera.shutter <= 0.0)
    reader.foreign({"samples"}, "one picture a frame is enough without shutter and aperture");
  else
    camera.samples = static_cast<int>(reader.whole_number("samples", 2, 256).value_or(camera.samples));
}

}  // namespace

void read_camera(const TomlValue& table, SceneDescription& scene, Problems& problems) {
  CameraEntry& camera = scene.camera;
  TableReader reader(table, "[camera]", problems);
  camera.place = table.place;
  camera.position = reader.vector("position", coordinate());
  camera.target = reader.vector("target", coordinate());
  camera.up = reader.vector("up", between(-1e6, 1e6)).value_or(camera.up);
  camera.fov = reader.number("fov", kFov).value_or(camera.fov);
  read_path(reader, camera, problems);
  if (reader.has("follow")) {
    camera.follow = read_named_body(reader, "follow", scene);
    reader.foreign({"target"}, "the camera looks at the body that it follows");
    camera.offset = reader.vector("offset", coordinate());
    if (camera.offset && camera.offset->norm() < 1e-9)
      reader.add_problem_at("offset", "the camera cannot be where it looks at", "for example [0, 0.3, 1]");
    if (camera.offset) reader.foreign({"position", "path"}, "the offset from the body says where it is");
  } else {
    reader.foreign({"offset"}, "it is from the body that the camera follows: add follow = \"name\"");
  }
  read_lens(reader, scene);
  reader.finish();
  if (camera.up.norm() < 1e-9)
    reader.add_problem_at("up", "up is zero and points nowhere", "up is usually [0, 1, 0]");
  if (!camera.position || !camera.target) return;
  const Vec3 view = *camera.target - *camera.position;
  if (view.norm() < 1e-9) {
    reader.add_problem_at("target", "the camera looks at itself", "move position or target");
  } else if (view.cross(camera.up).norm() < 1e-6 * view.norm() * camera.up.norm()) {
    reader.add_problem_at("target", "the camera looks straight along its up direction",
                          "tilt up, for example [0, 0, 1]");
  }
}

void read_light(const TomlValue& table, LightEntry& light, Problems& problems) {
  TableReader reader(table, "[light]", problems);
  light.preset = reader.choice("preset", kLightNames).value_or("");
  if (const TomlValue* sun = reader.value("sun"); sun != nullptr && sun->is_table()) {
    TableReader inner(*sun, "[light] sun", problems);
    light.sun_direction = inner.vector("direction", between(-1e6, 1e6));
    light.sun_colour = read_colour(inner, "colour");
    light.sun_strength = inner.number("strength", between(0.0, 100.0));
    light.sun_size = inner.number("size", between(0.0, 40.0, "degrees"));
    inner.finish();
  } else if (sun != nullptr) {
    light.sun_direction = reader.as_vector(*sun, "sun", between(-1e6, 1e6));
  }
  if (light.sun_direction && light.sun_direction->norm() < 1e-9) {
    reader.add_problem_at("sun", "the direction to the sun is zero and points nowhere",
                          "for example [0.5, 0.8, 0.4]");
  }
  light.sky = reader.number("sky", between(0.0, 100.0));
  light.casts_shadow = reader.truth("shadow").value_or(true);
  reader.finish();
}

void read_render(const TomlValue& table, RenderEntry& render, Problems& problems) {
  TableReader reader(table, "[render]", problems);
  render.look = reader.choice("look", kLookNames).value_or("");
  render.ground = reader.choice("ground", kGroundNames).value_or("");
  render.ground_colour = read_colour(reader, "ground_colour");
  render.checker = reader.number("checker", extent()).value_or(0.0);
  render.backdrop = reader.choice("backdrop", kBackdropNames).value_or(render.backdrop);
  render.overlay = reader.choice("overlay", kOverlayNames).value_or(render.overlay);
  render.overlay_most = reader.number("overlay_most", positive());
  render.exposure = reader.number("exposure", between(1e-3, 1e3)).value_or(1.0);
  render.has_caption = reader.truth("caption").value_or(false);
  reader.foreign({"fps", "size", "resolution", "quality"},
                 "it is of the film: on the command line --fps 30, --size 1280x720 or --quality full");
  reader.foreign({"motion_blur", "shutter"}, "write [camera] with shutter = 0.5");
  reader.foreign({"light", "sun"}, "write [light] with preset = \"noon\", or sun = [0.5, 0.8, 0.4]");
  reader.finish();
}

}  // namespace shatterbox::sandbox::scene
