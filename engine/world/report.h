// What a run did, in numbers with units: impacts with their verdicts, breaks with their errors, contact,
// conservation.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/body/body.h"
#include "engine/core/stage_timer.h"
#include "engine/core/vec.h"

namespace shatterbox::world {

/// One impact whose stress was evaluated (or could not be).
struct ImpactRow {
  double time = 0.0;  // s
  std::string body;
  body::BodyId id = 0;
  bool is_struck = false;           // by a collision; otherwise contact alone pressed
  double impulse = 0.0;             // N s
  double duration = 0.0;            // s
  double stress = 0.0;              // Pa, greatest principal, the pulse's peak
  double strength = 0.0;            // Pa, there
  double ratio = 0.0;               // stress / strength
  double von_mises = 0.0;           // Pa, greatest; of what can yield
  double yield = 0.0;               // Pa; 0: it does not yield, or was not asked
  double perforation_energy = 0.0;  // J, that the striker needs to go through; 0: it is far from that
  double perforation_ratio = 0.0;   // of that, what it has
  std::string verdict;              // "broke", "held: 0.62 of its strength", "not evaluated: ..."
  Vec3 place = Vec3::Zero();        // m, world, at that time
};

/// One body that came apart.
struct BreakRow {
  double time = 0.0;  // s
  std::string body;
  body::BodyId id = 0;
  int pieces = 0;
  double new_area = 0.0;                // m2: crack length times thickness
  double grain_share = 0.0;             // of new area on grain boundaries
  double fracture_energy = 0.0;         // J, used by cracks
  double elastic_energy = 0.0;          // J, available
  double mass_error = 0.0;              // relative, by sum over the pieces
  double momentum_error = 0.0;          // relative
  double angular_momentum_error = 0.0;  // relative, about the parent's centre
  double energy_gain = 0.0;             // kinetic, after / before - 1, at the birth
  double thickness = 0.0;               // m
  int generation = 0;                   // within its impact event, 0 for the first break
  int crack_generations = 0;            // solves of the cracking body
  bool energy_guard_active = false;
  bool generation_bound_active = false;
  double mass = 0.0;  // kg, of what broke
  int merged = 0;     // pieces that joined a neighbour: nothing could resolve them, or there was no room
  double merged_mass = 0.0;   // kg, of them
  Vec3 place = Vec3::Zero();  // m, world: where the hit was
  /// Cracks as segments in the parent's material space (x, y, z of both ends), for studies of their
  /// orientation.
  std::vector<std::array<Vec3, 2>> cracks;
  std::vector<body::BodyId> born;                          // the pieces; one if a crack set nothing free
  Vec3 place_material = Vec3::Zero();                      // m
  std::vector<std::shared_ptr<const body::Shape>> shapes;  // of the pieces
};

/// Pairs of triangles of different pieces that cross at the birth, counted when asked for.
long count_overlaps(const BreakRow& row);

/// One dent that an impact left.
struct DentRow {
  double time = 0.0;  // s
  std::string body;
  body::BodyId id = 0;         // that it had until then
  body::BodyId born = 0;       // that it has since; 0: there was no room for a dent
  double depth = 0.0;          // m: farthest that a point of its surface moved
  double volume_change = 0.0;  // relative
  double energy = 0.0;         // J, of plastic flow
  double flowed_volume = 0.0;  // m3
  double torn_area = 0.0;      // m2, of the tears that it opened (one face)
  double von_mises = 0.0;      // Pa, greatest
  double yield = 0.0;          // Pa
  double share = 1.0;          // of the dent for which there was room; 0: none
  bool is_cut = false;         // all of it would have crushed elements, or swollen
  double mass_error = 0.0;     // relative
  Vec3 place = Vec3::Zero();   // m, world: where the hit was
};

/// One joint: the most that it ever bore, and whether it is open.
struct JointRow {
  int number = 0;
  std::string name, body_a, body_b;  // as they were when it was made
  double area = 0.0;                 // m2
  double most_ratio = 0.0;           // of what it can bear
  Vec3 force = Vec3::Zero();         // N on a then: along the normal from b to a, and across it
  Vec3 moment = Vec3::Zero();        // N m, about the same axes
  double tension = 0.0;              // Pa, greatest at the rim; less than 0: all of it was pressed
  double shear = 0.0;                // Pa
  bool is_struck = false;            // by a collision
  double opened = -1.0;              // s; -1: it holds
  std::string verdict;               // "opened: 1.3 of its strength in shear", "held: 0.62 of its strength"
};

struct ContactFigures {
  int contacts = 0;  // with a gap below twice the kept one, last step
  int most_contacts = 0;
  double least_gap =
      0.0;  // m, over the run and all pairs but those that crossed at their start; 0: none near
  long crossing_pairs = 0;  // crossed when they were first seen: exempt until they have come apart
  std::vector<std::string> crossing_names;  // "a / b", of the first hundred
  std::vector<std::string> parted_names;    // "a / b": b lay exactly in a and was set aside; a hundred
  int longest_cut = 0;                      // steps in a row in which the failsafe had to cut one body short:
  std::string longest_cut_names;            // "a / b", it and whom it met then; empty: none
  long failsafe_steps = 0;
  double body_steps = 0.0;  // steps of bodies that were awake
  double frozen_body_steps = 0.0;
  double frozen_share = 0.0;  // of them: these by those
  double drift = 0.0;         // m, ContactScheme::paper: greatest distance of a surface from its rigid body
  double residual = 0.0;      // m/s, worst normal velocity left by the solver, last step
  int hits = 0;               // pairs in which the continuous pass had to act, last step
  long ways_tested = 0;       // pairs of bodies, a step and round each, whose ways the continuous pass tested
  double test_bytes = 0.0;    // that it kept for that, most in one step, hits apart
};

/// A scripted body with a path: how far its farthest point is from where it is to be, m.
struct ScriptedRow {
  body::BodyId id = 0;
  std::string body;
  double behind = 0.0;       // now
  double most_behind = 0.0;  // over the run
};

struct ConservationFigures {
  Vec3 momentum = Vec3::Zero();       // kg m/s, of all dynamic bodies
  double kinetic_energy = 0.0;        // J
  double potential_energy = 0.0;      // J, against the world's origin
  double greatest_energy_rise = 0.0;  // J, of the total energy from one step to the next, commands apart
  double momentum_error =
      0.0;  // kg m/s: greatest step's change that the impulse log and gravity do not explain
};

struct SolverFigures {
  double worst_residual = 0.0;  // relative, of the stress solves
  long solves = 0;
  long skipped = 0;  // impacts that a bound showed to be harmless, or that are like one just borne
  long factorisations = 0;
};

struct WorldReport {
  std::vector<ImpactRow> impacts;
  std::vector<BreakRow> breaks;
  std::vector<DentRow> dents;
  std::vector<JointRow> joints;  // by number
  ContactFigures contact;
  std::vector<ScriptedRow> scripted;  // ascending ids
  ConservationFigures conservation;
  SolverFigures solver;
  core::StageTimer stages;
  long steps = 0;
  int bodies_start = 0;
  long triangles_start = 0, triangles_most = 0;
  long tetrahedra_start = 0, tetrahedra_end = 0, tetrahedra_most = 0;  // cells of breakable solids
};

}  // namespace shatterbox::world
