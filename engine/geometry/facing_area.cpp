#include "engine/geometry/facing_area.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "engine/geometry/bvh.h"

namespace shatterbox::geometry {
namespace {

constexpr double kAgainst = -0.99985;  // cosine of the angle between the normals

struct NearTriangle {
  std::array<Vec3, 3> corners;
  Vec3 normal;
  Box box;
};

// The triangles that come near the box of the other mesh.
std::vector<NearTriangle> list_near_triangles(const TriangleMesh& mesh, const Box& other, double gap) {
  std::vector<NearTriangle> near;
  for (const auto& t : mesh.triangles) {
    NearTriangle f;
    for (std::size_t k = 0; k < 3; ++k) f.corners[k] = mesh.positions[static_cast<std::size_t>(t[k])];
    const Vec3 across = (f.corners[1] - f.corners[0]).cross(f.corners[2] - f.corners[0]);
    if (!(across.squaredNorm() > 0.0)) continue;
    f.normal = across.normalized();
    for (const Vec3& p : f.corners) f.box.include(p);
    if (overlaps(f.box, other, gap)) near.push_back(f);
  }
  return near;
}

// What of b's triangle lies over a's, in the plane of a.
std::vector<Vec3> common_polygon(const NearTriangle& a, const NearTriangle& b) {
  std::vector<Vec3> polygon;
  for (const Vec3& p : b.corners) polygon.emplace_back(p - a.normal.dot(p - a.corners[0]) * a.normal);
  for (std::size_t k = 0; k < 3 && !polygon.empty(); ++k) {
    const Vec3& from = a.corners[k];
    const Vec3 inwards = a.normal.cross(a.corners[(k + 1) % 3] - from);
    std::vector<Vec3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const double at_p = inwards.dot(p - from), at_q = inwards.dot(q - from);
      if (at_p >= 0.0) kept.push_back(p);
      if ((at_p < 0.0) != (at_q < 0.0)) kept.emplace_back(p + at_p / (at_p - at_q) * (q - p));
    }
    polygon = std::move(kept);
  }
  return polygon;
}

struct Patch {
  std::array<Vec3, 3> corners;
  double area = 0.0;
};

// The convex hull, by Andrew's monotone chain.
std::vector<Vec2> hull_of(std::vector<Vec2> points) {
  const auto comes_before = [](const Vec2& p, const Vec2& q) {
    return p.x() < q.x() || (p.x() == q.x() && p.y() < q.y());
  };
  std::sort(points.begin(), points.end(), comes_before);
  std::vector<Vec2> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= first + 2) {
        const Vec2 last = hull.back() - hull[hull.size() - 2], next = p - hull.back();
        if (last.x() * next.y() - last.y() * next.x() > 0.0) break;
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

// Centre, principal axes and moments of the parts, whose normals sum up to `normal`.
FacingArea measure(const std::vector<Patch>& parts, const Vec3& normal) {
  FacingArea result;
  for (const Patch& part : parts) {
    result.area += part.area;
    result.centre += part.area / 3.0 * (part.corners[0] + part.corners[1] + part.corners[2]);
  }
  result.centre /= result.area;
  const Vec3 x = normal.normalized();
  int least = 0;
  x.cwiseAbs().minCoeff(&least);
  const Vec3 u = x.cross(Vec3::Unit(least)).normalized(), v = x.cross(u);
  Mat2 second = Mat2::Zero();
  for (const Patch& part : parts) {
    Vec2 sum = Vec2::Zero();
    Mat2 squares = Mat2::Zero();
    for (const Vec3& corner : part.corners) {
      const Vec2 p(u.dot(corner - result.centre), v.dot(corner - result.centre));
      sum += p;
      squares += p * p.transpose();
    }
    second += part.area / 12.0 * (squares + sum * sum.transpose());
  }
  const Eigen::SelfAdjointEigenSolver<Mat2> principal(second);
  const Vec2 along = principal.eigenvectors().col(1);
  const Vec3 y = along.x() * u + along.y() * v;
  result.axes << x, y, x.cross(y);
  result.moments = {principal.eigenvalues()[0], principal.eigenvalues()[1]};
  for (const Patch& part : parts) {
    for (const Vec3& corner : part.corners)
      result.outline.emplace_back(y.dot(corner - result.centre),
                                  result.axes.col(2).dot(corner - result.centre));
  }
  result.outline = hull_of(std::move(result.outline));
  return result;
}

}  // namespace

FacingArea find_facing_area(const TriangleMesh& a, const TriangleMesh& b, double gap) {
  const std::vector<NearTriangle> near_a = list_near_triangles(a, box_of(b), gap),
                                  near_b = list_near_triangles(b, box_of(a), gap);
  std::vector<Patch> parts;
  Vec3 normal = Vec3::Zero();
  double reach = 0.0;
  for (const NearTriangle& fa : near_a) {
    for (const NearTriangle& fb : near_b) {
      if (fa.normal.dot(fb.normal) > kAgainst || !overlaps(fa.box, fb.box, gap)) continue;
      const Vec3 middle = (fb.corners[0] + fb.corners[1] + fb.corners[2]) / 3.0;
      const double distance = fa.normal.dot(middle - fa.corners[0]);
      if (std::abs(distance) > gap) continue;
      const std::vector<Vec3> polygon = common_polygon(fa, fb);
      for (std::size_t k = 2; k < polygon.size(); ++k) {
        Patch part{{polygon[0], polygon[k - 1], polygon[k]}, 0.0};
        const Vec3 across = (part.corners[1] - part.corners[0]).cross(part.corners[2] - part.corners[0]);
        part.area = 0.5 * across.norm();
        for (Vec3& corner : part.corners) corner += 0.5 * distance * fa.normal;
        normal -= part.area * fa.normal;
        reach = std::max(reach, (fa.corners[1] - fa.corners[0]).norm());
        parts.push_back(part);
      }
    }
  }
  double area = 0.0;
  for (const Patch& part : parts) area += part.area;
  // Edges that only touch have no area but that of rounding.
  if (!(area > 1e-9 * reach * reach) || !(normal.norm() > 0.1 * area)) return {};
  return measure(parts, normal);
}

}  // namespace shatterbox::geometry
