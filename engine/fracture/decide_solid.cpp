#include "engine/fracture/decide_solid.h"

#include <algorithm>
#include <map>
#include <optional>

#include "engine/core/clock.h"
#include "engine/core/disjoint_sets.h"
#include "engine/core/hash.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/fracture/solid_bridges.h"
#include "engine/fracture/solid_core.h"
#include "engine/fracture/solid_force.h"
#include "engine/fracture/solid_hole.h"
#include "engine/fracture/solid_tracer.h"
#include "engine/fracture/split_solid.h"
#include "engine/fracture/torn_solid.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kToldSize = 1.5;  // of the elements, is the least that they can tell of a crack
constexpr double kSolidGrowthThatCounts =
    0.04;  // of the cracks' area: a generation that adds less is the last

constexpr double kLeastLump = 0.5;  // of the cube of that, is what parts from bridges

// Of what a hit does not give back: more does not go into tears, for what they open flows before.
constexpr double kTornShare = 0.5;

// Where a crack came to nothing, none is begun again before the stress is so many times as great.
constexpr double kSolidTriedAgain = 1.25;

class SolidDecider {
 public:
  SolidDecider(const SolidSubject& subject, const Impact& impact, const FractureSettings& settings)
      : subject_(prepared(subject)),
        impact_(impact),
        settings_(settings),
        crack_cost_(crack_cost_of(subject_)),
        force_(subject_, impact, settings) {}

  SolidDecision decide() {
    Verdict& verdict = decision_.verdict;
    if (!force_.prepare(verdict.reason)) return std::move(decision_);
    verdict.impulse = force_.hardest().load->impulse;
    verdict.place = force_.hardest().load->point_material;
    if (const auto bound = force_.harmless_bound()) {
      verdict.outcome = Outcome::held;
      verdict.reason = "bound";
      verdict.stress = bound->stress;
      verdict.strength = bound->strength;
      verdict.ratio = bound->stress / bound->strength;
      return std::move(decision_);
    }
    if (!force_.settle(decision_, verdict.reason)) return std::move(decision_);
    verdict.duration = force_.duration();
    verdict.force = force_.hardest().first_force;
    solve_stresses(true);
    std::vector<SolidCandidate> candidates = find_candidates(*subject_.complex, true);
    if (take_hole()) {
      take_dent(decision_.perforation->momentum_share());
      return std::move(decision_);
    }
    leave_to_dent(candidates);
    if (!(verdict.ratio > 1.0) || candidates.empty()) {
      verdict.outcome = Outcome::held;
      take_dent();
      return std::move(decision_);
    }
    tell_yield();
    force_.book_energy(decision_);
    if (subject_.material.yield > 0.0)
      decision_.elastic_energy = std::min(decision_.elastic_energy, kTornShare * force_.struck_energy().most);
    run_generations(std::move(candidates));
    if (verdict.outcome == Outcome::broke)
      open_tears();
    else
      take_dent();
    return std::move(decision_);
  }

 private:
  static SolidSubject prepared(SolidSubject subject) {
    prepare_subject(subject);
    return subject;
  }
  const SolidModel& model() const { return *subject_.model; }
  /// J/m2. Beside a crack in what yields a neck as wide as the body is thick is drawn out to the elongation,
  /// which takes the most of what a tear takes [CR77].
  static double crack_cost_of(const SolidSubject& subject) {
    const material::Material& material = subject.material;
    const bool draws_neck = material.yield > 0.0 && subject.model;
    return material.fracture_energy +
           (draws_neck ? material.yield * material.elongation * subject.model->width : 0.0);
  }

  /// The least stress that an element bears, Pa: its weakest flaw's, or that of sound material.
  double weakest_of(int element) const {
    const SolidFlawField& flaws = *subject_.flaws;
    const auto own = flaws.of_element(element);  // the weakest comes first
    return own.empty() ? flaws.greatest_strength : std::min(own.front().strength, flaws.greatest_strength);
  }

  /// Stress at the pulse's peak under all loads together, averaged once, and its first principal values: of
  /// later generations a bound of them where that is borne.
  void solve_stresses(bool is_first) {
    const geometry::SolidMesh& mesh = force_.mesh();
    const std::vector<geometry::SolidContact>& contacts = force_.contacts();
    ++decision_.generations;
    stresses_ = stress::average_stresses(
        mesh, contacts, stress::cell_stresses(*model().stiffness, mesh, force_.displacement()));
    tensions_.resize(stresses_.size());
    core::parallel_for(stresses_.size(), 1024, [&](Size c) {
      tensions_[c] = stress::most_tension(stresses_[c]);
      if (is_first || tensions_[c] > weakest_of(mesh.cells[c].element))
        tensions_[c] = stress::principal_axes(stresses_[c]).values(0);
    });
    core::DisjointSets pieces(mesh.cells.size());
    for (const geometry::SolidContact& contact : contacts) pieces.unite(contact.cell_a, contact.cell_b);
    pieces_.resize(mesh.cells.size());
    for (Size c = 0; c < pieces_.size(); ++c) pieces_[c] = pieces.find(static_cast<int>(c));
  }

  /// Flaws under more stress than they bear; and, for the verdict, the worst of all. Sound material breaks
  /// too, but of places in it there are as many as cells: they count only where no flaw does.
  std::vector<SolidCandidate> find_candidates(const geometry::SolidComplex& complex, bool is_first) {
    const SolidFlawField& flaws = *subject_.flaws;
    Verdict& verdict = decision_.verdict;
    std::vector<SolidCandidate> candidates, sound;
    std::vector<int> cells_in(complex.elements->mesh.tetrahedra.size(), 0);
    for (const geometry::SolidPart& cell : complex.cells) ++cells_in[at(cell.element)];
    if (is_first) decision_.element_stress.assign(cells_in.size(), 0.0);
    const auto consider = [&](std::vector<SolidCandidate>& found, Size cell, const Vec3& place,
                              double strength, int number) {
      const double overload = tensions_[cell] / strength;
      if (is_first && overload > verdict.ratio) {
        verdict.ratio = overload;
        verdict.stress = tensions_[cell];
        verdict.strength = strength;
        verdict.place = place;
      }
      if (overload > 1.0) found.push_back({static_cast<int>(cell), place, strength, overload, number});
    };
    for (Size c = 0; c < tensions_.size(); ++c) {
      const geometry::SolidPart& part = complex.cells[c];
      if (is_first) {
        double& here = decision_.element_stress[at(part.element)];
        here = std::max(here, tensions_[c]);
      }
      if (!(tensions_[c] > weakest_of(part.element) * (is_first ? std::min(1.0, verdict.ratio) : 1.0)))
        continue;
      // Of an element that the surface or a crack goes through, only what lies in the cell counts.
      const auto own_flaws = flaws.of_element(part.element);
      const bool is_whole = !own_flaws.empty() && cells_in[at(part.element)] == 1 && model().is_full(part);
      bool has_flaw = false;
      for (const SolidFlaw& flaw : own_flaws) {
        if (!is_whole && !cell_holds(complex, static_cast<int>(c), flaw.place)) continue;
        has_flaw = true;
        consider(candidates, c, flaw.place, flaw.strength, static_cast<int>(&flaw - flaws.flaws.data()));
      }
      const bool counts =
          tensions_[c] > flaws.greatest_strength * (is_first ? std::min(1.0, verdict.ratio) : 1.0);
      if (!has_flaw && counts && part.volume > 0.0)
        consider(sound, c, cell_centre(complex, part), flaws.greatest_strength,
                 static_cast<int>(flaws.flaws.size() + c));
    }
    return candidates.empty() ? sound : candidates;
  }

  /// The stress by which what yields is judged.
  void tell_yield() {
    if (!(subject_.material.yield > 0.0)) return;
    decision_.verdict.von_mises = greatest_von_mises(model(), force_.struck_displacement());
    decision_.verdict.yield = subject_.material.yield;
  }

  /// Of a hit that gives the body that share of its momentum: a plate that is gone through is dished as by
  /// one that it holds and that gives it as much.
  void take_dent(double share = 1.0) {
    const material::Material& material = subject_.material;
    if (!(material.yield > 0.0)) return;
    const double energy = share * share;
    const DentEnergy struck = force_.struck_energy();
    const DentEnergy brought{energy * struck.all, energy * struck.most};
    const VecX displacement = share * force_.struck_displacement();
    YieldFinding finding = has_open_cracks(*subject_.complex) && !decision_.perforates()
                               ? find_yield(torn(subject_.complex), material, displacement, brought)
                               : find_yield(subject_.model, material, displacement, brought);
    decision_.verdict.von_mises = finding.stress / share;
    decision_.verdict.yield = material.yield;
    decision_.dent = std::move(finding.dent);
  }

  /// Whether the one who strikes hardest goes through: then his hole is all that breaks.
  bool take_hole() {
    const Striker* hardest = hardest_striker(force_.presses());
    if (!hardest || !(subject_.material.yield > 0.0)) return false;
    const std::optional<SolidHole> found = find_perforation(*subject_.complex, subject_.material, *hardest,
                                                            settings_.least_width, subject_.first_cut_id);
    if (!found) return false;
    decision_.perforation = std::make_shared<const Perforation>(*found);
    if (!found->is_through()) return false;
    decision_.verdict.outcome = Outcome::broke;
    decision_.complex = found->complex;
    decision_.part_count = found->part_count;
    decision_.cracks = 1;
    decision_.new_area = found->wall_area;
    decision_.fracture_energy = found->needed;
    decision_.elastic_energy = found->there;
    return true;
  }

  /// The solid that was solved last, with its cracks.
  std::shared_ptr<const TornSolid> torn(std::shared_ptr<const geometry::SolidComplex> complex) const {
    const material::Material& material = subject_.material;
    return make_torn(std::move(complex), force_.mesh(), {material.young, material.poisson, material.density},
                     subject_.clamped_vertices);
  }

  /// What has torn in this event goes on to flow.
  void leave_to_dent(std::vector<SolidCandidate>& candidates) {
    if (!impact_.has_torn || candidates.empty()) return;
    candidates.clear();
    decision_.verdict.reason = "it has torn";
  }

  /// Whether what came off is too little to be a piece: then it holds on to the whole again.
  bool join_crumbs() {
    SolidSplit split = split_solid(*decision_.complex, settings_.least_width);
    if (split.pieces.size() != 1) return false;
    decision_.complex = std::make_shared<geometry::SolidComplex>(std::move(split.pieces.front().complex));
    decision_.part_count = 1;
    return true;
  }

  /// What tears and stays in one piece is dented as it is by then, by what the tears leave of the hit.
  void open_tears() {
    if (!(subject_.material.yield > 0.0)) return;
    if (decision_.part_count != count_parts(*subject_.complex) && !join_crumbs()) return;
    const int generations = decision_.generations;
    const bool is_known = is_answered_ && (is_solved_ || solve_again(*decision_.complex));
    decision_.generations = generations;
    if (!is_known) return;
    DentEnergy struck = force_.struck_energy();
    const double left = std::max(0.0, struck.most - decision_.fracture_energy);
    struck.all *= struck.most > 0.0 ? left / struck.most : 0.0;
    struck.most = left;
    decision_.dent =
        find_yield(torn(decision_.complex), subject_.material, force_.struck_displacement(), struck).dent;
  }

  SolidTracerSetup tracer_setup() {
    SolidTracerSetup setup;
    setup.solved = {&force_.mesh(), &force_.displacement()};
    setup.guides.stresses = &stresses_;
    setup.guides.pieces = &pieces_;
    setup.guides.turns = turns_.get();
    if (!trees_) trees_.emplace(model().stiffness->vertex_rank.of(*model().mesh.elements));
    setup.guides.trees = &*trees_;
    setup.guides.strength = subject_.material.strength;
    setup.material = &subject_.material;
    setup.fracture_energy = crack_cost_;
    setup.grains = subject_.grains.get();
    for (const SolidPress& press : force_.presses())
      setup.centres.push_back({press.contact.point, press.contact.radius});
    setup.least_size = kToldSize * model().mean_edge_length;
    setup.energy_budget = settings_.has_energy_guard ? energy_left() : -1.0;
    setup.resting_share = force_.resting_share();
    setup.first_id = subject_.first_cut_id + decision_.cracks;
    return setup;
  }

  /// A guide for those that come to nothing again would be made in vain.
  void leave_out_stillborn(std::vector<SolidCandidate>& candidates) const {
    std::erase_if(candidates, [this](const SolidCandidate& c) {
      const auto before = stillborn_.find(c.number);
      return before != stillborn_.end() && c.overload < kSolidTriedAgain * before->second;
    });
  }

  /// The cracked complex. Where that has no answer, what it has cracked by then is the decision.
  bool solve_again(const geometry::SolidComplex& complex) {
    is_answered_ = force_.settle_again(find_form(complex), origins_, decision_, decision_.verdict.reason);
    if (is_answered_) solve_stresses(false);
    return is_answered_;
  }

  /// False if it was the last.
  bool run_generation(std::vector<SolidCandidate> candidates) {
    const auto start = core::Clock::now();
    SolidTracer tracer(*complex_, tracer_setup());
    tracer.resume(cracks_);
    leave_out_stillborn(candidates);
    tracer.nucleate(std::move(candidates), cracks_);
    for (const SolidCandidate& c : tracer.stillborn()) stillborn_[c.number] = c.overload;
    decision_.generation_bound_active = false;
    decision_.energy_guard_active = decision_.energy_guard_active || tracer.is_out_of_energy();
    is_solved_ = !(tracer.area() > 0.0);
    if (is_solved_) return false;
    settle(*complex_);
    origins_ = tracer.origins();
    decision_.cracks += tracer.crack_count();
    decision_.new_area += tracer.area();
    decision_.grain_area += tracer.grain_area();
    decision_.fracture_energy += tracer.energy();
    decision_.elastic_energy += tracer.given();
    decision_.trace_ms += core::milliseconds_since(start);
    return !tracer.is_out_of_energy() && tracer.area() >= kSolidGrowthThatCounts * decision_.new_area;
  }

  /// What is cracked through but for what the elements cannot tell of hangs by that. False if that holds.
  bool break_bridges() {
    if (!is_answered_) return false;
    const int generations = decision_.generations;
    is_solved_ = is_solved_ || solve_again(*complex_);
    decision_.generations = generations;
    if (!is_solved_) return false;
    const double size = kToldSize * model().mean_edge_length;
    const double area = part_bridges(*complex_, {.contacts = &force_.contacts(),
                                                 .tensions = &tensions_,
                                                 .strength = subject_.flaws->greatest_strength,
                                                 .least_volume = kLeastLump * size * size * size,
                                                 .most_area = most_area(),
                                                 .id = subject_.first_cut_id + decision_.cracks});
    if (!(area > 0.0)) return false;
    ++decision_.cracks;
    decision_.new_area += area;
    decision_.fracture_energy += crack_cost_ * area;
    return true;
  }

  /// J of the event that cracks may still spend.
  double energy_left() const { return std::max(0.0, decision_.elastic_energy - decision_.fracture_energy); }

  /// Area that the energy left allows, m2.
  double most_area() const {
    return settings_.has_energy_guard && crack_cost_ > 0.0 ? energy_left() / crack_cost_ : 1e300;
  }

  /// What is pressed by more than it bears is crushed, where the elements can tell of that. False if nothing
  /// is.
  bool crush_cores() {
    if (!(settings_.core_spacing > 0.0) || subject_.material.yield > 0.0) return false;
    const auto start = core::Clock::now();
    SolidCoreSetup setup;
    for (const SolidPress& press : force_.presses()) {
      if (!is_collision(*press.load)) continue;
      const double radius = crushed_disc_radius(press.first_force, subject_.material.strength);
      if (radius >= kToldSize * model().mean_edge_length)
        setup.cores.push_back({press.contact.point, radius});
    }
    setup.least_size = model().mean_edge_length;
    setup.most_area = most_area();
    setup.seed = core::mix(subject_.seed + 0x636f7265);
    setup.id = subject_.first_cut_id + decision_.cracks;
    const CrushedSolid crushed = crush(*complex_, setup);
    decision_.trace_ms += core::milliseconds_since(start);
    decision_.energy_guard_active = decision_.energy_guard_active || crushed.is_out_of_energy;
    if (!(crushed.area > 0.0)) return false;
    ++decision_.cracks;
    decision_.core_cells = crushed.cells;
    decision_.new_area += crushed.area;
    decision_.fracture_energy += subject_.material.fracture_energy * crushed.area;
    return true;
  }

  void run_generations(std::vector<SolidCandidate> candidates) {
    turns_ = subject_.kept_turns->of(model().mesh.elements, model().size, settings_.waviness, subject_.seed);
    complex_ = std::make_shared<geometry::SolidComplex>(*subject_.complex);
    for (int generation = 0; generation < settings_.most_generations; ++generation) {
      if (generation > 0) {
        if (!solve_again(*complex_)) break;
        candidates = find_candidates(*complex_, false);
      }
      if (!run_generation(std::move(candidates))) break;
      decision_.generation_bound_active = generation + 1 == settings_.most_generations;
    }
    int parts = count_parts(*complex_);
    if (parts == count_parts(*subject_.complex) && break_bridges()) parts = count_parts(*complex_);
    if (decision_.cracks == 0) {
      // Every overloaded flaw lay where no cut is possible, or there was no energy for one.
      decision_.verdict.outcome = Outcome::held;
      decision_.verdict.reason =
          decision_.energy_guard_active ? "no energy for a crack" : "no crack could start";
      return;
    }
    if (crush_cores()) parts = count_parts(*complex_);
    decision_.verdict.outcome = Outcome::broke;
    decision_.part_count = parts;
    decision_.complex = std::move(complex_);
  }

  const SolidSubject subject_;
  const Impact& impact_;
  const FractureSettings& settings_;
  const double crack_cost_;  // J/m2
  SolidForce force_;
  SolidDecision decision_;
  std::shared_ptr<const CrackTurns> turns_;
  std::optional<GuideTrees> trees_;
  std::vector<stress::SolidStress> stresses_;  // of this generation, per cell
  std::vector<double> tensions_;               // their first principal values
  std::vector<int> pieces_;                    // that its cells are in
  std::vector<OpenCrack> cracks_;              // of this decision
  std::shared_ptr<geometry::SolidComplex> complex_;
  std::vector<int> origins_;         // |cells|: those of the mesh last solved that they were part of
  bool is_solved_ = false;           // the complex as it is
  bool is_answered_ = true;          // the solve before
  std::map<int, double> stillborn_;  // overload by candidate's number, where no crack came of it
};

}  // namespace

void prepare_subject(SolidSubject& subject) {
  if (!subject.complex) return;
  const material::Material& material = subject.material;
  if (!subject.stiffness)
    subject.stiffness = stress::make_solid_stiffness(subject.complex->elements,
                                                     {material.young, material.poisson, material.density});
  if (!subject.model && subject.kept_model) subject.model = subject.kept_model->find();
  if (!subject.model) {
    subject.model = make_solid_model(subject.complex, subject.stiffness, subject.clamped_vertices);
    if (subject.kept_model) subject.kept_model->keep(subject.model);
  }
  if (!subject.flaws)
    subject.flaws = std::make_shared<const SolidFlawField>(
        draw_solid_flaws(*subject.complex->elements, material, subject.seed));
  if (!subject.kept_turns) subject.kept_turns = std::make_shared<KeptCrackTurns>();
}

void prepare_cracks(const SolidSubject& subject) {
  SolidSubject whole = subject;
  prepare_subject(whole);
  whole.stiffness->vertex_rank.of(*whole.complex->elements);
  whole.kept_turns->of(whole.complex->elements, whole.model->size, FractureSettings{}.waviness, whole.seed);
}

SolidDecision decide_solid(const SolidSubject& subject, const Impact& impact,
                           const FractureSettings& settings) {
  return SolidDecider(subject, impact, settings).decide();
}

}  // namespace shatterbox::fracture
