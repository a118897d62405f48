// How hard and how long an impact presses on a shell: its duration from the compliances of both bodies, the
// peak force of each load, and what is left of it once the body cracks.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/fracture/decide_shell.h"
#include "engine/fracture/rigid_contact.h"
#include "engine/stress/shell_stiffness.h"
#include "engine/stress/shell_system.h"

namespace shatterbox::fracture {

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

/// All loads of one impact on one prepared subject. Both must outlive it.
class ImpactForce {
 public:
  ImpactForce(const ShellSubject& subject, const ShellImpact& impact, const FractureSettings& settings);

  /// Places the loads. False, and `problem` says why, if there is nothing to press or to be pressed.
  bool prepare(std::string& problem);

  /// Stress bound over strength, at the worst place, if kinetic energy and resting contact can break nothing;
  /// none if a solve has to tell.
  std::optional<LoadBound::Worst> harmless_bound() const;

  /// Whether displacement() tells enough. It is asked once, before the duration is sought, with all loads as
  /// the unscreened system answers them.
  using IsEnough = std::function<bool()>;

  /// Duration of the hardest collision, by a fixed point over screenings; then the peak forces. Factors and
  /// times are booked in `decision`. False, and `problem` says why, if there is no answer. `is_enough`:
  /// empty, nothing but the end of the search is.
  bool settle(const IsEnough& is_enough, Decision& decision, std::string& problem);

  /// Before the body cracks: what the verdict did not have to know of the loads. Books the elastic energy.
  void complete(Decision& decision);

  /// The cracked body under the force that its compliance and the energy left allow.
  bool settle_again(const geometry::ShellMesh& mesh, const std::vector<geometry::CellContact>& contacts,
                    Decision& decision, std::string& problem);

  /// Displacement (|dof|) of the mesh last solved at the pulse's peak, under all loads and the spin together.
  const VecX& displacement() const { return displacement_; }

  /// That part of it which the collisions cause; zero if there is no answer. Before settle_again.
  VecX struck_displacement(Decision& decision);
  /// What the collisions bring for a dent. Before settle_again.
  DentEnergy struck_energy() const;

  const std::vector<Press>& presses() const { return presses_; }
  const Press& hardest() const { return presses_[hardest_]; }
  double duration() const { return duration_; }  // s
  double residual() const { return residual_; }  // worst of the solves on the mesh last solved

 private:
  using System = stress::ShellSystemCache::System;
  double spin_stress() const;
  double borne_by(std::size_t cell) const;
  bool is_spinning() const;
  bool is_alone() const;
  bool does_spin_crack() const;
  geometry::ShellMesh pressed_parts(const geometry::ShellMesh& mesh) const;
  std::optional<std::size_t> find_lead() const;
  bool use(const System& system, std::string& problem);
  bool answer_lead(std::size_t lead, Decision& decision, std::string& problem);
  bool can_wait(std::size_t i) const;
  template <class IsWanted>
  void answer(const IsWanted& is_wanted, Decision& decision);
  void answer_others(std::size_t lead, Decision& decision);
  bool solve_together(const geometry::ShellMesh& mesh, Decision& decision, std::string& problem);
  bool solve(const VecX& load, stress::ShellSolution& solution, std::string& problem);
  double felt_compliance(const ContactAnswer& answer) const;
  double duration_of(const Press& press, const ContactAnswer& answer) const;
  bool is_short() const;
  double guess_duration(const Press& lead, double rim) const;
  void find_groups(const geometry::ShellMesh& mesh, const std::vector<geometry::CellContact>& contacts);
  bool use_unscreened(Decision& decision, std::string& problem);
  bool settle_lead(std::size_t lead, Decision& decision, std::string& problem);
  bool ends_search(std::size_t lead, Decision& decision);
  bool is_plainly_short(std::size_t lead, Decision& decision, std::string& problem);
  bool climb(std::size_t lead, Decision& decision, std::string& problem);
  bool find_screening(std::size_t lead, Decision& decision, std::string& problem);
  bool screen(int exponent, std::size_t lead, Decision& decision, std::string& problem);
  void settle_force(Press& press, const ContactAnswer& answer);
  void cap_forces(const Decision& decision);
  void prepare_cracked();

  const ShellSubject& subject_;
  const ShellImpact& impact_;
  const FractureSettings& settings_;
  std::vector<Press> presses_;
  std::vector<PressGroups> groups_;     // of the mesh last solved
  std::vector<ContactAnswer> answers_;  // of the loads, or of the lead alone while the duration is sought
  stress::ShellSolution lead_;          // under a unit force
  VecX displacement_;
  double residual_ = 0.0;
  std::shared_ptr<const stress::ShellSystem> system_;
  std::size_t hardest_ = 0;
  double duration_ = 0.0;  // s, of the lead; contact_average without one
  IsEnough is_enough_;     // empty: not to be asked
  bool has_lead_ = false;  // one whose duration counts, with its displacement in `lead_`
  bool is_estimate_ = false;
  bool is_screened_ = false;
  bool is_cracked_ = false;
  int exponent_ = 0;  // of the screening of the cracked body
};

}  // namespace shatterbox::fracture
