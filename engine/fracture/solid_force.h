// How hard and how long an impact presses on a solid: as impact_force.h for shells, by conjugate gradients in
// place of factors. Resting contact, whose force no solve has to tell, is solved for all at once: of a body
// that breaks only what of it is next to nothing beside the impact.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/fracture/decide_solid.h"
#include "engine/fracture/rigid_contact.h"

namespace shatterbox::fracture {

/// Resting contact that all together presses less than that, of the greatest force on its part, is one load.
inline constexpr double kMinorForce = 0.01;

/// A load on the way to its force.
struct SolidPress {
  const ImpactLoad* load = nullptr;
  ContactPress contact;
  double first_force = 0.0;       // N, peak, on the intact body
  double first_compliance = 0.0;  // m/N, intact, in the system of the later generations
  double force = 0.0;             // N, in this generation
  double duration = 0.0;          // s
  double energy = 0.0;            // J, kinetic energy behind a collision; else elastic energy
  // Under a unit force, as the pieces share it, on the mesh last solved.
  VecX displacement;                // |dof|, m; empty once its energy is spent
  double compliance = 0.0;          // m/N
  double elastic_compliance = 0.0;  // m/N
  std::vector<double> shares;       // of its groups in the force
  /// Resting contact that was not solved for by itself: it has no compliance and no energy.
  bool is_minor = false;
};

/// A mesh to be pressed on, its system, and the pieces under each load.
struct SolidStage {
  const geometry::SolidMesh* mesh = nullptr;
  const stress::SolidSkin* skin = nullptr;
  std::shared_ptr<const stress::SolidSystem> system;
  std::vector<PressGroups> groups;
  double screening = 0.0;  // 1/s
  /// |presses| + 1, of one unit force each, and of the rest: displacements (|dof|, m) that solves begin with;
  /// empty ones, or none at all: at nothing.
  std::vector<VecX> begins;

  /// The connected part that a group of a load is on.
  int part_of(std::size_t press, std::size_t group) const;
  std::size_t heaviest_group(std::size_t press) const;
};

/// All loads of one impact on one prepared subject. Both must outlive it.
class SolidForce {
 public:
  SolidForce(const SolidSubject& subject, const Impact& impact, const FractureSettings& settings);

  /// Places the loads. False, and `problem` says why, if there is nothing to press or to be pressed.
  bool prepare(std::string& problem);

  /// Stress bound over strength, at the worst place, if kinetic energy, resting contact and spin can break
  /// nothing; none if a solve has to tell.
  std::optional<LoadBound::Worst> harmless_bound() const;

  /// Duration of the hardest collision, by a fixed point over screenings; then the peak forces. False, and
  /// `problem` says why, if there is no answer.
  bool settle(SolidDecision& decision, std::string& problem);

  /// Before the body cracks: what of resting contact counts is solved for by itself, and the elastic energy
  /// booked. False, and `problem` says why, if there is no answer.
  bool complete(SolidDecision& decision, std::string& problem);

  /// The cut body under the force that its compliance and the energy left allow. `origins` (|cells|): which
  /// cell of the mesh solved before each was, which is still there.
  /// After false nothing is solved any more.
  bool settle_again(SolidForm form, const std::vector<int>& origins, SolidDecision& decision,
                    std::string& problem);

  /// The mesh last solved, and its cells' contacts.
  const geometry::SolidMesh& mesh() const { return *now_.mesh; }
  const std::vector<geometry::SolidContact>& contacts() const {
    return is_cracked_ ? form_.contacts : subject_.model->contacts;
  }

  /// Displacement (|dof|) of the mesh last solved at the pulse's peak, under all loads and the spin together.
  const VecX& displacement() const { return displacement_; }
  /// That part of it which the collisions cause.
  VecX struck_displacement() const;
  /// What the collisions bring for a dent.
  DentEnergy struck_energy() const;
  const std::vector<SolidPress>& presses() const { return presses_; }
  const SolidPress& hardest() const { return presses_[hardest_]; }
  double duration() const { return duration_; }  // s

 private:
  double spin_stress() const;
  bool is_spinning() const;
  double felt_compliance(const SolidPress& press) const;
  double duration_of(const SolidPress& press) const;
  bool answer(const SolidStage& stage, const std::vector<std::size_t>& wanted, SolidDecision& decision,
              std::string& problem, bool wants_rest = false);
  void choose_minor();
  void put_together();
  bool promote_minor(SolidDecision& decision, std::string& problem);
  std::vector<double> part_forces() const;
  void drop_spent(std::vector<std::size_t>& wanted, const SolidDecision& decision);
  void settle_cracked_force(SolidPress& press, const SolidDecision& decision);
  double first_inertia(const SolidPress& press) const;
  bool settle_lead(std::size_t lead, SolidDecision& decision, std::string& problem);
  void find_groups();
  void settle_force(SolidPress& press);
  void prepare_cracked();
  void carry_over(const geometry::SolidMesh& mesh, const std::vector<int>& origins);
  VecX find_rest() const;
  void sum_up();
  bool note(const stress::SolidSolution& solution, SolidDecision& decision, std::string& problem) const;

  const SolidSubject& subject_;
  const Impact& impact_;
  const FractureSettings& settings_;
  std::vector<SolidPress> presses_;
  SolidStage first_, now_;  // the intact body; the mesh last solved
  SolidForm form_;          // of now_, once it has cracked
  VecX displacement_, rest_displacement_;
  std::vector<std::size_t> together_;  // presses that are minor until the body breaks
  std::size_t hardest_ = 0;
  double duration_ = 0.0;  // s, of the lead; contact_average without one
  int exponent_ = 0;       // of the screening of the cracked body
  bool has_lead_ = false;
  bool is_cracked_ = false;
};

}  // namespace shatterbox::fracture
