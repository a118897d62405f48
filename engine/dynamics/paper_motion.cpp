#include "engine/dynamics/paper_motion.h"

#include <algorithm>
#include <cmath>

#include "engine/collision/analytic_contact.h"
#include "engine/collision/broad_phase.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/dynamics/particle_soup.h"
#include "engine/dynamics/rest.h"

namespace shatterbox::dynamics {
namespace {

using body::Body;
using body::ShapeKind;
using core::at;

/// Sweeps over the vertices below a plane.
constexpr int kPlaneSweeps = 8;

/// Share of the body's mass at each vertex.
std::vector<double> lump_mass(const body::Shape& shape, const collision::Collider& collider) {
  std::vector<double> share(collider.vertices.size(), 0.0);
  double total = 0.0;
  for (const auto& t : collider.triangles) {
    const Vec3 &p = collider.vertices[at(t[0])], &q = collider.vertices[at(t[1])],
               &r = collider.vertices[at(t[2])];
    const double area = body::is_round(shape.kind) ? 1.0 : (q - p).cross(r - p).norm();
    for (const int corner : t) share[at(corner)] += area;
    total += 3.0 * area;
  }
  for (double& s : share) s *= shape.mass / total;
  return share;
}

DriftingSurface make_surface(const Body& body, std::shared_ptr<const collision::Collider> collider) {
  DriftingSurface surface;
  surface.id = body.id;
  surface.shape = body.shape;
  surface.collider = std::move(collider);
  if (body.is_dynamic()) surface.inertia = find_principal_inertia(body.shape->inertia);
  for (const double mass : lump_mass(*body.shape, *surface.collider))
    surface.inverse_masses.push_back(body.is_dynamic() && mass > 0.0 ? 1.0 / mass : 0.0);
  for (const Vec3& v : surface.collider->vertices) surface.particles.push_back(body.pose.apply(v));
  return surface;
}

/// Brings the surfaces in line with the bodies: new ones start on their bodies.
void match_bodies(const std::vector<Body>& bodies, PaperContactState& state) {
  std::vector<DriftingSurface> old = std::move(state.surfaces);
  state.surfaces.clear();
  const auto find_collider = [&](const std::shared_ptr<const body::Shape>& shape) {
    for (const auto* surfaces : {&state.surfaces, &old})
      for (const DriftingSurface& surface : *surfaces)
        if (surface.shape == shape) return surface.collider;
    return collision::make_collider(*shape, collision::SurfaceMotion::free);
  };
  auto known = old.begin();
  for (const Body& body : bodies) {
    while (known != old.end() && known->id < body.id) ++known;
    const bool is_known = known != old.end() && known->id == body.id && known->shape == body.shape;
    state.surfaces.push_back(is_known ? *known : make_surface(body, find_collider(body.shape)));
  }
}

/// Pose after a free step with these velocities at its start; `spin` becomes that at its end.
Pose free_end(const Body& body, const PrincipalInertia& inertia, const ContactSettings& settings,
              const Vec3& velocity, Vec3& spin) {
  Pose end = body.pose;
  const double dt = settings.time_step;
  end.translation += dt * velocity;
  if (body.is_dynamic()) {
    end.translation += 0.5 * dt * dt * body.free_acceleration(settings.gravity);
    advance_turn(inertia, body.locked, dt, SpinOrder::fourth, end.rotation, spin);
  }
  return end;
}

/// Impulses of the planes on the rigid bodies, before the cloth collision (sec. III, last paragraph): no
/// vertex of the rigid end state stays below a plane.
class PlaneImpulses {
 public:
  PlaneImpulses(const ContactSettings& settings, std::vector<Body>& bodies, body::ImpulseLog& log)
      : settings_(settings), bodies_(bodies), log_(log) {}

  void apply(Body& body, const DriftingSurface& surface) {
    if (!body.is_dynamic()) return;
    for (int sweep = 0; sweep < kPlaneSweeps; ++sweep) {
      bool is_clear = true;
      for (const Body& plane : bodies_) {
        if (plane.shape->kind != ShapeKind::plane || !body.collides_with(plane)) continue;
        is_clear = !lift(body, surface, plane, sweep == 0) && is_clear;
      }
      if (is_clear) return;
    }
  }

 private:
  bool lift(Body& body, const DriftingSurface& surface, const Body& plane, bool may_bounce) {
    Vec3 spin = body.angular_velocity;
    const Pose end = free_end(body, surface.inertia, settings_, body.velocity, spin);
    std::vector<Vec3> ends;
    for (const Vec3& v : surface.collider->vertices) ends.push_back(end.apply(v));
    std::vector<collision::Contact> below;
    collision::find_plane_contacts(*surface.collider, ends, plane.pose, 0.0, below);
    const Body predicted = body;  // for its speeds: what lifts one vertex lifts others too
    for (const collision::Contact& c : below) {
      const Vec3 point = body.pose.apply(end.apply_inverse(c.on_a));  // where it is at the step's start
      const double ending_on_plane = c.normal.dot(predicted.velocity_at(point)) - c.gap / settings_.time_step;
      push(body, plane, c, point, ending_on_plane, may_bounce);
    }
    return !below.empty();
  }

  /// Gives the vertex at `point` the speed `wanted` along the plane's normal; a collision bounces.
  void push(Body& body, const Body& plane, const collision::Contact& c, const Vec3& point, double wanted,
            bool may_bounce) {
    const PairMaterial material = pair_material(body, plane, settings_);
    const Vec3 velocity = body.velocity_at(point);
    const double speed = c.normal.dot(velocity);
    const double now = c.normal.dot(point - plane.pose.translation);
    const double threshold = impact_threshold(settings_, settings_.kept_gap * body.shape->bounding_radius);
    const bool is_collision = may_bounce && speed < -threshold && now > 0.0;
    if (is_collision) wanted = std::max(wanted, -material.restitution * speed);
    if (wanted <= speed) return;
    const auto mobility = [&](const Vec3& direction) {
      return body.mobility(body.pose.apply_inverse(point), body.pose.rotation.conjugate() * direction);
    };
    const double yielding = mobility(c.normal);
    if (!(yielding > 0.0)) return;
    const double normal_impulse = (wanted - speed) / yielding;
    Vec3 impulse = normal_impulse * c.normal;
    const Vec3 sliding = velocity - speed * c.normal;
    if (const double slide = sliding.norm(); slide > 0.0) {
      const Vec3 way = sliding / slide;
      impulse -= std::min(material.friction * normal_impulse, slide / mobility(way)) * way;
    }
    body.push(impulse, point);
    log_push(body, plane, c, point, impulse, is_collision ? -speed : 0.0, 1.0 / yielding);
  }

  void log_push(const Body& body, const Body& plane, const collision::Contact& c, const Vec3& point,
                const Vec3& impulse, double closing_speed, double effective_mass) {
    const auto kind = closing_speed > 0.0 ? body::ImpulseKind::collision : body::ImpulseKind::contact;
    body::LoggedImpulse entry =
        body::log_impulse(kind, body.id, body.pose, plane.id, plane.pose, point, c.normal, impulse);
    entry.closing_speed = closing_speed;
    entry.effective_mass = effective_mass;
    log_.push_back(entry);
  }

  const ContactSettings& settings_;
  std::vector<Body>& bodies_;
  body::ImpulseLog& log_;
};

bool may_meet(const Body& a, const Body& b) {
  const bool is_plane = a.shape->kind == ShapeKind::plane || b.shape->kind == ShapeKind::plane;
  return !is_plane && a.collides_with(b) && (a.is_dynamic() || b.is_dynamic());
}

/// Pairs whose particles' swept boxes overlap.
std::vector<SoupPair> find_pairs(const std::vector<Body>& bodies, const ContactSettings& settings,
                                 const std::vector<SoupBody>& soup) {
  std::vector<collision::SweptBound> bounds(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    geometry::Box& box = bounds[i].box;
    const double margin =
        soup[i].collider->radius + settings.kept_gap * 2.0 * bodies[i].shape->bounding_radius;
    double fastest = 0.0;
    for (std::size_t v = 0; v < soup[i].positions.size(); ++v) {
      box.include(soup[i].positions[v]);
      box.include(soup[i].positions[v] + settings.time_step * soup[i].velocities[v]);
      fastest = std::max(fastest, soup[i].velocities[v].norm());
    }
    // Impulses may turn a particle anywhere within twice its reach.
    const Vec3 reach = Vec3::Constant(margin + settings.time_step * fastest);
    box.low -= reach;
    box.high += reach;
    bounds[i].is_moving = bodies[i].is_dynamic();
  }
  std::vector<SoupPair> pairs;
  for (const auto& [a, b] : collision::find_overlapping_pairs(bounds)) {
    const Body &first = bodies[at(a)], &second = bodies[at(b)];
    if (!may_meet(first, second)) continue;
    double size = 1e300;
    for (const Body* body : {&first, &second})
      if (body->is_dynamic()) size = std::min(size, 2.0 * body->shape->bounding_radius);
    pairs.push_back({a, b, settings.kept_gap * size, pair_material(first, second, settings).friction});
  }
  return pairs;
}

/// Net linear and angular impulse of the particles of one body about its centre at the step's start.
void add_net_impulse(const SoupBody& soup, const std::vector<Vec3>& wanted, Body& body) {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  for (std::size_t v = 0; v < wanted.size(); ++v) {
    if (soup.inverse_masses[v] == 0.0) continue;
    const Vec3 impulse = (soup.velocities[v] - wanted[v]) / soup.inverse_masses[v];
    linear += impulse;
    angular += (soup.positions[v] - body.pose.translation).cross(impulse);
  }
  body.velocity += body.locked.let_move(body.inverse_mass * linear);
  body.angular_velocity += body.inverse_inertia_world() * angular;
}

void log_soup(const std::vector<Body>& bodies, const ContactSettings& settings,
              const std::vector<SoupPair>& pairs, const std::vector<SoupImpulse>& impulses,
              body::ImpulseLog& log) {
  for (const SoupImpulse& i : impulses) {
    const SoupPair& pair = pairs[at(i.pair)];
    const Body &a = bodies[at(pair.a)], &b = bodies[at(pair.b)];
    const bool is_collision = i.closing_speed > impact_threshold(settings, pair.thickness);
    const auto kind = is_collision ? body::ImpulseKind::collision : body::ImpulseKind::contact;
    body::LoggedImpulse entry =
        body::log_impulse(kind, a.id, a.pose, b.id, b.pose, i.point, i.normal, i.impulse);
    if (is_collision) entry.closing_speed = i.closing_speed;
    log.push_back(entry);
  }
}

/// What zones gave to the particles of each body: it has no partner.
void log_zones(const std::vector<Body>& bodies, const std::vector<SoupPair>& pairs,
               const std::vector<SoupImpulse>& impulses, const std::vector<Vec3>& velocities_before,
               body::ImpulseLog& log) {
  std::vector<Vec3> explained(bodies.size(), Vec3::Zero());
  for (const SoupImpulse& i : impulses) {
    explained[at(pairs[at(i.pair)].a)] += i.impulse;
    explained[at(pairs[at(i.pair)].b)] -= i.impulse;
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!bodies[i].is_dynamic()) continue;
    const Vec3 got = bodies[i].shape->mass * (bodies[i].velocity - velocities_before[i]);
    const Vec3 rest = got - explained[i];
    if (rest.norm() <= 1e-12 * got.norm()) continue;
    body::LoggedImpulse entry;
    entry.kind = body::ImpulseKind::failsafe;
    entry.body_a = bodies[i].id;
    entry.point_world = bodies[i].pose.translation;
    entry.impulse_world = rest;
    entry.impulse_a = bodies[i].pose.rotation.conjugate() * rest;
    log.push_back(entry);
  }
}

}  // namespace

void add_to_hash(const PaperContactState& state, core::Hash& hash) {
  for (const DriftingSurface& surface : state.surfaces) {
    hash.add(std::uint64_t{surface.id});
    for (const Vec3& particle : surface.particles) hash.add(particle);
  }
}

ContactReport step_paper_motion(std::vector<Body>& bodies, const ContactSettings& settings,
                                PaperContactState& state, body::ImpulseLog& log) {
  match_bodies(bodies, state);
  PlaneImpulses planes(settings, bodies, log);
  std::vector<SoupBody> soup(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const DriftingSurface& surface = state.surfaces[i];
    planes.apply(bodies[i], surface);
    Vec3 spin = bodies[i].angular_velocity;
    const bool is_moving = bodies[i].motion != body::Motion::fixed;
    const Pose end =
        is_moving ? free_end(bodies[i], surface.inertia, settings, bodies[i].velocity, spin) : bodies[i].pose;
    soup[i] = {surface.collider.get(), surface.particles, {}, surface.inverse_masses};
    for (std::size_t v = 0; v < surface.particles.size(); ++v)
      soup[i].velocities.push_back((end.apply(surface.collider->vertices[v]) - surface.particles[v]) /
                                   settings.time_step);
  }
  std::vector<std::vector<Vec3>> wanted;
  std::vector<Vec3> velocities_before;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    wanted.push_back(soup[i].velocities);
    velocities_before.push_back(bodies[i].velocity);
  }
  const std::vector<SoupPair> pairs = find_pairs(bodies, settings, soup);
  std::vector<SoupImpulse> impulses;
  const SoupReport cloth = collide_soup(settings.time_step, pairs, soup, impulses);
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].is_dynamic()) add_net_impulse(soup[i], wanted[i], bodies[i]);
  log_soup(bodies, settings, pairs, impulses, log);
  log_zones(bodies, pairs, impulses, velocities_before, log);

  ContactReport report;
  report.contacts = report.solver_contacts = cloth.near_features;
  report.least_gap = cloth.least_gap;
  report.hits = cloth.hits;
  report.rounds = cloth.rounds;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Body& body = bodies[i];
    DriftingSurface& surface = state.surfaces[i];
    if (body.motion == body::Motion::fixed) continue;
    body.pose = free_end(body, surface.inertia, settings, body.velocity, body.angular_velocity);
    if (body.is_dynamic()) body.velocity += settings.time_step * body.free_acceleration(settings.gravity);
    report.awake_bodies += body.is_dynamic() ? 1 : 0;
    report.failsafe_steps += cloth.zoned[i] && body.is_dynamic() ? 1 : 0;
    for (std::size_t v = 0; v < surface.particles.size(); ++v) {
      surface.particles[v] += settings.time_step * soup[i].velocities[v];
      const double drift = (surface.particles[v] - body.pose.apply(surface.collider->vertices[v])).norm();
      report.drift = std::max(report.drift, drift);
    }
  }
  if (report.awake_bodies > 0)
    report.frozen_share = static_cast<double>(report.failsafe_steps) / report.awake_bodies;
  return report;
}

}  // namespace shatterbox::dynamics
