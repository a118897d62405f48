#include "tests/bench/peer_pile.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "engine/geometry/crossings.h"

namespace shatterbox::bench {

PeerScene make_peer_scene(std::span<const body::Body> bodies, const Vec3& gravity, double time_step) {
  PeerScene scene;
  scene.gravity = gravity;
  scene.time_step = time_step;
  for (const body::Body& body : bodies) {
    const body::Shape& shape = *body.shape;
    PeerBody peer;
    peer.kind = shape.kind;
    peer.half_extent = shape.half_extent;
    peer.radius = shape.radius;
    peer.is_dynamic = body.is_dynamic();
    peer.mass = shape.mass;
    peer.inertia = shape.inertia.diagonal();
    peer.pose = body.pose;
    peer.velocity = body.velocity;
    peer.spin = body.angular_velocity;
    peer.friction = body.friction;
    peer.restitution = body.restitution;
    if (shape.kind == body::ShapeKind::shell) {
      const Eigen::SelfAdjointEigenSolver<Mat3> solver(shape.inertia);
      Mat3 axes = solver.eigenvectors();
      if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);
      peer.inertia = solver.eigenvalues();
      peer.body_from_principal = Quat(axes);
      peer.pose.rotation = body.pose.rotation * peer.body_from_principal;
      peer.mesh = shape.surface;
      for (Vec3& p : peer.mesh.positions) p = axes.transpose() * p;
      if (peer.is_dynamic) scene.kept_gap = 1e-3 * shape.bounding_radius;
    }
    scene.bodies.push_back(std::move(peer));
  }
  return scene;
}

long count_crossings(const PeerScene& scene, const PeerPile& pile) {
  std::vector<geometry::TriangleMesh> meshes;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].kind != body::ShapeKind::shell) continue;
    const Pose pose = pile.pose(i);
    meshes.push_back(scene.bodies[i].mesh);
    for (Vec3& p : meshes.back().positions) p = pose.apply(p);
  }
  return geometry::count_crossing_pairs(meshes);
}

double mean_height(const PeerScene& scene, const PeerPile& pile) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!scene.bodies[i].is_dynamic) continue;
    sum += pile.pose(i).translation.y();
    count += 1.0;
  }
  return sum / std::max(1.0, count);
}

}  // namespace shatterbox::bench
