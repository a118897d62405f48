#include "sandbox/run/foresee.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <numeric>
#include <span>

#include <fmt/format.h>

#include "engine/core/clock.h"
#include "sandbox/run/interrupt.h"
#include "sandbox/run/projector.h"
#include "sandbox/scene/parts.h"
#include "sandbox/scene/words.h"

namespace shatterbox::sandbox::run {

namespace {

using core::Clock;
using core::milliseconds_since;
using scene::SceneDescription;

constexpr const char* kBlast = "a blast";
constexpr double kPressed = 1e-3;  // m/s: what comes no faster presses

/// The scene in which body number `tried` alone can break.
struct Trial {
  SceneDescription scene;
  scene::ScenePlan plan;
};

void make_unbreakable(world::BodyDescription& description) {
  if (auto* shell = std::get_if<world::ShellDescription>(&description.form)) shell->is_breakable = false;
  if (auto* solid = std::get_if<world::SolidDescription>(&description.form)) solid->is_breakable = false;
}

/// Of its copies the one that falls from highest stays, where it is.
void keep_highest(scene::BodyEntry& body, std::uint64_t seed, std::size_t number, scene::BodyPlan& plan) {
  const std::vector<Pose> poses = scene::copy_poses(body, seed, number);
  const Pose highest = *std::max_element(poses.begin(), poses.end(), [](const Pose& a, const Pose& b) {
    return a.translation.y() < b.translation.y();
  });
  body.position = highest.translation;
  body.rotation = highest.rotation;
  body.repeat = {};
  plan.description.pose = highest;
}

/// What an event does to bodies that are not in the trial it does to nobody; nor is there any film.
bool is_without(const scene::EventEntry& event, const std::vector<bool>& is_away) {
  const auto goes = [&is_away](int body) { return body >= 0 && is_away[static_cast<std::size_t>(body)]; };
  if (std::holds_alternative<scene::Speed>(event.action) || goes(event.who.body)) return true;
  const auto* throws = std::get_if<scene::Projectile>(&event.action);
  const auto* target = throws == nullptr ? nullptr : std::get_if<scene::BodyRef>(&throws->target);
  return target != nullptr && goes(target->body);
}

Trial make_trial(const SceneDescription& scene, const scene::ScenePlan& plan, std::size_t tried,
                 bool is_alone) {
  Trial trial{scene, plan};
  std::vector<bool> is_away(scene.bodies.size(), false);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    scene::BodyEntry& body = trial.scene.bodies[i];
    if (i == tried && is_alone) keep_highest(body, scene.world.seed, i, trial.plan.bodies[i]);
    if (i == tried || !can_break(body)) continue;
    make_unbreakable(trial.plan.bodies[i].description);
    is_away[i] = is_alone;
    body.is_held_back = body.is_held_back || is_alone;
  }
  std::erase_if(trial.scene.events, [&is_away](const auto& event) { return is_without(event, is_away); });
  return trial;
}

double bytes_of(const world::World& world) {
  double bytes = 0.0;
  for (const world::PartCount& part : world.inventory()) bytes += part.bytes;
  return bytes;
}

bool is_of(const scene::BuiltScene& built, body::BodyId id, int entry) {
  const scene::Origin* origin = scene::origin_of(built, id);
  return origin != nullptr && origin->entry == entry;
}

std::string name_of(std::span<const body::Body> bodies, body::BodyId id) {
  const body::Body* body = body::find_body(bodies, id);
  return body == nullptr ? kBlast : body->name;
}

/// The hardest meeting of body number `tried`, which is whole, with anything else in the last step.
void note_meetings(const scene::BuiltScene& built, int tried, Foreseen& found) {
  for (const body::LoggedImpulse& hit : built.world.impulse_log()) {
    const bool is_a = is_of(built, hit.body_a, tried);
    if (!is_a && !is_of(built, hit.body_b, tried)) continue;
    if (!found.other.empty() && hit.closing_speed <= found.speed) continue;
    found.other = name_of(built.world.bodies(), is_a ? hit.body_b : hit.body_a);
    found.speed = hit.closing_speed;
    found.time = built.world.time();
  }
}

/// What broke it: who gave its pieces most, and how fast it was at the place before the step. The log is of
/// the step that was taken again, with the pieces in its place.
void note_break(const scene::BuiltScene& built, int tried, const std::vector<body::Body>& before,
                Foreseen& found) {
  struct Met {
    double impulse = 0.0;  // N s, in all
    double closing = 0.0;  // m/s, of its first collision
    double first = 1e300;  // s, of that, since the step's begin
  };
  const world::BreakRow& broken = built.world.report().breaks.front();
  found.time = broken.time;
  std::map<body::BodyId, Met> met;
  for (const body::LoggedImpulse& hit : built.world.impulse_log()) {
    const bool is_a = is_of(built, hit.body_a, tried), is_b = is_of(built, hit.body_b, tried);
    if (is_a == is_b) continue;
    Met& other = met[is_a ? hit.body_b : hit.body_a];
    other.impulse += hit.impulse_world.norm();
    if (hit.kind != body::ImpulseKind::collision || hit.time >= other.first) continue;
    other.first = hit.time;
    other.closing = hit.closing_speed;
  }
  const body::Body* whole = body::find_body(before, broken.id);
  double most = 0.0;
  for (const auto& [other, given] : met) {
    if (given.impulse <= most) continue;
    most = given.impulse;
    found.other = name_of(built.world.bodies(), other);
    const body::Body* known = body::find_body(before, other);
    // What was thrown in this very step is known by how it met.
    found.speed = known == nullptr || whole == nullptr
                      ? given.closing
                      : (whole->velocity_at(broken.place) - known->velocity_at(broken.place)).norm();
  }
}

/// Asks the projector to break off, in the middle of a step too, after some time or at Ctrl-C.
class Patience {
 public:
  Patience(Projector& projector, double seconds) : seconds_(seconds) {
    projector.set_stop([this] {
      const bool is_over = is_interrupted() || milliseconds_since(begin_) > 1e3 * seconds_;
      if (is_over) is_over_ = true;
      return is_over;
    });
  }
  void begin_anew() { begin_ = Clock::now(); }
  bool is_over() const { return is_over_; }

 private:
  double seconds_;
  Clock::time_point begin_ = Clock::now();
  std::atomic<bool> is_over_{false};
};

/// Steps on behind a break, and counts what it left and cost.
void note_aftermath(Projector& projector, const scene::BuiltScene& built, int tried, double break_ms,
                    Foreseen& found) {
  std::vector<double> steps{break_ms};
  const long count = static_cast<long>(kAftermath * built.world.settings().steps_per_second);
  for (long i = 0; i < count; ++i) {
    const auto start = Clock::now();
    if (!projector.next()) break;
    steps.push_back(milliseconds_since(start));
  }
  std::sort(steps.begin(), steps.end());
  found.break_ms = steps.back();
  found.later_ms = steps[steps.size() / 2];
  found.all_ms = std::accumulate(steps.begin(), steps.end(), 0.0);
  found.pieces = 0;
  for (const body::Body* part : scene::parts_of(built, built.world.bodies(), {tried, -1}))
    found.pieces += built.world.ancestry(part->id).parent != 0 ? 1 : 0;
}

void play_trial(const SceneDescription& scene, scene::BuiltScene& built, int tried, double most_seconds,
                Foreseen& found) {
  Recorder unread;
  Projector projector(scene, built, unread, false, static_cast<int>(scene.world.steps_per_second), 1);
  const double bytes = bytes_of(built.world);
  std::vector<body::Body> before;
  Patience patience(projector, most_seconds);
  for (auto start = Clock::now(); projector.next(); start = Clock::now()) {
    const double milliseconds = milliseconds_since(start);
    const world::WorldReport& report = built.world.report();
    for (const world::ImpactRow& impact : report.impacts)
      if (built.world.ancestry(impact.id).parent == 0) found.ratio = std::max(found.ratio, impact.ratio);
    if (report.breaks.empty()) {
      note_meetings(built, tried, found);
      before.assign(built.world.bodies().begin(), built.world.bodies().end());
      continue;
    }
    note_break(built, tried, before, found);
    patience.begin_anew();
    note_aftermath(projector, built, tried, milliseconds, found);
    found.bytes = std::max(0.0, bytes_of(built.world) - bytes);
    break;
  }
  found.was_given_up = patience.is_over();
  if (found.was_given_up) {
    found.given_up_at = built.world.time();
    found.patience = most_seconds;
  }
}

}  // namespace

std::vector<Foreseen> foresee(const SceneDescription& scene, const scene::ScenePlan& plan, std::size_t most,
                              double patience) {
  int bodies = 0, breakable = 0;
  for (const scene::BodyEntry& body : scene.bodies) {
    bodies += body.repeat.total();
    breakable += can_break(body) ? 1 : 0;
  }
  std::vector<Foreseen> all;
  for (std::size_t i = 0; i < scene.bodies.size() && all.size() < most; ++i) {
    const scene::BodyEntry& body = scene.bodies[i];
    if (!can_break(body)) continue;
    Foreseen found;
    found.body = body.name;
    found.copies = body.repeat.total();
    found.is_alone = bodies > kMostTogether;
    found.has_others = breakable > 1;
    const Trial trial = make_trial(scene, plan, i, found.is_alone);
    scene::Problems problems;
    auto built = scene::raise_world(trial.scene, trial.plan, problems);
    if (!built) continue;
    built->world.prepare();
    play_trial(trial.scene, *built, static_cast<int>(i), patience, found);
    all.push_back(std::move(found));
  }
  return all;
}

std::string describe(const Foreseen& f) {
  std::string who = fmt::format("\"{}\"", f.body);
  if (f.copies > 1)
    who +=
        f.is_alone ? fmt::format(", one of {} alone", f.copies) : fmt::format(", the first of {}", f.copies);
  const std::string met = f.other.empty()     ? ""
                          : f.other == kBlast ? "is struck by a blast"
                          : f.speed < kPressed
                              ? fmt::format("is pressed by \"{}\"", f.other)
                              : fmt::format("meets \"{}\" with {:.3g} m/s", f.other, f.speed);
  const std::string given_up =
      fmt::format("; the step that begins at {:.3f} s was not over after {:g} s: the trial was given up",
                  f.given_up_at, f.patience);
  if (f.pieces > 0)
    return fmt::format(
        "{}: {} at {:.3f} s and breaks, {:.3g} times as stressed as it bears: {} after "
        "{:g} s; that took {:.0f} ms, then {:.3g} ms a step{}{}",
        who, met, f.time, f.ratio, scene::counted(f.pieces, "piece"), kAftermath, f.break_ms, f.later_ms,
        f.bytes < 1e5 ? "" : fmt::format(", {:.2g} MB more", f.bytes / 1e6), f.was_given_up ? given_up : "");
  if (f.was_given_up)
    return fmt::format("{}: holds until {:.3f} s{}{}", who, f.given_up_at,
                       met.empty() ? "" : ", at its hardest it " + met, given_up);
  if (met.empty()) return who + ": meets nothing";
  const std::string stressed =
      f.ratio >= 1.0 ? fmt::format(
                           ", though stressed to {:.2g} of what it bears: no crack starts in elements as "
                           "large as its own (element_size)",
                           f.ratio)
      : f.ratio > 0.0 ? fmt::format(", at most {:.2g} of what it bears", f.ratio)
                      : "; far from what it bears";
  const char* holds = f.has_others || f.is_alone ? "holds if nothing else breaks" : "holds";
  return fmt::format("{}: {}{}, at {:.3f} s {}", who, holds, stressed, f.time, met);
}

}  // namespace shatterbox::sandbox::run
