// Decide, for shells: does this impact break this body, and along which cracks? Pure: nothing is changed, the
// answer is the cracked mesh. Rankine's criterion on flaws [BHTF07 VII-A], cracks traced through the
// elements, the body solved again after each generation of cracks with the force that its new compliance
// allows.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/vec.h"
#include "engine/fracture/decision_figures.h"
#include "engine/fracture/flaws.h"
#include "engine/fracture/fracture_settings.h"
#include "engine/fracture/grains.h"
#include "engine/geometry/shell_mesh.h"
#include "engine/material/material.h"
#include "engine/stress/shell_system_cache.h"

namespace shatterbox::fracture {

using ShellLoad = ImpactLoad;
using ShellImpact = Impact;

/// A place where a crack stopped inside the material; it can run on in a later generation or impact.
struct CrackTip {
  int crack = 0;
  int edge = 0;                 // of the element mesh
  double parameter = 0.0;       // along the edge, from its lower-numbered vertex
  int element = 0;              // to be entered next
  Vec3 heading = Vec3::Zero();  // unit, in the plane of the element it came through
  double length = 0.0;          // m, of the crack behind it
};

/// The body: what it is made of, how it is held, what has happened to it so far.
struct ShellSubject {
  std::shared_ptr<const geometry::ShellMesh> mesh;
  /// Kept factors of the intact mesh, unscreened and one for each power of two of the screening; shared by
  /// all copies of the body, and kept from impact to impact (pieces make theirs at their first hit that
  /// passes the bound). Null: made for this decision and thrown away.
  std::shared_ptr<stress::ShellSystemCache> systems;
  material::Material material;
  double thickness = 0.0;                    // m
  std::vector<int> clamped_vertices;         // held, of the element mesh, ascending; empty: a free body
  std::shared_ptr<const FlawField> flaws;    // of the first parent; null: drawn from the seed
  std::shared_ptr<const GrainField> grains;  // null: no grains
  std::vector<CrackTip> tips;                // open tips, as the last decision left them
  std::uint64_t seed = 1;
};

struct Perforation;
struct ShellDent;

/// One straight stretch of a crack in one cell.
struct CrackSegment {
  int crack = 0;
  int side_id = 0;  // of both faces, in ShellCorner
  int generation = 0;
  bool is_on_grain = false;  // along a grain boundary
  std::array<Vec3, 2> ends;  // material space, m
};

struct Decision : DecisionFigures {
  std::shared_ptr<const geometry::ShellMesh> mesh;  // cracked; null unless it broke
  std::vector<geometry::CellContact> contacts;      // of its cells
  std::vector<CrackTip> tips;                       // that stopped inside the material
  std::vector<CrackSegment> segments;
  std::shared_ptr<const ShellDent> dent;  // of what holds, or has a hole; null: none
  /// Of what yields; if the striker goes through, its hole is the break. Null: nobody comes near that.
  std::shared_ptr<const Perforation> perforation;
  int dice = 0;            // into which stored stress broke it; what is stored is spent then
  double factor_ms = 0.0;  // wall time; enters no state
};

/// Fills in what is kept between impacts where it is null: the systems (nothing is factored yet) and the
/// flaws.
void prepare_subject(ShellSubject& subject);

/// The verdict, and the cracked mesh where it breaks.
Decision decide_shell(const ShellSubject& subject, const ShellImpact& impact,
                      const FractureSettings& settings = {});

}  // namespace shatterbox::fracture
