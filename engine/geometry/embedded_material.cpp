#include "engine/geometry/embedded_material.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "engine/core/index.h"
#include "engine/geometry/face_regions.h"
#include "engine/geometry/flat_cells.h"
#include "engine/geometry/material_cells.h"
#include "engine/geometry/mesh_findings.h"
#include "engine/geometry/solid_vertices.h"
#include "engine/geometry/surface_parts.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kLeastVolume = 1e-14;  // of an element: less is what rounding makes

class Embedding {
 public:
  Embedding(const SolidElements& elements, const TriangleMesh& surface, const EdgeTopology& surface_edges,
            const SurfaceCrossings& crossings)
      : elements_(elements),
        surface_(surface),
        surface_edges_(surface_edges),
        crossings_(crossings),
        positions_(place_vertices(elements, surface, surface_edges, crossings)) {}

  core::Result<EmbeddedMaterial> run() {
    for (Size v = 0; v < surface_.positions.size(); ++v)
      if (crossings_.vertex_tetrahedron[v] < 0) return uncovered(surface_.positions[v]);
    if (auto fault = divide_faces()) return core::Error{*fault};
    if (auto fault = divide_elements()) return core::Error{*fault};
    join_flat_cells(positions_, embedded_);
    place_facet_vertices();
    return std::move(embedded_);
  }

 private:
  static core::Error uncovered(const Vec3& place) {
    return core::Error{"the elements do not cover the surface: they end before " + at_place(place)};
  }

  static std::string does_not_fit(const Vec3& place) {
    return "the surface crosses itself near " + at_place(place);
  }

  Vec3 middle_of_face(Size f) const {
    Vec3 sum = Vec3::Zero();
    for (const int v : elements_.topology.faces[f]) sum += elements_.mesh.positions[at(v)] / 3.0;
    return sum;
  }

  /// The facets on all faces, and what the surface's triangles have in common with them.
  std::optional<std::string> divide_faces() {
    const Size count = elements_.topology.faces.size();
    is_whole_face_.assign(count, 0);
    FaceRegions regions(elements_, surface_, surface_edges_, crossings_, positions_);
    for (Size f = 0; f < count; ++f) {
      first_facet_.push_back(static_cast<int>(embedded_.material.facets.size()));
      first_segment_.push_back(static_cast<int>(segments_.size()));
      const auto& [first, second] = elements_.topology.face_tetrahedra[f];
      if (!crossings_.has_material[at(first)] && (second < 0 || !crossings_.has_material[at(second)]))
        continue;
      if (!regions.find(static_cast<int>(f))) return does_not_fit(middle_of_face(f));
      if (second < 0 && !regions.polygons().empty()) return uncovered(middle_of_face(f)).message;
      is_whole_face_[f] = regions.is_whole() ? 1 : 0;
      segments_.insert(segments_.end(), regions.segments().begin(), regions.segments().end());
      for (const std::vector<int>& polygon : regions.polygons())
        add_facet(polygon, FacetKind::element_face, -1);
    }
    first_facet_.push_back(static_cast<int>(embedded_.material.facets.size()));
    first_segment_.push_back(static_cast<int>(segments_.size()));
    return std::nullopt;
  }

  FacetLoop& add_facet(const std::vector<int>& polygon, FacetKind kind, int tag) {
    SolidMaterial& material = embedded_.material;
    FacetLoop facet;
    facet.first_corner = static_cast<int>(material.corners.size());
    facet.corner_count = static_cast<int>(polygon.size());
    facet.kind = kind;
    facet.tag = tag;
    material.corners.insert(material.corners.end(), polygon.begin(), polygon.end());
    material.facets.push_back(facet);
    return material.facets.back();
  }

  std::optional<std::string> divide_elements() {
    SurfaceParts parts(elements_, surface_, surface_edges_, crossings_, first_segment_, segments_);
    for (int t = 0; t < static_cast<int>(elements_.mesh.tetrahedra.size()); ++t) {
      if (!crossings_.has_material[at(t)]) continue;
      const auto& faces = elements_.topology.tetrahedron_faces[at(t)];
      if (!parts.find(t)) return does_not_fit(middle_of_face(at(faces[0])));
      const bool is_whole = parts.parts().empty() && std::all_of(faces.begin(), faces.end(), [&](int f) {
                              return is_whole_face_[at(f)] != 0;
                            });
      is_whole ? add_whole_cell(t) : add_cells(t, parts.parts());
    }
    return std::nullopt;
  }

  /// Side 0 of a face's facets is that of the face's first tetrahedron.
  Size side_of(int face, int t) const { return elements_.topology.face_tetrahedra[at(face)][0] == t ? 0 : 1; }

  void add_whole_cell(int t) {
    const int cell = static_cast<int>(embedded_.volumes.size());
    for (const int f : elements_.topology.tetrahedron_faces[at(t)])
      embedded_.material.facets[at(first_facet_[at(f)])].cells[side_of(f, t)] = cell;
    Vec3 centroid = Vec3::Zero();
    for (const int v : elements_.mesh.tetrahedra[at(t)]) centroid += 0.25 * elements_.mesh.positions[at(v)];
    add_cell(t, tetrahedron_volume(elements_.mesh, t), centroid, true);
  }

  void add_cell(int t, double volume, const Vec3& centroid, bool is_whole) {
    embedded_.material.cell_elements.push_back(t);
    embedded_.volumes.push_back(volume);
    embedded_.centroids.push_back(centroid);
    embedded_.is_whole.push_back(is_whole ? 1 : 0);
  }

  void add_cells(int t, const std::vector<SurfacePart>& parts) {
    SolidMaterial& material = embedded_.material;
    std::vector<std::pair<int, Size>> sides;  // facet, side
    for (const int f : elements_.topology.tetrahedron_faces[at(t)])
      for (int k = first_facet_[at(f)]; k < first_facet_[at(f) + 1]; ++k) sides.push_back({k, side_of(f, t)});
    for (const SurfacePart& part : parts) {
      sides.push_back({static_cast<int>(material.facets.size()), 0});
      add_facet(part.corners, FacetKind::outer, part.triangle);
    }
    std::vector<ElementPolygon> polygons;
    for (const auto& [k, side] : sides) {
      const FacetLoop& facet = material.facets[at(k)];
      polygons.push_back({material.corners.data() + facet.first_corner, facet.corner_count, side == 1, -1});
    }
    const double least = kLeastVolume * tetrahedron_volume(elements_.mesh, t);
    const std::vector<MaterialPart> cells = divide_into_parts(positions_, polygons, least);
    for (Size i = 0; i < sides.size(); ++i)
      material.facets[at(sides[i].first)].cells[sides[i].second] =
          static_cast<int>(embedded_.volumes.size()) + polygons[i].part;
    for (const MaterialPart& cell : cells)
      add_cell(t, cell.volume <= least ? 0.0 : cell.volume, cell.centroid, false);
  }

  /// Only the vertices in use, in their order, with their nodes.
  void place_facet_vertices() {
    SolidMaterial& material = embedded_.material;
    std::vector<int> number(positions_.size(), -1);
    for (const int v : material.corners) number[at(v)] = 0;
    const SolidVertexMaker maker(elements_, surface_, crossings_, positions_);
    for (Size v = 0; v < number.size(); ++v) {
      if (number[v] < 0) continue;
      number[v] = static_cast<int>(material.vertices.size());
      material.vertices.push_back(maker.make(static_cast<int>(v)));
    }
    for (int& v : material.corners) v = number[at(v)];
  }

  const SolidElements& elements_;
  const TriangleMesh& surface_;
  const EdgeTopology& surface_edges_;
  const SurfaceCrossings& crossings_;
  std::vector<Vec3> positions_;
  std::vector<int> first_facet_, first_segment_;  // |F| + 1
  std::vector<SurfaceSegment> segments_;
  std::vector<std::uint8_t> is_whole_face_;
  EmbeddedMaterial embedded_;
};

}  // namespace

core::Result<EmbeddedMaterial> embed_surface(const SolidElements& elements, const TriangleMesh& surface,
                                             const EdgeTopology& surface_edges,
                                             const SurfaceCrossings& crossings) {
  return Embedding(elements, surface, surface_edges, crossings).run();
}

core::Result<EmbeddedMaterial> embed_surface(const SolidElements& elements, const TriangleMesh& surface) {
  const EdgeTopology edges = build_edge_topology(surface.triangles);
  for (Size e = 0; e < edges.edges.size(); ++e)
    if (edges.triangle_count(static_cast<int>(e)) != 2)
      return core::Error{"the surface is not closed: see the edge at " +
                         at_place(surface.positions[at(edges.edges[e][0])])};
  const core::Result<SurfaceCrossings> crossings = find_surface_crossings(elements, surface, edges);
  if (!crossings) return core::Error{crossings.error()};
  return embed_surface(elements, surface, edges, crossings.value());
}

std::vector<double> embedded_volumes(const SolidElements& elements, const EmbeddedMaterial& embedded) {
  std::vector<double> volumes(elements.mesh.tetrahedra.size(), 0.0);
  for (Size c = 0; c < embedded.volumes.size(); ++c)
    volumes[at(embedded.material.cell_elements[c])] += embedded.volumes[c];
  return volumes;
}

}  // namespace shatterbox::geometry
