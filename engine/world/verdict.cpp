#include "engine/world/verdict.h"

#include <algorithm>
#include <cmath>

#include "engine/core/parallel.h"
#include "engine/fracture/perforation_law.h"
#include "engine/material/tempering.h"
#include "engine/stress/contact_duration.h"
#include "engine/stress/stress_bound.h"
#include "engine/world/perforation.h"

namespace shatterbox::world {
namespace {

/// Loads nearer than this share of the body's bounding radius are one load.
constexpr double kGatherRadius = 0.25;
/// Resting contact is evaluated again when its force has grown by this factor since the body last held, or so
/// far that its stress, which is in proportion, would reach the strength.
constexpr double kContactGrowth = 1.1;
/// A body that bore an impact in an earlier pass bears one of that many times its loads, as long as its ratio
/// of stress to strength times the factor stays below this.
constexpr double kBorneRatio = 0.95;
/// Where the stress is above the strength and yet no crack could start, or there was no energy for one, that
/// is so again for loads up to so many times as great.
constexpr double kBorneAgain = 1.02;
/// Of what has used all its generations, and holds: only what is so much harder is told once more.
constexpr double kUsedAgain = 2.0;
/// Loads smaller than this share of the hardest one do not decide whether two impacts are alike.
constexpr double kMinorLoad = 0.05;
/// Times its flow stress, that a body bears all over a patch that is pressed into it. [Hertz] ch. 6
constexpr double kHardness = 3.0;
constexpr int kSolidGenerations = 6;  // solves of a cracking solid

struct Candidate {
  const body::Body* body = nullptr;
  const Fragile* fragile = nullptr;
  Load hardest;
  std::vector<Load> loads;
  double first_time = 0.0;     // s
  bool is_struck = false;      // by a collision
  bool is_piece = false;       // born of a break
  bool has_used_all = false;   // generations of its event
  double contact_force = 0.0;  // N, of what rests on it
  fracture::Impact impact;
};

struct Judge {
  const std::vector<body::Body>& bodies;
  const std::map<body::BodyId, ImpactMemory>& memories;
  const WorldSettings& settings;
  const dynamics::ContactSettings& contact;
  const PartBegin* begin = nullptr;
  const body::ImpulseLog& log;

  double restitution(const body::Body& struck, body::BodyId other) const {
    const body::Body* partner = body::find_body(bodies, other);
    return partner ? dynamics::pair_material(struck, *partner, contact).restitution : struck.restitution;
  }

  fracture::ImpactLoad impact_load(const body::Body& struck, const material::Material& material,
                                   const Load& load, bool is_collision) const {
    fracture::ImpactLoad out;
    if (settings.criterion == Criterion::penalty) {
      out.snapshots.step = 1.0 / settings.steps_per_second;
      out.snapshots.first =
          (std::floor(load.time / out.snapshots.step) + 1.0) * out.snapshots.step - load.time;
    }
    const body::Body* partner = body::find_body(bodies, load.other);
    out.point_material = load.point_body + struck.shape->material_from_body;
    out.impulse = load.impulse_body.norm();
    out.direction = load.impulse_body / out.impulse;
    double inverse = struck.mobility(load.point_body, out.direction);
    if (partner && load.other_impulse.squaredNorm() > 0.0)
      out.other_inverse_mass = partner->mobility(load.other_point, load.other_impulse.normalized());
    inverse += out.other_inverse_mass;
    out.effective_mass = inverse > 0.0 ? 1.0 / inverse : 0.0;
    out.is_resting = !is_collision;
    if (load.spread > 0.0) {
      out.is_resting = false;
      out.hertz_radius = load.spread;
      return out;
    }
    if (!is_collision || !(out.effective_mass > 0.0)) return out;
    // What stands behind a body that is squeezed, or shares its impact with other places, shows in the
    // impulse: the mass that was stopped at the speed of the impact. A single contact has the pair's own
    // effective mass.
    out.restitution = restitution(struck, load.other);
    const double bounce = 1.0 + out.restitution;
    out.closing_speed = load.closing_speed;
    if (load.closing_speed > 0.0)
      out.effective_mass = out.impulse / (bounce * load.closing_speed);
    else
      out.closing_speed = out.impulse / (bounce * out.effective_mass);
    const stress::HertzContact contact_pair = find_hertz_contact(struck, body::find_body(bodies, load.other));
    const double force = stress::peak_force(contact_pair, out.effective_mass, out.closing_speed);
    out.hertz_compliance = stress::hertz_compliance(contact_pair, force);
    out.hertz_radius = stress::hertz_patch_radius(contact_pair, force);
    if (const double flow = fracture::flow_stress(material); flow > 0.0)
      out.hertz_radius = std::max(
          out.hertz_radius,
          stress::plastic_patch_radius(contact_pair, fracture::collision_energy(out), kHardness * flow));
    return out;
  }
};

/// Drops what is older than `average` (s). Half a step more or less decides nothing, so rounding must not.
void forget_old_contact(ImpactMemory& memory, double time, double average, double step) {
  std::erase_if(memory.contact, [&](const Load& load) { return load.time < time - average + 0.5 * step; });
}

double total_force(const std::vector<Load>& loads, double average) {
  double sum = 0.0;
  for (const Load& load : loads) sum += load.impulse_body.norm();
  return sum / average;
}

/// Pa, at most, where `force` (N) bends a body over its whole size: a solid as a bar of its least width, a
/// shell as a strip of kLeastWidth of its size.
double bending_bound(const body::Body& body, double force) {
  const double thickness = body.shape->thickness;
  const double reach = 2.0 * body.shape->bounding_radius;
  if (const double width = body.shape->width; width > 0.0)
    return stress::bending_bound(width, width, reach, force);
  return stress::bending_bound(thickness, std::max(thickness, reach * kLeastWidth), reach, force);
}

std::vector<Load> gather_by_place(const std::vector<Load>& loads, double radius) {
  std::vector<Load> gathered;
  add_to_event(gathered, loads, radius);
  return gathered;
}

/// [BHTF07] sec. VI: collision and contact of one step together.
void gather_paper_step(const OwnImpulses& log, const body::Body& body, double radius, double time,
                       std::vector<Load>& loads) {
  for (const auto kind :
       {body::ImpulseKind::collision, body::ImpulseKind::contact, body::ImpulseKind::continuous})
    add_to_event(loads, gather_loads(log, kind, body, radius, time), radius);
}

/// Collisions of this step, less what is charged already and what passes through to seated neighbours.
std::vector<Load> gather_collisions(const Judge& judge, const OwnImpulses& log, const body::Body& body,
                                    double radius, double time, ImpactMemory& memory) {
  Vec3 passed_on = Vec3::Zero();
  const auto passes_on = [&](const Load& load) {
    const body::Body* other = body::find_body(judge.bodies, load.other);
    const bool is_neighbour = other && is_seated(body, *other, load);
    if (is_neighbour) passed_on += load.impulse_body;
    return is_neighbour;
  };
  gather_loads(log, body::ImpulseKind::contact, body, radius, time, passes_on);
  std::vector<Load> hits =
      gather_loads(log, body::ImpulseKind::collision, body, radius, time, [&](Load& load) {
        if (passes_on(load)) return true;
        const auto other = judge.memories.find(load.other);
        return take_charged(memory, other == judge.memories.end() ? nullptr : &other->second, load);
      });
  keep_own_share(hits, passed_on);
  return hits;
}

/// s, of the hardest load if that is a blast's.
std::optional<double> blast_duration_of(const std::vector<Load>& loads) {
  const Load* hardest = nullptr;
  for (const Load& load : loads)
    if (!hardest || load.impulse_body.squaredNorm() > hardest->impulse_body.squaredNorm()) hardest = &load;
  if (!hardest || !(hardest->duration > 0.0)) return std::nullopt;
  return hardest->duration;
}

/// Contact of this step, and of those before that are not forgotten yet: its force, N.
double gather_contact(const OwnImpulses& log, const body::Body& body, double radius, double time, double step,
                      bool is_paper, ImpactMemory& memory) {
  const double average = contact_average(step);
  forget_old_contact(memory, time, average, step);
  if (!is_paper)
    for (const Load& load : gather_loads(log, body::ImpulseKind::contact, body, radius, time))
      memory.contact.push_back(load);
  return total_force(memory.contact, average);
}

/// An event is over when no collision came for two durations; by the paper's criterion with its step.
bool is_event_over(const ImpactMemory& memory, const std::vector<Load>& hits, double time, bool is_paper) {
  double last = -1e9, next = hits.empty() ? time : 1e9;
  for (const Load& load : memory.event) last = std::max(last, load.time);
  for (const Load& load : hits) next = std::min(next, load.time);
  return is_paper || next - last > 2.0 * memory.event_duration;
}

void add_to_event(ImpactMemory& memory, const std::vector<Load>& hits, double radius, double time,
                  bool is_paper) {
  if (!memory.event.empty() && is_event_over(memory, hits, time, is_paper)) {
    memory.event.clear();
    memory.event_duration = 0.0;
    memory.has_open_dent = false;
  }
  add_to_event(memory.event, hits, radius);
}

/// What is known of the stress by that much resting contact, N, from the last solve: it is in proportion.
std::optional<double> known_ratio(const ImpactMemory& memory, double contact_force) {
  if (!(memory.solved_contact > 0.0) || contact_force > kContactGrowth * memory.solved_contact)
    return std::nullopt;
  return memory.solved_ratio * contact_force / memory.solved_contact;
}

/// What presses on the body, and, of what was `struck` in this step, the event.
void fill_candidate(const Judge& judge, const body::Body& body, double radius, double time, bool is_struck,
                    const ImpactMemory& memory, Candidate& candidate) {
  const bool is_paper = judge.settings.criterion == Criterion::paper;
  const std::vector<Load> event = is_struck ? memory.event : std::vector<Load>{};
  const material::Material& material = candidate.fragile->material();
  for (const Load& load : event) {
    candidate.impact.loads.push_back(judge.impact_load(body, material, load, !is_paper));
    candidate.impact.loads.back().was_asked = load.was_asked;
    if (judge.begin && !is_paper && load.time >= judge.begin->time && material.yield > 0.0)
      candidate.impact.loads.back().striker = find_striker(*judge.begin, judge.log, body.id, load.other);
  }
  const std::optional<double> blast = blast_duration_of(event);
  // What presses at rest is nothing beside a blast, whose duration is that of all loads.
  if (!blast)
    for (const Load& load : gather_by_place(memory.contact, radius))
      candidate.impact.loads.push_back(judge.impact_load(body, material, load, false));
  candidate.is_struck = is_struck;
  const std::vector<Load>& told = is_struck ? event : memory.contact;
  candidate.hardest = *std::max_element(told.begin(), told.end(), [](const Load& a, const Load& b) {
    return a.impulse_body.squaredNorm() < b.impulse_body.squaredNorm();
  });
  candidate.loads = event;
  candidate.loads.insert(candidate.loads.end(), memory.contact.begin(), memory.contact.end());
  candidate.is_piece = memory.charged_event != 0;
  candidate.first_time = event.empty() ? time : event.front().first_time;
  for (const Load& load : event) candidate.first_time = std::min(candidate.first_time, load.first_time);
  // Generations are bounded per event: when the impact that made a piece is over, counting begins anew.
  const int generation = candidate.first_time > memory.charged_until ? 0 : memory.generation;
  candidate.has_used_all = generation >= judge.settings.most_generations;
  candidate.impact.has_torn = candidate.first_time <= memory.torn_until;
  candidate.impact.contact_average = contact_average(1.0 / judge.settings.steps_per_second);
  candidate.impact.spin_material = body.pose.rotation.conjugate() * body.angular_velocity;
  if (judge.settings.stress_window) candidate.impact.given_duration = judge.settings.stress_window;
  if (candidate.fragile->contact_duration)
    candidate.impact.given_duration = candidate.fragile->contact_duration;
  if (blast) candidate.impact.given_duration = blast;
  if (is_paper) candidate.impact.given_duration = judge.settings.paper_duration;
}

/// What becomes of the impulses of a step on a body.
enum class Claim {
  nothing,  // to evaluate
  bounded,  // too weak by what bounds it
  borne,    // like what was borne
  due       // to be judged
};

/// The impact of this step on one body.
Claim gather_impact(const Judge& judge, const OwnImpulses& log, const body::Body& body, double time,
                    ImpactMemory& memory, Candidate& candidate) {
  const double radius = kGatherRadius * body.shape->bounding_radius;
  const double step = 1.0 / judge.settings.steps_per_second;
  const bool is_paper = judge.settings.criterion == Criterion::paper;
  std::vector<Load> hits;
  if (is_paper)
    gather_paper_step(log, body, radius, time, hits);
  else
    hits = gather_collisions(judge, log, body, radius, time, memory);
  const double contact_force = gather_contact(log, body, radius, time, step, is_paper, memory);
  add_to_event(memory, hits, radius, time, is_paper);

  bool is_pressed = contact_force > memory.tested_growth * memory.tested_contact;
  // Contact is an average over a time that a newborn piece has not lived yet.
  if (!is_paper && time < memory.born + contact_average(step)) is_pressed = false;
  if (is_pressed &&
      bending_bound(body, contact_force) < material::borne_tension(candidate.fragile->material())) {
    if (hits.empty()) return Claim::bounded;
    is_pressed = false;
  }
  if (hits.empty() && !is_pressed) return Claim::nothing;
  fill_candidate(judge, body, radius, time, !hits.empty(), memory, candidate);
  candidate.contact_force = contact_force;
  candidate.impact.resting_ratio = known_ratio(memory, contact_force);
  memory.tested_contact = std::max(memory.tested_contact, contact_force);
  return Claim::due;
}

/// By how much the loads exceed those of the impact that was borne, place by place; 1e9 where one has no
/// like.
double load_growth(const std::vector<Load>& loads, const BorneImpact& borne, double radius) {
  double hardest = 0.0;
  for (const Load& load : loads) hardest = std::max(hardest, load.impulse_body.norm());
  double growth = 0.0;
  for (const Load& load : loads) {
    const double impulse = load.impulse_body.norm();
    if (impulse < kMinorLoad * hardest) continue;
    double like = 0.0;
    for (const Load& old : borne.loads)
      if ((old.point_body - load.point_body).norm() < radius)
        like = std::max(like, old.impulse_body.dot(load.impulse_body) / impulse);
    growth = std::max(growth, like > 0.0 ? impulse / like : 1e9);
  }
  return growth;
}

/// How many times its loads a body bears that has held.
double most_growth_of(const fracture::Verdict& verdict) {
  const double ratio = verdict.most_ratio();
  const double growth = ratio < 1.0 ? kBorneRatio / std::max(ratio, 1e-300) : kBorneAgain;
  if (!(verdict.von_mises > 0.0)) return growth;
  return std::min(growth, kBorneRatio * verdict.yield / verdict.von_mises);
}

/// Who yields is judged anew in each pass: the dent is as deep as the hit is hard.
bool has_yielded(const fracture::Verdict& verdict) {
  return verdict.yield > 0.0 && verdict.von_mises > verdict.yield;
}

/// Null: this is harder than what was borne, or nothing was.
const BorneImpact* find_like_borne(const Candidate& candidate, const BorneImpacts& borne) {
  const auto found = borne.find(candidate.body->id);
  if (found == borne.end() || found->second.had_used_all != candidate.has_used_all) return nullptr;
  const double radius = kGatherRadius * candidate.body->shape->bounding_radius;
  return load_growth(candidate.loads, found->second, radius) < found->second.most_growth ? &found->second
                                                                                         : nullptr;
}

/// `duration`: of the event's impact, s; 0: nothing struck.
void keep_verdict(double duration, double tested_growth, ImpactMemory& memory) {
  memory.event_duration = std::max(memory.event_duration, duration);
  memory.tested_growth = tested_growth;
}

/// The dent of the event that is under way, in place of what it was when less of the event was known.
void await_dent(const EvaluatedImpact& impact, const body::Body& body, ImpactMemory& memory) {
  const fracture::Verdict& verdict = impact.figures().verdict;
  const bool holds = verdict.outcome == fracture::Outcome::held || impact.is_cracked_only();
  if (memory.has_open_dent) memory.dents.pop_back();
  memory.has_open_dent = false;
  // What tears does not keep the shape in which it tore.
  const bool is_over = memory.generation == 0 || impact.first_time > memory.charged_until;
  if (!holds || !memory.keeps_dents || !is_over) return;
  std::visit(
      [&](const auto& decision) {
        if (!decision.dent) return;
        memory.has_open_dent = true;
        memory.dents.push_back({decision.dent, verdict.von_mises, verdict.yield,
                                impact.hardest.point_body + body.shape->material_from_body});
      },
      impact.decision);
}

/// Breakable bodies that impulses of this part of a step act on, ascending.
std::vector<body::BodyId> find_touched(const body::ImpulseLog& log, const Fragiles& fragiles) {
  std::vector<body::BodyId> touched;
  for (const body::LoggedImpulse& entry : log)
    for (const body::BodyId id : {entry.body_a, entry.body_b})
      if (fragiles.count(id)) touched.push_back(id);
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  return touched;
}

/// Impacts that have to be judged: of those like one that was borne the verdict is kept.
std::vector<Candidate> gather_candidates(const Judge& judge, const Fragiles& fragiles, double time,
                                         std::map<body::BodyId, ImpactMemory>& memories,
                                         const BorneImpacts& borne, EvaluationFigures& figures) {
  const std::vector<body::BodyId> touched = find_touched(judge.log, fragiles);
  const std::vector<OwnImpulses> impulses = sort_by_body(judge.log, touched);
  std::vector<Candidate> all(touched.size());
  std::vector<ImpactMemory*> own(touched.size(), nullptr);  // null: the body is gone
  for (std::size_t i = 0; i < touched.size(); ++i) {
    all[i].body = body::find_body(judge.bodies, touched[i]);
    if (all[i].body) own[i] = &memories[touched[i]];
  }
  std::vector<Claim> claims(touched.size(), Claim::nothing);
  core::parallel_for(touched.size(), 16, [&](std::size_t i) {
    if (!own[i]) return;
    all[i].fragile = fragiles.at(touched[i]).get();
    claims[i] = gather_impact(judge, impulses[i], *all[i].body, time, *own[i], all[i]);
    if (claims[i] != Claim::due) return;
    if (const BorneImpact* like = find_like_borne(all[i], borne)) {
      claims[i] = Claim::borne;
      keep_verdict(like->duration, like->tested_growth, *own[i]);
    }
  });
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < all.size(); ++i) {
    figures.skipped += claims[i] == Claim::bounded || claims[i] == Claim::borne ? 1 : 0;
    if (claims[i] == Claim::due) candidates.push_back(std::move(all[i]));
  }
  return candidates;
}

fracture::FractureSettings how_to_decide(const WorldSettings& settings, const Candidate& candidate) {
  fracture::FractureSettings how;
  how.most_generations = candidate.is_piece ? std::min(settings.piece_generations, settings.crack_generations)
                                            : settings.crack_generations;
  // Cracks of solids go on for longer before they part anything, and their solves cost less.
  if (std::holds_alternative<fracture::SolidSubject>(candidate.fragile->subject))
    how.most_generations = kSolidGenerations;
  if (candidate.has_used_all) how.most_generations = 1;  // for the verdict
  how.has_energy_guard = settings.has_energy_guard;
  // Nobody asks how well each of a thousand shards held; of what has not cracked yet, that is told as it is.
  how.may_estimate = candidate.is_piece;
  how.solve_residual = settings.solve_residual;
  how.least_width = kLeastWidth * candidate.fragile->size;
  // The crushed core is the mark of the hit on the whole body; a shard is hardly larger than a core.
  if (candidate.is_piece) how.core_spacing = 0.0;
  return how;
}

/// Of a piece that breaks: nobody will ask for them again.
void give_up_factors(const EvaluatedImpact& impact, const Candidate& candidate) {
  if (!candidate.is_piece || impact.has_used_all) return;
  if (impact.figures().verdict.outcome != fracture::Outcome::broke) return;
  if (const auto* shell = std::get_if<fracture::ShellSubject>(&candidate.fragile->subject))
    shell->systems->give_up();
}

EvaluatedImpact judge_impact(const WorldSettings& settings, const Candidate& candidate) {
  const fracture::FractureSettings how = how_to_decide(settings, candidate);
  EvaluatedImpact impact;
  impact.id = candidate.body->id;
  impact.hardest = candidate.hardest;
  impact.is_struck = candidate.is_struck;
  impact.first_time = candidate.first_time;
  impact.has_used_all = candidate.has_used_all;
  for (const Load& load : candidate.loads)
    if (load.other == candidate.hardest.other) impact.charged += load.impulse_body.norm();
  if (const auto* shell = std::get_if<fracture::ShellSubject>(&candidate.fragile->subject))
    impact.decision = fracture::decide_shell(*shell, candidate.impact, how);
  else if (const auto* solid = std::get_if<fracture::SolidSubject>(&candidate.fragile->subject))
    impact.decision = fracture::decide_solid(*solid, candidate.impact, how);
  give_up_factors(impact, candidate);
  return impact;
}

/// What later steps are to know of it.
void remember(const EvaluatedImpact& impact, Candidate& candidate, ImpactMemory& memory,
              BorneImpacts& borne) {
  const fracture::DecisionFigures& decision = impact.figures();
  const double ratio = decision.verdict.most_ratio();
  const double duration = impact.is_struck ? decision.verdict.duration : 0.0;
  const double tested_growth =
      ratio < 1.0 ? std::min(kContactGrowth, 1.0 / std::max(ratio, 1e-300)) : kBorneAgain;
  const bool holds = decision.verdict.outcome == fracture::Outcome::held || impact.is_cracked_only();
  if (impact.has_used_all)
    borne[impact.id] = {std::move(candidate.loads), kUsedAgain, duration, tested_growth, true};
  else if (holds && !has_yielded(decision.verdict))
    borne[impact.id] = {std::move(candidate.loads), most_growth_of(decision.verdict), duration, tested_growth,
                        false};
  if (!decision.needed_no_solve()) {
    memory.solved_contact = holds && !impact.is_cracked_only() ? candidate.contact_force : 0.0;
    memory.solved_ratio = ratio;
  }
  if (impact.is_struck) await_dent(impact, *candidate.body, memory);
  if (const fracture::Perforation* asked = find_perforation(impact); asked && !asked->is_through())
    for (Load& load : memory.event) load.was_asked = true;
  keep_verdict(duration, tested_growth, memory);
}

}  // namespace

double borne_at_rest(const body::Body& body, const Fragile& fragile, const ImpactMemory& memory) {
  const double harmless = material::borne_tension(fragile.material()) / bending_bound(body, 1.0);
  return std::max(harmless, memory.tested_growth * memory.tested_contact);
}

std::vector<EvaluatedImpact> evaluate_stress(const std::vector<body::Body>& bodies,
                                             const body::ImpulseLog& log, const Fragiles& fragiles,
                                             const WorldSettings& settings,
                                             const dynamics::ContactSettings& contact, double time,
                                             std::map<body::BodyId, ImpactMemory>& memories,
                                             BorneImpacts& borne, EvaluationFigures& figures,
                                             const PartBegin* begin) {
  const Judge judge{bodies, memories, settings, contact, begin, log};
  std::vector<Candidate> candidates = gather_candidates(judge, fragiles, time, memories, borne, figures);
  std::vector<EvaluatedImpact> evaluated(candidates.size());
  core::parallel_for(candidates.size(), 1,
                     [&](std::size_t i) { evaluated[i] = judge_impact(settings, candidates[i]); });
  for (std::size_t i = 0; i < evaluated.size(); ++i) {
    remember(evaluated[i], candidates[i], memories[evaluated[i].id], borne);
    const fracture::DecisionFigures& decision = evaluated[i].figures();
    figures.solves += decision.generations;
    figures.factorisations += decision.factorisations;
    if (decision.needed_no_solve()) ++figures.skipped;
    figures.worst_residual = std::max(figures.worst_residual, decision.residual);
  }
  return evaluated;
}

}  // namespace shatterbox::world
