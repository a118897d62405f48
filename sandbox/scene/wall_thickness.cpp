#include "sandbox/scene/wall_thickness.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "engine/dynamics/line_of_sight.h"

namespace shatterbox::sandbox::scene {

double wall_thickness(const geometry::TriangleMesh& mesh) {
  constexpr std::size_t kLooks = 300;
  constexpr double kBegin = 1e-6;  // of the size, below the surface
  auto shape = std::make_shared<body::Shape>();
  shape->kind = body::ShapeKind::shell;  // of a solid one is inside already
  shape->surface = mesh;
  for (const Vec3& p : mesh.positions) shape->bounding_radius = std::max(shape->bounding_radius, p.norm());
  std::vector<body::Body> bodies(1);
  bodies[0].shape = shape;
  const dynamics::LineOfSight sight(bodies);
  const geometry::Box box = geometry::box_of(mesh);
  const double size = (box.high - box.low).norm();
  std::vector<std::pair<double, double>> looks;  // m, and the area of the triangle
  double area = 0.0;
  const std::size_t stride = std::max<std::size_t>(1, mesh.triangles.size() / kLooks);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += stride) {
    const auto corner = [&](std::size_t i) -> const Vec3& {
      return mesh.positions[static_cast<std::size_t>(mesh.triangles[t][i])];
    };
    const Vec3 across = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    if (!(across.norm() > 0.0)) continue;
    const Vec3 in = -across.normalized();
    const Vec3 from = (corner(0) + corner(1) + corner(2)) / 3.0 + kBegin * size * in;
    const auto share = sight.first_hit(from, from + size * in);
    if (!share) continue;
    looks.emplace_back(*share * size, across.norm());
    area += across.norm();
  }
  std::sort(looks.begin(), looks.end());
  for (const auto& [thickness, own_area] : looks) {
    area -= 2.0 * own_area;
    if (area <= 0.0) return thickness;
  }
  return 0.0;
}

}  // namespace shatterbox::sandbox::scene
