#include "engine/geometry/tetrahedralise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/geometry/box_tets.h"
#include "engine/geometry/generator_faults.h"
#include "engine/geometry/lattice_warp.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/mesh_findings.h"
#include "engine/geometry/tet_lattice.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

/// Of a large cell, on average: how much farther from the surface they begin than they must, for they stand
/// at whole multiples of their size; measured.
constexpr double kAlignment = 0.75;

/// The cell size for about `count` tetrahedra: twelve a cell, over the volume and a layer along the surface.
double size_for_count(const TriangleMesh& surface, const TetrahedraOptions& options) {
  const double layer = options.warps ? 0.16 : 0.31;  // of a cell, on average beyond the surface: measured
  const double volume = enclosed_volume(surface), area = surface_area(surface);
  const double radius = 3.0 * volume / area;  // of a ball of such a volume and area
  const auto makes_too_many = [&](double size) {
    double filled = volume + layer * area * size;
    // Where eight cells join to one, and that again.
    for (int level = 1; 1 << level <= options.grading; ++level) {
      const double depth = (least_depth(level) + kAlignment * (1 << level)) * size;
      const double share = std::max(0.0, 1.0 - depth / radius);
      filled -= 7.0 / core::pow(8.0, level) * volume * share * share * share;
    }
    return 12.0 * filled > options.count * size * size * size;
  };
  double low = 0.0, high = core::sqrt(area) + volume / area;
  while (makes_too_many(high)) high *= 2.0;
  for (int i = 0; i < 60; ++i) {
    const double size = 0.5 * (low + high);
    (makes_too_many(size) ? low : high) = size;
  }
  return high;
}

/// A vertex as a mean of the corners of one element that it lies in, or on but for rounding.
void place_in_element(const SolidElements& elements, int element, SolidVertex& vertex) {
  Tetrahedron nodes = elements.mesh.tetrahedra[at(element)];
  std::sort(nodes.begin(), nodes.end());
  std::array<Vec3, 4> corners;
  for (Size k = 0; k < 4; ++k) corners[k] = elements.mesh.positions[at(nodes[k])];
  const auto six_volumes = [](const std::array<Vec3, 4>& c) {
    return (c[1] - c[0]).cross(c[2] - c[0]).dot(c[3] - c[0]);
  };
  const double whole = six_volumes(corners);
  std::array<double, 4> shares;
  double sum = 0.0;
  for (Size k = 0; k < 4; ++k) {
    std::array<Vec3, 4> with_vertex = corners;
    with_vertex[k] = vertex.position;
    shares[k] = std::max(six_volumes(with_vertex) / whole, 0.0);
    if (shares[k] < 1e-15) shares[k] = 0.0;
    sum += shares[k];
  }
  vertex.nodes.fill(-1);
  vertex.weights.fill(0.0);
  for (Size k = 0, kept = 0; k < 4; ++k)
    if (shares[k] > 0.0) {
      vertex.nodes[kept] = nodes[k];
      vertex.weights[kept++] = shares[k] / sum;
    }
}

/// Drops elements without material, and the nodes of nothing else.
void drop_empty_elements(SolidElements& elements, SolidMaterial& material) {
  std::vector<int> element_number(elements.mesh.tetrahedra.size(), -1);
  std::vector<int> node_number(elements.mesh.positions.size(), -1);
  for (const int t : material.cell_elements) {
    element_number[at(t)] = 0;
    for (const int v : elements.mesh.tetrahedra[at(t)]) node_number[at(v)] = 0;
  }
  // What was joined to a neighbour may have corners that belong to elements that go.
  for (const FacetLoop& facet : material.facets)
    for (int i = facet.first_corner; i < facet.first_corner + facet.corner_count; ++i) {
      SolidVertex& vertex = material.vertices[at(material.corners[at(i)])];
      if (std::any_of(vertex.nodes.begin(), vertex.nodes.end(),
                      [&](int v) { return v >= 0 && node_number[at(v)] < 0; }))
        place_in_element(elements, material.cell_elements[at(facet.cells[0])], vertex);
    }
  Size kept = 0;
  for (Size v = 0; v < node_number.size(); ++v) {
    if (node_number[v] < 0) continue;
    node_number[v] = static_cast<int>(kept);
    elements.mesh.positions[kept++] = elements.mesh.positions[v];
  }
  elements.mesh.positions.resize(kept);
  kept = 0;
  for (Size t = 0; t < element_number.size(); ++t) {
    if (element_number[t] < 0) continue;
    element_number[t] = static_cast<int>(kept);
    Tetrahedron corners = elements.mesh.tetrahedra[t];
    for (int& v : corners) v = node_number[at(v)];
    elements.mesh.tetrahedra[kept++] = corners;
  }
  elements.mesh.tetrahedra.resize(kept);
  elements.topology = build_tet_topology(elements.mesh.tetrahedra);
  for (int& t : material.cell_elements) t = element_number[at(t)];
  for (SolidVertex& vertex : material.vertices)
    for (int& v : vertex.nodes)
      if (v >= 0) v = node_number[at(v)];
}

}  // namespace

double element_size_for(const TriangleMesh& surface, const TetrahedraOptions& options) {
  return options.element_size == 0.0 && options.count > 0 ? size_for_count(surface, options)
                                                          : options.element_size;
}

core::Result<EmbeddedSolid> tetrahedralise(const TriangleMesh& surface, const TetrahedraOptions& options) {
  const EdgeTopology edges = build_edge_topology(surface.triangles);
  for (Size e = 0; e < edges.edges.size(); ++e)
    if (edges.triangle_count(static_cast<int>(e)) != 2)
      return core::Error{"the surface is not closed: see the edge at " +
                         at_place(surface.positions[at(edges.edges[e][0])])};
  const double volume = enclosed_volume(surface);
  if (!(volume > 0.0)) return core::Error{"the surface is inside out, or encloses nothing"};
  const double size = element_size_for(surface, options);
  if (const auto fault = find_size_fault("the element size", size)) return core::Error{*fault};
  if (!is_grading(options.grading))
    return core::Error{"a grading of " + std::to_string(options.grading) + " is none: it is 1, 2, 4 or 8"};

  core::Result<TetMesh> lattice = make_covering_lattice(surface, size, options.grading, kMostTetrahedra);
  if (!lattice) return core::Error{lattice.error()};
  SolidElements all{std::move(lattice.value()), {}};
  all.topology = build_tet_topology(all.mesh.tetrahedra);
  core::Result<SurfaceCrossings> crossings = find_surface_crossings(all, surface, edges);
  if (!crossings) return core::Error{crossings.error()};
  if (options.warps)
    if (const auto fault = warp_lattice(all, crossings.value(), surface, edges, size))
      return core::Error{*fault};
  core::Result<EmbeddedMaterial> embedded = embed_surface(all, surface, edges, crossings.value());
  if (!embedded) return core::Error{embedded.error()};
  drop_empty_elements(all, embedded.value().material);
  EmbeddedSolid solid;
  solid.element_size = size;
  solid.quality = measure_quality(all.mesh);
  solid.cover_ratio = solid.quality.volume / volume;
  solid.elements = std::make_shared<const SolidElements>(std::move(all));
  solid.embedded = std::move(embedded.value());
  return solid;
}

}  // namespace shatterbox::geometry
