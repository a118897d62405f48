#include "engine/fracture/crushed_core.h"

#include <algorithm>
#include <iterator>
#include <optional>

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

constexpr double kNoSize = 1e300;

struct Seed {
  Vec3 position = Vec3::Zero();
  double size = kNoSize;  // m, of its cell
  bool is_open = false;   // its cell is broken out whole
  int piece = 0;          // that it is in
};

double size_at(const CrushedCore& core, double distance) {
  return core.cell_size * std::max(1.0, distance / core.patch_radius);
}

/// How far from the centre seeds are needed, m.
double reach_of(const CrushedCore& core) {
  return core.radius + kMargin * size_at(core, core.radius);
}

/// Elements that hang together with the centre inside a ball about it, ascending.
std::vector<int> elements_in_reach(const geometry::ShellElements& elements, const CrushedCore& core) {
  const auto& triangles = elements.mesh.triangles;
  const double reach = reach_of(core);
  const auto is_near = [&](int element) {
    const geometry::Triangle& t = triangles[at(element)];
    const auto& x = elements.mesh.positions;
    const Vec3 middle = (x[at(t[0])] + x[at(t[1])] + x[at(t[2])]) / 3.0;
    double radius = 0.0;
    for (const int v : t) radius = std::max(radius, (x[at(v)] - middle).norm());
    return (middle - core.centre).norm() < reach + radius;
  };
  int first = -1;
  double nearest = 1e300;
  for (Size t = 0; t < triangles.size(); ++t) {
    const Vec3 middle = position_in_element(elements, static_cast<int>(t), Vec2(1.0 / 3.0, 1.0 / 3.0));
    const double distance = (middle - core.centre).squaredNorm();
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

/// The seed that belongs at a place: its cell is as small as the nearest hits ask for. None where nobody
/// asks.
std::optional<Seed> seed_at(const std::vector<CrushedCore>& cores, const Vec3& x) {
  Seed seed;
  seed.position = x;
  bool is_in_reach = false;
  for (const CrushedCore& core : cores) {
    const double distance = (x - core.centre).norm();
    seed.size = std::min(seed.size, size_at(core, distance));
    is_in_reach = is_in_reach || distance <= reach_of(core);
    seed.is_open = seed.is_open || distance < core.radius;
  }
  return is_in_reach ? std::optional(seed) : std::nullopt;
}

std::vector<Seed> throw_darts(const ShellCutter& cutter, const CoreSetup& setup) {
  const auto& [cores, in_reach] = setup.group;
  const geometry::ShellElements& elements = cutter.elements();
  geometry::ShellElements part;
  part.mesh.positions = elements.mesh.positions;
  for (const int element : in_reach) part.mesh.triangles.push_back(elements.mesh.triangles[at(element)]);
  double finest = kNoSize;
  for (const CrushedCore& core : cores) finest = std::min(finest, core.cell_size);
  std::vector<SurfacePoint> darts =
      scatter_on_surface(part, kDartsPerCell / (finest * finest), cores.front().seed);
  std::sort(darts.begin(), darts.end(), [](const SurfacePoint& a, const SurfacePoint& b) {
    return a.key != b.key ? a.key < b.key : a.element < b.element;
  });
  std::vector<Seed> seeds;
  for (const SurfacePoint& dart : darts) {
    core::stop_if_asked();
    std::optional<Seed> seed = seed_at(cores, position_in_element(part, dart.element, dart.barycentric));
    if (!seed) continue;
    const int cell = cutter.find_cell(in_reach[at(dart.element)], dart.barycentric);
    if (cell < 0) continue;
    seed->piece = setup.pieces[at(cutter.cell(cell).origin)];
    const double least = kLeastDistance * seed->size;
    const bool is_free = std::none_of(seeds.begin(), seeds.end(), [&](const Seed& other) {
      return other.piece == seed->piece && (other.position - seed->position).squaredNorm() < least * least;
    });
    if (is_free) seeds.push_back(*seed);
  }
  return seeds;
}

bool share_one(const std::vector<int>& a, const std::vector<int>& b) {
  return std::any_of(a.begin(), a.end(), [&](int x) { return std::binary_search(b.begin(), b.end(), x); });
}

}  // namespace

std::vector<CoreGroup> group_cores(const geometry::ShellElements& elements,
                                   const std::vector<CrushedCore>& cores) {
  struct Numbered {
    std::vector<int> cores, elements;
  };
  std::vector<Numbered> groups;
  for (Size i = 0; i < cores.size(); ++i) {
    // With every group that it touches it becomes one, in the place of the first of them.
    Numbered joined{{static_cast<int>(i)}, elements_in_reach(elements, cores[i])};
    Size place = groups.size();
    for (Size g = groups.size(); g-- > 0;) {
      if (!share_one(groups[g].elements, joined.elements)) continue;
      joined.cores.insert(joined.cores.end(), groups[g].cores.begin(), groups[g].cores.end());
      std::vector<int> both;
      std::set_union(joined.elements.begin(), joined.elements.end(), groups[g].elements.begin(),
                     groups[g].elements.end(), std::back_inserter(both));
      joined.elements = std::move(both);
      groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(g));
      place = g;
    }
    std::sort(joined.cores.begin(), joined.cores.end());
    groups.insert(groups.begin() + static_cast<std::ptrdiff_t>(place), std::move(joined));
  }
  std::vector<CoreGroup> found;
  for (Numbered& group : groups) {
    found.push_back({{}, std::move(group.elements)});
    for (const int i : group.cores) found.back().cores.push_back(cores[at(i)]);
  }
  return found;
}

CellCracks crush_cores(ShellCutter& cutter, const ElementPlanes& planes, const CoreSetup& setup) {
  CellSetup cells;
  cells.elements = setup.group.elements;
  for (const Seed& seed : throw_darts(cutter, setup))
    cells.seeds.push_back({seed.position, seed.is_open, seed.piece});
  cells.pieces = setup.pieces;
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
