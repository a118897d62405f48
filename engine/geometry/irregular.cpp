#include "engine/geometry/irregular.h"

#include <algorithm>
#include <array>

#include "engine/core/elementary.h"
#include "engine/core/random.h"
#include "engine/geometry/edge_topology.h"

namespace shatterbox::geometry {
namespace {

// Enough rounds to forget the lattice the mesh began with: with jitter 0.3 the directions of a pane's edges
// are even to a few per cent. Fewer leave its three directions for cracks to follow.
constexpr int kMeltRounds = 8;
constexpr int kSettleRounds = 8;
constexpr int kMeltFlipPasses = 3;
constexpr int kSettleFlipPasses = 12;
constexpr double kGuardCosine = 0.92;  // 23 degrees: random steps go no sharper
constexpr double kMendCosine = 0.80;   // 37 degrees: sharper ones are relaxed
constexpr double kFlatCosine = 0.7;    // an edge is flipped only where the surface is flatter than 45 degrees

class Loosener {
 public:
  Loosener(TriangleMesh& mesh, SurfaceWalk& walk) : mesh_(mesh), walk_(walk) {}

  void flip_edges(int most_passes) {
    for (int pass = 0; pass < most_passes; ++pass)
      if (flip_pass() == 0) break;
    list_fans();
  }

  void step_randomly(double jitter, core::Random& random) {
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v) {
      const double turn = 2.0 * core::kPi * random.uniform();
      const double length = jitter * core::sqrt(random.uniform());  // even over a disc
      const Vec2 wanted(length * core::cos(turn), length * core::sin(turn));
      try_steps(v, mean_edge(v) * wanted, kGuardCosine);
    }
  }

  /// Vertices of sharp triangles go towards the middle of their neighbours if that makes the sharpest angle
  /// wider.
  void relax() {
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v) {
      const double before = sharpest_around(v);
      if (before < kMendCosine) continue;
      const Vec3 offset = neighbour_middle(v) - mesh_.positions[v];
      const Vec2 wanted = walk_.tangents(walk_.parameters[v]).transpose() * offset;
      try_steps(v, wanted, -1.0);
    }
  }

 private:
  const Vec3& at(int vertex) const { return mesh_.positions[static_cast<std::size_t>(vertex)]; }

  static int opposite(const Triangle& t, int a, int b) {
    for (const int v : t)
      if (v != a && v != b) return v;
    return -1;
  }

  Vec3 normal(const Triangle& t) const { return (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])); }
  double sharpest(const Triangle& t) const { return sharpest_cosine(at(t[0]), at(t[1]), at(t[2])); }

  int flip_pass() {
    const EdgeTopology topology = build_edge_topology(mesh_.triangles);
    std::vector<std::uint8_t> touched(mesh_.triangles.size(), 0);
    int flips = 0;
    for (std::size_t e = 0; e < topology.edges.size(); ++e) {
      if (topology.triangle_count(static_cast<int>(e)) != 2) continue;
      const auto begin = static_cast<std::size_t>(topology.first_triangle[e]);
      const auto first = static_cast<std::size_t>(topology.edge_triangles[begin]);
      const auto second = static_cast<std::size_t>(topology.edge_triangles[begin + 1]);
      if (touched[first] || touched[second]) continue;
      if (!flip(topology, topology.edges[e], first, second)) continue;
      touched[first] = touched[second] = 1;
      ++flips;
    }
    return flips;
  }

  /// Replaces the edge by the other diagonal if that makes the sharpest angle of the two triangles wider.
  bool flip(const EdgeTopology& topology, const std::array<int, 2>& edge, std::size_t first,
            std::size_t second) {
    const int crease = walk_.creases[static_cast<std::size_t>(edge[0])];
    if (crease >= 0 && crease == walk_.creases[static_cast<std::size_t>(edge[1])]) return false;
    Triangle& t = mesh_.triangles[first];
    Triangle& u = mesh_.triangles[second];
    // a -> b in the first triangle's own direction, c and d the far corners.
    const int c = opposite(t, edge[0], edge[1]);
    const auto corner = static_cast<std::size_t>(std::find(t.begin(), t.end(), c) - t.begin());
    const int a = t[(corner + 1) % 3];
    const int b = t[(corner + 2) % 3];
    const int d = opposite(u, a, b);
    const std::array<int, 2> diagonal{std::min(c, d), std::max(c, d)};
    if (c == d || std::binary_search(topology.edges.begin(), topology.edges.end(), diagonal)) return false;
    const Triangle t_new{a, d, c};
    const Triangle u_new{d, b, c};
    if (std::max(sharpest(t_new), sharpest(u_new)) >= std::max(sharpest(t), sharpest(u)) - 1e-9) return false;
    for (const Vec3& n_new : {normal(t_new), normal(u_new)})
      for (const Vec3& n_old : {normal(t), normal(u)})
        if (n_new.dot(n_old) < kFlatCosine * n_new.norm() * n_old.norm()) return false;
    t = t_new;
    u = u_new;
    return true;
  }

  void list_fans() {
    first_.assign(mesh_.positions.size() + 1, 0);
    for (const Triangle& t : mesh_.triangles)
      for (const int v : t) ++first_[static_cast<std::size_t>(v) + 1];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    fans_.resize(3 * mesh_.triangles.size());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (const int v : mesh_.triangles[t]) fans_[next[static_cast<std::size_t>(v)]++] = t;
  }

  template <class Visit>
  void for_fan(std::size_t v, const Visit& visit) const {
    for (std::size_t i = first_[v]; i < first_[v + 1]; ++i) visit(mesh_.triangles[fans_[i]]);
  }

  double sharpest_around(std::size_t v) const {
    double worst = -1.0;
    for_fan(v, [&](const Triangle& t) { worst = std::max(worst, sharpest(t)); });
    return worst;
  }

  double mean_edge(std::size_t v) const {
    double sum = 0.0;
    int count = 0;
    for_fan(v, [&](const Triangle& t) {
      for (const int w : t) {
        if (w == static_cast<int>(v)) continue;
        sum += (at(w) - mesh_.positions[v]).norm();
        ++count;
      }
    });
    return count > 0 ? sum / count : 0.0;
  }

  Vec3 neighbour_middle(std::size_t v) const {
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for_fan(v, [&](const Triangle& t) {
      for (const int w : t) {
        if (w == static_cast<int>(v)) continue;
        sum += at(w);
        ++count;
      }
    });
    return count > 0 ? Vec3(sum / count) : mesh_.positions[v];
  }

  /// Takes the wanted step, or a half, quarter or eighth of it: the first that leaves the sharpest angle
  /// around the vertex no sharper than `guard`, or than it was.
  void try_steps(std::size_t v, const Vec2& wanted, double guard) {
    Vec2 step = wanted.cwiseProduct(walk_.freedom[v]);
    if (step.isZero(0.0)) return;
    const Vec3 old_position = mesh_.positions[v];
    const double allowed = std::max(sharpest_around(v) - (guard < 0.0 ? 1e-9 : 0.0), guard);
    std::vector<Vec3> normals;
    for_fan(v, [&](const Triangle& t) { normals.push_back(normal(t)); });
    for (int attempt = 0; attempt < 4; ++attempt, step *= 0.5) {
      const Vec3 parameter = walk_.stepped(walk_.parameters[v], step);
      mesh_.positions[v] = walk_.position(parameter);
      bool is_good = sharpest_around(v) <= allowed;
      std::size_t i = 0;
      for_fan(v, [&](const Triangle& t) { is_good = normal(t).dot(normals[i++]) > 0.0 && is_good; });
      if (is_good) {
        walk_.parameters[v] = parameter;
        return;
      }
    }
    mesh_.positions[v] = old_position;
  }

  TriangleMesh& mesh_;
  SurfaceWalk& walk_;
  std::vector<std::size_t> first_;  // |V| + 1: begin of a vertex's triangles in fans_
  std::vector<std::size_t> fans_;
};

}  // namespace

double sharpest_cosine(const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::array<Vec3, 3> sides{b - a, c - b, a - c};
  const std::array<double, 3> lengths{sides[0].norm(), sides[1].norm(), sides[2].norm()};
  double worst = -1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 2) % 3;
    const double product = lengths[i] * lengths[j];
    if (product == 0.0) return 1.0;
    worst = std::max(worst, -sides[i].dot(sides[j]) / product);
  }
  return worst;
}

void make_irregular(TriangleMesh& mesh, SurfaceWalk& walk, double jitter, std::uint64_t seed) {
  Loosener loosener(mesh, walk);
  core::Random random(seed, 0x6a177e5);
  loosener.flip_edges(kSettleFlipPasses);
  if (jitter > 0.0) {
    for (int round = 0; round < kMeltRounds; ++round) {
      loosener.step_randomly(jitter, random);
      loosener.flip_edges(kMeltFlipPasses);
    }
  }
  for (int round = 0; round < kSettleRounds; ++round) {
    loosener.relax();
    loosener.flip_edges(kSettleFlipPasses);
  }
}

}  // namespace shatterbox::geometry
