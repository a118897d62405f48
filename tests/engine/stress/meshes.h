// Small meshes with closed-form answers for the tests of stress.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "engine/core/elementary.h"
#include "engine/core/random.h"
#include "engine/geometry/shell_mesh.h"
#include "engine/stress/shell_stiffness.h"

namespace shatterbox::stress::testing {

using Elements = std::shared_ptr<const geometry::ShellElements>;

inline Elements make_elements(geometry::TriangleMesh mesh) {
  auto elements = std::make_shared<geometry::ShellElements>();
  elements->mesh = std::move(mesh);
  elements->topology = geometry::build_edge_topology(elements->mesh.triangles);
  return elements;
}

/// Plate [0, width] x [0, height] in the plane z = 0, normal +z, diagonals alternating; inner vertices are
/// moved by up to `jitter` of a cell.
inline geometry::TriangleMesh grid_mesh(int nx, int ny, double width, double height, double jitter = 0.0) {
  geometry::TriangleMesh mesh;
  core::Random random(7, 0);
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      const bool is_inside = i > 0 && j > 0 && i < nx && j < ny;
      const double dx = is_inside ? random.uniform(-jitter, jitter) : 0.0;
      const double dy = is_inside ? random.uniform(-jitter, jitter) : 0.0;
      mesh.positions.emplace_back((i + dx) * width / nx, (j + dy) * height / ny, 0.0);
    }
  const auto vertex = [nx](int i, int j) { return j * (nx + 1) + i; };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
      if ((i + j) % 2 == 0) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
      }
    }
  return mesh;
}
inline Elements grid(int nx, int ny, double width, double height, double jitter = 0.0) {
  return make_elements(grid_mesh(nx, ny, width, height, jitter));
}

/// Disc of radius 1 in z = 0: vertex 0 in the middle, ring k has 6 k vertices.
inline Elements disc(int rings) {
  geometry::TriangleMesh mesh;
  mesh.positions.emplace_back(0.0, 0.0, 0.0);
  const auto first = [](int ring) { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1); };
  for (int ring = 1; ring <= rings; ++ring)
    for (int i = 0; i < 6 * ring; ++i) {
      const double angle = 2.0 * core::kPi * i / (6.0 * ring);
      const double radius = static_cast<double>(ring) / rings;
      mesh.positions.emplace_back(radius * core::cos(angle), radius * core::sin(angle), 0.0);
    }
  for (int ring = 1; ring <= rings; ++ring)
    for (int sector = 0; sector < 6; ++sector)
      for (int i = 0; i < ring; ++i) {
        const auto outer = [&](int k) { return first(ring) + (sector * ring + k) % (6 * ring); };
        const auto inner = [&](int k) {
          return ring == 1 ? 0 : first(ring - 1) + (sector * (ring - 1) + k) % (6 * (ring - 1));
        };
        mesh.triangles.push_back({outer(i), outer(i + 1), inner(i)});
        if (i + 1 < ring) mesh.triangles.push_back({inner(i), outer(i + 1), inner(i + 1)});
      }
  return make_elements(std::move(mesh));
}

/// Sphere of radius 1: 20 * 4^level triangles; vertex 0 and its antipode are poles of the first icosahedron.
inline Elements icosphere(int level, double radius = 1.0) {
  geometry::TriangleMesh mesh;
  mesh.positions.emplace_back(0.0, 0.0, 1.0);
  const double z = 1.0 / core::sqrt(5.0);
  const double r = 2.0 * z;
  for (int i = 0; i < 10; ++i) {
    const double angle = core::kPi * (2 * (i % 5) + (i < 5 ? 0 : 1)) / 5.0;
    mesh.positions.emplace_back(r * core::cos(angle), r * core::sin(angle), i < 5 ? z : -z);
  }
  mesh.positions.emplace_back(0.0, 0.0, -1.0);
  for (int i = 0; i < 5; ++i) {
    const int j = (i + 1) % 5;
    mesh.triangles.push_back({0, 1 + i, 1 + j});
    mesh.triangles.push_back({1 + i, 6 + i, 1 + j});
    mesh.triangles.push_back({1 + j, 6 + i, 6 + j});
    mesh.triangles.push_back({11, 6 + j, 6 + i});
  }
  for (int l = 0; l < level; ++l) {
    std::map<std::array<int, 2>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [found, is_new] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(mesh.positions.size()));
      if (is_new) {
        const Vec3 sum =
            mesh.positions[static_cast<std::size_t>(a)] + mesh.positions[static_cast<std::size_t>(b)];
        mesh.positions.push_back(sum.normalized());
      }
      return found->second;
    };
    std::vector<geometry::Triangle> finer;
    for (const auto& t : mesh.triangles) {
      const int a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      finer.push_back({t[0], a, c});
      finer.push_back({a, t[1], b});
      finer.push_back({c, b, t[2]});
      finer.push_back({a, b, c});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3& position : mesh.positions) position *= radius;
  return make_elements(std::move(mesh));
}

/// Makes the cells of each element two: cut by the line lambda_1 = share (from edge 0 to edge 1), an open
/// crack. Used on whole columns of elements to cut plates.
inline geometry::ShellMesh cut_between(const geometry::ShellMesh& mesh, double x) {
  using namespace geometry;
  ShellMesh cut;
  cut.elements = mesh.elements;
  for (const ShellCell& cell : mesh.cells) {
    // Both sides of the plane, by clipping the polygon.
    for (const double side : {1.0, -1.0}) {
      ShellCell piece = cell;
      piece.first_corner = static_cast<int>(cut.corners.size());
      piece.corner_count = 0;
      const auto distance = [&](const ShellCorner& corner) {
        return side * (position_in_element(*mesh.elements, cell.element, corner.barycentric).x() - x);
      };
      for (int c = 0; c < cell.corner_count; ++c) {
        const ShellCorner& a = mesh.corners[static_cast<std::size_t>(cell.first_corner + c)];
        const ShellCorner& b =
            mesh.corners[static_cast<std::size_t>(cell.first_corner + (c + 1) % cell.corner_count)];
        const double da = distance(a), db = distance(b);
        if (da > 0.0) {
          cut.corners.push_back(a);
          ++piece.corner_count;
        }
        if ((da > 0.0) != (db > 0.0)) {
          ShellCorner crossing = a;
          crossing.barycentric = a.barycentric + da / (da - db) * (b.barycentric - a.barycentric);
          if (da > 0.0) {  // leaves: the crack begins here
            crossing.side = SideKind::crack;
            crossing.side_id = 0;
          }
          cut.corners.push_back(crossing);
          ++piece.corner_count;
        }
      }
      if (piece.corner_count < 3) {
        cut.corners.resize(static_cast<std::size_t>(piece.first_corner));
        continue;
      }
      double doubled = 0.0;
      for (int c = 1; c + 1 < piece.corner_count; ++c) {
        const Vec2 o = cut.corners[static_cast<std::size_t>(piece.first_corner)].barycentric;
        const Vec2 p = cut.corners[static_cast<std::size_t>(piece.first_corner + c)].barycentric - o;
        const Vec2 q = cut.corners[static_cast<std::size_t>(piece.first_corner + c + 1)].barycentric - o;
        doubled += p.x() * q.y() - p.y() * q.x();
      }
      piece.area = doubled * element_area(*mesh.elements, cell.element);
      cut.cells.push_back(piece);
    }
  }
  assign_degrees_of_freedom(cut, find_cell_contacts(cut));
  return cut;
}

}  // namespace shatterbox::stress::testing
