// Decide, for solids: does this impact break this body, and along which cracks? Pure: nothing is changed, the
// answer is the cut complex. Rankine's criterion on flaws [BHTF07 VII-A]; each crack is one nodal field,
// grown from its flaw over crossed faces; the body is solved again after each generation of cracks with the
// force that its new compliance allows.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/fracture/decision_figures.h"
#include "engine/fracture/fracture_settings.h"
#include "engine/fracture/perforation.h"
#include "engine/fracture/solid_dent.h"
#include "engine/fracture/solid_flaws.h"
#include "engine/fracture/solid_guides.h"
#include "engine/fracture/solid_model.h"
#include "engine/fracture/space_grains.h"
#include "engine/geometry/solid_complex.h"
#include "engine/material/material.h"

namespace shatterbox::fracture {

/// The body: what it is made of, how it is held.
struct SolidSubject {
  std::shared_ptr<const geometry::SolidComplex> complex;  // settled
  /// What is kept between impacts and shared by copies; null: made for this decision and thrown away. The
  /// stiffness, the flaws and the turns are the first parent's, for all its pieces.
  std::shared_ptr<const stress::SolidStiffness> stiffness;
  std::shared_ptr<const SolidModel> model;
  std::shared_ptr<KeptSolidModel> kept_model;  // where the model is kept that `model` is not yet; may be null
  std::shared_ptr<const SolidFlawField> flaws;
  std::shared_ptr<KeptCrackTurns> kept_turns;
  std::shared_ptr<const SpaceGrains> grains;  // null: none
  material::Material material;
  std::vector<int> clamped_vertices;  // held, of the element mesh, ascending; empty: a free body
  std::uint64_t seed = 1;
  int first_cut_id = 0;  // tag of the first new crack's facets: above those of its earlier ones
};

struct SolidDecision : DecisionFigures {
  std::shared_ptr<const geometry::SolidComplex> complex;  // cut, settled; null unless it broke
  int part_count = 1;                                     // that the cut complex falls into
  int iterations = 0;                                     // of conjugate gradients, of all solves
  std::shared_ptr<const SolidDent> dent;                  // of the uncut elements; null: none
  /// Of what yields; if the striker goes through, its hole is the break. Null: nobody comes near that.
  std::shared_ptr<const Perforation> perforation;

  bool perforates() const { return perforation && perforation->is_through(); }
};

/// Fills in what is kept between impacts where it is null.
void prepare_subject(SolidSubject& subject);
/// Finds what is kept for cracks, which the first one would otherwise wait for.
void prepare_cracks(const SolidSubject& subject);

/// The verdict, and the cut complex where it breaks. Of `settings`, waviness, the patch, the guard and the
/// generations count.
SolidDecision decide_solid(const SolidSubject& subject, const Impact& impact,
                           const FractureSettings& settings = {});

}  // namespace shatterbox::fracture
