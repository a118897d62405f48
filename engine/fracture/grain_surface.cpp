#include "engine/fracture/grain_surface.h"

#include <algorithm>
#include <cmath>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/fracture/crack_guide.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kOnCrack = 1e-4;  // of the greatest value about: a node that has less is on the crack
constexpr int kSmoothings = 3;     // of the field; fewer leave edges that pieces are born crossing at

/// On which side of a crack a grain lies.
struct GrainSide {
  int above = 0, below = 0;  // nodes
  bool is_cut = false;
  int side() const { return is_cut || above + below == 0 ? 0 : above >= below ? 1 : -1; }
};

/// Share of a grain's volume that a crack parts from it, up to which it turns into the boundary instead. It
/// finds cos^4(angle / 2) of the energy release there, and takes it if that is more than the weakness (M.-Y.
/// He, J. W. Hutchinson, J. Appl. Mech. 56, 1989, as in a shell); a plane that leaves a cap of a ball of
/// height 1 - c (radii) meets its surface under the angle whose cosine is c.
double most_grazed(double weakness) {
  const double c = std::clamp(2.0 * core::sqrt(weakness) - 1.0, 0.0, 1.0);
  return 0.25 * (1.0 - c) * (1.0 - c) * (2.0 + c);
}

std::vector<GrainSide> take_sides(const SpaceGrains& grains, const std::vector<double>& potential,
                                  const geometry::Tetrahedron& start, double weakness) {
  std::vector<GrainSide> sides(grains.seeds.size());
  for (Size n = 0; n < potential.size(); ++n) {
    if (potential[n] == 0.0) continue;
    GrainSide& side = sides[at(grains.owner(static_cast<int>(n)))];
    ++(potential[n] > 0.0 ? side.above : side.below);
  }
  const double most = most_grazed(weakness);
  for (GrainSide& side : sides) {
    const double lesser = static_cast<double>(std::min(side.above, side.below));
    side.is_cut = lesser > most * (side.above + side.below);
  }
  for (const int node : start) sides[at(grains.owner(node))].is_cut = true;
  return sides;
}

/// |nodes|, m: about how far each is from the zero of a field, with its sign; 0 where that is not known.
std::vector<double> distances(const geometry::TetMesh& mesh, const std::vector<double>& field) {
  std::vector<double> slope(field.size(), 0.0);
  for (const geometry::Tetrahedron& t : mesh.tetrahedra)
    for (const auto& edge : geometry::kTetrahedronEdges) {
      const int a = t[at(edge[0])], b = t[at(edge[1])];
      if (field[at(a)] == 0.0 || field[at(b)] == 0.0) continue;
      const double rise =
          std::abs(field[at(a)] - field[at(b)]) / (mesh.positions[at(a)] - mesh.positions[at(b)]).norm();
      for (const int v : {a, b}) slope[at(v)] = std::max(slope[at(v)], rise);
    }
  std::vector<double> out(field.size(), 0.0);
  for (Size n = 0; n < field.size(); ++n)
    if (slope[n] > 0.0) out[n] = field[n] / slope[n];
  return out;
}

/// Where three grains meet a crack has an edge as sharp as they have, and faces that turn so much in one
/// element find no room to stand back: each value moves to the mean of itself and of its neighbours' mean.
void smooth(const geometry::TetMesh& mesh, const std::vector<double>& known, std::vector<double>& field) {
  std::vector<double> sum(field.size(), 0.0), weight(field.size(), 0.0);
  for (const geometry::Tetrahedron& t : mesh.tetrahedra)
    for (const auto& edge : geometry::kTetrahedronEdges) {
      const int a = t[at(edge[0])], b = t[at(edge[1])];
      if (known[at(a)] == 0.0 || known[at(b)] == 0.0) continue;
      sum[at(a)] += field[at(b)];
      sum[at(b)] += field[at(a)];
      weight[at(a)] += 1.0;
      weight[at(b)] += 1.0;
    }
  for (Size n = 0; n < field.size(); ++n)
    if (weight[n] > 0.0) field[n] = 0.5 * field[n] + 0.5 * sum[n] / weight[n];
}

}  // namespace

std::vector<double> follow_grains(const SpaceGrains& grains, const geometry::TetMesh& mesh,
                                  const std::vector<double>& potential, int start, double weakness) {
  const std::vector<GrainSide> sides = take_sides(grains, potential, mesh.tetrahedra[at(start)], weakness);
  const std::vector<double> distance = distances(mesh, potential);
  std::vector<double> field(potential.size(), 0.0);
  for (Size n = 0; n < field.size(); ++n) {
    if (potential[n] == 0.0) continue;
    const auto near = grains.of_node(static_cast<int>(n));
    // Of the halves of a grain that is cut, the one beyond the crack is as much farther as the crack is.
    const double most = near.front().energy + grains.reach[n];
    double above = most, below = most;
    for (const NodeGrain& g : near) {
      const GrainSide& grain = sides[at(g.grain)];
      const int side = grain.side();
      if (side > 0 || grain.is_cut)
        above = std::min(above, g.energy + std::max(0.0, grain.is_cut ? -distance[n] : 0.0));
      if (side < 0 || grain.is_cut)
        below = std::min(below, g.energy + std::max(0.0, grain.is_cut ? distance[n] : 0.0));
    }
    field[n] = below - above;
  }
  for (int pass = 0; pass < kSmoothings; ++pass) smooth(mesh, potential, field);
  settle_near_nodes(mesh, potential, field);
  return field;
}

bool is_on_boundary(const SpaceGrains& grains, const geometry::Tetrahedron& nodes,
                    const std::vector<double>& field) {
  double most = 0.0;
  for (const int node : nodes) most = std::max(most, std::abs(field[at(node)]));
  // A node that was put on the crack is on neither side, unless there is no other on one of them.
  const auto is_off = [&](int node) { return std::abs(field[at(node)]) > kOnCrack * most; };
  const bool has_above = std::any_of(nodes.begin(), nodes.end(),
                                     [&](int node) { return is_off(node) && field[at(node)] > 0.0; });
  for (const int a : nodes)
    for (const int b : nodes) {
      const bool is_pair = field[at(a)] > 0.0 && field[at(b)] < 0.0 && is_off(b) && (is_off(a) || !has_above);
      if (is_pair && grains.owner(a) == grains.owner(b)) return false;
    }
  return true;
}

}  // namespace shatterbox::fracture
