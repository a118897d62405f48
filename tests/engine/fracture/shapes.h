// Small shells for the tests of fracture: panes and spheres as shell meshes, and random chords through them.
#pragma once

#include <memory>

#include "engine/core/random.h"
#include "engine/fracture/shell_cutter.h"
#include "engine/geometry/generators.h"

namespace shatterbox::test {

inline std::shared_ptr<const geometry::ShellElements> make_elements(geometry::TriangleMesh mesh) {
  auto elements = std::make_shared<geometry::ShellElements>();
  elements->topology = geometry::build_edge_topology(mesh.triangles);
  elements->mesh = std::move(mesh);
  return elements;
}

inline std::shared_ptr<const geometry::ShellElements> make_pane(double size, double edge,
                                                                double jitter = 0.3) {
  return make_elements(geometry::make_pane(size, size, {edge, jitter, 1}).value());
}

inline std::shared_ptr<const geometry::ShellElements> make_sphere(double radius, double edge) {
  return make_elements(geometry::make_sphere(radius, {edge, 0.3, 1}).value());
}

/// Cuts a random cell along a chord between two random places of its border, corners of the cell included.
inline bool cut_at_random(fracture::ShellCutter& cutter, core::Random& random) {
  const int number = static_cast<int>(random.index(static_cast<std::uint64_t>(cutter.cell_count())));
  const fracture::CutCell& cell = cutter.cell(number);
  const auto place = [&]() {
    fracture::BorderPlace p;
    p.side = static_cast<int>(random.index(cell.polygon.size()));
    const auto& from = cell.polygon[static_cast<std::size_t>(p.side)];
    const auto& to = cell.polygon[(static_cast<std::size_t>(p.side) + 1) % cell.polygon.size()];
    p.is_corner = random.uniform() < 0.3;
    p.barycentric = from.barycentric;
    if (p.is_corner) return p;
    const double share = random.uniform();
    p.barycentric += share * (to.barycentric - from.barycentric);
    if (from.side == geometry::SideKind::element_edge) {
      const double q = geometry::edge_parameter(cutter.elements(), cell.element, from.side_id, p.barycentric);
      p.barycentric = geometry::barycentric_on_edge(cutter.elements(), cell.element, from.side_id,
                                                    geometry::round_edge_parameter(q));
    }
    return p;
  };
  const fracture::BorderPlace a = place();
  const fracture::BorderPlace b = place();
  return cutter.cut(number, a, b, geometry::SideKind::crack, cutter.new_side_id());
}

}  // namespace shatterbox::test
