// Solids for the tests of cutting: Kuhn's cubes, and random cuts of any kind through them.
#pragma once

#include <memory>

#include "engine/core/random.h"
#include "engine/geometry/solid_cutter.h"

namespace shatterbox::test {

/// The unit cube as n x n x n cubes of six tetrahedra each, vertices inside moved by `jitter` of an edge.
inline std::shared_ptr<const geometry::SolidElements> make_cube_elements(int n, double jitter = 0.0,
                                                                         std::uint64_t seed = 1) {
  auto elements = std::make_shared<geometry::SolidElements>();
  core::Random random(seed);
  const int m = n + 1;
  for (int z = 0; z < m; ++z)
    for (int y = 0; y < m; ++y)
      for (int x = 0; x < m; ++x) {
        Vec3 p(x, y, z);
        const Eigen::Vector3i place(x, y, z);
        for (int k = 0; k < 3; ++k) {
          const double shift = jitter * random.uniform(-1.0, 1.0);
          if (place[k] > 0 && place[k] < n) p[k] += shift;
        }
        elements->mesh.positions.push_back(p / n);
      }
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const auto v = [&](int i) { return ((z + (i >> 2)) * m + y + ((i >> 1) & 1)) * m + x + (i & 1); };
        for (const auto& t :
             {std::array{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}})
          elements->mesh.tetrahedra.push_back({v(t[0]), v(t[1]), v(t[2]), v(t[3])});
      }
  elements->topology = geometry::build_tet_topology(elements->mesh.tetrahedra);
  return elements;
}

inline std::vector<int> all_cells(const geometry::SolidComplex& complex) {
  std::vector<int> cells;
  for (std::size_t c = 0; c < complex.cells.size(); ++c) cells.push_back(static_cast<int>(c));
  return cells;
}

/// The plane normal . x = offset, in all cells.
inline geometry::SolidCut plane_cut(const geometry::SolidComplex& complex, const Vec3& normal, double offset,
                                    int id = 0) {
  geometry::SolidCut cut;
  for (const Vec3& p : complex.elements->mesh.positions) cut.node_values.push_back(normal.dot(p) - offset);
  cut.cells = all_cells(complex);
  cut.id = id;
  return cut;
}

/// A cut to make trouble: a plane anywhere, through three nodes, along an edge, hardly off one of these, the
/// last one again, a field of random values, or of whole ones with many zeros; in all cells, in some, or on
/// one side of an earlier plane.
inline geometry::SolidCut random_cut(const geometry::SolidComplex& complex, core::Random& random, int id,
                                     geometry::SolidCut* last = nullptr) {
  const auto& positions = complex.elements->mesh.positions;
  const auto node = [&]() -> const Vec3& { return positions[random.index(positions.size())]; };
  geometry::SolidCut cut;
  const std::uint64_t kind = random.index(8);
  const double tiny =
      random.index(2) == 0 ? 0.0 : 1e-3 * random.normal() * random.uniform() * random.uniform();
  Vec3 normal = Vec3(random.normal(), 0, 0);
  normal.y() = random.normal();
  normal.z() = random.normal();
  const Vec3 a = node(), b = node(), c = node();
  double offset = normal.dot(positions[0]) + random.uniform() * normal.dot(positions.back() - positions[0]);
  if (kind == 0) normal = (b - a).cross(c - a);
  if (kind == 1) normal = (b - a).cross(normal);
  if (kind <= 2) offset = normal.dot(a) + tiny;
  for (const Vec3& p : positions) {
    double value = normal.dot(p) - offset;
    if (kind == 3) value = random.normal();
    if (kind == 4) value = static_cast<double>(random.index(3)) - 1.0;
    if (kind == 5) value += 0.2 * random.normal();
    cut.node_values.push_back(value);
  }
  if (kind == 6 && last) {
    cut.node_values = last->node_values;
    for (double& value : cut.node_values) value += tiny;
  }
  const std::uint64_t where = random.index(3);
  for (const int cell : all_cells(complex))
    if (where == 0 || (where == 1 && random.index(3) > 0) ||
        (where == 2 &&
         positions[static_cast<std::size_t>(complex.elements->mesh.tetrahedra[static_cast<std::size_t>(
                       complex.cells[static_cast<std::size_t>(cell)].element)][1])]
                 .x() < 0.6))
      cut.cells.push_back(cell);
  cut.kind = random.index(5) == 0 ? geometry::FacetKind::grain : geometry::FacetKind::crack;
  cut.id = id;
  if (last) *last = cut;
  return cut;
}

}  // namespace shatterbox::test
