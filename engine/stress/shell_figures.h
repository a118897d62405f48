// What every impact on one piece asks of its mesh, whatever the load: made once, kept beside the factors.
#pragma once

#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/shell_mesh.h"
#include "engine/stress/shell_stiffness.h"

namespace shatterbox::stress {

struct ShellFigures {
  std::vector<geometry::CellContact> contacts;  // of find_cell_contacts
  VecX lumped_mass;                             // |dof|, kg and kg m2
  geometry::MassProperties mass;                // of the material, kg, m
  double size = 0.0;                            // m, greatest side of the bounding box of the uncut elements
  double reach = 0.0;                           // m, diagonal of the box of the elements with cells
  double mean_edge_length = 0.0;                // m, of the elements with cells
  std::vector<double> stressed_areas;           // |cells|, m2: see stress_bound.h
};

ShellFigures make_shell_figures(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh);

}  // namespace shatterbox::stress
