#include "engine/stress/shell_load.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include "engine/core/elementary.h"
#include "engine/core/index.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

Vec3 corner_position(const geometry::ShellMesh& mesh, const geometry::ShellCell& cell, int corner) {
  const Vec2& barycentric = mesh.corners[at(cell.first_corner + corner)].barycentric;
  return geometry::position_in_element(*mesh.elements, cell.element, barycentric);
}

Vec3 nearest_on_segment(const Vec3& point, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length_squared = along.squaredNorm();
  if (!(length_squared > 0.0)) return a;
  return a + std::clamp(along.dot(point - a) / length_squared, 0.0, 1.0) * along;
}

/// Nearest point of a convex polygon in space; `normal` unit.
Vec3 nearest_on_polygon(const Vec3& point, std::span<const Vec3> polygon, const Vec3& normal) {
  bool is_inside = true;
  Vec3 nearest = polygon.front();
  double least = (point - nearest).squaredNorm();
  for (Size i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % polygon.size()];
    is_inside = is_inside && normal.dot((b - a).cross(point - a)) >= 0.0;
    const Vec3 candidate = nearest_on_segment(point, a, b);
    const double distance = (point - candidate).squaredNorm();
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  if (is_inside) return point - normal.dot(point - polygon.front()) * normal;
  return nearest;
}

std::vector<Vec3> cell_polygon(const geometry::ShellMesh& mesh, const geometry::ShellCell& cell) {
  std::vector<Vec3> polygon;
  for (int c = 0; c < cell.corner_count; ++c) polygon.push_back(corner_position(mesh, cell, c));
  return polygon;
}

Vec3 element_normal(const geometry::ShellElements& elements, int element) {
  const geometry::Triangle& t = elements.mesh.triangles[at(element)];
  const Vec3& a = elements.mesh.positions[at(t[0])];
  const Vec3 normal = (elements.mesh.positions[at(t[1])] - a).cross(elements.mesh.positions[at(t[2])] - a);
  const double length = normal.norm();
  return length > 0.0 ? Vec3(normal / length) : Vec3::UnitZ();
}

/// Weights of an element's corners at a point of its plane.
Vec3 corner_weights(const geometry::ShellElements& elements, int element, const Vec3& point) {
  const geometry::Triangle& t = elements.mesh.triangles[at(element)];
  const Vec3& a = elements.mesh.positions[at(t[0])];
  const Vec3 ab = elements.mesh.positions[at(t[1])] - a;
  const Vec3 ac = elements.mesh.positions[at(t[2])] - a;
  const Vec3 normal = ab.cross(ac);
  const double scale = normal.squaredNorm();
  if (!(scale > 0.0)) return Vec3::Constant(1.0 / 3.0);
  const Vec3 offset = point - a;
  const double b = normal.dot(offset.cross(ac)) / scale;
  const double c = normal.dot(ab.cross(offset)) / scale;
  return Vec3(1.0 - b - c, b, c);
}

/// The paraboloid 1 - d^2 / radius^2 about the patch's centre, where it is above zero, over one cell: its
/// integral and its mean's corner weights. By the middles of equal parts of each triangle of the cell's fan.
PatchShare share_of_cell(const geometry::ShellMesh& mesh, int number, const LoadPatch& patch) {
  constexpr double kMostDivisions = 16.0, kPointsPerRadius = 6.0;
  const geometry::ShellCell& cell = mesh.cells[at(number)];
  const Vec2 a = mesh.corners[at(cell.first_corner)].barycentric;
  const Vec3 pa = corner_position(mesh, cell, 0);
  const double whole = 2.0 * geometry::element_area(*mesh.elements, cell.element);
  const double per_square = 1.0 / (patch.radius * patch.radius);
  PatchShare share{number, 0.0, Vec3::Zero()};
  Vec2 moment = Vec2::Zero();
  for (int c = 1; c + 1 < cell.corner_count; ++c) {
    const Vec2 ab = mesh.corners[at(cell.first_corner + c)].barycentric - a;
    const Vec2 ac = mesh.corners[at(cell.first_corner + c + 1)].barycentric - a;
    const Vec3 pb = corner_position(mesh, cell, c), pc = corner_position(mesh, cell, c + 1);
    const double longest = std::max({(pb - pa).norm(), (pc - pa).norm(), (pc - pb).norm()});
    const int divisions = static_cast<int>(
        std::clamp(std::ceil(longest * kPointsPerRadius / patch.radius), 1.0, kMostDivisions));
    const Vec3 from = pa - patch.centre, along_b = (pb - pa) / divisions, along_c = (pc - pa) / divisions;
    double sum = 0.0, sum_b = 0.0, sum_c = 0.0;
    const auto add = [&](double b_steps, double c_steps) {
      const double weight = 1.0 - (from + b_steps * along_b + c_steps * along_c).squaredNorm() * per_square;
      if (weight <= 0.0) return;
      sum += weight;
      sum_b += weight * b_steps;
      sum_c += weight * c_steps;
    };
    for (int i = 0; i < divisions; ++i)
      for (int j = 0; i + j < divisions; ++j) {
        add(i + 1.0 / 3.0, j + 1.0 / 3.0);
        if (i + j + 1 < divisions) add(i + 2.0 / 3.0, j + 2.0 / 3.0);
      }
    const double area = 0.5 * (ab.x() * ac.y() - ab.y() * ac.x()) * whole / (divisions * divisions);
    share.weight += area * sum;
    moment += area * (sum * a + (sum_b / divisions) * ab + (sum_c / divisions) * ac);
  }
  if (share.weight > 0.0) {
    const Vec2 mean = moment / share.weight;
    share.corner_weights = Vec3(1.0 - mean.x() - mean.y(), mean.x(), mean.y());
  }
  return share;
}

/// Elements nearer than `radius` to a centre that hang together with the first one, ascending.
std::vector<int> flood_elements(const geometry::ShellElements& elements, int first, const Vec3& centre,
                                double radius) {
  std::vector<char> is_seen(elements.mesh.triangles.size(), 0);
  std::vector<int> found{first};
  is_seen[at(first)] = 1;
  for (Size next = 0; next < found.size(); ++next)
    for (const int edge : elements.topology.triangle_edges[at(found[next])]) {
      const auto& begin = elements.topology.first_triangle;
      for (int k = begin[at(edge)]; k < begin[at(edge) + 1]; ++k) {
        const int neighbour = elements.topology.edge_triangles[at(k)];
        if (is_seen[at(neighbour)] != 0) continue;
        is_seen[at(neighbour)] = 1;
        const geometry::Triangle& t = elements.mesh.triangles[at(neighbour)];
        const auto& positions = elements.mesh.positions;
        const std::array<Vec3, 3> polygon = {positions[at(t[0])], positions[at(t[1])], positions[at(t[2])]};
        const Vec3 nearest = nearest_on_polygon(centre, polygon, element_normal(elements, neighbour));
        if ((nearest - centre).squaredNorm() < radius * radius) found.push_back(neighbour);
      }
    }
  std::sort(found.begin(), found.end());
  return found;
}

/// Sets the patch's centre and cell: the nearest point of the material, in the first cell of those that tie.
void find_nearest_cell(const geometry::ShellMesh& mesh, const Vec3& point, LoadPatch& patch) {
  // A cell is within its element's longest edge of each of the element's corners: that leaves few to measure.
  const auto& positions = mesh.elements->mesh.positions;
  std::vector<double> to_corner(mesh.cells.size()), reach(mesh.cells.size());
  double farthest_needed = 0.0;
  for (Size c = 0; c < mesh.cells.size(); ++c) {
    const geometry::Triangle& t = mesh.elements->mesh.triangles[at(mesh.cells[c].element)];
    const Vec3 &p0 = positions[at(t[0])], &p1 = positions[at(t[1])], &p2 = positions[at(t[2])];
    to_corner[c] = core::sqrt((point - p0).squaredNorm());
    reach[c] = core::sqrt(std::max((p1 - p0).squaredNorm(), (p2 - p0).squaredNorm()));
    if (c == 0 || to_corner[c] + reach[c] < farthest_needed) farthest_needed = to_corner[c] + reach[c];
  }
  farthest_needed *= 1.0 + 1e-9;
  double least = 0.0;
  for (Size c = 0; c < mesh.cells.size(); ++c) {
    if (to_corner[c] - reach[c] > farthest_needed) continue;
    const geometry::ShellCell& cell = mesh.cells[c];
    const Vec3 nearest =
        nearest_on_polygon(point, cell_polygon(mesh, cell), element_normal(*mesh.elements, cell.element));
    const double distance = (nearest - point).squaredNorm();
    if (patch.nearest_cell >= 0 && distance >= least) continue;
    least = distance;
    patch.nearest_cell = static_cast<int>(c);
    patch.centre = nearest;
    farthest_needed = std::min(farthest_needed, core::sqrt(distance) * (1.0 + 1e-9));
  }
}

}  // namespace

LoadPatch find_load_patch(const geometry::ShellMesh& mesh, const Vec3& point, double radius) {
  LoadPatch patch;
  patch.radius = radius;
  if (mesh.cells.empty()) return patch;
  find_nearest_cell(mesh, point, patch);
  const int first = mesh.cells[at(patch.nearest_cell)].element;
  std::vector<char> is_near(mesh.elements->mesh.triangles.size(), 0);
  for (const int element : flood_elements(*mesh.elements, first, patch.centre, radius))
    is_near[at(element)] = 1;
  double sum = 0.0;
  for (Size c = 0; c < mesh.cells.size() && radius > 0.0; ++c) {
    if (is_near[at(mesh.cells[c].element)] == 0) continue;
    const PatchShare share = share_of_cell(mesh, static_cast<int>(c), patch);
    if (!(share.weight > 0.0)) continue;
    sum += share.weight;
    patch.shares.push_back(share);
  }
  for (PatchShare& share : patch.shares) share.weight /= sum;
  if (patch.shares.empty())
    patch.shares.push_back({patch.nearest_cell, 1.0, corner_weights(*mesh.elements, first, patch.centre)});
  return patch;
}

std::vector<int> group_patch(const LoadPatch& patch, const std::vector<geometry::CellContact>& contacts) {
  const Size count = patch.shares.size();
  std::vector<int> parent(count);
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int i) {
    while (parent[at(i)] != i) i = parent[at(i)] = parent[at(parent[at(i)])];
    return i;
  };
  const int first = count > 0 ? patch.shares.front().cell : 0;
  const int last = count > 0 ? patch.shares.back().cell : -1;
  std::vector<int> share_of_cell(at(last - first + 1), -1);
  for (Size i = 0; i < count; ++i) share_of_cell[at(patch.shares[i].cell - first)] = static_cast<int>(i);
  const auto share_of = [&](int cell) {
    return cell < first || cell > last ? -1 : share_of_cell[at(cell - first)];
  };
  for (const geometry::CellContact& contact : contacts) {
    int a = share_of(contact.cell_a);
    int b = share_of(contact.cell_b);
    if (a < 0 || b < 0) continue;
    a = find(a);
    b = find(b);
    if (a != b) parent[at(std::max(a, b))] = std::min(a, b);
  }
  std::vector<int> groups(count, -1);
  int next = 0;
  for (Size i = 0; i < count; ++i) {
    const int root = find(static_cast<int>(i));
    groups[i] = root == static_cast<int>(i) ? next++ : groups[at(root)];
  }
  return groups;
}

namespace {

void add_share(const geometry::ShellMesh& mesh, const PatchShare& share, const Vec3& force, VecX& load) {
  const geometry::ShellCell& cell = mesh.cells[at(share.cell)];
  for (int i = 0; i < 3; ++i)
    load.segment<3>(vertex_dof(cell.vertices[at(i)])) += share.corner_weights(i) * force;
}

}  // namespace

VecX patch_load(const geometry::ShellMesh& mesh, const LoadPatch& patch, const Vec3& force) {
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  for (const PatchShare& share : patch.shares) add_share(mesh, share, share.weight * force, load);
  return load;
}

double group_weight(const LoadPatch& patch, const std::vector<int>& groups, int group) {
  double sum = 0.0;
  for (Size i = 0; i < patch.shares.size(); ++i)
    if (groups[i] == group) sum += patch.shares[i].weight;
  return sum;
}

VecX group_load(const geometry::ShellMesh& mesh, const LoadPatch& patch, const std::vector<int>& groups,
                int group, const Vec3& force) {
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  const double whole = group_weight(patch, groups, group);
  if (!(whole > 0.0)) return load;
  for (Size i = 0; i < patch.shares.size(); ++i)
    if (groups[i] == group) add_share(mesh, patch.shares[i], patch.shares[i].weight / whole * force, load);
  return load;
}

VecX centrifugal_load(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh, const Vec3& spin,
                      const Vec3& centre_of_mass) {
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  const double per_area = stiffness.properties.density * stiffness.properties.thickness;
  for (const geometry::ShellCell& cell : mesh.cells) {
    const double whole = 2.0 * geometry::element_area(*mesh.elements, cell.element);
    const Vec2 a = mesh.corners[at(cell.first_corner)].barycentric;
    for (int c = 1; c + 1 < cell.corner_count; ++c) {
      const Vec2 b = mesh.corners[at(cell.first_corner + c)].barycentric;
      const Vec2 d = mesh.corners[at(cell.first_corner + c + 1)].barycentric;
      const double area = 0.5 * ((b - a).x() * (d - a).y() - (b - a).y() * (d - a).x()) * whole;
      // The middles of the sides: exact for the product of two linear functions.
      for (const Vec2& middle : std::array<Vec2, 3>{(a + b) / 2.0, (b + d) / 2.0, (d + a) / 2.0}) {
        const Vec3 arm = geometry::position_in_element(*mesh.elements, cell.element, middle) - centre_of_mass;
        const Vec3 force = -per_area * area / 3.0 * spin.cross(spin.cross(arm));
        const Vec3 weights(1.0 - middle.x() - middle.y(), middle.x(), middle.y());
        for (int i = 0; i < 3; ++i) load.segment<3>(vertex_dof(cell.vertices[at(i)])) += weights(i) * force;
      }
    }
  }
  return load;
}

double mean_edge_length(const geometry::ShellMesh& mesh) {
  double sum = 0.0;
  const auto& positions = mesh.elements->mesh.positions;
  for (const geometry::ShellCell& cell : mesh.cells) {
    const geometry::Triangle& t = mesh.elements->mesh.triangles[at(cell.element)];
    for (Size i = 0; i < 3; ++i) sum += (positions[at(t[(i + 1) % 3])] - positions[at(t[i])]).norm();
  }
  return mesh.cells.empty() ? 0.0 : sum / (3.0 * static_cast<double>(mesh.cells.size()));
}

}  // namespace shatterbox::stress
