// Cracks of one generation in a solid: where they start, and how far each runs: from cell to cell while the
// stress drives it on, until it arrests, reaches the surface, or meets another cut.
#pragma once

#include <optional>
#include <vector>

#include "engine/fracture/crack_set.h"
#include "engine/fracture/solid_crack.h"
#include "engine/fracture/solid_guides.h"
#include "engine/fracture/space_grains.h"
#include "engine/geometry/solid_complex.h"
#include "engine/geometry/solid_cutter.h"
#include "engine/material/material.h"
#include "engine/stress/solid_stress.h"

namespace shatterbox::fracture {

/// A flaw that the stress is above.
struct SolidCandidate {
  int cell = 0;
  Vec3 place = Vec3::Zero();  // m
  double strength = 0.0;      // Pa
  double overload = 0.0;      // stress / strength, above 1
  int number = 0;             // breaks ties
};

struct SolidLoadCentre {
  Vec3 point = Vec3::Zero();
  double radius = 0.0;  // m, of its patch
};

/// A crack that may run on in a later generation.
struct OpenCrack {
  int id = 0;              // tag of its facets
  double area = 0.0;       // m2
  CrackValues values;      // of its field
  std::vector<int> rests;  // elements that it did not enter
};

/// The solved mesh of a generation and its displacement: how far a crack stands open.
struct SolvedOpening {
  const geometry::SolidMesh* mesh = nullptr;
  const VecX* displacement = nullptr;  // |dof|, m
};

/// What does not change while the cracks of a generation run. All that is pointed to must outlive the tracer.
struct SolidTracerSetup {
  SolidGuideSetup guides;  // stresses and pieces are those of the cells at the generation's beginning
  SolvedOpening solved;
  const material::Material* material = nullptr;
  double fracture_energy = 0.0;         // J/m2, of what is no boundary between grains
  const SpaceGrains* grains = nullptr;  // null: none
  std::vector<SolidLoadCentre> centres;
  double least_size = 0.0;     // m, of a crack, and of what is between two: what the elements can tell
  double energy_budget = 0.0;  // J, for this generation; below zero: no guard
  double resting_share = 0.0;  // of the forces on it, those that stay while a crack opens
  int first_id = 0;            // tag of the first crack's facets
};

/// Cuts `complex`. One object a generation.
class SolidTracer {
 public:
  SolidTracer(geometry::SolidComplex& complex, SolidTracerSetup setup);

  /// Lets cracks of earlier generations run on where they rested, and keeps account of them.
  void resume(std::vector<OpenCrack>& cracks);
  /// Starts cracks at the candidates, most overloaded first, not too near to each other, and lets each run.
  /// They join `cracks`.
  void nucleate(std::vector<SolidCandidate> candidates, std::vector<OpenCrack>& cracks);

  /// |cells| of the complex as it is now: which one each was when the generation began.
  const std::vector<int>& origins() const { return origin_; }
  /// Where a crack was begun and came to nothing: it would have lain between cells, or stayed too small to
  /// tell.
  const std::vector<SolidCandidate>& stillborn() const { return stillborn_; }
  int crack_count() const { return crack_count_; }   // new ones
  double area() const { return area_; }              // m2, of the new cracks
  double grain_area() const { return grain_area_; }  // m2 of it, along grain boundaries
  double energy() const { return energy_; }          // J, used
  double given() const { return given_; }            // J of it, by what rests on what tore as a whole
  bool is_out_of_energy() const { return is_out_of_energy_; }

 private:
  /// A facet over which a crack may go on.
  struct Front {
    double drive = 0.0;      // Pa, of the stress across it behind the facet
    double intensity = 0.0;  // Pa sqrt(m), by which the crack stands open there, as it was solved
    int order = 0, cell = 0;
    bool operator<(const Front& other) const {
      return drive != other.drive ? drive < other.drive : order > other.order;
    }
  };
  /// How far the present crack has come.
  struct Extent {
    std::size_t cells = 0;
    double area = 0.0, new_area = 0.0, new_grain_area = 0.0, new_energy = 0.0, force = 0.0, drive = 0.0,
           pull = 0.0;
  };
  /// A cell that the present crack might enter.
  struct Step {
    int cell = 0;
    CrackCap cap;
    double tension = 0.0;    // Pa
    double solved = 0.0;     // Pa sqrt(m), of the front
    double intensity = 0.0;  // Pa sqrt(m), that drives it there
  };
  bool is_shielded(const SolidCandidate& candidate) const;
  void look_ahead(const std::vector<SolidCandidate>& candidates, std::size_t first, std::size_t most,
                  std::vector<CrackValues>& fields);
  bool start(const SolidCandidate& candidate, CrackValues field, std::vector<OpenCrack>& cracks);
  void begin(int id, double area, double strength);
  void bear_out();
  Extent extent() const;
  void take_back(const Extent& extent);
  void fall_back();
  std::optional<Step> next_step();
  void enter(const Step& step);
  double opening_of(const geometry::SolidFacet& facet) const;
  void grow();
  void tear();
  double tension_across(int cell, const Vec3& gradient) const;
  std::optional<double> intensity_beside(int cell);
  bool runs_beside_crack(int cell, const CrackCap& cap) const;
  double boundary_weakness() const;
  double weakness_at(int element) const;
  double cost_of(double area, double weakness) const;
  bool pay(double area, double weakness);
  void charge(double area, double weakness);
  bool take();
  void add_cells_beyond(std::vector<int>& cells);
  void cut();

  geometry::SolidComplex& complex_;
  SolidTracerSetup setup_;
  geometry::SolidCutter cutter_;
  CrackField field_;
  CrackSet present_;             // caps of this generation
  std::vector<double> lengths_;  // m, square root of each crack's area, by id
  SolidGuides guides_;
  std::vector<int> origin_;    // |cells|: the cell at the generation's beginning that it is part of
  std::vector<int> entered_;   // |cells|: id of the last crack in it + 1
  std::vector<int> active_;    // cells of the present crack
  std::vector<Vec3> middles_;  // m, of its caps in them
  std::vector<Front> fronts_;  // heap
  std::vector<Front> halted_;  // those where K is below K_Ic
  std::vector<int> rests_;     // elements that the present crack did not enter
  std::vector<SolidCandidate> stillborn_;
  int next_order_ = 0, crack_count_ = 0, present_id_ = 0;
  double crack_area_ = 0.0;      // m2, of the present crack
  double solved_area_ = 0.0;     // m2, of it when it was solved
  double crack_force_ = 0.0;     // N, across what of it is new
  double crack_drive_ = 0.0;     // Pa2 m3: K^2 over that
  double crack_pull_ = 0.0;      // N, across what of it is pulled
  double new_area_ = 0.0;        // m2, of that
  double new_grain_area_ = 0.0;  // m2 of that, along grain boundaries
  double new_energy_ = 0.0;      // J, for it
  double strength_ = 0.0;        // Pa, of the flaw where the present crack starts
  double balance_ = 0.0;         // Pa2 m3: K^2 - K_Ic^2 over what of its area is not borne out yet
  Extent borne_out_;             // of it: as far as what drives it pays for all of it
  double area_ = 0.0, grain_area_ = 0.0, energy_ = 0.0, given_ = 0.0, toughness_ = 0.0;
  bool is_out_of_energy_ = false;
};

/// Whether a point is in a settled cell, as far as the planes of its facets tell (border included).
bool cell_holds(const geometry::SolidComplex& complex, int cell, const Vec3& point);

}  // namespace shatterbox::fracture
