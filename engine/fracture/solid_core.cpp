#include "engine/fracture/solid_core.h"

#include <algorithm>
#include <utility>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/stop.h"
#include "engine/fracture/point_cubes.h"
#include "engine/fracture/seed_spacing.h"
#include "engine/fracture/solid_tracer.h"
#include "engine/fracture/space_points.h"
#include "engine/geometry/solid_contacts.h"
#include "engine/geometry/solid_punch.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kCompressiveStrength = 8.0;  // in tensile ones [Gri24]
constexpr double kCellsAcross = 3.0;          // a core's radius, of the finest
constexpr double kCoarsening = 1.5;           // from these to its rim
constexpr double kReachOfCells = 0.2;    // of their size, beyond their seeds: so the core's volume is right
constexpr double kRimMargin = 1.5;       // seeds beyond the core that bound its cells, in cell sizes there
constexpr double kNeighbourReach = 2.5;  // cell sizes: who is farther away has no wall in common

struct CoreSeed {
  Vec3 position = Vec3::Zero();
  double size = 1e300;   // m, of its cell
  bool is_open = false;  // its cell is broken out whole
  int piece = 0;         // that it is in
};

class Crusher {
 public:
  Crusher(const geometry::SolidComplex& complex, const SolidCoreSetup& setup)
      : complex_(complex), setup_(setup) {
    // What several points press with is one blow: it makes as many cells as that of one would.
    double squares = 0.0;
    for (const SolidCore& core : setup.cores) squares += core.radius * core.radius;
    finest_ = std::max(setup.least_size, core::sqrt(squares) / kCellsAcross);
    find_near();
  }

  /// |cells|: the piece that each near one is in; -1 for the others.
  const std::vector<int>& pieces() const { return pieces_; }

  void throw_darts() {
    struct Dart {
      std::uint64_t key = 0;
      Vec3 place = Vec3::Zero();
    };
    std::vector<Dart> darts;
    const SpacePoints points(finest_ * core::pow(SpacePoints::kPointsPerCube / kDartsPerSeed, 1.0 / 3.0),
                             setup_.seed);
    for (const SolidCore& core : setup_.cores) {
      const Vec3 half = Vec3::Constant(reach_of(core));
      points.visit_box(core.centre - half, core.centre + half, [&](const Vec3& place, core::Random random) {
        darts.push_back({random.bits(), place});
      });
    }
    std::sort(darts.begin(), darts.end(), [](const Dart& a, const Dart& b) { return a.key < b.key; });
    for (Size i = 0; i < darts.size(); ++i)
      if (i == 0 || darts[i].key != darts[i - 1].key) try_seed(darts[i].place);  // boxes may overlap
  }

  std::vector<geometry::PunchRegion> regions() const {
    std::vector<geometry::PunchRegion> regions;
    for (const CoreSeed& seed : seeds_) {
      if (!seed.is_open) continue;
      std::vector<std::pair<double, const CoreSeed*>>
          others;  // the nearest cut most of what is not the cell's
      for (const CoreSeed& other : seeds_) {
        const double distance = (other.position - seed.position).norm();
        if (&other != &seed && other.piece == seed.piece &&
            distance < kNeighbourReach * std::max(seed.size, other.size))
          others.push_back({distance, &other});
      }
      std::stable_sort(others.begin(), others.end(),
                       [](const auto& a, const auto& b) { return a.first < b.first; });
      geometry::PunchRegion region;
      region.group = seed.piece;
      for (const auto& [distance, other] : others) {
        const Vec3 apart = other->position - seed.position;
        region.sides.push_back({apart, apart.dot(0.5 * (seed.position + other->position))});
      }
      regions.push_back(std::move(region));
    }
    return regions;
  }

 private:
  double size_at(const SolidCore& core, double distance) const {
    return finest_ * std::max(1.0, kCoarsening * distance / core.radius);
  }
  /// How far from a core's centre seeds are needed, m.
  double reach_of(const SolidCore& core) const {
    return core.radius + kRimMargin * size_at(core, core.radius);
  }

  /// Cells that seeds may be in or that belong to them, and the pieces that these are in.
  void find_near() {
    const geometry::TetMesh& mesh = complex_.elements->mesh;
    std::vector<Vec3> middles(mesh.tetrahedra.size(), Vec3::Zero());
    std::vector<char> is_near(mesh.tetrahedra.size(), 0);
    double greatest_radius = 0.0;
    for (Size t = 0; t < is_near.size(); ++t) {
      for (const int v : mesh.tetrahedra[t]) middles[t] += 0.25 * mesh.positions[at(v)];
      double radius = 0.0;
      for (const int v : mesh.tetrahedra[t])
        radius = std::max(radius, (mesh.positions[at(v)] - middles[t]).norm());
      is_near[t] = std::any_of(setup_.cores.begin(), setup_.cores.end(), [&](const SolidCore& core) {
        return (middles[t] - core.centre).norm() < reach_of(core) + radius;
      });
      if (is_near[t] != 0) greatest_radius = std::max(greatest_radius, radius);
    }
    int piece_count = 0;
    pieces_ = label_parts(complex_.cells.size(), find_solid_contacts(complex_), piece_count);
    cells_ = PointCubes(greatest_radius);
    for (Size c = 0; c < pieces_.size(); ++c) {
      const int element = complex_.cells[c].element;
      if (is_near[at(element)] != 0)
        cells_.add(middles[at(element)], static_cast<int>(c));
      else
        pieces_[c] = -1;
    }
  }

  /// -1: none holds it.
  int cell_at(const Vec3& place) const {
    int found = -1;
    cells_.visit_about(cells_.cube_of(place), [&](const std::vector<int>& cells) {
      const auto holder =
          std::find_if(cells.begin(), cells.end(), [&](int c) { return cell_holds(complex_, c, place); });
      if (holder != cells.end()) found = *holder;
      return found < 0;
    });
    return found;
  }

  void try_seed(const Vec3& place) {
    CoreSeed seed;
    seed.position = place;
    bool is_in_reach = false;
    for (const SolidCore& core : setup_.cores) {
      const double distance = (place - core.centre).norm();
      if (distance > reach_of(core)) continue;
      is_in_reach = true;
      seed.size = std::min(seed.size, size_at(core, distance));
      seed.is_open = seed.is_open || distance + kReachOfCells * size_at(core, distance) < core.radius;
    }
    if (!is_in_reach) return;
    const double least = kLeastSeedSpacing * seed.size;
    if (std::any_of(seeds_.begin(), seeds_.end(), [&](const CoreSeed& other) {
          return (other.position - place).squaredNorm() < least * least;
        }))
      return;
    core::stop_if_asked();
    const int cell = cell_at(place);
    if (cell < 0) return;
    seed.piece = pieces_[at(cell)];
    seeds_.push_back(seed);
  }

  const geometry::SolidComplex& complex_;
  const SolidCoreSetup& setup_;
  double finest_ = 0.0;    // m, of cells
  PointCubes cells_{1.0};  // near ones, by the middles of their elements
  std::vector<int> pieces_;
  std::vector<CoreSeed> seeds_;
};

}  // namespace

double crushed_disc_radius(double force, double strength) {
  return core::sqrt(force / (core::kPi * kCompressiveStrength * strength));
}

CrushedSolid crush(geometry::SolidComplex& complex, const SolidCoreSetup& setup) {
  CrushedSolid out;
  if (setup.cores.empty()) return out;
  Crusher crusher(complex, setup);
  crusher.throw_darts();
  const std::vector<geometry::PunchRegion> regions = crusher.regions();
  if (regions.empty()) return out;
  geometry::SolidComplex cut = complex;
  const geometry::Punched punched =
      punch_out(cut, regions, crusher.pieces(), setup.id, geometry::Walls::plane);
  if (punched.wall_area > setup.most_area) {
    out.is_out_of_energy = true;
    return out;
  }
  out.area = punched.wall_area;
  out.cells = static_cast<int>(std::count_if(punched.volumes.begin(), punched.volumes.end(),
                                             [](double volume) { return volume > 0.0; }));
  if (out.area > 0.0) complex = std::move(cut);
  return out;
}

}  // namespace shatterbox::fracture
