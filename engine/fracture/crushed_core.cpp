#include "engine/fracture/crushed_core.h"

#include <algorithm>
#include <array>
#include <map>

#include "engine/core/elementary.h"
#include "engine/core/hash.h"
#include "engine/core/index.h"
#include "engine/core/stop.h"

namespace shatterbox::fracture {
namespace {

using geometry::ShellCorner;
using geometry::SideKind;
using Size = std::size_t;
using core::at;

constexpr double kLeastDistance = 0.75;  // of seeds, share of the local cell size
constexpr double kDartsPerCell = 8.0;    // for the smallest cells
constexpr double kVertexMargin = 0.05;   // no facet crosses an edge nearer to a vertex, share of the edge
constexpr double kLostArea = 1e-14;      // of an element: parts below are nothing but rounding
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

/// Squared distances at an element's corners, from the core's centre to keep numbers small.
struct Energy {
  int seed = 0;
  std::array<double, 3> corners{};
};

double value_at(const std::array<double, 3>& corners, const Vec2& b) {
  return corners[0] * (1.0 - b.x() - b.y()) + corners[1] * b.x() + corners[2] * b.y();
}

class Crusher {
 public:
  Crusher(ShellCutter& cutter, const std::vector<ElementPlane>& planes, const CoreSetup& setup)
      : cutter_(cutter),
        planes_(planes),
        setup_(setup),
        elements_(elements_in_reach(cutter, setup)),
        seeds_(throw_darts(cutter, elements_, setup)) {
    for (const Seed& seed : seeds_)
      is_crushed_.push_back((seed.position - setup.centre).norm() < setup.radius);
  }

  Core crush() {
    Core core;
    if (seeds_.size() < 2) return core;
    std::vector<std::pair<int, std::vector<std::vector<ShellCorner>>>> cuts;
    std::vector<char> is_used(seeds_.size(), 0);
    for (const int element : elements_) {
      core::stop_if_asked();
      if (!(planes_[at(element)].scale > 0.0) || cutter_.cells_of(element).empty()) continue;
      const std::vector<Energy> energies = energies_of(element);
      const auto is_inside = [this](const Energy& e) { return is_crushed_[at(e.seed)] != 0; };
      if (std::none_of(energies.begin(), energies.end(), is_inside)) continue;
      for (const int cell : cutter_.cells_of(element)) {
        auto parts = divide(cell, energies, core, is_used);
        if (parts.size() > 1) cuts.emplace_back(cell, std::move(parts));
      }
    }
    if (setup_.most_length >= 0.0 && core.length > setup_.most_length) {
      core = {};
      core.is_out_of_energy = true;
      return core;
    }
    for (auto& [cell, parts] : cuts) cutter_.replace(cell, std::move(parts));
    core.cells = static_cast<int>(std::count(is_used.begin(), is_used.end(), 1));
    return core;
  }

 private:
  /// Energy of every seed at a vertex; the least is lowered so far that no facet comes too near. Kept: all
  /// elements about the vertex must see the same numbers.
  const std::vector<double>& vertex_energies(int vertex) {
    std::vector<double>& energies = at_vertex_[vertex];
    if (!energies.empty()) return energies;
    const Vec3& x = cutter_.elements().mesh.positions[at(vertex)];
    int best = 0;
    for (Size i = 0; i < seeds_.size(); ++i) {
      energies.push_back((x - seeds_[i].position).squaredNorm());
      if (energies[i] < energies[at(best)]) best = static_cast<int>(i);
    }
    const double edge = planes_[at(elements_.front())].scale;
    double lead = 0.0;
    for (Size i = 0; i < seeds_.size(); ++i) {
      if (static_cast<int>(i) == best) continue;
      const double apart = (seeds_[i].position - seeds_[at(best)].position).norm();
      const double wanted = kVertexMargin * 2.0 * apart * std::min(edge, apart);
      lead = std::max(lead, wanted - (energies[i] - energies[at(best)]));
    }
    energies[at(best)] -= lead;
    return energies;
  }

  /// Seeds that may own a part of an element, nearest to its middle first: those kill the others early.
  std::vector<Energy> energies_of(int element) {
    const geometry::Triangle& triangle = cutter_.elements().mesh.triangles[at(element)];
    std::array<const std::vector<double>*, 3> corners{};
    for (Size i = 0; i < 3; ++i) corners[i] = &vertex_energies(triangle[i]);
    std::vector<Energy> energies;
    for (Size s = 0; s < seeds_.size(); ++s)
      energies.push_back({static_cast<int>(s), {(*corners[0])[s], (*corners[1])[s], (*corners[2])[s]}});
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
                                               Core& core, std::vector<char>& is_used) {
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
        // Between two cells that are not crushed the material stays whole.
        const bool is_open = is_crushed_[at(own.seed)] || is_crushed_[at(other.seed)];
        part = clip(cell.element, part, difference, is_open ? SideKind::crack : SideKind::grain, id->second);
        if (part.size() < 3) break;
      }
      if (part.size() < 3 || polygon_fraction(part) <= kLostArea) continue;
      parts.push_back(std::move(part));
      owners.push_back(own.seed);
    }
    const auto is_crushed = [this](int owner) { return is_crushed_[at(owner)] != 0; };
    if (std::none_of(owners.begin(), owners.end(), is_crushed)) return {};
    for (const int owner : owners)
      if (is_crushed(owner)) is_used[at(owner)] = 1;
    if (parts.size() > 1) add_segments(cell.element, ids, parts, core);
    return parts;
  }

  /// Each facet is written down once, from the first of its two cells.
  void add_segments(int element, const std::map<std::pair<int, int>, int>& ids,
                    const std::vector<std::vector<ShellCorner>>& parts, Core& core) const {
    const ElementPlane& plane = planes_[at(element)];
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
        core.length += (end - begin).norm();
        core.segments.push_back({setup_.crack, part[i].side_id, setup_.generation, false, {begin, end}});
      }
  }

  ShellCutter& cutter_;
  const std::vector<ElementPlane>& planes_;
  const CoreSetup& setup_;
  const std::vector<int> elements_;  // ascending
  const std::vector<Seed> seeds_;
  std::vector<char> is_crushed_;  // per seed
  std::map<int, std::vector<double>> at_vertex_;
};

}  // namespace

Core crush_core(ShellCutter& cutter, const std::vector<ElementPlane>& planes, const CoreSetup& setup) {
  if (!(setup.radius > 0.0) || !(setup.cell_size > 0.0) || !(setup.patch_radius > 0.0)) return {};
  return Crusher(cutter, planes, setup).crush();
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
