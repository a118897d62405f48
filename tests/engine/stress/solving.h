// What the tests of solves share: a material, loads, supports, differences.
#pragma once

#include <catch2/catch.hpp>

#include "engine/core/index.h"
#include "engine/stress/shell_load.h"
#include "engine/stress/shell_stress.h"
#include "engine/stress/shell_system.h"

namespace shatterbox::stress::testing {

inline ShellProperties properties_of(double thickness, double poisson_ratio = 0.3) {
  ShellProperties properties;
  properties.youngs_modulus = 2e9;
  properties.poisson_ratio = poisson_ratio;
  properties.density = 1200.0;
  properties.thickness = thickness;
  return properties;
}

inline double bending_stiffness(const ShellProperties& p) {
  return p.youngs_modulus * p.thickness * p.thickness * p.thickness /
         (12.0 * (1.0 - p.poisson_ratio * p.poisson_ratio));
}

inline std::shared_ptr<const ShellSystem> make_system(const std::shared_ptr<const ShellStiffness>& stiffness,
                                                      const geometry::ShellMesh& mesh, double screening = 0.0,
                                                      const ShellSupport& support = {}) {
  auto system = ShellSystem::make(stiffness, mesh, screening, support);
  REQUIRE(system.ok());
  return system.value();
}

/// Border of the unit square: vertices, and edges if clamped.
inline ShellSupport square_support(const geometry::ShellMesh& mesh, bool is_clamped) {
  const auto& elements = *mesh.elements;
  std::vector<char> vertices(elements.mesh.positions.size(), 0);
  std::vector<char> edges(elements.topology.edges.size(), 0);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!elements.topology.is_boundary(static_cast<int>(e))) continue;
    edges[e] = is_clamped ? 1 : 0;
    for (const int v : elements.topology.edges[e]) vertices[core::at(v)] = 1;
  }
  return find_support(mesh, vertices, edges);
}

inline VecX pressure_load(const geometry::ShellMesh& mesh, double pressure) {
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  for (const geometry::ShellCell& cell : mesh.cells) {
    const Vec3 normal = geometry::facet_frame(*mesh.elements, cell.element).col(2);
    for (const int v : cell.vertices) load.segment<3>(vertex_dof(v)) += pressure * cell.area / 3.0 * normal;
  }
  return load;
}

inline Vec3 stress_norms(const std::vector<CellStress>& a, const std::vector<CellStress>& b) {
  double difference = 0.0, size = 0.0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    difference += (a[c].membrane - b[c].membrane).squaredNorm() + (a[c].bending - b[c].bending).squaredNorm();
    size += b[c].membrane.squaredNorm() + b[c].bending.squaredNorm();
  }
  return {core::sqrt(difference / size), core::sqrt(size), 0.0};
}

}  // namespace shatterbox::stress::testing
