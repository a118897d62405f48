#include <algorithm>

#include <fmt/format.h>

#include "engine/core/elementary.h"

#include "sandbox/scene/read_event.h"

namespace shatterbox::sandbox::scene {

namespace {

const Range kFilmTime = between(0.0, 1e4, "s");

/// Keys of other moves of the camera.
void refuse_other_moves(TableReader& reader) {
  reader.foreign({"position", "target", "fov"}, "it is for move = \"cut\" or \"dolly\"");
  reader.foreign({"angle"}, "it is for move = \"orbit\"");
  reader.foreign({"body", "offset"}, "it is for move = \"follow\"");
  reader.foreign({"duration", "easing"}, "a cut takes no time; write move = \"dolly\"");
}

void read_view(TableReader& reader, CameraChange& change) {
  change.position = reader.vector("position", coordinate());
  change.target = reader.vector("target", coordinate());
  change.fov = reader.number("fov", between(1.0, 150.0, "degrees"));
  if (!reader.has("position") && !reader.has("target") && !reader.has("fov"))
    reader.add_problem(reader.table().place, fmt::format("{} changes nothing", reader.what()),
                       "give position, target or fov");
  if (change.position && change.target && (*change.position - *change.target).norm() < 1e-9)
    reader.add_problem_at("target", "the camera looks at itself", "move position or target");
}

bool is_printable(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return (c >= 32 && c <= 126) || c == '\n'; });
}

}  // namespace

Speed read_speed(TableReader& reader) {
  Speed speed;
  if (const auto factor = reader.number("factor", between(1e-4, 100.0))) {
    speed.factor = *factor;
  } else if (!reader.has("factor")) {
    reader.add_problem(reader.table().place, fmt::format("{} has no \"factor\"", reader.what()),
                       "add factor = 0.1: a tenth of the true speed");
  }
  speed.ramp = reader.number("ramp", kFilmTime).value_or(speed.ramp);
  return speed;
}

CameraChange read_camera_change(TableReader& reader, const SceneDescription& scene, BodyRef& who) {
  CameraChange change;
  const std::string move = reader.choice("move", {"cut", "dolly", "orbit", "follow"}).value_or("cut");
  if (move == "cut") {
    read_view(reader, change);
  } else {
    change.duration = reader.number("duration", kFilmTime).value_or(1.0);
    change.is_smooth = reader.choice("easing", {"smooth", "straight"}).value_or("smooth") == "smooth";
  }
  if (move == "dolly") {
    change.move = CameraMove::dolly;
    read_view(reader, change);
  } else if (move == "orbit") {
    change.move = CameraMove::orbit;
    change.angle =
        reader.number("angle", between(-36000.0, 36000.0, "degrees")).value_or(0.0) * (core::kPi / 180.0);
    if (!reader.has("angle"))
      reader.add_problem(reader.table().place, fmt::format("{} has no \"angle\"", reader.what()),
                         "add angle = 90 (degrees)");
  } else if (move == "follow") {
    change.move = CameraMove::follow;
    who = read_acted_body(reader, scene);
    change.offset = reader.vector("offset", coordinate());
    if (change.offset && change.offset->norm() < 1e-9)
      reader.add_problem_at("offset", "the camera cannot be where it looks at", "for example [0, 0.3, 1]");
  }
  refuse_other_moves(reader);
  return change;
}

OverlayChange read_overlay_change(TableReader& reader) {
  OverlayChange change;
  change.name = reader.choice("show", kOverlayNames).value_or("none");
  if (!reader.has("show"))
    reader.add_problem(reader.table().place, fmt::format("{} shows nothing", reader.what()),
                       "add show = \"stress\", or \"none\" to end it");
  change.most = reader.number("most", positive());
  return change;
}

Caption read_caption(TableReader& reader) {
  Caption caption;
  if (const auto text = reader.text("text")) {
    caption.text = *text;
    if (!is_printable(caption.text))
      reader.add_problem_at("text", "a caption is written in plain letters (ASCII)", "for example \"ue\"");
  } else if (!reader.has("text")) {
    reader.add_problem(reader.table().place, fmt::format("{} says nothing", reader.what()),
                       "add text = \"..\"");
  }
  caption.duration = reader.number("duration", kFilmTime).value_or(caption.duration);
  caption.fade = reader.number("fade", kFilmTime).value_or(caption.fade);
  return caption;
}

}  // namespace shatterbox::sandbox::scene
