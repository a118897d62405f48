#include "engine/geometry/remade_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/generator_faults.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/mesh_findings.h"
#include "engine/geometry/orientation.h"
#include "engine/geometry/self_crossings.h"
#include "engine/geometry/surface_distance.h"
#include "engine/geometry/winding_number.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kMostNodes = 8e6;          // of the grid
constexpr double kInside = 0.5;             // least winding number
constexpr double kLeastShareOfEdge = 0.01;  // a vertex stays so far from the ends of its edge
constexpr int kSlides = 8;                  // of all vertices along the surface
constexpr int kBisections = 20;             // of an edge over a hole
constexpr double kAside = 0.02;             // of the spacing: where the two sides of a triangle are asked
constexpr double kMostBridged = 0.05, kMostLost = 0.01, kMostVolumeOff = 0.05;
// The grid's planes lie where few surfaces have theirs.
const Vec3 kMargin(1.31, 1.47, 1.17);  // spacings

// Six tetrahedra about a cube's diagonal [Kuh60]; corners by bits x, y, z.
constexpr std::array<std::array<int, 4>, 6> kTetrahedra = {
    {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};

class Remaking {
 public:
  Remaking(const TriangleMesh& given, double spacing)
      : given_(given),
        spacing_(spacing),
        winding_(given),
        tree_(build_triangle_tree(given.positions, given.triangles)),
        boxes_(node_boxes(tree_, given)),
        triangle_boxes_(triangle_boxes(given)) {}

  core::Result<RemadeSurface> run() {
    if (const auto fault = find_size_fault("the spacing", spacing_)) return core::Error{*fault};
    if (given_.triangles.empty()) return core::Error{"there are no triangles"};
    if (!place_grid()) return core::Error{"it is too fine for a surface of that size: take larger elements"};
    find_inside();
    march();
    if (corners_.empty()) return core::Error{"it encloses nothing, or nothing as wide as an element"};
    make_mesh();
    even_out();
    if (const auto fault = find_dishonesty()) return core::Error{*fault};
    return std::move(out_);
  }

 private:
  // An edge of the grid, from a node in one of seven directions.
  using Edge = std::uint64_t;

  bool place_grid() {
    Box box = box_of(given_);
    origin_ = box.low - spacing_ * kMargin;
    double nodes = 1.0;
    for (int k = 0; k < 3; ++k) {
      const double count = std::ceil((box.high[k] - origin_[k]) / spacing_) + 2.0;
      nodes *= count;
      if (!(nodes < kMostNodes)) return false;
      count_[at(k)] = static_cast<Size>(count);
    }
    return true;
  }

  Size node_at(Size x, Size y, Size z) const { return (z * count_[1] + y) * count_[0] + x; }
  Size node_beside(Size node, int bits) const {
    return node + ((bits & 1) ? 1 : 0) + ((bits & 2) ? count_[0] : 0) +
           ((bits & 4) ? count_[0] * count_[1] : 0);
  }
  Vec3 place_of(Size node) const {
    const Size x = node % count_[0], y = node / count_[0] % count_[1], z = node / (count_[0] * count_[1]);
    return origin_ + spacing_ * Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
  }

  /// What faces inwards all over winds the other way. Nothing reaches the grid's border.
  void find_inside() {
    std::vector<float> winding(count_[0] * count_[1] * count_[2]);
    core::parallel_for(winding.size(), 1024, [&](Size node) {
      winding[node] = static_cast<float>(winding_.about(place_of(node)));
    });
    const auto inside = std::count_if(winding.begin(), winding.end(), [](float w) { return w > 0.5F; });
    const auto outside_in = std::count_if(winding.begin(), winding.end(), [](float w) { return w < -0.5F; });
    sign_ = outside_in > inside ? -1.0 : 1.0;
    is_inside_.assign(winding.size(), 0);
    for (Size z = 1; z + 1 < count_[2]; ++z)
      for (Size y = 1; y + 1 < count_[1]; ++y)
        for (Size x = 1; x + 1 < count_[0]; ++x) {
          const Size node = node_at(x, y, z);
          is_inside_[node] = sign_ * static_cast<double>(winding[node]) > kInside ? 1 : 0;
        }
  }

  bool is_inside(const Vec3& p) const { return sign_ * winding_.about(p) > kInside; }

  void march() {
    for (Size z = 0; z + 1 < count_[2]; ++z)
      for (Size y = 0; y + 1 < count_[1]; ++y)
        for (Size x = 0; x + 1 < count_[0]; ++x) march_cube(node_at(x, y, z));
  }

  void march_cube(Size node) {
    int count = 0;
    for (int bits = 0; bits < 8; ++bits) count += is_inside_[node_beside(node, bits)];
    if (count == 0 || count == 8) return;
    for (const std::array<int, 4>& tetrahedron : kTetrahedra) march_tetrahedron(node, tetrahedron);
  }

  void march_tetrahedron(Size node, const std::array<int, 4>& tetrahedron) {
    std::array<int, 4> in{}, out{};
    Size ins = 0, outs = 0;
    for (const int bits : tetrahedron) {
      if (is_inside_[node_beside(node, bits)] != 0)
        in[ins++] = bits;
      else
        out[outs++] = bits;
    }
    if (ins == 1) add(node, {{{in[0], out[0]}, {in[0], out[1]}, {in[0], out[2]}}});
    if (ins == 3) add(node, {{{in[0], out[0]}, {in[1], out[0]}, {in[2], out[0]}}});
    if (ins != 2) return;
    add(node, {{{in[0], out[0]}, {in[0], out[1]}, {in[1], out[1]}}});
    add(node, {{{in[0], out[0]}, {in[1], out[1]}, {in[1], out[0]}}});
  }

  static Vec3 corner(int bits) {
    return {(bits & 1) ? 1.0 : 0.0, (bits & 2) ? 1.0 : 0.0, (bits & 4) ? 1.0 : 0.0};
  }

  /// A triangle whose corners lie between a corner inside and one outside, turned to face outwards.
  void add(Size node, const std::array<std::pair<int, int>, 3>& edges) {
    std::array<Edge, 3> keys{};
    std::array<Vec3, 3> middles;
    Vec3 outward = Vec3::Zero();
    for (Size i = 0; i < 3; ++i) {
      const auto& [in, out] = edges[i];
      const int low = in & out,
                direction = in ^ out;  // of two corners of a tetrahedron one has all bits of the other
      keys[i] = 8 * static_cast<Edge>(node_beside(node, low)) + static_cast<Edge>(direction);
      middles[i] = corner(in) + corner(out);
      outward += corner(out) - corner(in);
    }
    if ((middles[1] - middles[0]).cross(middles[2] - middles[0]).dot(outward) < 0.0)
      std::swap(keys[1], keys[2]);
    corners_.insert(corners_.end(), keys.begin(), keys.end());
  }

  void make_mesh() {
    std::vector<Edge> edges = corners_;
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    out_.mesh.positions.resize(edges.size());
    is_bridge_.assign(edges.size(), 0);
    core::parallel_for(edges.size(), 256, [&](Size i) {
      const Size from = static_cast<Size>(edges[i] / 8),
                 to = node_beside(from, static_cast<int>(edges[i] % 8));
      place_vertex(from, to, i);
    });
    for (Size c = 0; c < corners_.size(); c += 3) {
      Triangle t{};
      for (Size i = 0; i < 3; ++i)
        t[i] =
            static_cast<int>(std::lower_bound(edges.begin(), edges.end(), corners_[c + i]) - edges.begin());
      out_.mesh.triangles.push_back(t);
    }
  }

  /// Where an edge of the grid leaves what the surface winds about.
  void place_vertex(Size from, Size to, Size vertex) {
    const Vec3 a = place_of(from), b = place_of(to);
    const bool starts_inside = is_inside_[from] != 0;
    const auto is_changed = [&](double t) { return is_inside(a + t * (b - a)) != starts_inside; };
    const std::vector<double> passages = find_passages(a, b);
    double share = -1.0;
    for (Size i = 0; i < passages.size() && share < 0.0; ++i) {
      const double next = i + 1 < passages.size() ? passages[i + 1] : 1.0;
      if (i + 1 == passages.size() || is_changed(0.5 * (passages[i] + next))) share = passages[i];
    }
    if (share < 0.0) {
      is_bridge_[vertex] = 1;
      double low = 0.0, high = 1.0;
      for (int k = 0; k < kBisections; ++k)
        (is_changed(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
      share = 0.5 * (low + high);
    }
    out_.mesh.positions[vertex] = a + std::clamp(share, kLeastShareOfEdge, 1.0 - kLeastShareOfEdge) * (b - a);
  }

  /// Shares of the way from a to b at which it passes through triangles, ascending.
  std::vector<double> find_passages(const Vec3& a, const Vec3& b) const {
    Box box;
    box.include(a);
    box.include(b);
    std::vector<double> shares;
    std::vector<int> stack(1, 0);
    while (!stack.empty()) {
      const int n = stack.back();
      stack.pop_back();
      if (!overlaps(boxes_[at(n)], box)) continue;
      const TriangleTree::Node& node = tree_.nodes[at(n)];
      for (int k = node.begin; k < node.begin + node.count; ++k) {
        const int triangle = tree_.order[at(k)];
        if (!overlaps(triangle_boxes_[at(triangle)], box)) continue;
        const Triangle& t = given_.triangles[at(triangle)];
        const std::array<Vec3, 3> c = {given_.positions[at(t[0])], given_.positions[at(t[1])],
                                       given_.positions[at(t[2])]};
        if (passage_of_edge(a, b, c) == 0) continue;
        const double before = oriented_volume(c[0], c[1], c[2], a),
                     after = oriented_volume(c[0], c[1], c[2], b);
        shares.push_back(before == after ? 0.5 : std::clamp(before / (before - after), 0.0, 1.0));
      }
      if (node.count > 0) continue;
      stack.push_back(node.right);
      stack.push_back(n + 1);
    }
    std::sort(shares.begin(), shares.end());
    return shares;
  }

  /// Marching leaves triangles of all sizes: vertices slide along the surface, towards the larger ones, as
  /// far as nothing passes through itself for it.
  void even_out() {
    const std::vector<Vec3> before = out_.mesh.positions;
    for (int slides = kSlides; slides > 0; slides /= 2) {
      for (int k = 0; k < slides; ++k) slide();
      if (find_self_crossings(out_.mesh).count == 0) return;
      out_.mesh.positions = before;
    }
  }

  void slide() {
    std::vector<Vec3>& positions = out_.mesh.positions;
    std::vector<Vec3> normals(positions.size(), Vec3::Zero()), moments = normals;
    std::vector<double> areas(positions.size(), 0.0);
    for (const Triangle& t : out_.mesh.triangles) {
      const Vec3& a = positions[at(t[0])];
      const Vec3 normal = (positions[at(t[1])] - a).cross(positions[at(t[2])] - a);
      const double area = normal.norm();
      const Vec3 middle = middle_of(out_.mesh, t);
      for (const int v : t) {
        normals[at(v)] += normal;
        moments[at(v)] += area * (middle - positions[at(v)]);
        areas[at(v)] += area;
      }
    }
    for (Size v = 0; v < positions.size(); ++v) {
      const double length_squared = normals[v].squaredNorm();
      if (!(length_squared > 0.0)) continue;
      const Vec3 way = moments[v] / areas[v];
      positions[v] += way - way.dot(normals[v]) / length_squared * normals[v];
    }
  }

  /// What is over holes, and what of the surface given is not there any more.
  std::optional<std::string> find_dishonesty() {
    double area = 0.0, bridged = 0.0, farthest = -1.0;
    Vec3 hole = Vec3::Zero();
    const Box box = box_of(given_);
    const double size = (box.high - box.low).norm() + 4.0 * spacing_;
    const SurfaceDistance given(given_);
    for (const Triangle& t : out_.mesh.triangles) {
      const double own = area_of(out_.mesh, t);
      area += own;
      if (is_bridge_[at(t[0])] + is_bridge_[at(t[1])] + is_bridge_[at(t[2])] < 2) continue;
      bridged += own;
      const Vec3 middle = middle_of(out_.mesh, t);
      const NearestPlace nearest = given.find(middle, size);
      if (nearest.distance > farthest) {
        farthest = nearest.distance;
        hole = middle;
      }
    }
    out_.bridged_share = bridged / area;
    find_lost();
    char text[256];
    if (out_.bridged_share > kMostBridged) {
      std::snprintf(text, sizeof text, "%.0f %% of its surface would be over holes, the widest about ",
                    100.0 * out_.bridged_share);
      return text + at_place(hole) + ": what is inside cannot be told";
    }
    if (out_.lost_share > kMostLost) {
      std::snprintf(text, sizeof text,
                    "%.0f %% of its surface encloses nothing, or nothing as thick as %.3g m, as about ",
                    100.0 * out_.lost_share, spacing_);
      return text + at_place(lost_);
    }
    const double volume = find_volume(), made = enclosed_volume(out_.mesh);
    if (std::abs(made - volume) > kMostVolumeOff * volume) {
      std::snprintf(text, sizeof text,
                    "on a grid of %.3g m its volume would be off by %.0f %%: take smaller elements", spacing_,
                    100.0 * std::abs(made / volume - 1.0));
      return text;
    }
    return std::nullopt;
  }

  /// m3 that the surface given winds about: cells near it are asked at eight places each.
  double find_volume() const {
    std::vector<char> is_near(is_inside_.size(), 0);
    for (const Box& box : triangle_boxes_) {
      std::array<Size, 3> low{}, high{};
      for (int k = 0; k < 3; ++k) {
        low[at(k)] = static_cast<Size>((box.low[k] - origin_[k]) / spacing_);
        high[at(k)] = static_cast<Size>((box.high[k] - origin_[k]) / spacing_);
      }
      for (Size z = low[2]; z <= high[2]; ++z)
        for (Size y = low[1]; y <= high[1]; ++y)
          for (Size x = low[0]; x <= high[0]; ++x) is_near[node_at(x, y, z)] = 1;
    }
    std::vector<int> eighths(is_near.size(), 0);
    core::parallel_for(eighths.size(), 1024, [&](Size cell) {
      if (is_near[cell] == 0) eighths[cell] = 8 * is_inside_[cell];
      for (int bits = 0; bits < 8 && is_near[cell] != 0; ++bits)
        eighths[cell] += is_inside(place_of(cell) + spacing_ * (Vec3::Constant(0.25) + 0.5 * corner(bits)));
    });
    double sum = 0.0;
    for (const int eighth : eighths) sum += eighth;
    return sum / 8.0 * spacing_ * spacing_ * spacing_;
  }

  /// Triangles given that have the same on both sides, nothing, or the border nowhere near.
  void find_lost() {
    const SurfaceDistance made(out_.mesh);
    std::vector<char> is_lost(given_.triangles.size(), 0);
    core::parallel_for(is_lost.size(), 64, [&](Size i) {
      const Triangle& t = given_.triangles[i];
      const Vec3 middle = middle_of(given_, t);
      const Vec3 &a = given_.positions[at(t[0])], &b = given_.positions[at(t[1])],
                 &c = given_.positions[at(t[2])];
      const Vec3 aside = kAside * spacing_ * (b - a).cross(c - a).normalized();
      const bool is_within = is_inside(middle + aside) && is_inside(middle - aside);
      is_lost[i] = !is_within && made.find(middle, 2.0 * spacing_).triangle < 0 ? 1 : 0;
    });
    double area = 0.0, lost = 0.0, largest = 0.0;
    for (Size i = 0; i < is_lost.size(); ++i) {
      const double own = area_of(given_, given_.triangles[i]);
      area += own;
      if (is_lost[i] == 0) continue;
      lost += own;
      if (own <= largest) continue;
      largest = own;
      lost_ = middle_of(given_, given_.triangles[i]);
    }
    out_.lost_share = lost / area;
  }

  static Vec3 middle_of(const TriangleMesh& mesh, const Triangle& t) {
    return (mesh.positions[at(t[0])] + mesh.positions[at(t[1])] + mesh.positions[at(t[2])]) / 3.0;
  }
  static double area_of(const TriangleMesh& mesh, const Triangle& t) {
    const Vec3& a = mesh.positions[at(t[0])];
    return 0.5 * (mesh.positions[at(t[1])] - a).cross(mesh.positions[at(t[2])] - a).norm();
  }

  const TriangleMesh& given_;
  double spacing_;  // m
  WindingNumber winding_;
  TriangleTree tree_;
  std::vector<Box> boxes_, triangle_boxes_;
  double sign_ = 1.0;
  Vec3 origin_ = Vec3::Zero();
  std::array<Size, 3> count_{};
  std::vector<std::uint8_t> is_inside_;  // nodes
  std::vector<Edge> corners_;            // three a triangle
  std::vector<std::uint8_t> is_bridge_;  // vertices
  Vec3 lost_ = Vec3::Zero();
  RemadeSurface out_;
};

}  // namespace

core::Result<RemadeSurface> remake_surface(const TriangleMesh& surface, double spacing) {
  return Remaking(surface, spacing).run();
}

}  // namespace shatterbox::geometry
