#include "engine/fracture/crushed_core.h"

#include <algorithm>

#include "engine/core/elementary.h"
#include "engine/core/hash.h"
#include "engine/core/index.h"
#include "engine/core/stop.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kLeastDistance = 0.75;  // of seeds, share of the local cell size
constexpr double kDartsPerCell = 8.0;    // for the smallest cells
constexpr double kMargin = 2.0;     // seeds beyond the core that bound its cells, in cell sizes at its rim
constexpr double kSoftness = 0.25;  // of an element's overload about one, over which it counts in part

struct Seed {
  Vec3 position;
  double size;  // m, of its cell
};

double size_at(const CoreSetup& setup, double distance) {
  return setup.cell_size * std::max(1.0, distance / setup.patch_radius);
}

/// How far from the centre seeds are needed, m.
double reach_of(const CoreSetup& setup) {
  return setup.radius + kMargin * size_at(setup, setup.radius);
}

/// Elements with material that hang together with the centre inside a ball about it, ascending.
std::vector<int> elements_in_reach(const ShellCutter& cutter, const CoreSetup& setup) {
  const geometry::ShellElements& elements = cutter.elements();
  const auto& triangles = elements.mesh.triangles;
  const double reach = reach_of(setup);
  const auto is_near = [&](int element) {
    const geometry::Triangle& t = triangles[at(element)];
    const auto& x = elements.mesh.positions;
    const Vec3 middle = (x[at(t[0])] + x[at(t[1])] + x[at(t[2])]) / 3.0;
    double radius = 0.0;
    for (const int v : t) radius = std::max(radius, (x[at(v)] - middle).norm());
    return (middle - setup.centre).norm() < reach + radius;
  };
  int first = -1;
  double nearest = 1e300;
  for (Size t = 0; t < triangles.size(); ++t) {
    const Vec3 middle = position_in_element(elements, static_cast<int>(t), Vec2(1.0 / 3.0, 1.0 / 3.0));
    const double distance = (middle - setup.centre).squaredNorm();
    if (distance < nearest) {
      nearest = distance;
      first = static_cast<int>(t);
    }
  }
  if (first < 0 || !is_near(first)) return {};
  std::vector<char> is_seen(triangles.size(), 0);
  is_seen[at(first)] = 1;
  std::vector<int> found{first};
  for (Size next = 0; next < found.size(); ++next)
    for (const int edge : elements.topology.triangle_edges[at(found[next])])
      for (int k = elements.topology.first_triangle[at(edge)];
           k < elements.topology.first_triangle[at(edge) + 1]; ++k) {
        const int neighbour = elements.topology.edge_triangles[at(k)];
        if (is_seen[at(neighbour)] != 0 || !is_near(neighbour)) continue;
        is_seen[at(neighbour)] = 1;
        found.push_back(neighbour);
      }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<Seed> throw_darts(const ShellCutter& cutter, const std::vector<int>& elements,
                              const CoreSetup& setup) {
  geometry::ShellElements part;
  part.mesh.positions = cutter.elements().mesh.positions;
  for (const int element : elements)
    part.mesh.triangles.push_back(cutter.elements().mesh.triangles[at(element)]);
  std::vector<SurfacePoint> darts =
      scatter_on_surface(part, kDartsPerCell / (setup.cell_size * setup.cell_size), setup.seed);
  std::sort(darts.begin(), darts.end(), [](const SurfacePoint& a, const SurfacePoint& b) {
    return a.key != b.key ? a.key < b.key : a.element < b.element;
  });
  const double reach = reach_of(setup);
  std::vector<Seed> seeds;
  for (const SurfacePoint& dart : darts) {
    core::stop_if_asked();
    const Vec3 x = position_in_element(part, dart.element, dart.barycentric);
    const double distance = (x - setup.centre).norm();
    if (distance > reach) continue;
    const double size = size_at(setup, distance);
    const double least = kLeastDistance * size;
    const bool is_free = std::none_of(seeds.begin(), seeds.end(), [&](const Seed& other) {
      return (other.position - x).squaredNorm() < least * least;
    });
    if (is_free) seeds.push_back({x, size});
  }
  return seeds;
}

}  // namespace

CellCracks crush_core(ShellCutter& cutter, const ElementPlanes& planes, const CoreSetup& setup) {
  if (!(setup.radius > 0.0) || !(setup.cell_size > 0.0) || !(setup.patch_radius > 0.0)) return {};
  CellSetup cells;
  cells.elements = elements_in_reach(cutter, setup);
  for (const Seed& seed : throw_darts(cutter, cells.elements, setup))
    cells.seeds.push_back({seed.position, (seed.position - setup.centre).norm() < setup.radius});
  cells.most_length = setup.most_length;
  cells.crack = setup.crack;
  cells.generation = setup.generation;
  return cut_cells(cutter, planes, cells);
}

double crushed_radius(const geometry::ShellElements& elements, const std::vector<double>& overloads,
                      const Vec3& centre, double reach) {
  double area = 0.0;
  for (Size t = 0; t < overloads.size(); ++t) {
    const double share = std::min(1.0, 0.5 + (overloads[t] - 1.0) / (2.0 * kSoftness));
    if (!(share > 0.0)) continue;
    const Vec3 middle = position_in_element(elements, static_cast<int>(t), Vec2(1.0 / 3.0, 1.0 / 3.0));
    if ((middle - centre).norm() < reach) area += share * element_area(elements, static_cast<int>(t));
  }
  return core::sqrt(area / core::kPi);
}

}  // namespace shatterbox::fracture
