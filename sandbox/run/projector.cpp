#include "sandbox/run/projector.h"

#include <cmath>

#include "engine/core/elementary.h"
#include "sandbox/run/doubts.h"
#include "sandbox/run/interrupt.h"
#include "sandbox/scene/parts.h"
#include "sandbox/script/between.h"

namespace shatterbox::sandbox::run {

Projector::Projector(const scene::SceneDescription& scene, scene::BuiltScene& built, Recorder& recorder,
                     bool has_audit, int frames_per_second, int slots)
    : scene_(scene),
      built_(built),
      recorder_(recorder),
      script_(scene),
      rig_(scene.camera, view::find_subject(scene, built.plan)),
      reframing_(scene, built, rig_.subject()),
      inspector_(has_audit, recorder.record),
      frames_per_second_(frames_per_second),
      slots_(slots) {
  if (has_audit) built_.world.keep_ways();
  set_stop(is_interrupted);
}

void Projector::set_stop(core::StopQuestion wants_to_stop) {
  wants_to_stop_ = std::move(wants_to_stop);
  built_.world.set_stop(wants_to_stop_);
}

double Projector::steps_at(double film) const {
  const double steps = script_.clock().simulated_at(film) * scene_.world.steps_per_second;
  const double whole = std::floor(steps + 0.5);
  return std::abs(steps - whole) < 1e-6 ? whole : steps;
}

view::Moment Projector::now() const {
  const double time = built_.world.time(), film = script_.clock().film_at(time);
  return {film, time, script_.clock().factor_at(film), built_.world.bodies(), reframing_.shift()};
}

view::Whereabouts Projector::whereabouts() const {
  return [this](scene::BodyRef who) { return scene::centre_of(built_, built_.world.bodies(), who); };
}

script::Sight Projector::look() {
  const view::Viewpoint view = rig_.view_at(now(), whereabouts());
  const Vec3 way = view.target - view.position;
  const double half = view.fov * core::kPi / 360.0;
  const double height = 2.0 * way.norm() * core::sin(half) / core::cos(half);
  const Vec3 right = way.cross(scene_.camera.up).normalized();
  return {view.position, view.target, height * right, height * right.cross(way).normalized()};
}

bool Projector::step(double film) {
  world::World& world = built_.world;
  for (std::string& fault : script_.play(built_, [this] { return look(); }))
    recorder_.record.warnings.push_back(std::move(fault));
  throws_.add(script_.take_throws());
  const view::Moment moment = now();
  for (const scene::Cue& cue : script_.take_cues()) {
    if (const auto* change = std::get_if<scene::CameraChange>(&cue.event->action))
      rig_.begin(*change, cue.event->who, cue.film, moment, whereabouts());
    cues_.push_back(cue);
  }
  if (steps_at(film) < static_cast<double>(world.steps() + 1)) {
    before_.assign(world.bodies().begin(), world.bodies().end());
    steps_before_ = world.steps();
  }
  inspector_.begin_step(world);
  if (!world.step()) {
    recorder_.note_broken_off(world);
    return false;
  }
  inspector_.end_step(world);
  reframing_.look();
  throws_.look(world);
  return true;
}

double Projector::time_ahead() const {
  return script_.clock().simulated_at(static_cast<double>(slot_ / slots_ + 1) / frames_per_second_);
}

std::optional<view::Moment> Projector::next() {
  const int frame = ++slot_ / slots_;
  const double rate = frames_per_second_, film = slot_ / (rate * slots_), middle = (frame + 0.5) / rate;
  world::World& world = built_.world;
  // A frame whose first half is beyond the end is none.
  const auto is_over = [&] {
    return frame > 0 && script_.clock().simulated_at(middle) > scene_.seconds * (1.0 + 1e-12);
  };
  // Slow motion may begin before the end, and bring the frame back before it.
  const auto may_go_on = [&] {
    return !is_over() || (script_.may_change_speed() && world.steps() < last_step());
  };
  while (may_go_on() && static_cast<double>(world.steps()) < steps_at(film) && !wants_to_stop_()) {
    if (step(film)) recorder_.note_step(world);
  }
  if (is_over() || wants_to_stop_()) return std::nullopt;
  const script::FilmClock& clock = script_.clock();
  view::Moment moment{film, clock.simulated_at(film), clock.factor_at(film), world.bodies(),
                      reframing_.shift()};
  if (const double steps = steps_at(film); steps < static_cast<double>(world.steps())) {
    const double share = steps - static_cast<double>(steps_before_);
    between_ = script::bodies_between(before_, world, share);
    moment.bodies = between_;
    moment.shift = reframing_.shift(share);
  }
  return moment;
}

long Projector::last_step() const {
  return static_cast<long>(scene_.seconds * scene_.world.steps_per_second + 0.5);
}

void Projector::finish() {
  while (built_.world.steps() < last_step() && !wants_to_stop_()) (void)step(1e300);
  if (wants_to_stop_()) return;
  for (std::string& sentence : throws_.missed(built_.world.time()))
    recorder_.record.warnings.push_back(std::move(sentence));
  for (const scene::Problem& doubt : find_afterthoughts(scene_, built_))
    recorder_.record.warnings.push_back(scene::describe(doubt));
}

}  // namespace shatterbox::sandbox::run
