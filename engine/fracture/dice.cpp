#include "engine/fracture/dice.h"

#include <algorithm>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/stop.h"
#include "engine/fracture/flaws.h"
#include "engine/fracture/point_cubes.h"

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
  PointCubes cubes(least);
  std::vector<CellSeed> seeds;
  for (const SurfacePoint& dart : darts) {
    core::stop_if_asked();
    const Vec3 x = position_in_element(elements, dart.element, dart.barycentric);
    bool has_room = true;
    cubes.visit_about(cubes.cube_of(x), [&](const std::vector<int>& numbers) {
      has_room = std::none_of(numbers.begin(), numbers.end(), [&](int seed) {
        return (seeds[at(seed)].position - x).squaredNorm() < least * least;
      });
      return has_room;
    });
    if (!has_room) continue;
    cubes.add(x, static_cast<int>(seeds.size()));
    seeds.push_back({x, true});
  }
  return seeds;
}

}  // namespace

CellCracks cut_dice(ShellCutter& cutter, const ElementPlanes& planes, const DiceSetup& setup) {
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
