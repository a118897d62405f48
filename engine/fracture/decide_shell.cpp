#include "engine/fracture/decide_shell.h"

#include <algorithm>

#include "engine/core/clock.h"
#include "engine/core/hash.h"
#include "engine/core/index.h"
#include "engine/fracture/cell_flaws.h"
#include "engine/fracture/crack_tracer.h"
#include "engine/fracture/crushed_core.h"
#include "engine/fracture/dice.h"
#include "engine/fracture/impact_force.h"
#include "engine/fracture/shell_dent.h"
#include "engine/fracture/shell_hole.h"
#include "engine/fracture/shell_subject.h"
#include "engine/fracture/split_shell.h"
#include "engine/material/tempering.h"
#include "engine/stress/shell_stress.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kCoreOverload = 5.0;       // stress over strength above which the core is crushed
constexpr double kCoreReach = 6.0;          // patch radii
constexpr double kMostCoreCells = 40.0;     // across a core's radius
constexpr double kCurvatureReach = 2.0;     // patch radii, about which the curvature is taken
constexpr double kMostDice = 20000.0;       // of one sheet: of more nothing could be made
constexpr double kFlat = 1e6;               // body sizes: a greater radius of curvature is none
constexpr double kWaveLength = 0.14;        // of the paths' noise, share of the body's size
constexpr double kGrowthThatCounts = 0.04;  // of the cracks' length: a generation that adds less is the last

using core::Clock;
using core::milliseconds_since;

class Decider {
 public:
  Decider(const ShellSubject& subject, const ShellImpact& impact, const FractureSettings& settings)
      : subject_(prepared(subject)),
        impact_(impact),
        settings_(settings),
        force_(subject_, impact, settings) {}

  Decision decide() {
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
    mesh_ = subject_.mesh;
    const auto is_enough = may_estimate() ? [this] { return is_plainly_borne(); } : ImpactForce::IsEnough();
    if (!force_.settle(is_enough, decision_, verdict.reason)) return std::move(decision_);
    verdict.duration = force_.duration();
    verdict.force = force_.hardest().first_force;
    const bool is_over = is_overloaded();
    note_struck();
    if (!take_hole() && is_over && !leave_to_dent()) {
      force_.complete(decision_);
      run_generations();
    }
    take_dent();
    return std::move(decision_);
  }

 private:
  static ShellSubject prepared(ShellSubject subject) {
    prepare_subject(subject);
    return subject;
  }

  const geometry::ShellElements& elements() const { return *subject_.mesh->elements; }
  double size() const { return subject_.systems->figures().size; }
  const std::vector<geometry::CellContact>& contacts() const {
    return mesh_ == subject_.mesh ? subject_.systems->figures().contacts : contacts_;
  }

  /// Stress at the pulse's peak under all loads together, averaged once; and its slope, for the flaws.
  void solve_stresses() {
    ++decision_.generations;
    decision_.residual = std::max(decision_.residual, force_.residual());
    fits_ = stress::fit_stresses(
        *mesh_, contacts(),
        stress::cell_stresses(subject_.systems->stiffness(), *mesh_, force_.displacement()));
    int piece_count = 0;
    pieces_ = label_pieces(mesh_->cells.size(), contacts(), piece_count);
    stresses_.clear();
    for (const stress::LinearStress& fit : fits_) stresses_.push_back(fit.mean);
  }

  /// What yields is dented by the hit as it is, and snapshots are taken at times of their own.
  bool may_estimate() const {
    return settings_.may_estimate && !(subject_.material.yield > 0.0) && !impact_.given_duration &&
           !are_snapshots(impact_);
  }

  /// Whether it holds, however far an estimate falls short.
  bool is_plainly_borne() {
    const Verdict before = decision_.verdict;
    solve_stresses();
    find_candidates(true);
    decision_.verdict.is_estimate = true;
    if (decision_.verdict.most_ratio() < 1.0) return true;
    decision_.verdict = before;
    decision_.generations = 0;
    return false;
  }

  /// The first solve's verdict: held, unless a flaw bears more than it can.
  bool is_overloaded() {
    if (!decision_.verdict.is_estimate) {
      solve_stresses();
      candidates_ = find_candidates(true);
    }
    note_element_stress(stresses_);
    if (decision_.verdict.ratio > 1.0) return true;
    decision_.verdict.outcome = Outcome::held;
    decision_.tips = subject_.tips;
    return false;
  }

  /// What a dent comes of, before anything cracks.
  void note_struck() {
    if (!(subject_.material.yield > 0.0)) return;
    struck_displacement_ = force_.struck_displacement(decision_);
    struck_energy_ = force_.struck_energy();
    yield_ = find_yield(subject_, struck_displacement_, struck_energy_);
  }

  /// Whether the one who strikes hardest goes through: then his hole is all that breaks.
  bool take_hole() {
    if (!(subject_.material.yield > 0.0)) return false;
    const Striker* hardest = hardest_striker(force_.presses());
    if (!hardest) return false;
    std::optional<ShellHole> found =
        find_perforation(subject_, *hardest, settings_.least_width, first_crack());
    if (!found) return false;
    decision_.perforation = std::make_shared<const Perforation>(*found);
    if (!found->is_through()) return false;
    decision_.verdict.outcome = Outcome::broke;
    decision_.mesh = std::move(found->mesh);
    decision_.contacts = std::move(found->contacts);
    decision_.segments = std::move(found->segments);
    decision_.tips = subject_.tips;
    decision_.cracks = 1;
    decision_.new_area = found->wall_area;
    decision_.fracture_energy = found->needed;
    decision_.elastic_energy = found->there;
    return true;
  }

  /// As of solids: under a striker who does not go through metal flows, and no crack starts; nor where flow
  /// takes up all of the energy, whoever brings it.
  bool leave_to_dent() {
    if (!decision_.perforation && !was_asked(impact_) && !yield_.takes_all) return false;
    decision_.verdict.outcome = Outcome::held;
    decision_.verdict.reason = yield_.takes_all ? "metal flows before it cracks" : "it is not gone through";
    decision_.tips = subject_.tips;
    return true;
  }

  /// What tears does not keep the shape in which it tore; what is gone through is dished as by a hit that it
  /// holds and that gives it as much momentum.
  void take_dent() {
    if (struck_displacement_.size() == 0) return;
    decision_.verdict.von_mises = yield_.stress;
    decision_.verdict.yield = subject_.material.yield;
    if (decision_.verdict.outcome == Outcome::held) decision_.dent = std::move(yield_.dent);
    if (!decision_.perforation || !decision_.perforation->is_through()) return;
    const double share = decision_.perforation->momentum_share(), energy = share * share;
    decision_.dent = find_yield(subject_, share * struck_displacement_,
                                {energy * struck_energy_.all, energy * struck_energy_.most})
                         .dent;
  }

  int first_crack() const {
    int first = 0;
    for (const CrackTip& tip : subject_.tips) first = std::max(first, tip.crack + 1);
    return first;
  }

  /// Flaws under more stress than they bear; and, for the verdict, the worst of all.
  std::vector<Candidate> find_candidates(bool is_first) {
    const geometry::ShellMesh& mesh = *mesh_;
    const FlawField& flaws = *subject_.flaws;
    // Cracks start where flaws are, which are the same on every mesh. Sound material breaks too, but of
    // places in it there are as many as cells: they count only for a piece that has no flaw of its own.
    std::vector<Candidate> candidates, sound;
    Verdict& verdict = decision_.verdict;
    const auto consider = [&](std::vector<Candidate>& found, Size cell, const Vec2& place, double tension,
                              double flaw_strength, int number) {
      const int element = mesh.cells[cell].element;
      const double strength = flaw_strength + subject_.material.surface_compression;
      const double overload = tension / strength;
      if (is_first && overload > verdict.ratio) {
        verdict.ratio = overload;
        verdict.stress = tension;
        verdict.strength = strength;
        verdict.place = position_in_element(elements(), element, place);
      }
      if (overload > 1.0) found.push_back({element, place, overload, number, pieces_[cell]});
    };
    for (Size c = 0; c < mesh.cells.size(); ++c) {
      const int element = mesh.cells[c].element;
      const Mat3 frame = geometry::facet_frame(elements(), element);
      bool has_flaw = false;
      for (const Flaw& flaw : flaws.of_element(element)) {
        if (!cell_holds(mesh, mesh.cells[c], flaw.barycentric)) continue;
        has_flaw = true;
        const Vec2 place = stress::place_in_frame(elements(), element, frame, flaw.barycentric);
        const double tension = stress::worst_stress(fits_[c].at(place)).principal.first;
        consider(candidates, c, flaw.barycentric, tension, flaw.strength,
                 static_cast<int>(&flaw - flaws.flaws.data()));
      }
      if (has_flaw) continue;
      Vec2 middle = Vec2::Zero();
      const int corners = mesh.cells[c].corner_count;
      for (int i = 0; i < corners; ++i)
        middle += mesh.corners[at(mesh.cells[c].first_corner + i)].barycentric;
      const double tension = stress::worst_stress(fits_[c].mean).principal.first;
      consider(sound, c, middle / corners, tension, flaws.greatest_strength,
               static_cast<int>(flaws.flaws.size()) + static_cast<int>(c));
    }
    return candidates.empty() ? sound : candidates;
  }

  TracerSetup tracer_setup(int generation) const {
    TracerSetup setup;
    setup.planes = &*planes_;
    setup.stresses = &stresses_;
    setup.material = &subject_.material;
    setup.grains = subject_.grains.get();
    setup.noise = &*noise_;
    setup.centres = centres_;
    setup.thickness = subject_.thickness;
    setup.energy_budget = settings_.has_energy_guard
                              ? std::max(0.0, decision_.elastic_energy - decision_.fracture_energy)
                              : -1.0;
    setup.generation = generation;
    setup.first_crack = next_crack_;
    return setup;
  }

  /// sqrt(R t), m, from how much the normals about a load differ from the one at it.
  double bending_length(const ContactPress& press) const {
    std::vector<double> distances_squared(elements().mesh.triangles.size());
    for (Size t = 0; t < distances_squared.size(); ++t) {
      const Vec3 middle =
          geometry::position_in_element(elements(), static_cast<int>(t), Vec2(1.0 / 3.0, 1.0 / 3.0));
      distances_squared[t] = (middle - press.point).squaredNorm();
    }
    const auto nearest = std::min_element(distances_squared.begin(), distances_squared.end());
    const ElementPlane& here = planes_->of(static_cast<int>(nearest - distances_squared.begin()));
    const double reach = kCurvatureReach * std::max(press.radius, core::sqrt(*nearest));
    double turn = 0.0, way = 0.0;
    for (Size t = 0; here.scale > 0.0 && t < distances_squared.size(); ++t) {
      if (distances_squared[t] > reach * reach) continue;
      const ElementPlane& plane = planes_->of(static_cast<int>(t));
      if (!(plane.scale > 0.0)) continue;
      turn += (plane.frame.col(2) - here.frame.col(2)).norm();
      way += (plane.middle() - here.middle()).norm();
    }
    const double flattest = kFlat * size();
    return core::sqrt(subject_.thickness * (way < flattest * turn ? way / turn : flattest));
  }

  void run_generations() {
    planes_.emplace(elements());
    for (const Press& press : force_.presses())
      centres_.push_back({press.contact.point, press.contact.radius, bending_length(press.contact)});
    noise_.emplace(kWaveLength * size(), settings_.waviness, subject_.seed);
    next_crack_ = first_crack();
    std::vector<CrackTip> tips = subject_.tips;
    for (int generation = 0; generation < settings_.most_generations; ++generation) {
      if (generation > 0) {
        if (!force_.settle_again(*mesh_, contacts_, decision_, decision_.verdict.reason)) break;
        solve_stresses();
        candidates_ = find_candidates(false);
      }
      const auto start = Clock::now();
      ShellCutter cutter(*mesh_);
      CrackTracer tracer(cutter, tracer_setup(generation));
      tracer.resume(tips, pieces_);
      tracer.nucleate(std::move(candidates_));
      decision_.generation_bound_active = false;
      if (!take_over(tracer, tips)) break;
      mesh_ = std::make_shared<const geometry::ShellMesh>(cutter.mesh(&contacts_));
      decision_.trace_ms += milliseconds_since(start);
      if (tracer.is_out_of_energy() || tracer.energy() < kGrowthThatCounts * decision_.fracture_energy) break;
      decision_.generation_bound_active = generation + 1 == settings_.most_generations;
    }
    conclude(std::move(tips));
  }

  /// Books what a generation did; false if no crack grew.
  bool take_over(const CrackTracer& tracer, std::vector<CrackTip>& tips) {
    decision_.energy_guard_active = decision_.energy_guard_active || tracer.is_out_of_energy();
    if (tracer.segments().empty()) return false;
    decision_.segments.insert(decision_.segments.end(), tracer.segments().begin(), tracer.segments().end());
    decision_.fracture_energy += tracer.energy();
    next_crack_ += tracer.crack_count();
    decision_.cracks += tracer.crack_count();
    tips = tracer.open_tips();
    return true;
  }

  void note_element_stress(const std::vector<stress::CellStress>& stresses) {
    decision_.element_stress.assign(elements().mesh.triangles.size(), 0.0);
    for (Size c = 0; c < stresses.size(); ++c) {
      double& here = decision_.element_stress[at(subject_.mesh->cells[c].element)];
      here = std::max(here, stress::worst_stress(stresses[c]).principal.first);
    }
  }

  /// Breaks the crushed cores out of a copy of the cracked mesh, if there are any.
  void crush() {
    std::vector<double> overloads = decision_.element_stress;
    for (double& overload : overloads) overload /= kCoreOverload * material::borne_tension(subject_.material);
    std::vector<CrushedCore> cores;
    for (Size i = 0; i < force_.presses().size(); ++i) {
      const Press& press = force_.presses()[i];
      if (!is_collision(*press.load)) continue;
      CrushedCore core;
      core.centre = press.contact.point;
      core.patch_radius = press.contact.radius;
      core.radius = crushed_radius(elements(), overloads, core.centre, kCoreReach * core.patch_radius);
      if (!(core.radius > 0.0)) continue;
      // A core that is very wide against the thickness has coarser cells: of more nothing could be made.
      core.cell_size = std::max(settings_.core_spacing * subject_.thickness, core.radius / kMostCoreCells);
      core.seed = core::mix(subject_.seed + i + 0x636f7265);
      cores.push_back(core);
    }
    if (cores.empty()) return;
    CoreSetup setup;
    int piece_count = 0;
    setup.pieces = label_pieces(mesh_->cells.size(), contacts_, piece_count);
    ShellCutter cutter(*mesh_);
    for (CoreGroup& group : group_cores(elements(), cores)) {
      setup.group = std::move(group);
      setup.crack = next_crack_;
      setup.generation = decision_.generations;
      if (settings_.has_energy_guard)
        setup.most_length = std::max(0.0, decision_.elastic_energy - decision_.fracture_energy) /
                            (subject_.material.fracture_energy * subject_.thickness);
      const CellCracks crushed = crush_cores(cutter, *planes_, setup);
      take_over(crushed);
      decision_.core_cells += crushed.cells;
    }
    mesh_ = std::make_shared<const geometry::ShellMesh>(cutter.mesh(&contacts_));
  }

  void take_over(const CellCracks& cut) {
    decision_.energy_guard_active = decision_.energy_guard_active || cut.is_out_of_energy;
    if (cut.cells == 0) return;
    ++next_crack_;
    decision_.fracture_energy += cut.length * subject_.material.fracture_energy * subject_.thickness;
    decision_.segments.insert(decision_.segments.end(), cut.segments.begin(), cut.segments.end());
  }

  /// What is stored in the sheet breaks all of it into dice, paid for by itself.
  void dice(double die_area) {
    double area = 0.0;
    for (const geometry::ShellCell& cell : mesh_->cells) area += cell.area;
    ShellCutter cutter(*mesh_);
    const CellCracks cut = cut_dice(cutter, *planes_,
                                    {std::max(die_area, area / kMostDice), next_crack_, decision_.generations,
                                     core::mix(subject_.seed + 0x64696365)});
    if (cut.cells == 0) return;
    take_over(cut);
    decision_.dice = cut.cells;
    decision_.elastic_energy += area * material::stored_energy(subject_.material, subject_.thickness);
    mesh_ = std::make_shared<const geometry::ShellMesh>(cutter.mesh(&contacts_));
  }

  void conclude(std::vector<CrackTip> tips) {
    if (decision_.segments.empty()) {
      // Every overloaded flaw lay where no cut is possible, or there was no energy for one.
      decision_.verdict.outcome = Outcome::held;
      decision_.verdict.reason =
          decision_.energy_guard_active ? "no energy for a crack" : "no crack could start";
      decision_.tips = subject_.tips;
      return;
    }
    const auto start = Clock::now();
    if (const double die_area = material::die_area(subject_.material, subject_.thickness); die_area > 0.0)
      dice(die_area);
    else if (settings_.core_spacing > 0.0 && !(subject_.material.yield > 0.0))
      crush();
    if (subject_.grains && !subject_.grains->is_empty()) assign_grains();
    decision_.mesh = mesh_;
    decision_.contacts = std::move(contacts_);
    decision_.verdict.outcome = Outcome::broke;
    if (decision_.dice == 0) decision_.tips = std::move(tips);
    for (const CrackSegment& segment : decision_.segments) {
      const double area = (segment.ends[1] - segment.ends[0]).norm() * subject_.thickness;
      decision_.new_area += area;
      if (segment.is_on_grain) decision_.grain_area += area;
    }
    decision_.trace_ms += milliseconds_since(start);
  }

  void assign_grains() {
    geometry::ShellMesh mesh = *mesh_;
    for (geometry::ShellCell& cell : mesh.cells) {
      Vec2 middle = Vec2::Zero();
      for (int i = 0; i < cell.corner_count; ++i)
        middle += mesh.corners[at(cell.first_corner + i)].barycentric;
      cell.grain = grain_at(*subject_.grains, cell.element, middle / cell.corner_count);
    }
    mesh_ = std::make_shared<const geometry::ShellMesh>(std::move(mesh));
  }

  const ShellSubject subject_;
  const ShellImpact& impact_;
  const FractureSettings& settings_;
  ImpactForce force_;
  Decision decision_;
  std::optional<ElementPlanes> planes_;
  std::vector<LoadCentre> centres_;
  std::optional<PathNoise> noise_;
  std::shared_ptr<const geometry::ShellMesh> mesh_;  // as it is in this generation
  std::vector<geometry::CellContact> contacts_;      // of the cracked mesh
  std::vector<stress::LinearStress> fits_;           // of this generation
  std::vector<stress::CellStress> stresses_;         // their means
  std::vector<int> pieces_;                          // that its cells are in
  std::vector<Candidate> candidates_;
  VecX struck_displacement_;  // |dof| of the uncracked mesh; of what yields
  DentEnergy struck_energy_;
  ShellYieldFinding yield_;  // under these
  int next_crack_ = 0;
};

}  // namespace

void prepare_subject(ShellSubject& subject) {
  if (!subject.mesh) return;
  if (!subject.systems)
    subject.systems = std::make_shared<stress::ShellSystemCache>(
        stress::make_shell_stiffness(subject.mesh->elements, properties_of(subject)), subject.mesh,
        support_of(subject, *subject.mesh));
  if (!subject.flaws)
    subject.flaws = std::make_shared<const FlawField>(
        draw_flaws(*subject.mesh->elements, subject.material, subject.seed));
}

Decision decide_shell(const ShellSubject& subject, const ShellImpact& impact,
                      const FractureSettings& settings) {
  return Decider(subject, impact, settings).decide();
}

}  // namespace shatterbox::fracture
