// One pile in several engines: what each is given, and what each must tell.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/body/body.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::bench {

/// A body as an engine is given it: meshes about their centre of mass, turned so that the inertia is diagonal
/// (some engines take no other).
struct PeerBody {
  body::ShapeKind kind = body::ShapeKind::shell;
  geometry::TriangleMesh mesh;      // shells, m, in principal axes
  Vec3 half_extent = Vec3::Zero();  // boxes, m
  double radius = 0.0;              // spheres, m
  bool is_dynamic = false;
  double mass = 0.0;            // kg
  Vec3 inertia = Vec3::Zero();  // kg m2, about the principal axes
  Pose pose;                    // world from principal axes
  Quat body_from_principal = Quat::Identity();
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();  // m/s, rad/s, world
  double friction = 0.5, restitution = 0.0;
};

struct PeerScene {
  std::vector<PeerBody> bodies;
  Vec3 gravity = Vec3(0.0, -9.81, 0.0);  // m/s2
  double time_step = 1.0 / 60.0;         // s
  double kept_gap = 5e-4;                // m: margin for engines that want one
};

/// The bodies of a world as peers take them.
PeerScene make_peer_scene(std::span<const body::Body> bodies, const Vec3& gravity, double time_step);

/// A running pile. Sleeping is off everywhere.
class PeerPile {
 public:
  virtual ~PeerPile() = default;
  virtual std::string engine() const = 0;
  virtual void step() = 0;
  virtual int contacts() const = 0;               // points that touch, after the last step
  virtual Pose pose(std::size_t body) const = 0;  // world from principal axes
};

/// Null where the engine cannot run with so many threads.
std::unique_ptr<PeerPile> make_bullet_pile(const PeerScene& scene, int threads);
std::unique_ptr<PeerPile> make_ode_pile(const PeerScene& scene, int threads);

/// Pairs of triangles of different shells that cross.
long count_crossings(const PeerScene& scene, const PeerPile& pile);

/// Mean height of the dynamic bodies' centres, m.
double mean_height(const PeerScene& scene, const PeerPile& pile);

}  // namespace shatterbox::bench
