#include "render/frame/simplify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "render/frame/expand.h"

namespace shatterbox::render {
namespace {

constexpr int kMostRounds = 12;
constexpr double kMeanShare =
    0.25;  // the mean of the squared distances may be this share of the greatest one's square
constexpr float kLeastTurnCosine = 0.8F;     // a triangle's plane turns by no more in one collapse
constexpr float kLeastNormalCosine = 0.95F;  // nor does the normal differ from end to end of a collapsed edge
constexpr float kLeastShape = 0.05F;         // of a triangle: 1 equilateral, 0 a line

// Mean of squared distances to planes: a symmetric form, by its ten entries.
struct Quadric {
  std::array<double, 10> q{};  // aa ab ac ad bb bc bd cc cd dd
  double planes = 0.0;
  void add_plane(glm::dvec3 n, double d) {
    const double v[4] = {n.x, n.y, n.z, d};
    std::size_t k = 0;
    for (int i = 0; i < 4; ++i) {
      for (int j = i; j < 4; ++j) q[k++] += v[i] * v[j];
    }
    planes += 1.0;
  }
  void add(const Quadric& other) {
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += other.q[i];
    planes += other.planes;
  }
  double at(glm::dvec3 p) const {
    const double sum =
        q[0] * p.x * p.x + q[4] * p.y * p.y + q[7] * p.z * p.z + q[9] +
        2.0 * (q[1] * p.x * p.y + q[2] * p.x * p.z + q[5] * p.y * p.z + q[3] * p.x + q[6] * p.y + q[8] * p.z);
    return std::max(sum, 0.0) / std::max(planes, 1.0);
  }
};

struct Triangle {
  std::array<std::uint32_t, 3> vertex;
  std::array<glm::vec3, 3> normal;  // by corner
  std::array<bool, 3> is_crack{};   // edge from the corner to the next
  std::uint8_t part = 0;
  bool is_gone = false;

  int corner_of(std::uint32_t v) const {
    return vertex[0] == v ? 0 : vertex[1] == v ? 1 : vertex[2] == v ? 2 : -1;
  }
};

// What surrounds a vertex, in order; on the outline the first and last neighbours lie on it too.
struct Ring {
  static constexpr std::size_t kMostTriangles = 24;
  bool is_simple = false, is_outline = false;
  std::array<std::uint32_t, kMostTriangles + 1> around{};  // the first `count`
  std::size_t count = 0;
  std::span<const std::uint32_t> neighbours() const { return {around.data(), count}; }
};

class Simplifier {
 public:
  Simplifier(const Mesh& mesh, float tolerance)
      : mesh_(mesh),
        tolerance_squared_(kMeanShare * tolerance * tolerance),
        fans_(mesh.positions.size()),
        quadrics_(mesh.positions.size()),
        waits_(mesh.positions.size(), 0),
        is_settled_(mesh.positions.size(), 0) {
    read();
    weigh();
  }

  void run() {
    for (int round = 0; round < kMostRounds; ++round) {
      std::fill(waits_.begin(), waits_.end(), char{0});
      std::size_t collapsed = 0, left = 0;
      for (std::uint32_t v = 0; v < fans_.size(); ++v) {
        if (fans_[v].empty()) continue;
        ++left;
        if (waits_[v] != 0 || is_settled_[v] != 0) continue;
        if (collapse(v))
          ++collapsed;
        else
          is_settled_[v] = 1;
      }
      if (collapsed * 50 <= left) return;
    }
  }

  Mesh result() const {
    Mesh out = mesh_;
    out.triangles.clear();
    out.parts.clear();
    out.cracks.clear();
    out.normals.clear();
    for (const Triangle& t : triangles_) {
      if (t.is_gone) continue;
      out.triangles.emplace_back(t.vertex[0], t.vertex[1], t.vertex[2]);
      out.normals.insert(out.normals.end(), t.normal.begin(), t.normal.end());
      if (!mesh_.parts.empty()) out.parts.push_back(t.part);
      if (mesh_.cracks.empty()) continue;
      out.cracks.push_back(static_cast<std::uint8_t>((t.is_crack[0] ? kCrackEdge0 : 0U) |
                                                     (t.is_crack[1] ? kCrackEdge1 : 0U) |
                                                     (t.is_crack[2] ? kCrackEdge2 : 0U)));
    }
    return out;
  }

 private:
  glm::vec3 position(std::uint32_t v) const { return mesh_.positions[v]; }

  void read() {
    const std::vector<glm::vec3> normals = mesh_.normals.empty() ? find_corner_normals(mesh_) : mesh_.normals;
    std::vector<std::uint8_t> counts(fans_.size(), 0);
    for (const glm::uvec3& t : mesh_.triangles)
      for (int k = 0; k < 3; ++k) counts[t[k]] = static_cast<std::uint8_t>(std::min(counts[t[k]] + 1, 255));
    for (std::size_t v = 0; v < fans_.size(); ++v) fans_[v].reserve(counts[v] + 2U);  // some grow
    triangles_.reserve(mesh_.triangles.size());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      Triangle triangle;
      const unsigned cracks = mesh_.cracks.empty() ? 0U : mesh_.cracks[t];
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.vertex[k] = mesh_.triangles[t][static_cast<int>(k)];
        triangle.normal[k] = normals[3 * t + k];
        triangle.is_crack[k] = (cracks & (1U << k)) != 0;
        fans_[triangle.vertex[k]].push_back(static_cast<std::uint32_t>(t));
      }
      if (!mesh_.parts.empty()) triangle.part = mesh_.parts[t];
      triangles_.push_back(triangle);
    }
  }

  glm::vec3 across(const std::array<std::uint32_t, 3>& v) const {
    return glm::cross(position(v[1]) - position(v[0]), position(v[2]) - position(v[0]));
  }

  // Planes of the triangles and, square to them, through the outline's edges.
  void weigh() {
    for (const Triangle& t : triangles_) {
      const glm::dvec3 area(across(t.vertex));
      const double length = glm::length(area);
      if (!(length > 0.0)) continue;
      const glm::dvec3 n = area / length;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t.vertex[k], b = t.vertex[(k + 1) % 3];
        const glm::dvec3 p(position(a)), along = glm::dvec3(position(b)) - p;
        quadrics_[a].add_plane(n, -glm::dot(n, p));
        const glm::dvec3 side = glm::cross(along, n);
        const double size = glm::length(side);
        if (!(size > 0.0) || triangles_about(a, b) != 1) continue;
        for (const std::uint32_t v : {a, b}) quadrics_[v].add_plane(side / size, -glm::dot(side / size, p));
      }
    }
  }

  int triangles_about(std::uint32_t a, std::uint32_t b) const {
    int count = 0;
    for (const std::uint32_t t : fans_[a]) count += triangles_[t].corner_of(b) >= 0 ? 1 : 0;
    return count;
  }

  // One part, one normal, triangles in a disc or in half of one: else the vertex stays.
  Ring ring_of(std::uint32_t v) const {
    Ring ring;
    const std::vector<std::uint32_t>& fan = fans_[v];
    std::array<std::array<std::uint32_t, 2>, Ring::kMostTriangles>
        edges{};  // of the fan, opposite to v, in the triangles' sense
    if (fan.size() > edges.size()) return ring;
    const Triangle& first = triangles_[fan.front()];
    const glm::vec3 normal = first.normal[static_cast<std::size_t>(first.corner_of(v))];
    for (std::size_t i = 0; i < fan.size(); ++i) {
      const Triangle& t = triangles_[fan[i]];
      const auto k = static_cast<std::size_t>(t.corner_of(v));
      if (t.part != first.part || glm::dot(t.normal[k], normal) < 0.9999F) return ring;
      edges[i] = {t.vertex[(k + 1) % 3], t.vertex[(k + 2) % 3]};
    }
    // The outline's first edge leaves a neighbour that no other edge arrives at.
    std::uint32_t at = edges[0][0];
    int starts = 0;
    for (std::size_t i = 0; i < fan.size(); ++i) {
      bool is_start = true;
      for (std::size_t j = 0; j < fan.size(); ++j) is_start = is_start && edges[j][1] != edges[i][0];
      if (is_start) at = edges[i][0];
      starts += is_start ? 1 : 0;
    }
    ring.is_outline = starts == 1;
    if (starts > 1 || fan.size() < (ring.is_outline ? 2U : 3U)) return ring;
    ring.around[ring.count++] = at;
    for (std::size_t step = 0; step < fan.size(); ++step) {
      std::size_t next = fan.size();
      for (std::size_t i = 0; i < fan.size() && next == fan.size(); ++i) {
        if (edges[i][0] == at) next = i;
      }
      if (next == fan.size()) return ring;
      at = edges[next][1];
      if (step + 1 < fan.size() || ring.is_outline) ring.around[ring.count++] = at;
    }
    ring.is_simple = ring.is_outline || at == ring.around[0];
    return ring;
  }

  bool is_crack_edge(std::uint32_t a, std::uint32_t b) {
    for (const std::uint32_t i : fans_[a]) {
      if (triangles_[i].corner_of(b) >= 0) return crack_of(triangles_[i], a, b);
    }
    return false;
  }

  // Whether the triangles of v, but for those that vanish, keep their sense and a shape when v moves to u.
  bool keeps_shape(std::uint32_t v, std::uint32_t u) const {
    for (const std::uint32_t i : fans_[v]) {
      const Triangle& t = triangles_[i];
      if (t.corner_of(u) >= 0) continue;
      std::array<std::uint32_t, 3> moved = t.vertex;
      moved[static_cast<std::size_t>(t.corner_of(v))] = u;
      const glm::vec3 before = across(t.vertex), after = across(moved);
      const float product = glm::length(before) * glm::length(after);
      if (glm::dot(before, after) <= kLeastTurnCosine * product) return false;
      float edges = 0.0F;
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec3 along = position(moved[(k + 1) % 3]) - position(moved[k]);
        edges += glm::dot(along, along);
      }
      if (3.4641F * glm::length(after) < kLeastShape * edges) return false;
    }
    return true;
  }

  // Neighbours that both share are only those of the triangles that vanish: else the surface would fold
  // together.
  bool is_link_simple(const Ring& ring, std::uint32_t v, std::uint32_t u) const {
    int shared = 0;
    for (const std::uint32_t n : ring.neighbours()) shared += n != u && triangles_about(n, u) > 0 ? 1 : 0;
    return shared == triangles_about(v, u);
  }

  // The corner normal that u has beside v.
  glm::vec3 normal_beside(std::uint32_t v, std::uint32_t u) const {
    for (const std::uint32_t i : fans_[v]) {
      const int k = triangles_[i].corner_of(u);
      if (k >= 0) return triangles_[i].normal[static_cast<std::size_t>(k)];
    }
    return glm::vec3(0.0F);
  }

  bool collapse(std::uint32_t v) {
    const Ring ring = ring_of(v);
    if (!ring.is_simple) return false;
    std::span<const std::uint32_t> targets = ring.neighbours();
    const std::array<std::uint32_t, 2> ends{targets.front(), targets.back()};
    if (ring.is_outline) {
      targets = ends;
      if (is_crack_edge(v, targets[0]) != is_crack_edge(v, targets[1])) return false;
    }
    const Triangle& any = triangles_[fans_[v].front()];
    const glm::vec3 normal = any.normal[static_cast<std::size_t>(any.corner_of(v))];
    std::array<double, Ring::kMostTriangles + 1> costs{};
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const glm::dvec3 p(position(targets[i]));
      costs[i] = quadrics_[v].at(p) + quadrics_[targets[i]].at(p);
    }
    // The cheapest that may be: what that asks costs more than the cost.
    for (;;) {
      const auto cheapest = std::min_element(costs.begin(), costs.begin() + targets.size());
      if (!(*cheapest < tolerance_squared_)) return false;
      const std::uint32_t u = targets[static_cast<std::size_t>(cheapest - costs.begin())];
      *cheapest = std::numeric_limits<double>::max();
      if (glm::dot(normal_beside(v, u), normal) < kLeastNormalCosine) continue;
      if (!is_link_simple(ring, v, u) || !keeps_shape(v, u)) continue;
      for (const std::uint32_t n : ring.neighbours())
        waits_[n] = 1;  // one collapse a neighbourhood and round
      move(v, u);
      unsettle(ring);
      return true;
    }
  }

  // Whose neighbours, or theirs, are not as they were may collapse after all.
  void unsettle(const Ring& ring) {
    for (const std::uint32_t n : ring.neighbours())
      for (const std::uint32_t i : fans_[n])
        for (const std::uint32_t w : triangles_[i].vertex) is_settled_[w] = 0;
  }

  // The flag of the edge between two corners of a triangle.
  static bool& crack_of(Triangle& t, std::uint32_t a, std::uint32_t b) {
    const int k = t.corner_of(a), l = t.corner_of(b);
    return t.is_crack[static_cast<std::size_t>(l == (k + 1) % 3 ? k : l)];
  }

  void move(std::uint32_t v, std::uint32_t u) {
    const glm::vec3 normal = normal_beside(v, u);
    for (const std::uint32_t i : fans_[v]) {
      if (triangles_[i].corner_of(u) >= 0) vanish(i, v, u);
    }
    for (const std::uint32_t i : fans_[v]) {
      Triangle& t = triangles_[i];
      if (t.is_gone) continue;
      const auto k = static_cast<std::size_t>(t.corner_of(v));
      t.vertex[k] = u;
      t.normal[k] = normal;
      fans_[u].push_back(i);
    }
    fans_[v].clear();
    quadrics_[u].add(quadrics_[v]);
  }

  // A triangle between v and u goes; its edge from v to the third corner falls upon the one from u, whose
  // flag it takes.
  void vanish(std::uint32_t i, std::uint32_t v, std::uint32_t u) {
    Triangle& t = triangles_[i];
    t.is_gone = true;
    std::uint32_t third = v;
    for (const std::uint32_t w : t.vertex) third = w != v && w != u ? w : third;
    std::erase(fans_[u], i);
    std::erase(fans_[third], i);
    for (const std::uint32_t j : fans_[v]) {
      Triangle& other = triangles_[j];
      if (!other.is_gone && other.corner_of(third) >= 0) crack_of(other, v, third) = crack_of(t, u, third);
    }
  }

  const Mesh& mesh_;
  double tolerance_squared_;
  std::vector<Triangle> triangles_;
  std::vector<std::vector<std::uint32_t>> fans_;  // triangles about each vertex
  std::vector<Quadric> quadrics_;
  std::vector<char> waits_;       // until the next round
  std::vector<char> is_settled_;  // could not collapse, and nothing about it has changed
};

}  // namespace

Mesh simplify(const Mesh& mesh, float tolerance) {
  check(mesh);
  Simplifier simplifier(mesh, tolerance);
  simplifier.run();
  return simplifier.result();
}

}  // namespace shatterbox::render
