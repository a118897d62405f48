#include "engine/geometry/face_regions.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/index.h"
#include "engine/geometry/flat_regions.h"
#include "engine/geometry/orientation.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

/// The place on p-q that divides the heights of its ends (of different signs, or zero) by the plane of a, b,
/// c.
Vec3 place_between(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double height_p = std::abs(oriented_volume(a, b, c, p));
  const double height_q = std::abs(oriented_volume(a, b, c, q));
  const double sum = height_p + height_q;
  if (!(sum > 0.0)) return p;
  return height_p <= height_q ? Vec3(p + height_p / sum * (q - p)) : Vec3(q + height_q / sum * (p - q));
}

}  // namespace

CrossingVertices number_vertices(const SolidElements& elements, const TriangleMesh& surface,
                                 const SurfaceCrossings& crossings) {
  CrossingVertices vertices;
  vertices.first_mesh = static_cast<int>(surface.positions.size());
  vertices.first_edge = vertices.first_mesh + static_cast<int>(elements.mesh.positions.size());
  vertices.first_face = vertices.first_edge + static_cast<int>(crossings.edge_crossings.size());
  vertices.count = vertices.first_face + static_cast<int>(crossings.face_crossings.size());
  return vertices;
}

std::vector<Vec3> place_vertices(const SolidElements& elements, const TriangleMesh& surface,
                                 const EdgeTopology& surface_edges, const SurfaceCrossings& crossings) {
  const std::vector<Vec3>& mesh = elements.mesh.positions;
  std::vector<Vec3> positions = surface.positions;
  positions.insert(positions.end(), mesh.begin(), mesh.end());
  for (Size e = 0; e < elements.topology.edges.size(); ++e)
    for (int k = crossings.first_edge_crossing[e]; k < crossings.first_edge_crossing[e + 1]; ++k) {
      const auto& [p, q] = elements.topology.edges[e];
      const Triangle& t = surface.triangles[at(crossings.edge_crossings[at(k)].triangle)];
      positions.push_back(place_between(mesh[at(p)], mesh[at(q)], surface.positions[at(t[0])],
                                        surface.positions[at(t[1])], surface.positions[at(t[2])]));
    }
  for (Size f = 0; f < elements.topology.faces.size(); ++f)
    for (int k = crossings.first_face_crossing[f]; k < crossings.first_face_crossing[f + 1]; ++k) {
      const auto& [p, q] = surface_edges.edges[at(crossings.face_crossings[at(k)].edge)];
      const auto& corners = elements.topology.faces[f];
      positions.push_back(place_between(surface.positions[at(p)], surface.positions[at(q)],
                                        mesh[at(corners[0])], mesh[at(corners[1])], mesh[at(corners[2])]));
    }
  return positions;
}

FaceRegions::FaceRegions(const SolidElements& elements, const TriangleMesh& surface,
                         const EdgeTopology& surface_edges, const SurfaceCrossings& crossings,
                         const std::vector<Vec3>& positions)
    : elements_(elements),
      surface_(surface),
      surface_edges_(surface_edges),
      crossings_(crossings),
      positions_(positions),
      vertices_(number_vertices(elements, surface, crossings)) {}

bool FaceRegions::find(int face) {
  segments_.clear();
  next_.clear();
  loops_.clear();
  polygons_.clear();
  is_whole_ = false;
  const int first = elements_.topology.face_tetrahedra[at(face)][0];
  const auto& faces = elements_.topology.tetrahedron_faces[at(first)];
  const auto local = static_cast<int>(std::find(faces.begin(), faces.end(), face) - faces.begin());
  const int direction = face_direction(elements_.mesh.tetrahedra[at(first)], local);
  if (!find_segments(face, direction)) return false;
  walk_border(face, direction);
  if (!trace_loops()) return false;
  if (is_whole_) {
    polygons_ = loops_;
  } else if (!loops_.empty()) {
    const auto& corners = elements_.topology.faces[at(face)];
    const Vec3& a = elements_.mesh.positions[at(corners[0])];
    const Vec3 normal =
        (elements_.mesh.positions[at(corners[1])] - a).cross(elements_.mesh.positions[at(corners[2])] - a);
    polygons_ = divide_flat_region(positions_, loops_, direction * normal);
  }
  return true;
}

/// Each triangle that meets the face has a beginning and an end on it: where the material goes out over the
/// face's border, or a side of the triangle comes in through the face, and the other way round.
bool FaceRegions::find_segments(int face, int direction) {
  ends_.clear();
  const auto& corners = elements_.topology.faces[at(face)];
  const int first = elements_.topology.face_tetrahedra[at(face)][0];
  for (Size i = 0; i < 3; ++i) {
    const int from = corners[i], to = corners[(i + 1) % 3];
    for (const int e : elements_.topology.tetrahedron_edges[at(first)]) {
      const auto& ends = elements_.topology.edges[at(e)];
      if (ends[0] != std::min(from, to) || ends[1] != std::max(from, to)) continue;
      // The border runs counter-clockwise seen from outside.
      const bool is_along = (from < to) == (direction > 0);
      for (int k = crossings_.first_edge_crossing[at(e)]; k < crossings_.first_edge_crossing[at(e) + 1];
           ++k) {
        const EdgeCrossing& crossing = crossings_.edge_crossings[at(k)];
        ends_.push_back({crossing.triangle, vertices_.first_edge + k, crossing.enters != is_along});
      }
    }
  }
  for (int k = crossings_.first_face_crossing[at(face)]; k < crossings_.first_face_crossing[at(face) + 1];
       ++k) {
    const FaceCrossing& crossing = crossings_.face_crossings[at(k)];
    const auto begin = at(surface_edges_.first_triangle[at(crossing.edge)]);
    for (const Size i : {begin, begin + 1}) {
      const int t = surface_edges_.edge_triangles[i];
      const int along = direction_along(surface_.triangles[at(t)], surface_edges_.edges[at(crossing.edge)]);
      ends_.push_back({t, vertices_.first_face + k, along * crossing.passage * direction < 0});
    }
  }
  std::sort(ends_.begin(), ends_.end(), [](const End& p, const End& q) {
    return p.triangle != q.triangle ? p.triangle < q.triangle : p.is_start > q.is_start;
  });
  if (ends_.size() % 2 != 0) return false;
  for (Size i = 0; i < ends_.size(); i += 2) {
    const End &start = ends_[i], &end = ends_[i + 1];
    if (start.triangle != end.triangle || !start.is_start || end.is_start) return false;
    segments_.push_back({start.triangle, start.vertex, end.vertex});
  }
  return true;
}

/// The parts of the border that are inside, and the segments, as steps from vertex to vertex.
void FaceRegions::walk_border(int face, int direction) {
  struct Stop {
    int vertex;
    bool goes_on_inside;
  };
  std::vector<Stop> stops;
  std::array<int, 3> corners = elements_.topology.faces[at(face)];
  if (direction < 0) std::swap(corners[1], corners[2]);
  const int first = elements_.topology.face_tetrahedra[at(face)][0];
  for (Size i = 0; i < 3; ++i) {
    const int from = corners[i], to = corners[(i + 1) % 3];
    if (crossings_.is_inside[at(from)]) stops.push_back({vertices_.first_mesh + from, true});
    for (const int e : elements_.topology.tetrahedron_edges[at(first)]) {
      const auto& ends = elements_.topology.edges[at(e)];
      if (ends[0] != std::min(from, to) || ends[1] != std::max(from, to)) continue;
      const int begin = crossings_.first_edge_crossing[at(e)],
                end = crossings_.first_edge_crossing[at(e) + 1];
      for (int n = 0; n < end - begin; ++n) {
        const int k = from < to ? begin + n : end - 1 - n;
        stops.push_back({vertices_.first_edge + k, crossings_.edge_crossings[at(k)].enters == (from < to)});
      }
    }
  }
  for (Size i = 0; i < stops.size(); ++i)
    if (stops[i].goes_on_inside) next_.push_back({stops[i].vertex, stops[(i + 1) % stops.size()].vertex});
  is_whole_ = segments_.empty() && next_.size() == 3;
  for (const SurfaceSegment& s : segments_) next_.push_back({s.from, s.to});
  std::sort(next_.begin(), next_.end());
}

bool FaceRegions::trace_loops() {
  std::vector<std::uint8_t> is_done(next_.size(), 0);
  for (Size seed = 0; seed < next_.size(); ++seed) {
    if (is_done[seed]) continue;
    loops_.emplace_back();
    for (Size i = seed; !is_done[i];) {
      is_done[i] = 1;
      loops_.back().push_back(next_[i].first);
      const auto after = std::lower_bound(next_.begin(), next_.end(), std::pair{next_[i].second, -1});
      if (after == next_.end() || after->first != next_[i].second) return false;
      i = static_cast<Size>(after - next_.begin());
    }
  }
  return true;
}

}  // namespace shatterbox::geometry
