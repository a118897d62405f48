#include <algorithm>

#include <fmt/format.h>

#include "sandbox/run/plan.h"

namespace shatterbox::sandbox::run {

namespace {

using scene::BodyEntry;
using scene::SceneDescription;

std::string quoted(const std::string& name) {
  return fmt::format("\"{}\"", name);
}

/// The first body that is so, in quotes; empty if none is.
template <class Claim>
std::string find_body_that(const SceneDescription& scene, const Claim& claim) {
  const auto found = std::find_if(scene.bodies.begin(), scene.bodies.end(), claim);
  return found == scene.bodies.end() ? "" : quoted(found->name);
}

template <class Action>
std::string find_event_of(const SceneDescription& scene) {
  for (const scene::EventEntry& event : scene.events)
    if (std::holds_alternative<Action>(event.action)) return quoted(event.name);
  return {};
}

template <class Form>
bool can_break_as(const BodyEntry& body) {
  return std::holds_alternative<Form>(body.form) && can_break(body);
}

/// Needed if there is somebody who needs it.
PartPlan part(const char* name, const std::string& who, const char* needs, const char* else_why) {
  return {name, !who.empty(), who.empty() ? else_why : who + " " + needs};
}

PartPlan option_part(const char* name, bool is_needed, const char* why, const char* else_why) {
  return {name, is_needed, is_needed ? why : else_why};
}

std::string overlay_of(const SceneDescription& scene) {
  if (scene.render.overlay != "none") return quoted(scene.render.overlay);
  for (const scene::EventEntry& event : scene.events)
    if (const auto* change = std::get_if<scene::OverlayChange>(&event.action);
        change && change->name != "none")
      return quoted(event.name);
  return {};
}

/// Solids alone have an inside to show.
std::string cut_open_body(const SceneDescription& scene) {
  const bool is_shown =
      scene.render.overlay == "level_set" ||
      std::any_of(scene.events.begin(), scene.events.end(), [](const scene::EventEntry& event) {
        const auto* change = std::get_if<scene::OverlayChange>(&event.action);
        return change && change->name == "level_set";
      });
  if (!is_shown) return {};
  return find_body_that(scene,
                        [](const BodyEntry& b) { return std::holds_alternative<scene::SolidForm>(b.form); });
}

}  // namespace

std::vector<PartPlan> plan_parts(const SceneDescription& scene, const Options& options) {
  const std::string moving =
      find_body_that(scene, [](const BodyEntry& b) { return b.motion == body::Motion::dynamic; });
  const std::string breakable = find_body_that(scene, scene::can_break);
  const bool may_free = !breakable.empty();  // pieces move, even of what is held
  const std::string mover = moving.empty() && may_free ? breakable : moving;
  const std::string grained = find_body_that(scene, [&](const BodyEntry& b) {
    return scene::can_break(b) &&
           scene.materials[static_cast<std::size_t>(b.material)].material.grain_size > 0.0;
  });
  const std::string late = find_body_that(scene, [](const BodyEntry& b) { return b.repeat.every > 0.0; });
  const std::string scripted =
      find_body_that(scene, [](const BodyEntry& b) { return b.motion == body::Motion::scripted; });
  const bool has_pictures = options.has_pictures;
  return {
      part("contact", mover, "can move and meet others", "nothing can move"),
      part("continuous_tests", mover, "must not pass through anything", "nothing can move"),
      part("sleeping", scene.world.has_sleep ? mover : "", "may come to rest",
           scene.world.has_sleep ? "nothing can move" : "scene.sleep is false"),
      part("scripted_motion", scripted, "follows a path", "no body has keyframes"),
      part("joints", scene.joints.empty() ? "" : quoted(scene.joints.front().name), "holds bodies together",
           "the scene has no [[joint]]"),
      part("level_sets", has_pictures ? cut_open_body(scene) : "", "is cut open by the overlay \"level_set\"",
           "solids touch by their triangles, and no overlay cuts them open"),
      part("shell_stress", find_body_that(scene, can_break_as<scene::ShellForm>),
           "can break: stiffness of membrane and bending, factors, flaws", "no shell can break"),
      part("tetrahedra", find_body_that(scene, can_break_as<scene::SolidForm>),
           "can break: elements inside its surface, their stress, flaws", "no solid can break"),
      part("grains", grained, "breaks along grains", "no material of what can break has a grain_size"),
      part("fracture", breakable, "can break: cutting with virtual nodes, pieces, going back in the step",
           "nothing can break"),
      part("explosions", find_event_of<scene::Explosion>(scene), "explodes", "no event explodes"),
      part("hands", find_event_of<scene::Grab>(scene), "grabs", "no event grabs"),
      part("script", scene.events.empty() ? late : quoted(scene.events.front().name), "waits for its time",
           "there are no events"),
      option_part("render", has_pictures, "pictures are asked for", "--no-render"),
      option_part("shadow", has_pictures && scene.light.casts_shadow, "the sun casts shadows",
                  has_pictures ? "light.shadow is false" : "--no-render"),
      part("overlay", has_pictures ? overlay_of(scene) : "", "is laid over", "none is asked for"),
      option_part("exposure", has_pictures && (scene.camera.shutter > 0.0 || scene.camera.aperture > 0.0),
                  "camera.shutter or camera.aperture: a frame is the mean of several pictures",
                  has_pictures ? "camera has no shutter and no aperture" : "--no-render"),
      option_part("video", !options.video.empty(), "a video is asked for", "no video is asked for"),
      option_part("recording", !options.recording.empty(), "--record", "--record is not asked for"),
      option_part("model", !options.model.empty(), "--export", "--export is not asked for"),
      option_part("audit", options.has_audit, "--audit", "--audit is not asked for"),
  };
}

void sort_parts(const std::vector<PartPlan>& parts, report::RunRecord& record) {
  const world::WorldReport& w = record.world;
  const auto has_stage = [&w](const std::string& name) { return w.stages.milliseconds(name) > 0.0; };
  const bool has_grain_edges = std::any_of(w.breaks.begin(), w.breaks.end(),
                                           [](const world::BreakRow& row) { return row.grain_share > 0.0; });
  const bool has_hits = std::any_of(record.frames.begin(), record.frames.end(),
                                    [](const report::FrameRecord& frame) { return frame.hits > 0; });
  const auto was_idle = [&](const std::string& name) {
    if (name == "contact") return w.contact.most_contacts == 0;
    if (name == "continuous_tests") return !has_hits;
    if (name == "sleeping") return !record.has_sleepers;
    if (name == "shell_stress") return w.solver.solves == 0;
    if (name == "grains") return !has_grain_edges;
    if (name == "fracture") return w.breaks.empty();
    if (name == "explosions" || name == "hands" || name == "joints") return !has_stage(name);
    return false;
  };
  record.used.clear();
  record.idle.clear();
  record.left_out.clear();
  for (const PartPlan& plan : parts)
    (!plan.is_needed       ? record.left_out
     : was_idle(plan.name) ? record.idle
                           : record.used)
        .push_back(plan.name);
}

}  // namespace shatterbox::sandbox::run
