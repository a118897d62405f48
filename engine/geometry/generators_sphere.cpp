// A sphere from an icosahedron whose faces are cut into triangles.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "engine/core/elementary.h"
#include "engine/geometry/generator_faults.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/irregular.h"

namespace shatterbox::geometry {
namespace {

struct Icosahedron {
  std::vector<Vec3> corners;
  std::vector<Triangle> faces;
};

Icosahedron make_icosahedron() {
  const double golden = 0.5 * (1.0 + core::sqrt(5.0));
  Icosahedron result;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-golden, golden})
      for (const Vec3& corner : {Vec3(0.0, a, b), Vec3(a, b, 0.0), Vec3(b, 0.0, a)})
        result.corners.push_back(corner / corner.norm());
  // Faces are the triples at the least distance of each other, turned outwards.
  const auto is_near = [&](std::size_t i, std::size_t j) {
    return (result.corners[i] - result.corners[j]).norm() < 1.1;
  };
  for (std::size_t i = 0; i < 12; ++i)
    for (std::size_t j = i + 1; j < 12; ++j)
      for (std::size_t k = j + 1; k < 12; ++k) {
        if (!is_near(i, j) || !is_near(j, k) || !is_near(k, i)) continue;
        const Vec3& a = result.corners[i];
        const bool is_outward = (result.corners[j] - a).cross(result.corners[k] - a).dot(a) > 0.0;
        const int n[] = {static_cast<int>(i), static_cast<int>(j), static_cast<int>(k)};
        result.faces.push_back(is_outward ? Triangle{n[0], n[1], n[2]} : Triangle{n[0], n[2], n[1]});
      }
  return result;
}

/// Unit sphere: every face of the icosahedron cut into frequency^2 triangles.
TriangleMesh make_geodesic(int frequency) {
  const Icosahedron solid = make_icosahedron();
  TriangleMesh mesh;
  // A grid point is named by the corners it is a mix of, so that neighbouring faces share it to the bit.
  std::map<std::array<int, 6>, int> numbers;
  const auto vertex = [&](const Triangle& face, int i, int j) {
    std::array<std::array<int, 2>, 3> mix{{{face[0], frequency - i - j}, {face[1], i}, {face[2], j}}};
    for (auto& m : mix)
      if (m[1] == 0) m[0] = -1;
    std::sort(mix.begin(), mix.end());
    const auto [place, is_new] =
        numbers.try_emplace({mix[0][0], mix[0][1], mix[1][0], mix[1][1], mix[2][0], mix[2][1]},
                            static_cast<int>(mesh.positions.size()));
    if (is_new) {
      Vec3 sum = Vec3::Zero();
      for (const auto& m : mix)
        if (m[0] >= 0) sum += m[1] * solid.corners[static_cast<std::size_t>(m[0])];
      mesh.positions.push_back(sum / sum.norm());
    }
    return place->second;
  };
  for (const Triangle& face : solid.faces)
    for (int i = 0; i < frequency; ++i)
      for (int j = 0; i + j < frequency; ++j) {
        mesh.triangles.push_back({vertex(face, i, j), vertex(face, i + 1, j), vertex(face, i, j + 1)});
        if (i + j + 1 < frequency)
          mesh.triangles.push_back(
              {vertex(face, i + 1, j), vertex(face, i + 1, j + 1), vertex(face, i, j + 1)});
      }
  return mesh;
}

Tangents tangents_of_sphere(const Vec3& normal) {
  const Vec3 axis = std::abs(normal.y()) < 0.7 ? Vec3::UnitY() : Vec3::UnitX();
  Tangents tangents;
  tangents.col(0) = axis.cross(normal).normalized();
  tangents.col(1) = normal.cross(tangents.col(0));
  return tangents;
}

}  // namespace

core::Result<TriangleMesh> make_sphere(double radius, const Meshing& meshing) {
  if (const auto fault = find_size_fault("a sphere's radius", radius)) return core::Error{*fault};
  if (const auto fault = find_fault(meshing, radius)) return core::Error{*fault};
  constexpr double kFrequency = 1.2;  // 20 f^2 equilateral triangles of one edge length cover 4 pi radius^2
  const double frequency = std::max(1.0, std::floor(kFrequency * radius / meshing.edge_length + 0.5));
  if (20.0 * frequency * frequency > kMostTriangles) return too_fine(meshing);
  TriangleMesh mesh = make_geodesic(static_cast<int>(frequency));
  SurfaceWalk walk;
  walk.parameters = mesh.positions;
  walk.freedom.assign(mesh.positions.size(), Vec2::Ones());
  walk.creases.assign(mesh.positions.size(), -1);
  walk.position = [radius](const Vec3& normal) { return Vec3(radius * normal); };
  walk.tangents = tangents_of_sphere;
  walk.stepped = [radius](const Vec3& normal, const Vec2& step) {
    return Vec3((normal + tangents_of_sphere(normal) * step / radius).normalized());
  };
  for (Vec3& p : mesh.positions) p *= radius;
  make_irregular(mesh, walk, meshing.jitter, meshing.seed);
  return mesh;
}

}  // namespace shatterbox::geometry
