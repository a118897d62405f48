#include "engine/geometry/surface_parts.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

}  // namespace

SurfaceParts::SurfaceParts(const SolidElements& elements, const TriangleMesh& surface,
                           const EdgeTopology& surface_edges, const SurfaceCrossings& crossings,
                           const std::vector<int>& first_segment, const std::vector<SurfaceSegment>& segments)
    : elements_(elements),
      surface_(surface),
      surface_edges_(surface_edges),
      crossings_(crossings),
      first_segment_(first_segment),
      segments_(segments) {
  find_side_ends();
}

void SurfaceParts::find_side_ends() {
  std::vector<std::pair<int, SideEnd>> ends;
  for (Size g = 0; g < surface_edges_.edges.size(); ++g)
    for (const bool is_begin : {true, false}) {
      const int v = surface_edges_.edges[g][is_begin ? 0 : 1];
      const int t = crossings_.vertex_tetrahedron[at(v)];
      if (t >= 0) ends.push_back({t, {static_cast<int>(g), v, is_begin}});
    }
  const CrossingVertices vertices = number_vertices(elements_, surface_, crossings_);
  for (Size f = 0; f < elements_.topology.faces.size(); ++f)
    for (int k = crossings_.first_face_crossing[f]; k < crossings_.first_face_crossing[f + 1]; ++k)
      for (const int t : elements_.topology.face_tetrahedra[f]) {
        if (t < 0) continue;
        const auto& faces = elements_.topology.tetrahedron_faces[at(t)];
        const auto local = std::find(faces.begin(), faces.end(), static_cast<int>(f)) - faces.begin();
        const FaceCrossing& crossing = crossings_.face_crossings[at(k)];
        const int direction = face_direction(elements_.mesh.tetrahedra[at(t)], static_cast<int>(local));
        ends.push_back({t, {crossing.edge, vertices.first_face + k, crossing.passage * direction < 0}});
      }
  first_side_end_.assign(elements_.mesh.tetrahedra.size() + 1, 0);
  for (const auto& [t, end] : ends) ++first_side_end_[at(t) + 1];
  std::partial_sum(first_side_end_.begin(), first_side_end_.end(), first_side_end_.begin());
  std::vector<int> next(first_side_end_.begin(), first_side_end_.end() - 1);
  side_ends_.resize(ends.size());
  for (const auto& [t, end] : ends) side_ends_[at(next[at(t)]++)] = end;
}

bool SurfaceParts::find(int tetrahedron) {
  steps_.clear();
  parts_.clear();
  for (const int f : elements_.topology.tetrahedron_faces[at(tetrahedron)]) {
    // The material's face and the part of the surface pass their common side in opposite directions.
    const bool is_first = elements_.topology.face_tetrahedra[at(f)][0] == tetrahedron;
    for (int s = first_segment_[at(f)]; s < first_segment_[at(f) + 1]; ++s) {
      const SurfaceSegment& segment = segments_[at(s)];
      steps_.push_back(
          {segment.triangle, is_first ? segment.to : segment.from, is_first ? segment.from : segment.to});
    }
  }
  return add_side_steps(tetrahedron) && trace_parts();
}

bool SurfaceParts::add_side_steps(int tetrahedron) {
  const auto begin = side_ends_.begin() + first_side_end_[at(tetrahedron)];
  const auto end = side_ends_.begin() + first_side_end_[at(tetrahedron) + 1];
  std::sort(begin, end, [](const SideEnd& p, const SideEnd& q) {
    return p.edge != q.edge ? p.edge < q.edge : p.is_begin > q.is_begin;
  });
  if ((end - begin) % 2 != 0) return false;
  for (auto i = begin; i != end; i += 2) {
    const SideEnd &first = *i, &second = *(i + 1);
    if (first.edge != second.edge || !first.is_begin || second.is_begin) return false;
    const auto k = at(surface_edges_.first_triangle[at(first.edge)]);
    for (const Size n : {k, k + 1}) {
      const int t = surface_edges_.edge_triangles[n];
      const bool is_along =
          direction_along(surface_.triangles[at(t)], surface_edges_.edges[at(first.edge)]) > 0;
      steps_.push_back({t, is_along ? first.vertex : second.vertex, is_along ? second.vertex : first.vertex});
    }
  }
  return true;
}

/// The steps of each triangle go round once: its part in a tetrahedron is convex.
bool SurfaceParts::trace_parts() {
  std::sort(steps_.begin(), steps_.end(), [](const Step& p, const Step& q) {
    return p.triangle != q.triangle ? p.triangle < q.triangle : p.from < q.from;
  });
  for (Size begin = 0; begin < steps_.size();) {
    Size end = begin;
    while (end < steps_.size() && steps_[end].triangle == steps_[begin].triangle) ++end;
    SurfacePart part{steps_[begin].triangle, {}};
    int vertex = steps_[begin].from;
    do {
      part.corners.push_back(vertex);
      const auto step = std::lower_bound(steps_.begin() + static_cast<std::ptrdiff_t>(begin),
                                         steps_.begin() + static_cast<std::ptrdiff_t>(end), vertex,
                                         [](const Step& s, int from) { return s.from < from; });
      if (step == steps_.begin() + static_cast<std::ptrdiff_t>(end) || step->from != vertex) return false;
      vertex = step->to;
    } while (vertex != part.corners[0] && part.corners.size() <= end - begin);
    if (part.corners.size() != end - begin) return false;
    parts_.push_back(std::move(part));
    begin = end;
  }
  return true;
}

}  // namespace shatterbox::geometry
