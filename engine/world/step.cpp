// World::step: the list of stages, for each part of the step. Each is a free function of its floor; here they
// are only called, timed and, when something broke, called again from the snapshot at the part's beginning
// with the pieces in place of the whole.
#include <algorithm>
#include <string>

#include "engine/core/stop.h"
#include "engine/dynamics/scripted_motion.h"
#include "engine/world/bits.h"
#include "engine/world/impact_row.h"
#include "engine/world/perforation.h"
#include "engine/world/pieces.h"
#include "engine/world/replace.h"
#include "engine/world/state.h"
#include "engine/world/verdict.h"

namespace shatterbox::world {
namespace {

/// Share of its size that a solid goes while what breaks it is followed.
constexpr double kWayOfHit = 0.2;

/// Share of a step in which its dents are made: what ends within it ends before 1.
constexpr double kDentTime = 1.0 - 1e-9;

/// How long the quickest solid of what broke takes for that, s. Its pieces, face on face, would come upon all
/// that is in their way at once, and bear together what comes one after the other: most would break again.
double time_of_hit(const std::vector<const EvaluatedImpact*>& broken, const std::vector<body::Body>& before) {
  double time = 1e300;
  for (const EvaluatedImpact* impact : broken) {
    const body::Shape& shape = *body::find_body(before, impact->id)->shape;
    if (shape.kind == body::ShapeKind::solid && impact->hardest.closing_speed > 0.0)
      time = std::min(time, kWayOfHit * 2.0 * shape.bounding_radius / impact->hardest.closing_speed);
  }
  return time;
}

/// Passes of one part of a step: the first, and one more for each generation of breaking that went back; or
/// for each round of joints that opened. These are many, and what breaks behind them must not wait.
constexpr int kMostPasses = 12;

/// Scripted ones that strike are driven.
bool is_free(const body::Body& body) {
  return body.is_dynamic() && body.motion == body::Motion::dynamic;
}

Vec3 momentum_of(const std::vector<body::Body>& bodies) {
  Vec3 sum = Vec3::Zero();
  for (const body::Body& body : bodies)
    if (is_free(body)) sum += body.shape->mass * body.velocity;
  return sum;
}

double total_energy(const std::vector<body::Body>& bodies, const Vec3& gravity,
                    ConservationFigures& figures) {
  figures.momentum = momentum_of(bodies);
  figures.kinetic_energy = figures.potential_energy = 0.0;
  for (const body::Body& body : bodies) {
    if (!is_free(body)) continue;
    figures.kinetic_energy += body::kinetic_energy(body);
    figures.potential_energy -= body.shape->mass * body.free_acceleration(gravity).dot(body.pose.translation);
  }
  return figures.kinetic_energy + figures.potential_energy;
}

/// Momentum that gravity and the logged impulses of what stands still (fixed bodies, sleepers) explain. What
/// broke and left its pieces its motion is in `before` alone, its pieces in `bodies` alone.
Vec3 explained_momentum(const std::vector<body::Body>& before, const std::vector<body::Body>& bodies,
                        std::span<const body::LoggedImpulse> log, const Vec3& gravity, double time_step) {
  const auto moved = [&](body::BodyId id) -> const body::Body* {
    if (const body::Body* body = body::find_body(bodies, id))
      return is_free(*body) && body->is_awake ? body : nullptr;
    const body::Body* broken = body::find_body(before, id);
    return broken && is_free(*broken) ? broken : nullptr;
  };
  Vec3 sum = Vec3::Zero();
  for (const body::Body& body : before)
    if (moved(body.id)) sum += body.shape->mass * time_step * body.free_acceleration(gravity);
  for (const body::LoggedImpulse& entry : log) {
    if (const body::Body* a = moved(entry.body_a)) sum += a->locked.let_move(entry.impulse_world);
    if (const body::Body* b = moved(entry.body_b)) sum -= b->locked.let_move(entry.impulse_world);
  }
  return sum;
}

/// Who was seen in one part of a step may have broken in a later one.
std::string name_of(const std::vector<body::Body>& bodies, body::BodyId id) {
  const body::Body* body = body::find_body(bodies, id);
  return body != nullptr ? body->name : "body " + std::to_string(id) + ", broken since";
}

void book_contact(const dynamics::ContactReport& contact, const std::vector<body::Body>& bodies,
                  ContactFigures& figures) {
  constexpr std::size_t kMostNames = 100;
  figures.contacts = contact.contacts;
  figures.most_contacts = std::max(figures.most_contacts, contact.contacts);
  if (contact.least_gap < 1e300)
    figures.least_gap =
        figures.least_gap == 0.0 ? contact.least_gap : std::min(figures.least_gap, contact.least_gap);
  for (const auto& [a, b] : contact.new_crossing_pairs) {
    ++figures.crossing_pairs;
    if (figures.crossing_names.size() < kMostNames)
      figures.crossing_names.push_back(name_of(bodies, a) + " / " + name_of(bodies, b));
  }
  for (const auto& [a, b] : contact.parted) {
    if (figures.parted_names.size() < kMostNames)
      figures.parted_names.push_back(name_of(bodies, a) + " / " + name_of(bodies, b));
  }
  if (contact.longest_cut > figures.longest_cut) {
    const auto& [a, b] = contact.longest_cut_pair;
    figures.longest_cut = contact.longest_cut;
    figures.longest_cut_names = name_of(bodies, a) + " / " + name_of(bodies, b);
  }
  figures.failsafe_steps += contact.failsafe_steps > 0 ? 1 : 0;
  figures.body_steps += contact.awake_bodies;
  figures.frozen_body_steps += contact.frozen_share * contact.awake_bodies;
  if (figures.body_steps > 0.0) figures.frozen_share = figures.frozen_body_steps / figures.body_steps;
  figures.residual = contact.residual;
  figures.hits = contact.hits;
  figures.ways_tested += contact.ways_tested;
  figures.test_bytes = std::max(figures.test_bytes, contact.test_bytes);
  figures.drift = std::max(figures.drift, contact.drift);
}

void book_scripted(const std::vector<body::Body>& bodies, std::vector<ScriptedRow>& rows) {
  for (const body::Body& body : bodies) {
    if (body.motion != body::Motion::scripted || !body.script.path) continue;
    auto row = std::lower_bound(rows.begin(), rows.end(), body.id,
                                [](const ScriptedRow& r, body::BodyId id) { return r.id < id; });
    if (row == rows.end() || row->id != body.id) row = rows.insert(row, {body.id, body.name, 0.0, 0.0});
    row->behind = dynamics::distance_behind(body);
    row->most_behind = std::max(row->most_behind, row->behind);
  }
}

/// Who may break is woken, where he sleeps, before he has to bear more.
void note_what_bodies_bear(MovingState& moving) {
  const ImpactMemory nothing;
  for (body::Body& body : moving.bodies) {
    if (!body.may_break) continue;
    const auto fragile = moving.fragiles.find(body.id);
    const auto memory = moving.memories.find(body.id);
    if (fragile == moving.fragiles.end()) continue;
    body.bears =
        borne_at_rest(body, *fragile->second, memory != moving.memories.end() ? memory->second : nothing);
  }
}

}  // namespace

dynamics::ContactReport World::move_bodies(const dynamics::StepPart& part, body::ImpulseLog& log) {
  State& s = *state_;
  return s.report.stages.time("motion", [&] {
    return s.settings.contact == ContactScheme::paper
               ? dynamics::step_paper_motion(s.moving.bodies, s.contact_settings, s.moving.paper_contact, log)
               : dynamics::move_part(s.moving.bodies, s.contact_settings, part, s.moving.contact, log);
  });
}

int World::count_parts() const {
  const State& s = *state_;
  return s.settings.contact == ContactScheme::paper
             ? 1
             : dynamics::count_parts(s.moving.bodies, s.contact_settings, s.moving.contact);
}

std::optional<dynamics::StepPart> World::divide_where_cut(const dynamics::StepPart& part,
                                                          const dynamics::ContactReport& moved) const {
  const State& s = *state_;
  if (s.settings.contact == ContactScheme::paper) return std::nullopt;
  return dynamics::divide_where_cut(s.contact_settings, part, moved);
}

bool World::step() {
  State& s = *state_;
  if (s.wants_to_stop && s.wants_to_stop()) return false;
  if (s.steps == 0) s.report.bodies_start = static_cast<int>(s.moving.bodies.size());
  s.begin = note_begin();
  s.borne.clear();
  s.log.clear();
  s.ended_ways.clear();
  dynamics::ContactReport contact;
  MovingState snapshot;
  try {
    // Only what may break has a snapshot to go back to, and steps that last.
    const core::StopScope scope(s.moving.fragiles.empty() ? nullptr : &s.wants_to_stop);
    take_parts(contact, snapshot);
  } catch (const core::Stopped&) {
    put_back(std::move(snapshot));
    return false;
  }
  s.begin = {};
  s.blasts.clear();
  for (dynamics::Hand& hand : s.hands) hand.velocity.setZero();
  s.ways = std::move(contact.ways);
  s.ways.insert(s.ways.end(), s.ended_ways.begin(), s.ended_ways.end());
  book_contact(contact, s.moving.bodies, s.report.contact);
  book_scripted(s.moving.bodies, s.report.scripted);
  ++s.steps;
  s.report.steps = s.steps;
  s.hash = s.report.stages.time("hash", [&] { return hash_state(s.moving, s.steps, s.hash); });
  return true;
}

/// A part of a step, moved.
struct World::MovedPart {
  dynamics::StepPart part;
  Passes passes;
  std::vector<body::Body> before;  // at its begin
  body::ImpulseLog given, log;     // all impulses; those of motion alone
  dynamics::ContactReport moved;
  // Where pieces inherit the motion of what broke in it, and ways are kept: the bodies at its end, and how
  // many breaks there were before.
  std::vector<body::Body> unbroken;
  std::size_t known_breaks = 0;
};

World::MovedPart World::move_part(const dynamics::StepPart& part, const Passes& passes) {
  MovedPart done{part, passes, {}, act(part), {}, {}, {}, 0};
  tell_watcher("acts", part, passes.count());
  done.before = state_->moving.bodies;
  done.moved = move_bodies(part, done.log);
  for (const body::Body& body : state_->moving.bodies)
    if (body.script.strikes) dynamics::begin_strike(*body::find_body(done.before, body.id));
  done.given.insert(done.given.end(), done.log.begin(), done.log.end());
  tell_watcher("motion", part, passes.count());
  return done;
}

World::PartEnd World::judge_part(MovedPart& done, MovingState& snapshot, dynamics::StepPart& part,
                                 dynamics::ContactReport& contact) {
  State& s = *state_;
  const double step = s.contact_settings.time_step;
  const auto divide = [&](const std::optional<dynamics::StepPart>& finer) {
    if (!finer) return false;
    s.moving = std::move(snapshot);
    part = *finer;
    return true;
  };
  if (divide(divide_where_cut(part, done.moved))) return PartEnd::subdivided;
  if (!s.moving.contact.joints.empty()) {
    const bool may_go_back =
        s.settings.after_break == AfterBreak::go_back && done.passes.openings + 1 < kMostPasses;
    const bool goes_back = open_joints(judge_joints(part, done.given), snapshot, may_go_back);
    tell_watcher("joints", part, done.passes.count());
    if (goes_back) return PartEnd::retaken_without_joints;
  }
  const auto impacts =
      judge_impacts(done.given, {done.before, time() + step * part.number / part.count, time()});
  for (const EvaluatedImpact& impact : impacts) s.factors.note_use(impact.id);
  if (divide(divide_before_holes(impacts, part, time(), step))) {
    s.borne.clear();  // their verdicts were not told
    return PartEnd::subdivided;
  }
  const std::size_t known_breaks = s.report.breaks.size();
  if (s.contact_settings.has_ways && s.settings.after_break == AfterBreak::inherit) {
    done.unbroken = s.moving.bodies;
    done.known_breaks = known_breaks;
  }
  std::vector<const EvaluatedImpact*> broken;
  const bool goes_back = s.report.stages.time("fracture", [&] {
    broken = book_verdicts(impacts, snapshot, done.passes.breaks);
    return break_bodies(broken, snapshot);
  });
  tell_watcher("fracture", part, done.passes.count());
  if (goes_back) {
    if (s.contact_settings.has_ways)
      divide_ways(done.before, std::span(s.report.breaks).subspan(known_breaks), s.moving.bodies,
                  static_cast<double>(part.number) / part.count, contact.ways, s.ended_ways);
    if (part.number == 0) part.count = std::max(part.count, count_parts());
    if (s.settings.contact == ContactScheme::standard)
      part = dynamics::divide_to(s.contact_settings, part, time_of_hit(broken, done.before));
    return PartEnd::retaken_with_pieces;
  }
  if (!done.moved.is_unfinished) return PartEnd::accepted;
  s.moving = std::move(snapshot);
  return PartEnd::retaken_in_full;
}

void World::take_parts(dynamics::ContactReport& contact, MovingState& snapshot) {
  State& s = *state_;
  core::StageTimer& timer = s.report.stages;
  const bool may_break = !s.moving.fragiles.empty() || !s.moving.contact.joints.empty();
  dynamics::StepPart part{0, count_parts()};
  PartEnd end = PartEnd::accepted;  // of the pass before
  for (Passes passes; part.number < part.count;) {
    if (may_break) timer.time("snapshot", [&] { snapshot = s.moving; });
    part.may_return = may_break;
    part.is_again = passes.count() > 0;
    // What joints held opens others; pieces hardly ever break in the part in which they were born.
    part.is_trial = end == PartEnd::retaken_without_joints && passes.breaks + 1 < kMostPasses &&
                    passes.openings + 1 < kMostPasses && dynamics::may_be_tried(s.contact_settings, part);
    MovedPart done = move_part(part, passes);
    end = may_break ? judge_part(done, snapshot, part, contact) : PartEnd::accepted;
    if (end == PartEnd::retaken_with_pieces) ++passes.breaks;
    if (end == PartEnd::retaken_without_joints) ++passes.openings;
    if (end != PartEnd::accepted) continue;
    dynamics::end_strikes(s.moving.bodies);
    book_conservation(done.before, done.log, s.contact_settings.time_step / part.count);
    s.log.insert(s.log.end(), done.given.begin(), done.given.end());
    dynamics::add_part(part, std::move(done.moved), contact);
    if (!done.unbroken.empty())
      divide_ways(done.unbroken, std::span(s.report.breaks).subspan(done.known_breaks), s.moving.bodies,
                  std::min((part.number + 1.0) / part.count, kDentTime), contact.ways, s.ended_ways);
    if (s.wants_to_stop && !s.begin.moving)
      s.begin.moving = std::move(snapshot);  // the next part has its own
    if (may_break) s.factors.clear_out(s.moving.fragiles, s.ancestry);
    ++part.number;
    passes = {};
  }
  finish_parts(part.count, snapshot, contact);
}

void World::finish_parts(int count, const MovingState& snapshot, dynamics::ContactReport& contact) {
  State& s = *state_;
  const bool may_break = !s.moving.fragiles.empty() || !s.moving.contact.joints.empty();
  const bool may_yield = may_break && std::any_of(s.materials.begin(), s.materials.end(),
                                                  [](const material::Material& m) { return m.yield > 0.0; });
  if (may_yield)
    s.report.stages.time("dents", [&] {
      const std::vector<body::Body> before =
          s.contact_settings.has_ways ? s.moving.bodies : std::vector<body::Body>{};
      const std::vector<BreakRow> reshaped = dent_bodies(snapshot);
      // They went through the step in the shape that they had.
      if (s.contact_settings.has_ways)
        divide_ways(before, reshaped, s.moving.bodies, kDentTime, contact.ways, s.ended_ways);
    });
  if (may_yield) tell_watcher("dents", {count - 1, count}, 0);
  if (s.settings.contact == ContactScheme::standard) {
    dynamics::end_step(s.contact_settings, contact, count, s.moving.contact);
    s.report.stages.time("sleep", [&] {
      if (s.contact_settings.has_sleep) note_what_bodies_bear(s.moving);
      dynamics::put_to_sleep(s.moving.bodies, s.contact_settings, s.moving.contact);
    });
  } else {
    s.moving.contact.shelf->newborn.clear();  // the paper's surfaces are others: nobody takes these from it
  }
  tell_watcher("sleep", {count - 1, count}, 0);
}

std::vector<EvaluatedImpact> World::judge_impacts(const body::ImpulseLog& log, const PartBegin& begin) {
  State& s = *state_;
  EvaluationFigures figures;
  // Who goes through is slowed down, and his plug gone, from the part's begin: that is the law of going back.
  const bool goes_back = s.settings.after_break == AfterBreak::go_back;
  auto impacts = s.report.stages.time("stress", [&] {
    return evaluate_stress(s.moving.bodies, log, s.moving.fragiles, s.settings, s.contact_settings, time(),
                           s.moving.memories, s.borne, figures, goes_back ? &begin : nullptr);
  });
  s.report.solver.solves += figures.solves;
  s.report.solver.skipped += figures.skipped;
  s.report.solver.factorisations += figures.factorisations;
  s.report.solver.worst_residual = std::max(s.report.solver.worst_residual, figures.worst_residual);
  return impacts;
}

std::vector<const EvaluatedImpact*> World::book_verdicts(std::span<const EvaluatedImpact> impacts,
                                                         MovingState& snapshot, int pass) {
  State& s = *state_;
  const double end_time = static_cast<double>(s.steps + 1) / s.settings.steps_per_second;
  std::vector<const EvaluatedImpact*> broken;
  for (const EvaluatedImpact& impact : impacts) {
    const body::Body& body = *body::find_body(s.moving.bodies, impact.id);
    ImpactMemory& memory = s.moving.memories[impact.id];
    if (!impact.figures().element_stress.empty())
      s.element_stress[impact.id] =
          std::make_shared<const std::vector<double>>(impact.figures().element_stress);
    if (impact.figures().verdict.outcome != fracture::Outcome::broke) {
      if (!impact.figures().needed_no_solve())
        s.report.impacts.push_back(describe_impact(impact, body, end_time));
      continue;
    }
    if (impact.has_used_all) {
      ImpactRow row = describe_impact(impact, body, end_time);
      row.verdict = "held: its impact event has used all its generations of breaking";
      s.report.impacts.push_back(row);
      continue;
    }
    if (impact.is_cracked_only()) {
      keep_begin(snapshot);
      const auto& decision = std::get<fracture::SolidDecision>(impact.decision);
      const auto fragile = cracked(*s.moving.fragiles.at(impact.id), decision);
      s.moving.fragiles[impact.id] = snapshot.fragiles[impact.id] = fragile;
      // It is not what bore its load until now.
      for (ImpactMemory* own : {&memory, &snapshot.memories[impact.id]}) {
        own->tested_contact = 0.0;
        own->born = time();
      }
      // What tears as a piece of what has just broken keeps no dent that would open it.
      const bool is_torn = memory.has_open_dent;
      if (fragile->material().yield > 0.0)
        memory.torn_until = snapshot.memories[impact.id].torn_until =
            impact.first_time + 2.0 * decision.verdict.duration;
      ImpactRow row = describe_impact(impact, body, end_time);
      row.verdict =
          format_ratio(is_torn ? "torn, in one piece: " : "cracked, in one piece: ", decision.verdict.ratio);
      s.report.impacts.push_back(row);
      continue;
    }
    if (waits_for_striker(impact, impacts)) continue;
    // When the impact that made a piece is over, counting begins anew.
    if (impact.first_time > memory.charged_until) memory.generation = 0;
    ImpactRow row = describe_impact(impact, body, end_time);
    if (pass + 1 >= kMostPasses) {
      row.verdict = "held: so much has broken in this step that it is not taken again";
      s.report.impacts.push_back(row);
      continue;
    }
    s.report.impacts.push_back(row);
    broken.push_back(&impact);
  }
  return broken;
}

bool World::break_bodies(std::span<const EvaluatedImpact* const> broken, MovingState& snapshot) {
  if (broken.empty()) return false;
  State& s = *state_;
  const double end_time = static_cast<double>(s.steps + 1) / s.settings.steps_per_second;
  keep_begin(snapshot);
  const bool goes_back = s.settings.after_break == AfterBreak::go_back;
  if (goes_back) {
    for (const EvaluatedImpact* impact : broken)
      snapshot.memories[impact->id].generation = s.moving.memories[impact->id].generation;
    dynamics::forget_blows(s.moving.bodies, snapshot.bodies);
    s.moving = std::move(snapshot);
  }
  const std::vector<body::Body> before = s.moving.bodies;
  const std::size_t first_paid = s.log.size();
  // All pay before any is replaced: those that broke on each other pay by one impulse on both.
  for (const EvaluatedImpact* impact : broken) {
    if (find_hole(*impact))
      pay_for_hole(s.moving, *impact, s.log);
    else if (goes_back)
      pay_for_cracks(s.moving, *impact, impact->figures().fracture_energy, s.log);
  }
  for (const EvaluatedImpact* impact : broken) {
    const bool has_hole = find_hole(*impact) != nullptr;
    const body::Body parent = *body::find_body(s.moving.bodies, impact->id);
    const bool keeps_dents = s.moving.memories[parent.id].keeps_dents;
    BreakRow row = replace_body(s.moving, *impact, end_time, s.ancestry);
    if (has_hole) {
      take_plug_along(s.moving, *impact, row, s.log);
      leave_dent(s.moving, *impact, row, keeps_dents);
    }
    hang_on(parent, row.born, end_time);
    row.time = end_time;
    inherit_stress(row.id, row.born);
    s.report.breaks.push_back(std::move(row));
  }
  book_breaks(before, std::span(s.log).subspan(first_paid));
  s.is_disturbed = true;
  return goes_back;
}

void World::inherit_stress(body::BodyId parent, const std::vector<body::BodyId>& born) {
  auto& stress = state_->element_stress;
  const auto found = stress.find(parent);
  if (found == stress.end()) return;
  for (const body::BodyId id : born) stress[id] = found->second;
  stress.erase(parent);
}

void World::book_momentum(const std::vector<body::Body>& before, std::span<const body::LoggedImpulse> log,
                          double time_step) {
  State& s = *state_;
  const Vec3 explained = explained_momentum(before, s.moving.bodies, log, s.settings.gravity, time_step);
  const double error = (momentum_of(s.moving.bodies) - momentum_of(before) - explained).norm();
  s.report.conservation.momentum_error = std::max(s.report.conservation.momentum_error, error);
}

void World::book_breaks(const std::vector<body::Body>& before, std::span<const body::LoggedImpulse> paid) {
  // What is held by an axis gives the rest of its pieces' momentum to that.
  if (std::any_of(before.begin(), before.end(), [](const body::Body& b) { return b.locked.any(); })) return;
  book_momentum(before, paid, 0.0);
}

void World::book_conservation(const std::vector<body::Body>& before, const body::ImpulseLog& log,
                              double time_step) {
  State& s = *state_;
  ConservationFigures& figures = s.report.conservation;
  const double energy = total_energy(s.moving.bodies, s.settings.gravity, figures);
  book_momentum(before, log, time_step);
  const bool is_driven = std::any_of(s.moving.bodies.begin(), s.moving.bodies.end(), [](const body::Body& b) {
    return b.is_driven() || !b.torque.isZero(0.0);
  });
  if (!s.is_disturbed && !is_driven)
    figures.greatest_energy_rise = std::max(figures.greatest_energy_rise, energy - s.last_energy);
  s.is_disturbed = false;
  s.last_energy = energy;
  long triangles = 0;
  for (const body::Body& body : s.moving.bodies)
    triangles += static_cast<long>(body.shape->surface.triangles.size());
  if (s.steps == 0) s.report.triangles_start = triangles;
  s.report.triangles_most = std::max(s.report.triangles_most, triangles);
  long tetrahedra = 0;
  for (const auto& [id, fragile] : s.moving.fragiles)
    if (const auto* solid = std::get_if<fracture::SolidSubject>(&fragile->subject))
      tetrahedra += static_cast<long>(solid->complex->cells.size());
  if (s.steps == 0) s.report.tetrahedra_start = tetrahedra;
  s.report.tetrahedra_end = tetrahedra;
  s.report.tetrahedra_most = std::max(s.report.tetrahedra_most, tetrahedra);
}

}  // namespace shatterbox::world
