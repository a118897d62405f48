// How hard and how long an impact presses on a solid: as impact_force.h for shells, by conjugate gradients in
// place of factors. Resting contact, whose forces no solve has to tell, is one load: each of its forces acts
// on the heaviest piece under it, and of all that press on one connected part of a cracked body the same
// share is left.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/fracture/decide_solid.h"
#include "engine/fracture/rigid_contact.h"

namespace shatterbox::fracture {

/// A load on the way to its force.
struct SolidPress {
  const ImpactLoad* load = nullptr;
  ContactPress contact;
  double first_force = 0.0;       // N, peak, on the intact body
  double first_compliance = 0.0;  // m/N, intact, in the system of the later generations
  double force = 0.0;             // N, in this generation
  double duration = 0.0;          // s
  double energy = 0.0;            // J, kinetic energy behind a collision; else elastic energy
  // Under a unit force, as the pieces share it, on the mesh last solved; of no resting contact.
  VecX displacement;                // |dof|, m; empty once its energy is spent
  double compliance = 0.0;          // m/N
  double elastic_compliance = 0.0;  // m/N
};

/// What acts on all of a body at once, and the answer of the mesh last solved.
struct WholeLoad {
  VecX displacement, rigid;  // |dof|, m, of free parts without their rigid motion, and that; empty: nothing
  double compliance = 0.0, elastic = 0.0;  // J: force . both, displacement . K displacement
};

/// The resting contact on one connected part, in units of its forces on the intact body.
struct RestingPart {
  std::vector<std::size_t> presses;     // ascending
  double contact = 0.0, inertia = 0.0;  // J; J/s2: what the contacts and the others' inertia give way
  double first_compliance = 0.0;        // J, intact, in the system of the later generations
  double energy = 0.0;                  // J, of the contacts and the intact body
  double share = 1.0;                   // of the forces, that is left
};

/// A mesh to be pressed on, its system, and the pieces under each load.
struct SolidStage {
  const geometry::SolidMesh* mesh = nullptr;
  const stress::SolidSkin* skin = nullptr;
  std::shared_ptr<const stress::SolidSystem> system;
  std::vector<PressGroups> groups;
  double screening = 0.0;  // 1/s
  /// |presses| + 2, of one unit force each, of resting contact and of the spin: displacements (|dof|, m) that
  /// solves begin with; empty ones, or none at all: at nothing.
  std::vector<VecX> begins;

  /// Of a load, on the heaviest piece under it; null: there is nothing.
  const VecX* heaviest_force(std::size_t press) const;
  /// The connected part that is on; -1: none.
  int part_of(std::size_t press) const;
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

  /// Before the body cracks: books the elastic energy.
  void book_energy(SolidDecision& decision);

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
  /// Of all forces as they press on the intact body, what rests on it or bears it.
  double resting_share() const;

 private:
  double spin_stress() const;
  bool is_spinning() const;
  double felt_compliance(const SolidPress& press) const;
  double duration_of(const SolidPress& press) const;
  bool answer(const SolidStage& stage, const std::vector<std::size_t>& wanted, SolidDecision& decision,
              std::string& problem, bool wants_whole = false);
  bool is_resting(const SolidPress& press) const;
  VecX resting_force(const SolidStage& stage, const std::vector<std::size_t>& presses) const;
  RestingPart make_resting_part(std::vector<std::size_t> presses, const WholeLoad& answer) const;
  bool part_resting(SolidDecision& decision, std::string& problem);
  bool settle_resting(SolidDecision& decision, std::string& problem);
  void drop_spent(std::vector<std::size_t>& wanted, const SolidDecision& decision);
  void settle_cracked_force(SolidPress& press, const SolidDecision& decision);
  double first_inertia(const Vec3& force, const Vec3& moment) const;
  bool settle_lead(std::size_t lead, SolidDecision& decision, std::string& problem);
  void find_groups();
  void settle_force(SolidPress& press);
  double excited_period() const;
  void prepare_cracked();
  void carry_over(const geometry::SolidMesh& mesh, const std::vector<int>& origins);
  void sum_up();
  void add_resting();
  bool note(const stress::SolidSolution& solution, SolidDecision& decision, std::string& problem) const;

  const SolidSubject& subject_;
  const Impact& impact_;
  const FractureSettings& settings_;
  std::vector<SolidPress> presses_;
  SolidStage first_, now_;  // the intact body; the mesh last solved
  SolidForm form_;          // of now_, once it has cracked
  VecX displacement_;
  WholeLoad rest_, spin_;                // under the resting contact's first forces; of the spin
  std::vector<std::size_t> resting_;     // presses, ascending
  WholeLoad first_rest_;                 // of the intact body, without displacements
  std::vector<RestingPart> rest_parts_;  // of the mesh last solved, once it has cracked
  std::size_t hardest_ = 0;
  double duration_ = 0.0;  // s, of the lead; contact_average without one
  int exponent_ = 0;       // of the screening of the cracked body
  bool has_lead_ = false;
  bool is_cracked_ = false;
};

}  // namespace shatterbox::fracture
