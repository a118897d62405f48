// A pane that its border holds.
#pragma once

#include "engine/geometry/generators.h"
#include "engine/world/description.h"

namespace shatterbox::test {

/// Square, upright, in triangles of 3 cm.
inline world::ShellDescription held_pane(double side, double thickness) {
  geometry::Meshing meshing;
  meshing.edge_length = 0.03;
  world::ShellDescription shell;
  shell.mesh = geometry::make_pane(side, side, meshing).value();
  shell.thickness = thickness;
  const double border = 0.5 * side - 1e-4;
  for (std::size_t v = 0; v < shell.mesh.positions.size(); ++v)
    if (shell.mesh.positions[v].head<2>().cwiseAbs().maxCoeff() > border)
      shell.clamped.push_back(static_cast<int>(v));
  return shell;
}

}  // namespace shatterbox::test
