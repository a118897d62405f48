// Scenes of many thin shells: boats in a pen, a sphere that has just come apart.
#pragma once

#include <algorithm>
#include <vector>

#include "engine/core/random.h"
#include "engine/geometry/crossings.h"
#include "engine/geometry/generators.h"
#include "tests/engine/dynamics/bodies.h"

namespace shatterbox::test {

/// An open boat of 300 triangles without thickness: a hull pointed at both ends, 1 m long, 0.4 m wide and
/// 0.24 m deep.
inline geometry::TriangleMesh boat_mesh() {
  constexpr int kAlong = 15, kAround = 10;
  geometry::TriangleMesh mesh;
  for (int i = 0; i <= kAlong; ++i) {
    const double x = -0.5 + static_cast<double>(i) / kAlong;
    const double width = 0.02 + 0.18 * (1.0 - 4.0 * x * x), depth = 0.04 + 0.2 * (1.0 - 4.0 * x * x);
    for (int k = 0; k <= kAround; ++k) {
      const double turn = core::kPi * k / kAround;
      mesh.positions.push_back(
          Vec3(x, 0.08 * 4.0 * x * x - depth * core::sin(turn), width * core::cos(turn)));
    }
  }
  const auto number = [](int i, int k) { return i * (kAround + 1) + k; };
  for (int i = 0; i < kAlong; ++i) {
    for (int k = 0; k < kAround; ++k) {
      mesh.triangles.push_back({number(i, k), number(i + 1, k), number(i + 1, k + 1)});
      mesh.triangles.push_back({number(i, k), number(i + 1, k + 1), number(i, k + 1)});
    }
  }
  return mesh;
}

inline Quat random_rotation(core::Random& random) {
  Quat::Coefficients c;
  do {
    for (int i = 0; i < 4; ++i) c[i] = random.uniform(-1, 1);
  } while (c.squaredNorm() > 1.0 || c.squaredNorm() < 0.01);
  return Quat(c).normalized();
}

/// `count` boats above a floor, between four thin walls; they fall in layers, turned at random.
inline Scene boats_scene(int count, std::uint64_t seed = 1, double time_step = 1.0 / 60.0) {
  Scene scene;
  scene.settings.time_step = time_step;
  scene.settings.has_sleep = false;
  scene.add(make_plane());
  const int across = std::max(2, static_cast<int>(0.62 * core::sqrt(static_cast<double>(count)) / 2.0));
  const double pitch = 1.1, half = 0.5 * pitch * across + 0.1;
  for (int wall = 0; wall < 4; ++wall) {
    auto mesh = square_mesh(4.0 * half, 8);
    for (Vec3& p : mesh.positions) {
      p = wall < 2 ? Vec3(wall == 0 ? -half : half, p.x(), p.z())
                   : Vec3(p.z(), p.x(), wall == 2 ? -half : half);
    }
    auto body = make_shell(mesh, false);
    body.pose.translation.y() += 4.0 * half + 0.001;
    scene.add(body);
  }
  core::Random random(seed);
  const auto first = make_shell(boat_mesh());
  for (int i = 0; i < count; ++i) {
    auto boat = first;
    const int layer = i / (across * across), place = i % (across * across);
    boat.pose.rotation = random_rotation(random);
    boat.pose.translation = Vec3(pitch * (place % across - 0.5 * (across - 1)), 0.7 + 1.1 * layer,
                                 pitch * (place / across - 0.5 * (across - 1)));
    scene.add(boat);
  }
  return scene;
}

/// A closed sphere in `count` pieces along the edges of its mesh, each standing back by `kerf` m from its
/// rim.
inline std::vector<geometry::TriangleMesh> shattered_sphere(double radius, double edge, int count,
                                                            double kerf, std::uint64_t seed = 1) {
  geometry::Meshing meshing;
  meshing.edge_length = edge;
  const auto whole = geometry::make_sphere(radius, meshing).value();
  core::Random random(seed);
  std::vector<Vec3> seeds;
  while (static_cast<int>(seeds.size()) < count) {
    Vec3 p;
    for (int i = 0; i < 3; ++i) p[i] = random.uniform(-1, 1);
    if (p.squaredNorm() < 1.0 && p.squaredNorm() > 0.01) seeds.push_back(radius * p.normalized());
  }
  std::vector<int> owner;
  for (const auto& t : whole.triangles) {
    Vec3 centre = Vec3::Zero();
    for (const int v : t) centre += whole.positions[static_cast<std::size_t>(v)] / 3.0;
    int best = 0;
    for (int s = 1; s < count; ++s) {
      if ((seeds[static_cast<std::size_t>(s)] - centre).squaredNorm() <
          (seeds[static_cast<std::size_t>(best)] - centre).squaredNorm())
        best = s;
    }
    owner.push_back(best);
  }
  // Corners of triangles of one piece that meet in a fan are one vertex; fans that only touch are two.
  std::vector<int> fan(3 * whole.triangles.size());
  for (std::size_t k = 0; k < fan.size(); ++k) fan[k] = static_cast<int>(k);
  const auto root = [&](std::size_t k) {
    while (fan[k] != static_cast<int>(k)) k = static_cast<std::size_t>(fan[k]);
    return k;
  };
  const auto corner_of = [&](int t, int v) {
    const auto& triangle = whole.triangles[static_cast<std::size_t>(t)];
    const int place = triangle[0] == v ? 0 : triangle[1] == v ? 1 : 2;
    return static_cast<std::size_t>(3 * t + place);
  };
  const auto topology = geometry::build_edge_topology(whole.triangles);
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    const auto first = static_cast<std::size_t>(topology.first_triangle[e]);
    const int t = topology.edge_triangles[first], u = topology.edge_triangles[first + 1];
    if (owner[static_cast<std::size_t>(t)] != owner[static_cast<std::size_t>(u)]) continue;
    for (const int v : topology.edges[e]) {
      const std::size_t x = root(corner_of(t, v)), y = root(corner_of(u, v));
      fan[std::max(x, y)] = static_cast<int>(std::min(x, y));
    }
  }
  std::vector<geometry::TriangleMesh> pieces(static_cast<std::size_t>(count));
  std::vector<int> number(fan.size(), -1), uses(whole.positions.size(), 0);
  std::vector<std::vector<Vec3>> inward(pieces.size());
  for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
    auto& piece = pieces[static_cast<std::size_t>(owner[t])];
    auto& in = inward[static_cast<std::size_t>(owner[t])];
    Vec3 centre = Vec3::Zero();
    for (const int v : whole.triangles[t]) centre += whole.positions[static_cast<std::size_t>(v)] / 3.0;
    geometry::Triangle own{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& p = whole.positions[static_cast<std::size_t>(whole.triangles[t][i])];
      int& n = number[root(3 * t + i)];
      if (n < 0) {
        n = static_cast<int>(piece.positions.size());
        piece.positions.push_back(p);
        in.push_back(Vec3::Zero());
      }
      own[i] = n;
      in[static_cast<std::size_t>(n)] += (centre - p).normalized();
    }
    piece.triangles.push_back(own);
  }
  // Rims stand back towards the material.
  for (std::size_t s = 0; s < pieces.size(); ++s) {
    auto& piece = pieces[s];
    const auto edges = geometry::build_edge_topology(piece.triangles);
    std::vector<char> is_rim(piece.positions.size(), 0);
    for (std::size_t e = 0; e < edges.edges.size(); ++e) {
      if (edges.first_triangle[e + 1] - edges.first_triangle[e] != 1) continue;
      for (const int v : edges.edges[e]) is_rim[static_cast<std::size_t>(v)] = 1;
    }
    for (std::size_t v = 0; v < piece.positions.size(); ++v) {
      if (is_rim[v] && inward[s][v].norm() > 1e-6) piece.positions[v] += kerf * inward[s][v].normalized();
    }
  }
  std::erase_if(pieces, [](const geometry::TriangleMesh& m) { return m.triangles.empty(); });
  return pieces;
}

/// A glass sphere that has just come apart over a floor, falling at `speed` m/s.
inline Scene shattered_scene(int count, double speed, double kerf = 4e-6, double edge = 0.002,
                             double radius = 0.04) {
  Scene scene;
  scene.add(make_plane());
  for (auto& mesh : shattered_sphere(radius, edge, count, kerf)) {
    auto body = make_shell(std::move(mesh));
    body.pose.translation.y() += radius + 1e-4;
    body.velocity = Vec3(0, -speed, 0);
    scene.add(body);
  }
  return scene;
}

/// Pairs of triangles of different bodies that cross, floors (planes) by vertices below them.
inline long count_crossings(const Scene& scene) {
  std::vector<geometry::TriangleMesh> meshes;
  long below = 0;
  for (const auto& b : scene.bodies) {
    if (b.shape->kind != body::ShapeKind::shell) continue;
    meshes.push_back(b.shape->surface);
    const Mat3 r = b.pose.rotation.toRotationMatrix();
    for (Vec3& p : meshes.back().positions) {
      p = r * p + b.pose.translation;
      if (scene.bodies[0].shape->kind == body::ShapeKind::plane && p.y() < 0.0) ++below;
    }
  }
  return below + geometry::count_crossing_pairs(meshes);
}

}  // namespace shatterbox::test
