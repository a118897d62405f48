#include "engine/fracture/voronoi_cells.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "engine/core/index.h"
#include "engine/core/stop.h"
#include "engine/fracture/grains.h"
#include "engine/fracture/point_cubes.h"

namespace shatterbox::fracture {
namespace {

using geometry::ShellCorner;
using geometry::SideKind;
using Size = std::size_t;
using core::at;

constexpr double kVertexMargin = 0.05;  // no facet crosses an edge nearer to a vertex, share of the edge
constexpr double kLostArea = 1e-14;     // of an element: parts below are nothing but rounding

/// Squared distances at an element's corners.
struct Energy {
  int seed = 0;
  std::array<double, 3> corners{};
};

double value_at(const std::array<double, 3>& corners, const Vec2& b) {
  return corners[0] * (1.0 - b.x() - b.y()) + corners[1] * b.x() + corners[2] * b.y();
}

class CellMaker {
 public:
  CellMaker(ShellCutter& cutter, const ElementPlanes& planes, const CellSetup& setup)
      : cutter_(cutter), planes_(planes), setup_(setup), seeds_(setup.seeds), cubes_(setup.reach) {
    for (Size i = 0; i < seeds_.size(); ++i) cubes_.add(seeds_[i].position, static_cast<int>(i));
  }

  CellCracks cut() {
    CellCracks cracks;
    std::vector<std::pair<int, std::vector<std::vector<ShellCorner>>>> cuts;
    std::vector<char> is_used(seeds_.size(), 0);
    for (const int element : setup_.elements) {
      core::stop_if_asked();
      if (!(planes_.of(element).scale > 0.0) || cutter_.cells_of(element).empty()) continue;
      std::map<int, std::vector<Energy>> by_piece;
      for (const int cell : cutter_.cells_of(element)) {
        const int piece = piece_of(cell);
        const auto known = by_piece.find(piece);
        const std::vector<Energy>& energies =
            known != by_piece.end() ? known->second : by_piece[piece] = energies_of(element, piece);
        const auto is_inside = [this](const Energy& e) { return seeds_[at(e.seed)].is_open; };
        if (std::none_of(energies.begin(), energies.end(), is_inside)) continue;
        auto parts = divide(cell, energies, cracks, is_used);
        if (parts.size() > 1) cuts.emplace_back(cell, std::move(parts));
      }
    }
    if (setup_.most_length >= 0.0 && cracks.length > setup_.most_length) {
      cracks = {};
      cracks.is_out_of_energy = true;
      return cracks;
    }
    for (auto& [cell, parts] : cuts) cutter_.replace(cell, std::move(parts));
    cracks.cells = static_cast<int>(std::count(is_used.begin(), is_used.end(), 1));
    return cracks;
  }

 private:
  /// What a vertex's nearest seed is lowered by so that no facet comes too near. Kept: all elements of a
  /// piece about the vertex must see the same numbers.
  struct Lead {
    int seed = -1;
    double value = 0.0;
  };

  int piece_of(int cell) const {
    return setup_.pieces.empty() ? 0 : setup_.pieces[at(cutter_.cell(cell).origin)];
  }

  double squared_distance(int vertex, int seed) const {
    return (cutter_.elements().mesh.positions[at(vertex)] - seeds_[at(seed)].position).squaredNorm();
  }

  /// All seeds of a piece within reach of any of the points, and some more, each once.
  template <class Points>
  std::vector<int> seeds_near(const Points& points, int piece) const {
    std::set<PointCubes::Cube> middles;
    for (const Vec3& x : points) middles.insert(cubes_.cube_of(x));
    std::vector<int> found;
    for (const PointCubes::Cube& middle : middles)
      cubes_.visit_about(middle, [&](const std::vector<int>& numbers) {
        for (const int n : numbers)
          if (seeds_[at(n)].piece == piece) found.push_back(n);
        return true;
      });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  const Lead& lead_at(int vertex, int piece) {
    const auto known = leads_.find({vertex, piece});
    if (known != leads_.end()) return known->second;
    Lead& lead = leads_[{vertex, piece}];
    const std::vector<int> near =
        seeds_near(std::array<Vec3, 1>{cutter_.elements().mesh.positions[at(vertex)]}, piece);
    for (const int seed : near)
      if (lead.seed < 0 || squared_distance(vertex, seed) < squared_distance(vertex, lead.seed))
        lead.seed = seed;
    if (lead.seed < 0) return lead;
    const double edge = planes_.of(setup_.elements.front()).scale;
    const double least = squared_distance(vertex, lead.seed);
    for (const int seed : near) {
      if (seed == lead.seed) continue;
      const double apart = (seeds_[at(seed)].position - seeds_[at(lead.seed)].position).norm();
      const double wanted = kVertexMargin * 2.0 * apart * std::min(edge, apart);
      lead.value = std::max(lead.value, wanted - (squared_distance(vertex, seed) - least));
    }
    return lead;
  }

  /// Those within reach of some point of an element: of points on it nowhere further apart than half the
  /// reach.
  std::vector<int> seeds_about(const geometry::Triangle& triangle, int piece) const {
    const auto& x = cutter_.elements().mesh.positions;
    double longest = 0.0;
    for (Size i = 0; i < 3; ++i)
      longest = std::max(longest, (x[at(triangle[i])] - x[at(triangle[(i + 1) % 3])]).norm());
    const int parts = 1 + static_cast<int>(2.0 * longest / setup_.reach);
    std::vector<Vec3> points;
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; i + j <= parts; ++j) {
        const double u = static_cast<double>(i) / parts, v = static_cast<double>(j) / parts;
        points.push_back((1.0 - u - v) * x[at(triangle[0])] + u * x[at(triangle[1])] +
                         v * x[at(triangle[2])]);
      }
    return seeds_near(points, piece);
  }

  /// Seeds that may own a part of an element, nearest to its middle first: those kill the others early.
  std::vector<Energy> energies_of(int element, int piece) {
    const geometry::Triangle& triangle = cutter_.elements().mesh.triangles[at(element)];
    std::array<const Lead*, 3> leads{};  // what a map holds stays where it is
    for (Size i = 0; i < 3; ++i) leads[i] = &lead_at(triangle[i], piece);
    std::vector<Energy> energies;
    for (const int seed : seeds_about(triangle, piece)) {
      Energy energy{seed, {}};
      for (Size i = 0; i < 3; ++i)
        energy.corners[i] =
            squared_distance(triangle[i], seed) - (seed == leads[i]->seed ? leads[i]->value : 0.0);
      energies.push_back(energy);
    }
    const auto middle = [](const Energy& e) { return e.corners[0] + e.corners[1] + e.corners[2]; };
    std::sort(energies.begin(), energies.end(), [&](const Energy& a, const Energy& b) {
      return middle(a) != middle(b) ? middle(a) < middle(b) : a.seed < b.seed;
    });
    // Who loses to another seed at all three corners loses everywhere between them.
    std::vector<Energy> rivals;
    for (const Energy& e : energies) {
      const bool is_beaten = std::any_of(rivals.begin(), rivals.end(), [&e](const Energy& r) {
        return r.corners[0] < e.corners[0] && r.corners[1] < e.corners[1] && r.corners[2] < e.corners[2];
      });
      if (!is_beaten) rivals.push_back(e);
    }
    return rivals;
  }

  /// The part of a polygon where `difference` is at most zero; the new side gets the number `id`.
  std::vector<ShellCorner> clip(int element, const std::vector<ShellCorner>& polygon,
                                const std::array<double, 3>& difference, SideKind kind, int id) const {
    std::vector<ShellCorner> kept;
    const Size n = polygon.size();
    for (Size i = 0; i < n; ++i) {
      const ShellCorner& from = polygon[i];
      const ShellCorner& to = polygon[(i + 1) % n];
      const double v = value_at(difference, from.barycentric);
      const double w = value_at(difference, to.barycentric);
      if (v <= 0.0) kept.push_back(from);
      if ((v <= 0.0) == (w <= 0.0)) continue;
      Vec2 place = from.barycentric + v / (v - w) * (to.barycentric - from.barycentric);
      if (from.side == SideKind::element_edge) place = place_on_edge(element, from, to, difference);
      if (v <= 0.0)
        kept.push_back({place, kind, id});
      else
        kept.push_back({place, from.side, from.side_id});
    }
    // A facet that runs through a corner leaves the corner twice.
    std::vector<ShellCorner> clean;
    for (Size i = 0; i < kept.size(); ++i)
      if (kept[i].barycentric != kept[(i + 1) % kept.size()].barycentric) clean.push_back(kept[i]);
    return clean;
  }

  /// From the values at the edge's ends, so that both elements of the edge find the same point.
  Vec2 place_on_edge(int element, const ShellCorner& from, const ShellCorner& to,
                     const std::array<double, 3>& difference) const {
    const geometry::ShellElements& elements = cutter_.elements();
    const geometry::Triangle& triangle = elements.mesh.triangles[at(element)];
    const Size a = at(from.side_id);
    const Size b = (a + 1) % 3;
    const bool is_upwards = triangle[a] < triangle[b];
    const double q = crossing_parameter(difference[is_upwards ? a : b], difference[is_upwards ? b : a]);
    const double p0 = edge_parameter(elements, element, from.side_id, from.barycentric);
    const double p1 = edge_parameter(elements, element, from.side_id, to.barycentric);
    return barycentric_on_edge(elements, element, from.side_id,
                               std::min(std::max(q, std::min(p0, p1)), std::max(p0, p1)));
  }

  std::vector<std::vector<ShellCorner>> divide(int cell_number, const std::vector<Energy>& energies,
                                               CellCracks& cracks, std::vector<char>& is_used) {
    const CutCell& cell = cutter_.cell(cell_number);
    std::map<std::pair<int, int>, int> ids;
    std::vector<std::vector<ShellCorner>> parts;
    std::vector<int> owners;
    for (const Energy& own : energies) {
      core::stop_if_asked();
      std::vector<ShellCorner> part = cell.polygon;
      for (const Energy& other : energies) {
        if (other.seed == own.seed) continue;
        std::array<double, 3> difference{};
        for (Size i = 0; i < 3; ++i) difference[i] = own.corners[i] - other.corners[i];
        const auto is_beaten = [&](const ShellCorner& c) {
          return value_at(difference, c.barycentric) > 0.0;
        };
        if (std::none_of(part.begin(), part.end(), is_beaten)) continue;
        const auto pair = std::minmax(own.seed, other.seed);
        auto id = ids.find(pair);
        if (id == ids.end()) id = ids.emplace(pair, cutter_.new_side_id()).first;
        // Between two cells that are not broken out the material stays whole.
        const bool is_open = seeds_[at(own.seed)].is_open || seeds_[at(other.seed)].is_open;
        part = clip(cell.element, part, difference, is_open ? SideKind::crack : SideKind::grain, id->second);
        if (part.size() < 3) break;
      }
      if (part.size() < 3 || polygon_fraction(part) <= kLostArea) continue;
      parts.push_back(std::move(part));
      owners.push_back(own.seed);
    }
    const auto is_broken_out = [this](int owner) { return seeds_[at(owner)].is_open; };
    if (std::none_of(owners.begin(), owners.end(), is_broken_out)) return {};
    for (const int owner : owners)
      if (is_broken_out(owner)) is_used[at(owner)] = 1;
    if (parts.size() > 1) add_segments(cell.element, ids, parts, cracks);
    return parts;
  }

  /// Each facet is written down once, from the first of its two cells.
  void add_segments(int element, const std::map<std::pair<int, int>, int>& ids,
                    const std::vector<std::vector<ShellCorner>>& parts, CellCracks& cracks) const {
    const ElementPlane& plane = planes_.of(element);
    std::map<int, char> is_written;
    std::map<int, char> is_own;
    for (const auto& [pair, id] : ids) is_own[id] = 1;
    for (const auto& part : parts)
      for (Size i = 0; i < part.size(); ++i) {
        if (part[i].side != SideKind::crack || !is_own.count(part[i].side_id) || is_written[part[i].side_id])
          continue;
        is_written[part[i].side_id] = 1;
        const Vec3 begin = plane.space(plane.flat(part[i].barycentric));
        const Vec3 end = plane.space(plane.flat(part[(i + 1) % part.size()].barycentric));
        cracks.length += (end - begin).norm();
        cracks.segments.push_back({setup_.crack, part[i].side_id, setup_.generation, false, {begin, end}});
      }
  }

  ShellCutter& cutter_;
  const ElementPlanes& planes_;
  const CellSetup& setup_;
  const std::vector<CellSeed>& seeds_;
  PointCubes cubes_;
  std::map<std::pair<int, int>, Lead> leads_;  // by vertex and piece
};

}  // namespace

CellCracks cut_cells(ShellCutter& cutter, const ElementPlanes& planes, const CellSetup& setup) {
  if (setup.seeds.size() < 2 || setup.elements.empty()) return {};
  return CellMaker(cutter, planes, setup).cut();
}

}  // namespace shatterbox::fracture
