#include "engine/geometry/solid_parting.h"

#include <algorithm>
#include <array>

#include "engine/core/index.h"
#include "engine/geometry/crossings.h"
#include "engine/geometry/solid_retreat.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kTrialStep = 1e-3;     // of the shortest edge: the kerf in which a parting is tried
constexpr double kLeastRetreat = 0.02;  // kerfs: what is gained by parting a vertex

/// The faces about one vertex in their order, counter-clockwise seen from outside.
struct Fan {
  std::vector<int> triangles, ends;  // ends: the vertex that each triangle begins at, seen from the middle
  std::vector<Vec3> normals;         // unit; zero of a face without area
};

Fan collect_fan(const SolidSurface& surface, int vertex, const std::vector<int>& triangles) {
  const TriangleMesh& mesh = surface.mesh;
  const auto after = [&](int triangle, Size steps) {
    const Triangle& t = mesh.triangles[at(triangle)];
    Size place = 0;
    while (t[place] != vertex) ++place;
    return t[(place + steps) % 3];
  };
  Fan fan;
  for (int triangle = triangles.front(); fan.triangles.size() < triangles.size();) {
    fan.triangles.push_back(triangle);
    fan.ends.push_back(after(triangle, 1));
    const Vec3& middle = mesh.positions[at(vertex)];
    const Vec3 b = mesh.positions[at(after(triangle, 1))] - middle;
    const Vec3 c = mesh.positions[at(after(triangle, 2))] - middle;
    const Vec3 normal = b.cross(c);
    const double size = normal.norm();
    fan.normals.push_back(size > kFlatFace * (b.squaredNorm() + c.squaredNorm()) ? Vec3(normal / size)
                                                                                 : Vec3(Vec3::Zero()));
    const int end = after(triangle, 2);
    const auto next =
        std::find_if(triangles.begin(), triangles.end(), [&](int t) { return after(t, 1) == end; });
    if (next == triangles.end() || *next == triangles.front()) break;
    triangle = *next;
  }
  return fan;
}

/// Tries to part a vertex that cannot stand back into two or three that can, each with an arc of its fan.
class VertexParting {
 public:
  VertexParting(const SolidSurface& surface, const VertexFaces& faces, int vertex, const Fan& fan)
      : surface_(surface), vertex_(vertex), fan_(fan), middle_(surface.mesh.positions[at(vertex)]) {
    double shortest = 1e300;
    for (const int end : fan.ends) {
      still_.push_back(surface.mesh.positions[at(end)]);
      shortest = std::min(shortest, (still_.back() - middle_).norm());
    }
    step_ = kTrialStep * shortest;
    for (Size i = 0; i < fan.ends.size(); ++i)
      moved_.push_back(still_[i] +
                       retreat(faces.cracks[at(fan.ends[i])], faces.outers[at(fan.ends[i])], step_));
  }

  /// Places of the fan at which it falls into arcs that stand back the farthest; empty if there are none.
  /// They are at edges that material lies all about: what is behind the face on one side of such an edge is
  /// inside.
  std::vector<Size> find() {
    const Size n = fan_.triangles.size();
    std::vector<Size> hollow;
    for (Size i = 0; i < n; ++i) {
      const Vec3 &before = fan_.normals[(i + n - 1) % n], &behind = fan_.normals[i];
      if (before.isZero(0.0) || behind.isZero(0.0)) continue;
      const Vec3 way = still_[(i + 1) % n] - middle_;
      if (before.dot(way) >= -kFlatFace * way.norm()) hollow.push_back(i);
    }
    for (Size i = 0; i < hollow.size(); ++i)
      for (Size j = i + 1; j < hollow.size(); ++j) consider({hollow[i], hollow[j]});
    if (!best_.empty()) return best_;
    for (Size i = 0; i < hollow.size(); ++i)
      for (Size j = i + 1; j < hollow.size(); ++j)
        for (Size k = j + 1; k < hollow.size(); ++k) consider({hollow[i], hollow[j], hollow[k]});
    return best_;
  }

 private:
  using Corners = std::array<Vec3, 3>;

  void consider(std::vector<Size> places) {
    double least = 1.0;
    std::vector<Vec3> middles;
    for (Size p = 0; p < places.size() && least > greatest_; ++p) {
      std::vector<Vec3> cracks, outers;
      for (Size i = places[p]; i != places[(p + 1) % places.size()]; i = (i + 1) % fan_.triangles.size())
        if (!fan_.normals[i].isZero(0.0))
          add_normal(cracks, outers, stands_back(surface_, fan_.triangles[i], vertex_), fan_.normals[i]);
      const Vec3 shift = cracks.empty() ? Vec3(Vec3::Zero()) : retreat(cracks, outers, step_);
      if (shift.isZero(0.0)) return;
      for (const Vec3& normal : cracks) least = std::min(least, -normal.dot(shift) / step_);
      middles.push_back(middle_ + shift);
    }
    if (!(least > greatest_) || meets_itself(places, middles)) return;
    greatest_ = least;
    best_ = std::move(places);
  }

  /// Whether the faces about the vertex, stood back, pass through each other or through where they were.
  bool meets_itself(const std::vector<Size>& places, const std::vector<Vec3>& middles) const {
    const Size n = fan_.triangles.size(), count = places.size();
    std::vector<Corners> moved;
    for (Size p = 0; p < count; ++p) {
      const Size end = places[(p + 1) % count];
      for (Size i = places[p]; i != end; i = (i + 1) % n)
        moved.push_back({middles[p], moved_[i], moved_[(i + 1) % n]});
      moved.push_back({middles[p], moved_[end], middles[(p + 1) % count]});
    }
    if (count == 3) moved.push_back({middles[0], middles[1], middles[2]});
    for (Size a = 0; a < moved.size(); ++a) {
      for (Size i = 0; i < n; ++i)
        if (stands_back(surface_, fan_.triangles[i], vertex_) &&
            passes(moved[a], {middle_, still_[i], still_[(i + 1) % n]}))
          return true;
      for (Size b = a + 1; b < moved.size(); ++b)
        if (passes(moved[a], moved[b])) return true;
    }
    return false;
  }

  static bool passes(const Corners& a, const Corners& b) {
    for (Size i = 0; i < 3; ++i)
      if (segment_pierces_triangle(a[i], a[(i + 1) % 3], b[0], b[1], b[2]) ||
          segment_pierces_triangle(b[i], b[(i + 1) % 3], a[0], a[1], a[2]))
        return true;
    return false;
  }

  const SolidSurface& surface_;
  const int vertex_;
  const Fan& fan_;
  const Vec3 middle_;
  std::vector<Vec3> still_, moved_;  // the fan's ends
  double step_ = 0.0;                // m, of the trial's kerf
  double greatest_ = kLeastRetreat;
  std::vector<Size> best_;
};

void add_crack_triangle(SolidSurface& surface, const Triangle& triangle, int like) {
  surface.mesh.triangles.push_back(triangle);
  surface.triangle_sources.push_back(-1);
  surface.triangle_facets.push_back(-1);
  surface.triangle_cells.push_back(int(surface.triangle_cells[at(like)]));
  surface.triangle_grains.push_back(int(surface.triangle_grains[at(like)]));
  surface.is_crack_face.push_back(1);
  surface.is_old_face.push_back(0);
}

/// Gives each arc of a fan a vertex of its own, in the same place, with triangles without area between them.
void part_vertex(SolidSurface& surface, int vertex, const Fan& fan, const std::vector<Size>& places) {
  const Size n = fan.triangles.size();
  std::vector<int> middles{vertex};
  for (Size p = 1; p < places.size(); ++p) {
    middles.push_back(static_cast<int>(surface.mesh.positions.size()));
    surface.mesh.positions.push_back(Vec3(surface.mesh.positions[at(vertex)]));
    surface.vertex_sources.push_back(int(surface.vertex_sources[at(vertex)]));
    surface.has_kerf.push_back(std::uint8_t(surface.has_kerf[at(vertex)]));
    for (Size i = places[p]; i != places[(p + 1) % places.size()]; i = (i + 1) % n) {
      Triangle& triangle = surface.mesh.triangles[at(fan.triangles[i])];
      std::replace(triangle.begin(), triangle.end(), vertex, middles[p]);
    }
  }
  for (Size p = 0; p < places.size(); ++p) {
    const Size place = places[(p + 1) % places.size()];
    add_crack_triangle(surface, {middles[p], fan.ends[place], middles[(p + 1) % places.size()]},
                       fan.triangles[place]);
  }
  if (places.size() == 3)
    add_crack_triangle(surface, {middles[0], middles[1], middles[2]}, fan.triangles[places[0]]);
}

}  // namespace

void part_vertices(SolidSurface& surface, double kerf) {
  const VertexFaces faces = collect_faces(surface);
  std::vector<int> stuck;
  for (Size v = 0; v < faces.cracks.size(); ++v)
    if (!faces.cracks[v].empty() && retreat(faces.cracks[v], faces.outers[v], kerf).isZero(0.0))
      stuck.push_back(static_cast<int>(v));
  for (const int vertex : stuck) {
    std::vector<int> triangles;
    for (Size t = 0; t < surface.mesh.triangles.size(); ++t) {
      const Triangle& own = surface.mesh.triangles[t];
      if (std::find(own.begin(), own.end(), vertex) != own.end()) triangles.push_back(static_cast<int>(t));
    }
    const Fan fan = collect_fan(surface, vertex, triangles);
    if (fan.triangles.size() != triangles.size()) continue;
    const std::vector<Size> places = VertexParting(surface, collect_faces(surface), vertex, fan).find();
    if (!places.empty()) part_vertex(surface, vertex, fan, places);
  }
}

}  // namespace shatterbox::geometry
