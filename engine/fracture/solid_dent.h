// Dents of solids [BHTF07] sec. VII-B: what flowed stays. Departs from it in where and how far: not all of a
// displacement stays, times a constant, but the shape that the plastic strains leave the unloaded solid in,
// strains only where von Mises' stress passed the yield strength, as large as the energy says.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/fracture/dent.h"
#include "engine/fracture/solid_model.h"
#include "engine/material/material.h"

namespace shatterbox::fracture {

struct TornSolid;

struct SolidDent : DentFigures {
  std::shared_ptr<const SolidModel> model;
  std::shared_ptr<const TornSolid> torn;  // whose model it is; null: there are no open cracks
  VecX displacement;                      // |dof|, m, to first order; a free solid's without rigid motion
  std::vector<Vec3> moves;                // |vertices of the element mesh|, m: where it leaves them
};

/// What dents of one solid have left of its elements so far. All of them are told from the shape before.
struct LeftDents {
  std::shared_ptr<const geometry::SolidElements> elements;  // null: none yet
  std::vector<Vec3> displacement;                           // |vertices|, m, to first order
  std::vector<Vec3> moves;                                  // |vertices|, m
  std::shared_ptr<const TornSolid> torn;  // on whose copies the solid is by now; null: as it was
};

/// The moves that a share of a dent's strains leaves, after others. They are not a share of the dent's moves
/// (half of what turns is shorter than either), nor those that it makes alone.
std::vector<Vec3> moves_of_share(const SolidDent& dent, double share, const LeftDents& before);

/// Adds what `moves_of_share` gave; nothing where that has been taken to other elements.
void leave(const SolidDent& dent, double share, const std::vector<Vec3>& moves, LeftDents& left);

/// Pa, greatest, under a displacement (|dof|, m).
double greatest_von_mises(const SolidModel& model, const VecX& displacement);

/// What an impact's linear displacement at its peak (|dof|, m, of the collisions alone) means for the shape.
struct YieldFinding {
  double stress = 0.0;                    // Pa, von Mises, greatest
  std::shared_ptr<const SolidDent> dent;  // null: nothing flows, or its shape cannot be told
};

YieldFinding find_yield(const std::shared_ptr<const SolidModel>& model, const material::Material& material,
                        const VecX& displacement, const DentEnergy& energy);
/// Of the displacement of a model's mesh that has open cracks: they gape.
YieldFinding find_yield(const std::shared_ptr<const TornSolid>& torn, const material::Material& material,
                        const VecX& displacement, const DentEnergy& energy);

}  // namespace shatterbox::fracture
