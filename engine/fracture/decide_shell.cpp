#include "engine/fracture/decide_shell.h"

#include <algorithm>
#include <chrono>

#include <Eigen/Eigenvalues>

#include "engine/core/elementary.h"
#include "engine/core/hash.h"
#include "engine/fracture/crack_tracer.h"
#include "engine/fracture/crushed_core.h"
#include "engine/fracture/rigid_contact.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/shell_surface.h"
#include "engine/stress/contact_duration.h"
#include "engine/stress/shell_load.h"
#include "engine/stress/shell_stress.h"
#include "engine/stress/stress_bound.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
Size at(int i) {
  return static_cast<Size>(i);
}

constexpr double kCoreOverload = 5.0;   // stress over strength above which the core is crushed
constexpr double kCoreReach = 6.0;      // patch radii
constexpr double kWaveLength = 0.14;    // of the paths' noise, share of the body's size
constexpr double kPatchElements = 1.5;  // least radius of a load's patch, in element sizes
// The same, as a share of the unbroken body's size: a mesh finer than that gives the same answer, crumbs
// included.
constexpr double kPatchShare = 0.05;
constexpr double kGrowthThatCounts = 0.04;  // of the cracks' length: a generation that adds less is the last
constexpr int kMostScreenings = 6;          // steps of the search for the duration

using Clock = std::chrono::steady_clock;
double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

stress::ShellProperties properties_of(const ShellSubject& subject) {
  stress::ShellProperties p;
  p.youngs_modulus = subject.material.young;
  p.poisson_ratio = subject.material.poisson;
  p.density = subject.material.density;
  p.thickness = subject.thickness;
  return p;
}

/// The support of a mesh of this body; edges between clamped vertices are held in a frame that does not turn.
stress::ShellSupport support_of(const ShellSubject& subject, const geometry::ShellMesh& mesh) {
  if (subject.clamped_vertices.empty()) return {};
  const geometry::ShellElements& elements = *mesh.elements;
  std::vector<char> vertices(elements.mesh.positions.size(), 0);
  for (const int v : subject.clamped_vertices) vertices[at(v)] = 1;
  std::vector<char> edges(elements.topology.edges.size(), 0);
  for (Size e = 0; e < edges.size(); ++e) {
    const auto& ends = elements.topology.edges[e];
    edges[e] = vertices[at(ends[0])] && vertices[at(ends[1])];
  }
  return stress::find_support(mesh, vertices, edges);
}

/// A load on the way to its force.
struct Press {
  const ShellLoad* load = nullptr;
  ContactPress contact;
  double first_force = 0.0;       // N, peak, on the intact body
  double first_compliance = 0.0;  // m/N, intact, in the system of the later generations
  double force = 0.0;             // N, in this generation
  double duration = 0.0;          // s
  double energy = 0.0;            // J, kinetic energy behind a collision; else elastic energy
};

class Decider {
 public:
  Decider(const ShellSubject& subject, const ShellImpact& impact, const FractureSettings& settings)
      : subject_(subject), impact_(impact), settings_(settings) {
    prepare_subject(subject_);
    if (subject_.systems) stiffness_ = subject_.systems->shared_stiffness();
  }

  Decision decide() {
    if (!prepare_loads()) return std::move(decision_);
    if (is_harmless()) return std::move(decision_);
    if (!settle_duration()) return std::move(decision_);
    run_generations();
    return std::move(decision_);
  }

 private:
  const geometry::ShellElements& elements() const { return *subject_.mesh->elements; }

  bool give_up(const std::string& why) {
    decision_.verdict.outcome = Outcome::not_evaluated;
    decision_.verdict.reason = why;
    return false;
  }

  bool prepare_loads() {
    if (!subject_.mesh || subject_.mesh->cells.empty()) return give_up("there is no material");
    const double least_radius = std::max({subject_.thickness, kPatchShare * size(),
                                          kPatchElements * stress::mean_edge_length(*subject_.mesh)});
    for (const ShellLoad& load : impact_.loads) {
      if (!(load.impulse > 0.0) && !(load.closing_speed > 0.0)) continue;
      if (!(load.direction.squaredNorm() > 0.5)) continue;
      Press press;
      press.load = &load;
      press.contact.point = load.point_material;
      press.contact.direction = load.direction;
      press.contact.hertz_compliance = std::max(0.0, load.hertz_compliance);
      press.contact.radius =
          settings_.patch_radius > 0.0 ? settings_.patch_radius : std::max(least_radius, load.hertz_radius);
      presses_.push_back(press);
      if (!hardest_ || load.impulse > hardest_->impulse) hardest_ = &load;
    }
    if (presses_.empty()) return give_up("no load");
    decision_.verdict.impulse = hardest_->impulse;
    decision_.verdict.place = hardest_->point_material;
    mass_ = shell_mass_properties(*subject_.mesh, subject_.thickness, subject_.material.density);
    return true;
  }

  bool is_collision(const ShellLoad& load) const {
    return load.closing_speed > 0.0 && load.effective_mass > 0.0;
  }

  /// What the kinetic energy can do at most, without any solve.
  bool is_harmless() {
    double energy = 0.0;
    for (const Press& press : presses_) {
      if (!is_collision(*press.load) || impact_.given_duration) return false;
      energy += 0.5 * press.load->effective_mass * press.load->closing_speed * press.load->closing_speed;
    }
    if (impact_.spin_material.norm() * size() > 1.0) return false;
    const auto& flaws = *subject_.flaws;
    double weakest = flaws.greatest_strength;
    for (const geometry::ShellCell& cell : subject_.mesh->cells)
      if (const auto own = flaws.of_element(cell.element); !own.empty())
        weakest = std::min(weakest, own.front().strength);
    // Loads add up, so do the roots of their energies: the sum of n roots is at most the root of n times the
    // sum.
    const double bound =
        stress::stress_bound(properties_of(subject_), stress::least_stressed_area(*subject_.mesh),
                             energy * static_cast<double>(presses_.size()));
    if (!(bound < weakest)) return false;
    Verdict& verdict = decision_.verdict;
    verdict.outcome = Outcome::held;
    verdict.reason = "bound";
    verdict.stress = bound;
    verdict.strength = weakest;
    verdict.ratio = bound / weakest;
    return true;
  }

  double size() {
    if (size_ == 0.0) {
      Vec3 low = elements().mesh.positions.front(), high = low;
      for (const Vec3& p : elements().mesh.positions) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
      size_ = (high - low).maxCoeff();
    }
    return size_;
  }

  /// Answers of the intact body in one system; false if there is no such system.
  bool press_intact(const stress::ShellSystemCache::System& system, std::vector<ContactAnswer>& answers) {
    if (!system) return give_up(system.error());
    system_ = system.value();
    const auto start = Clock::now();
    if (contacts_.empty()) contacts_ = find_cell_contacts(*subject_.mesh);
    answers = press_all(*system_, *subject_.mesh, contacts_);
    decision_.solve_ms += milliseconds_since(start);
    for (const ContactAnswer& answer : answers)
      if (!(answer.residual < 1e-4)) return give_up("the solve did not reach its accuracy");
    return true;
  }

  std::vector<ContactAnswer> press_all(const stress::ShellSystem& system, const geometry::ShellMesh& mesh,
                                       const std::vector<geometry::CellContact>& contacts) {
    std::vector<ContactPress> loads;
    for (const Press& press : presses_) loads.push_back(press.contact);
    return press(system, mesh, contacts, stress::lumped_mass(*stiffness_, mesh), loads);
  }

  /// A ball on a held body feels the body's inertia in its way; for free bodies it is in the effective mass.
  double felt_compliance(const ContactAnswer& answer) const {
    return subject_.clamped_vertices.empty() ? answer.elastic_compliance : answer.compliance;
  }

  double duration_of(const Press& press, const ContactAnswer& answer) const {
    if (impact_.given_duration) return *impact_.given_duration;
    return stress::series_duration(press.load->effective_mass, press.contact.hertz_compliance,
                                   felt_compliance(answer));
  }

  /// Duration of the hardest collision, by a fixed point over screenings; then the peak forces.
  bool settle_duration() {
    const auto start = Clock::now();
    const int made_before = subject_.systems->count();
    const auto& unscreened = subject_.systems->unscreened();
    decision_.factor_ms += milliseconds_since(start);
    if (!press_intact(unscreened, answers_)) return false;
    Size lead = 0;
    double duration = 0.0;
    for (Size i = 0; i < presses_.size(); ++i) {
      if (!is_collision(*presses_[i].load) && !impact_.given_duration) continue;
      if (duration == 0.0 || presses_[i].load->impulse > presses_[lead].load->impulse) {
        lead = i;
        duration = duration_of(presses_[i], answers_[i]);
      }
    }
    exponent_ = duration > 0.0 ? stress::quantise_screening(1.0 / duration) : 0;
    if (duration > 0.0 && duration < 0.5 * system_->first_period()) {
      is_screened_ = true;
      std::vector<int> tried;
      while (static_cast<int>(tried.size()) < kMostScreenings &&
             std::find(tried.begin(), tried.end(), exponent_) == tried.end()) {
        tried.push_back(exponent_);
        const auto factor_start = Clock::now();
        const auto& screened = subject_.systems->screened(exponent_);
        decision_.factor_ms += milliseconds_since(factor_start);
        if (!press_intact(screened, answers_)) return false;
        duration = duration_of(presses_[lead], answers_[lead]);
        exponent_ = stress::quantise_screening(1.0 / duration);
      }
      exponent_ = tried.back();
    }
    decision_.factorisations += subject_.systems->count() - made_before;
    decision_.verdict.duration = duration > 0.0 ? duration : impact_.contact_average;
    if (duration == 0.0) exponent_ = stress::quantise_screening(2.0 / system_->first_period());
    for (Size i = 0; i < presses_.size(); ++i) settle_force(presses_[i], answers_[i]);
    return true;
  }

  void settle_force(Press& press, const ContactAnswer& answer) {
    const ShellLoad& load = *press.load;
    const double compliance = press.contact.hertz_compliance + felt_compliance(answer);
    if (impact_.given_duration) {
      press.duration = *impact_.given_duration;
      press.first_force = stress::kPeakOverMeanHalfSine * load.impulse / press.duration;
    } else if (is_collision(load)) {
      press.duration = duration_of(press, answer);
      press.first_force = load.closing_speed * core::sqrt(load.effective_mass / compliance);
      press.energy = 0.5 * load.effective_mass * load.closing_speed * load.closing_speed;
    } else {
      press.duration = impact_.contact_average;
      press.first_force = load.impulse / press.duration;
    }
    press.force = press.first_force;
    const double elastic =
        0.5 * press.force * press.force * (press.contact.hertz_compliance + answer.elastic_compliance);
    if (press.energy == 0.0) press.energy = elastic;
    decision_.elastic_energy += std::min(elastic, press.energy);
    // Later generations are screened. Below the first frequency that adds the body's own inertia, as one
    // rigid whole.
    press.first_compliance = answer.compliance;
    if (!is_screened_ && subject_.clamped_vertices.empty()) {
      const double s = stress::screening_of(exponent_);
      press.first_compliance += rigid_mobility(load) / (s * s);
    }
  }

  /// Inverse mass at a load along its direction, 1/kg.
  double rigid_mobility(const ShellLoad& load) const {
    const Vec3 arm = (load.point_material - mass_.centre).cross(load.direction);
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(mass_.inertia);
    double turning = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double moment = axes.eigenvalues()[i];
      const double a = axes.eigenvectors().col(i).dot(arm);
      if (moment > 1e-12 * mass_.mass * axes.eigenvalues()[2]) turning += a * a / moment;
    }
    return 1.0 / mass_.mass + turning;
  }

  /// Stress at the pulse's peak under all loads together, averaged once.
  std::vector<stress::CellStress> stresses_under(const stress::ShellSystem& system,
                                                 const geometry::ShellMesh& mesh,
                                                 const std::vector<geometry::CellContact>& contacts,
                                                 const std::vector<ContactAnswer>& answers) const {
    VecX displacement = VecX::Zero(mesh.degree_of_freedom_count());
    for (Size i = 0; i < presses_.size(); ++i) displacement += presses_[i].force * answers[i].displacement;
    if (impact_.spin_material.squaredNorm() > 0.0)
      displacement +=
          system.solve(stress::centrifugal_load(*stiffness_, mesh, impact_.spin_material, mass_.centre))
              .displacement;
    return stress::average_stresses(mesh, contacts, stress::cell_stresses(*stiffness_, mesh, displacement));
  }

  /// Flaws under more stress than they bear; and, for the verdict, the worst of all.
  std::vector<Candidate> find_candidates(const geometry::ShellMesh& mesh,
                                         const std::vector<stress::CellStress>& stresses,
                                         const ShellCutter& cutter, bool is_first) {
    const FlawField& flaws = *subject_.flaws;
    std::vector<Candidate> candidates;
    Verdict& verdict = decision_.verdict;
    const auto consider = [&](int element, const Vec2& place, double tension, double strength, int number) {
      const double overload = tension / strength;
      if (is_first && overload > verdict.ratio) {
        verdict.ratio = overload;
        verdict.stress = tension;
        verdict.strength = strength;
        verdict.place = position_in_element(elements(), element, place);
      }
      if (overload > 1.0) candidates.push_back({element, place, overload, number});
    };
    for (Size c = 0; c < mesh.cells.size(); ++c) {
      const int element = mesh.cells[c].element;
      const double tension = stress::worst_stress(stresses[c]).principal.first;
      if (!(tension > 0.0)) continue;
      bool has_flaw = false;
      for (const Flaw& flaw : flaws.of_element(element)) {
        if (mesh.cells[c].corner_count != 3 || mesh.cells[c].area < 0.999 * element_area(elements(), element))
          if (cutter.find_cell(element, flaw.barycentric) != static_cast<int>(c)) continue;
        has_flaw = true;
        consider(element, flaw.barycentric, tension, flaw.strength,
                 static_cast<int>(&flaw - flaws.flaws.data()));
      }
      if (has_flaw) continue;
      Vec2 middle = Vec2::Zero();
      const int corners = mesh.cells[c].corner_count;
      for (int i = 0; i < corners; ++i)
        middle += mesh.corners[at(mesh.cells[c].first_corner + i)].barycentric;
      consider(element, middle / corners, tension, flaws.greatest_strength,
               static_cast<int>(flaws.flaws.size()) + static_cast<int>(c));
    }
    return candidates;
  }

  TracerSetup tracer_setup(const std::vector<stress::CellStress>& stresses, int generation) const {
    TracerSetup setup;
    setup.planes = &planes_;
    setup.stresses = &stresses;
    setup.material = &subject_.material;
    setup.grains = subject_.grains.get();
    setup.noise = &*noise_;
    for (const Press& press : presses_) setup.centres.push_back({press.contact.point, press.contact.radius});
    setup.thickness = subject_.thickness;
    setup.energy_budget = settings_.has_energy_guard
                              ? std::max(0.0, decision_.elastic_energy - decision_.fracture_energy)
                              : -1.0;
    setup.generation = generation;
    setup.first_crack = next_crack_;
    return setup;
  }

  void run_generations() {
    planes_ = make_element_planes(elements());
    noise_.emplace(kWaveLength * size(), settings_.waviness, subject_.seed);
    for (const CrackTip& tip : subject_.tips) next_crack_ = std::max(next_crack_, tip.crack + 1);
    mesh_ = subject_.mesh;
    std::vector<CrackTip> tips = subject_.tips;
    for (int generation = 0; generation < settings_.most_generations; ++generation) {
      if (generation > 0 && !solve_again()) break;
      const auto stresses = stresses_under(*system_, *mesh_, contacts_, answers_);
      ++decision_.generations;
      for (const ContactAnswer& answer : answers_)
        decision_.residual = std::max(decision_.residual, answer.residual);
      const auto start = Clock::now();
      ShellCutter cutter(*mesh_);
      std::vector<Candidate> candidates = find_candidates(*mesh_, stresses, cutter, generation == 0);
      if (generation == 0) {
        note_element_stress(stresses);
        note_force();
        if (!(decision_.verdict.ratio > 1.0)) {
          decision_.verdict.outcome = Outcome::held;
          decision_.tips = subject_.tips;
          return;
        }
      }
      CrackTracer tracer(cutter, tracer_setup(stresses, generation));
      tracer.resume(tips);
      tracer.nucleate(std::move(candidates));
      decision_.generation_bound_active = false;
      if (!take_over(tracer, tips)) break;
      mesh_ = std::make_shared<const geometry::ShellMesh>(cutter.mesh());
      contacts_ = find_cell_contacts(*mesh_);
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

  /// The cracked body under the force that its compliance allows.
  bool solve_again() {
    const auto start = Clock::now();
    auto system = stress::ShellSystem::make(stiffness_, *mesh_, stress::screening_of(exponent_),
                                            support_of(subject_, *mesh_));
    decision_.factor_ms += milliseconds_since(start);
    ++decision_.factorisations;
    if (!system) {
      decision_.verdict.reason = system.error();
      return false;
    }
    const auto solve_start = Clock::now();
    system_ = system.value();
    answers_ = press_all(*system_, *mesh_, contacts_);
    decision_.solve_ms += milliseconds_since(solve_start);
    const double s = system_->screening();
    for (Size i = 0; i < presses_.size(); ++i) {
      if (!(answers_[i].residual < 1e-4)) {
        decision_.verdict.reason = "the cracked body's solve did not reach its accuracy";
        return false;
      }
      Press& press = presses_[i];
      const double hertz = press.contact.hertz_compliance;
      const double other = press.load->other_inverse_mass / (s * s);
      const double left = std::max(0.0, 1.0 - decision_.fracture_energy / std::max(press.energy, 1e-300));
      press.force = press.first_force * (hertz + press.first_compliance + other) /
                    (hertz + answers_[i].compliance + other) * core::sqrt(left);
      press.force = std::min(press.force, press.first_force);
      // The springs cannot hold more than the energy that is left.
      const double most = core::sqrt(2.0 * press.energy * left / (hertz + answers_[i].elastic_compliance));
      press.force = std::min(press.force, most);
    }
    return true;
  }

  void note_element_stress(const std::vector<stress::CellStress>& stresses) {
    decision_.element_stress.assign(elements().mesh.triangles.size(), 0.0);
    for (Size c = 0; c < stresses.size(); ++c) {
      double& here = decision_.element_stress[at(subject_.mesh->cells[c].element)];
      here = std::max(here, stress::worst_stress(stresses[c]).principal.first);
    }
  }

  void note_force() {
    for (const Press& press : presses_)
      if (press.load == hardest_) decision_.verdict.force = press.first_force;
  }

  void crush(ShellCutter& cutter) {
    for (const Press& press : presses_) {
      if (!is_collision(*press.load)) continue;
      CoreSetup core;
      core.centre = press.contact.point;
      core.patch_radius = press.contact.radius;
      core.cell_size = settings_.core_spacing * subject_.thickness;
      core.crack = next_crack_;
      core.generation = decision_.generations;
      core.seed = core::mix(subject_.seed + static_cast<std::uint64_t>(next_crack_) + 0x636f7265);
      if (settings_.has_energy_guard)
        core.most_length = std::max(0.0, decision_.elastic_energy - decision_.fracture_energy) /
                           (subject_.material.fracture_energy * subject_.thickness);
      for (Size t = 0; t < decision_.element_stress.size(); ++t) {
        if (cutter.cells_of(static_cast<int>(t)).empty()) continue;
        const Vec3 middle = position_in_element(elements(), static_cast<int>(t), Vec2(1.0 / 3.0, 1.0 / 3.0));
        if ((middle - core.centre).norm() < kCoreReach * core.patch_radius &&
            decision_.element_stress[t] > kCoreOverload * subject_.material.strength)
          core.elements.push_back(static_cast<int>(t));
      }
      const Core crushed = crush_core(cutter, planes_, core);
      decision_.energy_guard_active = decision_.energy_guard_active || crushed.is_out_of_energy;
      if (crushed.cells == 0) continue;
      ++next_crack_;
      decision_.core_cells += crushed.cells;
      decision_.fracture_energy += crushed.length * subject_.material.fracture_energy * subject_.thickness;
      decision_.segments.insert(decision_.segments.end(), crushed.segments.begin(), crushed.segments.end());
    }
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
    ShellCutter cutter(*mesh_);
    if (settings_.core_spacing > 0.0) crush(cutter);
    geometry::ShellMesh mesh = cutter.mesh();
    if (subject_.grains && !subject_.grains->is_empty()) assign_grains(mesh);
    decision_.mesh = std::make_shared<const geometry::ShellMesh>(std::move(mesh));
    decision_.verdict.outcome = Outcome::broke;
    decision_.tips = std::move(tips);
    for (const CrackSegment& segment : decision_.segments) {
      const double area = (segment.ends[1] - segment.ends[0]).norm() * subject_.thickness;
      decision_.new_area += area;
      if (segment.is_on_grain) decision_.grain_area += area;
    }
    decision_.trace_ms += milliseconds_since(start);
  }

  void assign_grains(geometry::ShellMesh& mesh) const {
    for (geometry::ShellCell& cell : mesh.cells) {
      Vec2 middle = Vec2::Zero();
      for (int i = 0; i < cell.corner_count; ++i)
        middle += mesh.corners[at(cell.first_corner + i)].barycentric;
      cell.grain = grain_at(*subject_.grains, cell.element, middle / cell.corner_count);
    }
  }

  ShellSubject subject_;
  const ShellImpact& impact_;
  const FractureSettings& settings_;
  Decision decision_;
  geometry::MassProperties mass_;
  std::vector<Press> presses_;
  const ShellLoad* hardest_ = nullptr;
  double size_ = 0.0;  // m, largest side of the bounding box
  std::vector<ElementPlane> planes_;
  std::optional<PathNoise> noise_;
  std::shared_ptr<const geometry::ShellMesh> mesh_;  // as it is in this generation
  std::vector<geometry::CellContact> contacts_;
  std::shared_ptr<const stress::ShellStiffness> stiffness_;
  std::shared_ptr<const stress::ShellSystem> system_;
  std::vector<ContactAnswer> answers_;
  bool is_screened_ = false;
  int exponent_ = 0;  // of the screening of the cracked body
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
