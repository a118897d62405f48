#include "engine/stress/solid_load.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "engine/core/disjoint_sets.h"
#include "engine/core/index.h"
#include "engine/geometry/closest_points.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

std::array<Vec3, 3> triangle_corners(const SolidSkin& skin, int triangle) {
  const geometry::Triangle& t = skin.mesh.triangles[at(triangle)];
  return {skin.mesh.positions[at(t[0])], skin.mesh.positions[at(t[1])], skin.mesh.positions[at(t[2])]};
}

Vec3 twice_area_vector(const std::array<Vec3, 3>& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]);
}

/// Weights of an element's corners at a point of it.
Eigen::Vector4d corner_weights_at(const geometry::SolidElements& elements, int element, const Vec3& point) {
  const geometry::Tetrahedron& t = elements.mesh.tetrahedra[at(element)];
  const Vec3& a = elements.mesh.positions[at(t[0])];
  const Vec3 b = elements.mesh.positions[at(t[1])] - a, c = elements.mesh.positions[at(t[2])] - a,
             d = elements.mesh.positions[at(t[3])] - a, way = point - a;
  const double whole = b.cross(c).dot(d);
  if (!(whole > 0.0)) return Eigen::Vector4d::Constant(0.25);
  const double wb = way.cross(c).dot(d) / whole, wc = b.cross(way).dot(d) / whole,
               wd = b.cross(c).dot(way) / whole;
  return {1.0 - wb - wc - wd, wb, wc, wd};
}

/// The paraboloid 1 - d^2 / radius^2 about the patch's centre, where it is above zero, over one triangle: its
/// integral, and that of the place. By the middles of equal parts.
struct TriangleShare {
  double weight = 0.0;
  Vec3 moment = Vec3::Zero();
};

TriangleShare share_of_triangle(const std::array<Vec3, 3>& corners, const SolidPatch& patch) {
  constexpr double kMostDivisions = 16.0, kPointsPerRadius = 6.0;
  const Vec3 &a = corners[0], &b = corners[1], &c = corners[2];
  const double longest = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
  const int divisions =
      static_cast<int>(std::clamp(std::ceil(longest * kPointsPerRadius / patch.radius), 1.0, kMostDivisions));
  const Vec3 along_b = (b - a) / divisions, along_c = (c - a) / divisions;
  const double per_square = 1.0 / (patch.radius * patch.radius);
  TriangleShare share;
  const auto add = [&](double b_steps, double c_steps) {
    const Vec3 place = a + b_steps * along_b + c_steps * along_c;
    const double weight = 1.0 - (place - patch.centre).squaredNorm() * per_square;
    if (weight <= 0.0) return;
    share.weight += weight;
    share.moment += weight * place;
  };
  for (int i = 0; i < divisions; ++i)
    for (int j = 0; i + j < divisions; ++j) {
      add(i + 1.0 / 3.0, j + 1.0 / 3.0);
      if (i + j + 1 < divisions) add(i + 2.0 / 3.0, j + 2.0 / 3.0);
    }
  const double area = 0.5 * twice_area_vector(corners).norm() / (divisions * divisions);
  share.weight *= area;
  share.moment *= area;
  return share;
}

constexpr double kSurely = 1.0 + 1e-9;  // times a squared distance: beyond its rounding

/// visit(triangle, corners) for those whose boxes are no farther from the point than a squared distance, m2,
/// which visits may lessen.
template <class Visit>
void visit_near(const SolidSkin& skin, const Vec3& point, const double& farthest_squared,
                const Visit& visit) {
  for (Size block = 0; block < skin.blocks.size(); ++block) {
    if (squared_distance(skin.blocks[block], point) > farthest_squared) continue;
    const Size end = std::min((block + 1) * SolidSkin::kBlock, skin.cells.size());
    for (Size t = block * SolidSkin::kBlock; t < end; ++t) {
      const auto corners = triangle_corners(skin, static_cast<int>(t));
      geometry::Box box;
      for (const Vec3& corner : corners) box.include(corner);
      if (!(squared_distance(box, point) > farthest_squared)) visit(static_cast<int>(t), corners);
    }
  }
}

/// m2: some triangle is surely no farther.
double squared_distance_of_some(const SolidSkin& skin, const Vec3& point) {
  double least = 1e300;
  for (const geometry::Box& block : skin.blocks)
    least = std::min(least, (point - block.low).cwiseMax(block.high - point).squaredNorm());
  return kSurely * least;
}

/// Triangles nearer than the radius to the centre and not turned away, that hang together with the first one;
/// ascending.
std::vector<int> flood_skin(const SolidSkin& skin, int first, const SolidPatch& patch) {
  std::vector<int> near;
  const double farthest_squared = kSurely * patch.radius * patch.radius;
  visit_near(skin, patch.centre, farthest_squared, [&](int t, const std::array<Vec3, 3>& corners) {
    if (twice_area_vector(corners).dot(patch.normal) <= 0.0) return;
    const auto nearest = geometry::closest_on_triangle(patch.centre, corners[0], corners[1], corners[2]);
    if (nearest.distance < patch.radius || t == first) near.push_back(t);
  });
  core::DisjointSets sets(skin.mesh.positions.size());
  for (const int t : near)
    for (const int v : skin.mesh.triangles[at(t)]) sets.unite(v, skin.mesh.triangles[at(t)][0]);
  const int wanted = sets.find(skin.mesh.triangles[at(first)][0]);
  std::erase_if(near, [&](int t) { return sets.find(skin.mesh.triangles[at(t)][0]) != wanted; });
  return near;
}

void add_share(const geometry::SolidMesh& mesh, const SolidPatchShare& share, const Vec3& force, VecX& load) {
  const geometry::SolidCell& cell = mesh.cells[at(share.cell)];
  for (int i = 0; i < 4; ++i) load.segment<3>(3 * cell.vertices[at(i)]) += share.corner_weights(i) * force;
}

}  // namespace

void SolidSkin::add(const geometry::Triangle& triangle, int cell) {
  if (cells.size() % kBlock == 0) blocks.emplace_back();
  for (const int vertex : triangle) blocks.back().include(mesh.positions[at(vertex)]);
  mesh.triangles.push_back(triangle);
  cells.push_back(cell);
}

SolidSkin make_border_skin(const geometry::SolidMesh& mesh) {
  const geometry::SolidElements& elements = *mesh.elements;
  geometry::TriangleMesh border = geometry::boundary_surface(elements.mesh, elements.topology);
  SolidSkin skin;
  skin.mesh.positions = std::move(border.positions);
  auto next = border.triangles.begin();
  // In the order of boundary_surface.
  for (Size c = 0; c < mesh.cells.size(); ++c)
    for (const int face : elements.topology.tetrahedron_faces[at(mesh.cells[c].element)])
      if (elements.topology.face_tetrahedra[at(face)][1] < 0) skin.add(*next++, static_cast<int>(c));
  return skin;
}

SolidPatch find_load_patch(const geometry::SolidMesh& mesh, const SolidSkin& skin, const Vec3& point,
                           double radius) {
  SolidPatch patch;
  patch.radius = radius;
  int first = -1;
  double least = 1e300, farthest_squared = squared_distance_of_some(skin, point);
  visit_near(skin, point, farthest_squared, [&](int t, const std::array<Vec3, 3>& corners) {
    const auto nearest = geometry::closest_on_triangle(point, corners[0], corners[1], corners[2]);
    if (!(nearest.distance < least)) return;
    first = t;
    least = nearest.distance;
    farthest_squared = std::min(farthest_squared, kSurely * least * least);
    patch.centre = nearest.closest;
  });
  if (first < 0) return patch;
  patch.nearest_cell = skin.cells[at(first)];
  const Vec3 area = twice_area_vector(triangle_corners(skin, first));
  const double length = area.norm();
  if (length > 0.0) patch.normal = area / length;

  std::map<int, TriangleShare> by_cell;
  double sum = 0.0;
  if (radius > 0.0)
    for (const int t : flood_skin(skin, first, patch)) {
      const TriangleShare share = share_of_triangle(triangle_corners(skin, t), patch);
      if (!(share.weight > 0.0)) continue;
      TriangleShare& whole = by_cell[skin.cells[at(t)]];
      whole.weight += share.weight;
      whole.moment += share.moment;
      sum += share.weight;
    }
  for (const auto& [cell, share] : by_cell)
    patch.shares.push_back(
        {cell, share.weight / sum,
         corner_weights_at(*mesh.elements, mesh.cells[at(cell)].element, share.moment / share.weight)});
  if (patch.shares.empty())
    patch.shares.push_back(
        {patch.nearest_cell, 1.0,
         corner_weights_at(*mesh.elements, mesh.cells[at(patch.nearest_cell)].element, patch.centre)});
  return patch;
}

std::vector<int> group_patch(const geometry::SolidMesh& mesh, const SolidPatch& patch) {
  const Size count = patch.shares.size();
  core::DisjointSets sets(count);
  std::map<int, int> share_of_vertex;
  for (Size i = 0; i < count; ++i)
    for (const int vertex : mesh.cells[at(patch.shares[i].cell)].vertices) {
      const auto [found, is_new] = share_of_vertex.try_emplace(vertex, static_cast<int>(i));
      if (!is_new) sets.unite(found->second, static_cast<int>(i));
    }
  std::vector<int> groups(count, -1);
  int next = 0;
  for (Size i = 0; i < count; ++i) {
    const int root = sets.find(static_cast<int>(i));
    groups[i] = root == static_cast<int>(i) ? next++ : groups[at(root)];
  }
  return groups;
}

VecX patch_load(const geometry::SolidMesh& mesh, const SolidPatch& patch, const Vec3& force) {
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  for (const SolidPatchShare& share : patch.shares) add_share(mesh, share, share.weight * force, load);
  return load;
}

double group_weight(const SolidPatch& patch, const std::vector<int>& groups, int group) {
  double sum = 0.0;
  for (Size i = 0; i < patch.shares.size(); ++i)
    if (groups[i] == group) sum += patch.shares[i].weight;
  return sum;
}

VecX group_load(const geometry::SolidMesh& mesh, const SolidPatch& patch, const std::vector<int>& groups,
                int group, const Vec3& force) {
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  const double whole = group_weight(patch, groups, group);
  if (!(whole > 0.0)) return load;
  for (Size i = 0; i < patch.shares.size(); ++i)
    if (groups[i] == group) add_share(mesh, patch.shares[i], patch.shares[i].weight / whole * force, load);
  return load;
}

VecX centrifugal_load(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh, const Vec3& spin,
                      const Vec3& centre_of_mass) {
  VecX load = lumped_mass(stiffness, mesh);
  for (Size v = 0; v < mesh.vertex_source.size(); ++v) {
    const auto first = static_cast<Eigen::Index>(3 * v);
    const Vec3 arm = mesh.elements->mesh.positions[at(mesh.vertex_source[v])] - centre_of_mass;
    load.segment<3>(first) = -load(first) * spin.cross(spin.cross(arm));
  }
  return load;
}

double mean_edge_length(const geometry::SolidMesh& mesh) {
  double sum = 0.0;
  const auto& positions = mesh.elements->mesh.positions;
  for (const geometry::SolidCell& cell : mesh.cells) {
    const geometry::Tetrahedron& t = mesh.elements->mesh.tetrahedra[at(cell.element)];
    for (const auto& edge : geometry::kTetrahedronEdges)
      sum += (positions[at(t[at(edge[0])])] - positions[at(t[at(edge[1])])]).norm();
  }
  return mesh.cells.empty() ? 0.0 : sum / (6.0 * static_cast<double>(mesh.cells.size()));
}

}  // namespace shatterbox::stress
