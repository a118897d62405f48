// The figure: an upright animal in bands of armour, as the zero of a smooth union of rounded cones, taken to
// triangles by marching tetrahedra (Doi and Koide 1991) and evened out on the surface.
#include <algorithm>
#include <array>
#include <map>

#include "engine/core/elementary.h"
#include "engine/geometry/generator_faults.h"
#include "engine/geometry/generators.h"

namespace shatterbox::geometry {
namespace {

/// A segment with a radius that changes evenly from end to end.
struct RoundedCone {
  Vec3 from, to;
  double radius_from, radius_to;
};

// Of a figure one metre high, its feet on y = 0, looking along z; what stands aside is there on both sides.
const std::array<RoundedCone, 6> kMiddle{{
    {{0, 0.33, 0}, {0, 0.6, -0.01}, 0.155, 0.125},        // trunk
    {{0, 0.4, 0.05}, {0, 0.5, 0.04}, 0.14, 0.11},         // belly
    {{0, 0.6, 0}, {0, 0.75, 0.05}, 0.085, 0.075},         // neck
    {{0, 0.79, 0.05}, {0, 0.76, 0.2}, 0.095, 0.042},      // head and snout
    {{0, 0.27, -0.1}, {0, 0.12, -0.25}, 0.075, 0.045},    // tail
    {{0, 0.12, -0.25}, {0, 0.085, -0.38}, 0.045, 0.018},  // its end
}};
const std::array<RoundedCone, 11> kSides{{
    {{0.05, 0.86, 0.03}, {0.105, 0.965, -0.01}, 0.032, 0.024},  // ear
    {{0.12, 0.58, 0}, {0.27, 0.55, 0.06}, 0.06, 0.048},         // upper arm
    {{0.27, 0.55, 0.06}, {0.325, 0.68, 0.15}, 0.05, 0.042},     // lower arm
    {{0.325, 0.68, 0.15}, {0.33, 0.74, 0.17}, 0.045, 0.036},    // hand
    {{0.33, 0.75, 0.17}, {0.3, 0.815, 0.19}, 0.022, 0.015},     // fingers
    {{0.335, 0.75, 0.17}, {0.34, 0.83, 0.19}, 0.022, 0.015},
    {{0.345, 0.745, 0.17}, {0.38, 0.8, 0.18}, 0.022, 0.015},
    {{0.09, 0.29, 0}, {0.15, 0.17, 0.03}, 0.1, 0.068},          // thigh
    {{0.15, 0.17, 0.03}, {0.15, 0.06, -0.01}, 0.066, 0.052},    // lower leg
    {{0.15, 0.045, -0.02}, {0.165, 0.04, 0.13}, 0.046, 0.036},  // foot
    {{0.12, 0.56, -0.03}, {0.05, 0.62, -0.03}, 0.07, 0.06},     // shoulder
}};
constexpr double kBlend = 0.035;     // m, over which parts run into each other
constexpr double kBandWidth = 0.06;  // m, of the armour on the back
constexpr double kBandDepth = 0.007;

double distance_to(const RoundedCone& cone, const Vec3& p) {
  const Vec3 along = cone.to - cone.from;
  const double share = std::clamp((p - cone.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - cone.from - share * along).norm() -
         (cone.radius_from + share * (cone.radius_to - cone.radius_from));
}

double blend(double a, double b) {
  const double h = std::max(0.0, kBlend - std::abs(a - b)) / kBlend;
  return std::min(a, b) - 0.25 * kBlend * h * h;
}

/// Less than 0 inside; near the surface about the distance from it, m.
double figure_field(const Vec3& p) {
  const Vec3 side(std::abs(p.x()), p.y(), p.z());
  double value = 1e3;
  for (const RoundedCone& cone : kMiddle) value = blend(value, distance_to(cone, p));
  // Bands, deepest on the back, that fade out to the front, the neck and the tail.
  const double back = std::clamp((0.03 - p.z()) / 0.1, 0.0, 1.0);
  const double high =
      std::clamp((0.66 - p.y()) / 0.05, 0.0, 1.0) * std::clamp((p.y() - 0.24) / 0.05, 0.0, 1.0);
  value += kBandDepth * back * high * core::cos(2.0 * core::kPi * p.y() / kBandWidth);
  for (const RoundedCone& cone : kSides) value = blend(value, distance_to(cone, side));
  return value;
}

Vec3 slope_at(const Vec3& p) {
  constexpr double kStep = 1e-5;
  Vec3 slope;
  for (int axis = 0; axis < 3; ++axis)
    slope[axis] = (figure_field(p + kStep * Vec3::Unit(axis)) - figure_field(p - kStep * Vec3::Unit(axis))) /
                  (2.0 * kStep);
  return slope;
}

void put_on_surface(Vec3& p) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 slope = slope_at(p);
    p -= figure_field(p) / std::max(slope.squaredNorm(), 0.1) * slope;
  }
}

/// Cubes of a grid, each divided alike into six tetrahedra about its diagonal.
class Marcher {
 public:
  Marcher(const Vec3& low, const Vec3& high, double cell) : low_(low), cell_(cell) {
    for (int axis = 0; axis < 3; ++axis) count_[axis] = static_cast<int>((high[axis] - low[axis]) / cell) + 2;
    values_.resize(static_cast<std::size_t>(count_.prod()));
    for (int z = 0; z < count_.z(); ++z)
      for (int y = 0; y < count_.y(); ++y)
        for (int x = 0; x < count_.x(); ++x) values_[number({x, y, z})] = figure_field(place({x, y, z}));
  }

  TriangleMesh march() {
    // The ways from a cube's first corner to its last one, axis by axis.
    constexpr std::array<std::array<int, 3>, 6> kWays{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    for (int z = 0; z + 1 < count_.z(); ++z)
      for (int y = 0; y + 1 < count_.y(); ++y)
        for (int x = 0; x + 1 < count_.x(); ++x)
          for (std::size_t w = 0; w < kWays.size(); ++w) {
            std::array<Corner, 4> corners;
            corners[0] = {x, y, z};
            for (std::size_t k = 0; k < 3; ++k) {
              corners[k + 1] = corners[k];
              corners[k + 1][kWays[w][k]] += 1;
            }
            if (w >= 3) std::swap(corners[2], corners[3]);  // all wound alike
            cut(corners);
          }
    return std::move(mesh_);
  }

 private:
  using Corner = Eigen::Vector3i;

  Vec3 place(const Corner& c) const { return low_ + cell_ * c.cast<double>(); }
  std::size_t number(const Corner& c) const {
    return static_cast<std::size_t>(c.x() + count_.x() * (c.y() + count_.y() * c.z()));
  }
  bool is_inside(const Corner& c) const { return values_[number(c)] < 0.0; }

  int vertex_between(const Corner& a, const Corner& b) {
    const std::size_t na = number(a), nb = number(b);
    const auto [found, is_new] =
        vertices_.try_emplace({std::min(na, nb), std::max(na, nb)}, static_cast<int>(mesh_.positions.size()));
    if (is_new) {
      const double share = std::clamp(values_[na] / (values_[na] - values_[nb]), 0.05, 0.95);
      mesh_.positions.emplace_back(place(a) + share * (place(b) - place(a)));
    }
    return found->second;
  }

  // An even permutation of a positive tetrahedron's corners: its first ones are inside.
  void cut(std::array<Corner, 4> c) {
    int inside = 0;
    for (const Corner& corner : c) inside += is_inside(corner) ? 1 : 0;
    if (inside == 0 || inside == 4) return;
    // Turns that bring any two corners to the front and keep the tetrahedron's sense.
    constexpr std::array<std::array<std::size_t, 4>, 12> kTurns{{{0, 1, 2, 3},
                                                                 {0, 2, 3, 1},
                                                                 {0, 3, 1, 2},
                                                                 {1, 0, 3, 2},
                                                                 {1, 2, 0, 3},
                                                                 {1, 3, 2, 0},
                                                                 {2, 0, 1, 3},
                                                                 {2, 1, 3, 0},
                                                                 {2, 3, 0, 1},
                                                                 {3, 0, 2, 1},
                                                                 {3, 1, 0, 2},
                                                                 {3, 2, 1, 0}}};
    for (const auto& turn : kTurns) {
      const std::array<Corner, 4> t{c[turn[0]], c[turn[1]], c[turn[2]], c[turn[3]]};
      bool fits = true;
      for (std::size_t k = 0; k < 4; ++k) fits = fits && is_inside(t[k]) == (static_cast<int>(k) < inside);
      if (!fits) continue;
      const auto between = [&](std::size_t i, std::size_t k) { return vertex_between(t[i], t[k]); };
      if (inside == 1) {
        add(between(0, 1), between(0, 2), between(0, 3));
      } else if (inside == 3) {
        add(between(0, 3), between(1, 3), between(2, 3));
      } else {
        const int a = between(0, 2), b = between(0, 3), d = between(1, 3), e = between(1, 2);
        add(a, b, d);
        add(a, d, e);
      }
      return;
    }
  }
  void add(int a, int b, int c) { mesh_.triangles.push_back({a, b, c}); }

  Vec3 low_;
  double cell_;
  Eigen::Vector3i count_;
  std::vector<double> values_;
  std::map<std::pair<std::size_t, std::size_t>, int> vertices_;
  TriangleMesh mesh_;
};

/// Vertices go to the middle of their neighbours, along the surface.
void even_out(TriangleMesh& mesh, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    std::vector<Vec3> sums(mesh.positions.size(), Vec3::Zero());
    std::vector<int> counts(mesh.positions.size(), 0);
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = static_cast<std::size_t>(t[k]);
        sums[v] += mesh.positions[static_cast<std::size_t>(t[(k + 1) % 3])];
        ++counts[v];
      }
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      Vec3& p = mesh.positions[v];
      p = 0.5 * p + 0.5 / counts[v] * sums[v];
      put_on_surface(p);
    }
  }
}

}  // namespace

core::Result<TriangleMesh> make_figure(double height, const Meshing& meshing) {
  if (const auto fault = find_size_fault("a figure's height", height, 0.0)) return core::Error{*fault};
  if (const auto fault = find_fault(meshing, height)) return core::Error{*fault};
  constexpr double kCellOfEdge = 2.0;  // a cell has so many edges along its side
  const double cell = kCellOfEdge * meshing.edge_length / height;
  if (2.0 / (cell * cell) * 2.0 > kMostTriangles) return too_fine(meshing);
  constexpr double kCoarsest = 0.025;  // fingers and ears are hardly thicker
  const Vec3 margin = Vec3::Constant(2.0 * kCoarsest);
  TriangleMesh mesh =
      Marcher(Vec3(-0.42, 0.0, -0.42) - margin, Vec3(0.42, 1.0, 0.3) + margin, std::min(cell, kCoarsest))
          .march();
  even_out(mesh, 12);
  double low = 1e300, high = -1e300;
  for (const Vec3& p : mesh.positions) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  for (Vec3& p : mesh.positions) p = height / (high - low) * (p - Vec3(0.0, low, 0.0));
  return mesh;
}

}  // namespace shatterbox::geometry
