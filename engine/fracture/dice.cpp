#include "engine/fracture/dice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/stop.h"
#include "engine/fracture/flaws.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kDartsPerDie = 24.0;
constexpr double kApart = 0.80;  // of seeds, share of the root of a die's area: so many find room
constexpr double kReach = 2.5;   // in least distances: no place on a sheet is further from a seed

/// Darts that keep `least` m apart, in the order of their keys.
std::vector<CellSeed> thin_out(const geometry::ShellElements& elements, std::vector<SurfacePoint> darts,
                               double least) {
  std::sort(darts.begin(), darts.end(), [](const SurfacePoint& a, const SurfacePoint& b) {
    return a.key != b.key ? a.key < b.key : a.element < b.element;
  });
  using Cube = std::array<int, 3>;
  std::map<Cube, std::vector<int>> cubes;
  std::vector<CellSeed> seeds;
  for (const SurfacePoint& dart : darts) {
    core::stop_if_asked();
    const Vec3 x = position_in_element(elements, dart.element, dart.barycentric);
    Cube cube{};
    for (int a = 0; a < 3; ++a) cube[at(a)] = static_cast<int>(std::floor(x[a] / least));
    const auto is_free = [&](const Cube& other) {
      const auto found = cubes.find(other);
      return found == cubes.end() || std::none_of(found->second.begin(), found->second.end(), [&](int seed) {
               return (seeds[at(seed)].position - x).squaredNorm() < least * least;
             });
    };
    bool has_room = true;
    for (int i = -1; i <= 1 && has_room; ++i)
      for (int j = -1; j <= 1 && has_room; ++j)
        for (int k = -1; k <= 1 && has_room; ++k) has_room = is_free({cube[0] + i, cube[1] + j, cube[2] + k});
    if (!has_room) continue;
    cubes[cube].push_back(static_cast<int>(seeds.size()));
    seeds.push_back({x, true});
  }
  return seeds;
}

}  // namespace

CellCracks cut_dice(ShellCutter& cutter, const std::vector<ElementPlane>& planes, const DiceSetup& setup) {
  if (!(setup.area > 0.0)) return {};
  const geometry::ShellElements& elements = cutter.elements();
  const double least = kApart * core::sqrt(setup.area);
  CellSetup cells;
  cells.seeds =
      thin_out(elements, scatter_on_surface(elements, kDartsPerDie / setup.area, setup.seed), least);
  cells.reach = kReach * least;
  for (Size t = 0; t < elements.mesh.triangles.size(); ++t) cells.elements.push_back(static_cast<int>(t));
  cells.crack = setup.crack;
  cells.generation = setup.generation;
  return cut_cells(cutter, planes, cells);
}

}  // namespace shatterbox::fracture
