#include "engine/dynamics/particle_soup.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/collision/feature_gap.h"
#include "engine/core/disjoint_sets.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"

namespace shatterbox::dynamics {
namespace {

using collision::FeatureKind;
using collision::FeaturePair;
using core::at;

/// [BFA02] sec. 7: repulsion opens this share of the missing thickness in one step.
constexpr double kRepulsionShare = 0.1;
/// Rounds of impulses before zones, as [BFA02] sec. 7.4 suggests a few.
constexpr int kMostRounds = 10;
/// Least distance on the paths, share of the thickness.
constexpr double kLeastShare = 1e-3;

/// One feature pair that is near, or that meets on its way.
struct Meeting {
  int pair = 0;
  std::array<int, 4> bodies{}, particles{};
  std::array<double, 4> signed_weights{};  // relative velocity = sum of them times the velocities, a less b
  Vec3 normal = Vec3::UnitY();             // from b towards a
  double gap = 0.0;                        // m
};

Meeting describe(const FeaturePair& features, const collision::FeatureGap& gap, int number,
                 const SoupPair& pair, const std::vector<SoupBody>& bodies) {
  Meeting m;
  m.pair = number;
  m.normal = gap.normal;
  m.gap = gap.gap;
  const auto& a = *bodies[at(pair.a)].collider;
  const auto& b = *bodies[at(pair.b)].collider;
  const auto set = [&m](std::size_t i, int body, int particle, double weight) {
    m.bodies[i] = body;
    m.particles[i] = particle;
    m.signed_weights[i] = weight;
  };
  if (features.kind == FeatureKind::edge_edge) {
    for (std::size_t i = 0; i < 2; ++i) {
      set(i, pair.a, a.edges[at(features.a)][i], gap.weights[i]);
      set(i + 2, pair.b, b.edges[at(features.b)][i], -gap.weights[i + 2]);
    }
    return m;
  }
  const bool is_flipped = features.kind == FeatureKind::triangle_vertex;
  const int vertex_body = is_flipped ? pair.b : pair.a, face_body = is_flipped ? pair.a : pair.b;
  const double sign = is_flipped ? -1.0 : 1.0;
  const auto& face = is_flipped ? a.triangles[at(features.a)] : b.triangles[at(features.b)];
  set(0, vertex_body, is_flipped ? features.b : features.a, sign);
  for (std::size_t i = 0; i < 3; ++i) set(i + 1, face_body, face[i], -sign * gap.weights[i + 1]);
  return m;
}

class Soup {
 public:
  Soup(double time_step, const std::vector<SoupPair>& pairs, std::vector<SoupBody>& bodies,
       std::vector<SoupImpulse>& impulses)
      : time_step_(time_step), pairs_(pairs), bodies_(bodies), impulses_(impulses) {
    placed_.resize(bodies.size());
    core::parallel_for(bodies.size(), 4, [&](std::size_t i) {
      placed_[i].collider = bodies_[i].collider;
      placed_[i].start = bodies_[i].positions;
      collision::refit_boxes(placed_[i]);
    });
  }

  /// What is nearer than the thickness at the start.
  std::vector<Meeting> find_near() const {
    return collect([&](std::size_t p, std::vector<Meeting>& out) {
      const SoupPair& pair = pairs_[p];
      const auto &a = bodies_[at(pair.a)], &b = bodies_[at(pair.b)];
      collision::FeatureList list;
      collision::list_near_features(placed_[at(pair.a)], placed_[at(pair.b)], pair.thickness, list);
      collision::sort_by_bound(list);
      for (const FeaturePair& f : list) {
        const auto points = collision::gather(f, *a.collider, a.positions, *b.collider, b.positions);
        const auto gap = collision::measure(points, Vec3::UnitY());
        if (gap.gap < pair.thickness) out.push_back(describe(f, gap, static_cast<int>(p), pair, bodies_));
      }
    });
  }

  /// What the paths of the present velocities would bring together.
  std::vector<Meeting> find_hits() {
    std::vector<collision::SweptCollider> swept(bodies_.size());
    core::parallel_for(bodies_.size(), 4, [&](std::size_t i) {
      swept[i].collider = bodies_[i].collider;
      swept[i].start = bodies_[i].positions;
      swept[i].end.reserve(bodies_[i].positions.size());
      for (std::size_t v = 0; v < bodies_[i].positions.size(); ++v)
        swept[i].end.push_back(bodies_[i].positions[v] + time_step_ * bodies_[i].velocities[v]);
      collision::refit_swept_boxes(swept[i]);
    });
    return collect([&](std::size_t p, std::vector<Meeting>& out) {
      const SoupPair& pair = pairs_[p];
      const auto &a = bodies_[at(pair.a)], &b = bodies_[at(pair.b)];
      const double least = kLeastShare * pair.thickness;
      collision::FeatureList list;
      collision::list_swept_features(swept[at(pair.a)], swept[at(pair.b)], least, list);
      for (const FeaturePair& f : list) {
        const auto start = collision::gather(f, *a.collider, a.positions, *b.collider, b.positions);
        const auto end =
            collision::gather(f, *a.collider, swept[at(pair.a)].end, *b.collider, swept[at(pair.b)].end);
        const double now = collision::measure(start, Vec3::UnitY()).gap;
        const auto path = collision::follow_paths(start, end, std::min(least, 0.5 * now), Vec3::UnitY());
        if (path.has_hit) out.push_back(describe(f, path.gap, static_cast<int>(p), pair, bodies_));
      }
    });
  }

  /// Stops the approach and opens with at least `opening` m/s; Coulomb friction on the way.
  void push(const Meeting& m, double opening) {
    Vec3 relative = Vec3::Zero();
    double inverse_mass = 0.0;
    Vec3 point = Vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      const SoupBody& body = bodies_[at(m.bodies[i])];
      relative += m.signed_weights[i] * body.velocities[at(m.particles[i])];
      inverse_mass += m.signed_weights[i] * m.signed_weights[i] * body.inverse_masses[at(m.particles[i])];
      point += 0.5 * std::abs(m.signed_weights[i]) * body.positions[at(m.particles[i])];
    }
    const double normal_speed = m.normal.dot(relative);
    if (!(inverse_mass > 0.0) || normal_speed >= opening) return;
    const double change = opening - normal_speed;
    Vec3 impulse = (change / inverse_mass) * m.normal;
    const Vec3 sliding = relative - normal_speed * m.normal;
    const double slide = sliding.norm();
    const double grip = pairs_[at(m.pair)].friction * change;
    if (slide > 0.0) impulse -= (std::min(slide, grip) / (slide * inverse_mass)) * sliding;
    for (std::size_t i = 0; i < 4; ++i) {
      SoupBody& body = bodies_[at(m.bodies[i])];
      const std::size_t v = at(m.particles[i]);
      body.velocities[v] += m.signed_weights[i] * body.inverse_masses[v] * impulse;
    }
    impulses_.push_back({m.pair, point, m.normal, impulse, std::max(0.0, -normal_speed)});
  }

  double time_step() const { return time_step_; }
  const SoupPair& pair(int number) const { return pairs_[at(number)]; }

 private:
  /// Calls find(pair number, its meetings) on all pairs at once and joins the answers in the pairs' order.
  template <class Find>
  std::vector<Meeting> collect(const Find& find) const {
    std::vector<std::vector<Meeting>> found(pairs_.size());
    core::parallel_for(pairs_.size(), 4, [&](std::size_t p) { find(p, found[p]); });
    std::vector<Meeting> all;
    for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
    return all;
  }

  double time_step_;
  const std::vector<SoupPair>& pairs_;
  std::vector<SoupBody>& bodies_;
  std::vector<SoupImpulse>& impulses_;
  std::vector<collision::PlacedCollider> placed_;
};

/// Rigid zones of particles: [BFA02] sec. 7.5. A zone with a fixed particle stands still.
class RigidZones {
 public:
  explicit RigidZones(std::vector<SoupBody>& bodies) : bodies_(bodies), sets_(count(bodies)) {
    for (const SoupBody& body : bodies) {
      begin_.push_back(static_cast<int>(particles_.size()));
      for (std::size_t v = 0; v < body.positions.size(); ++v)
        particles_.push_back({static_cast<int>(begin_.size()) - 1, static_cast<int>(v)});
    }
    is_stopped_.assign(particles_.size(), 0);
  }

  /// Joins the particles of the hits, and moves every zone of more than one as a rigid body. A zone that is
  /// hit within itself (rounding alone can do that) stands still.
  void grow(const std::vector<Meeting>& hits, SoupReport& report) {
    for (const Meeting& m : hits) {
      int first = number(m, 0);
      bool is_known = true;
      for (std::size_t i = 1; i < 4; ++i)
        is_known = is_known && sets_.find(number(m, i)) == sets_.find(first);
      if (is_known) is_stopped_[at(sets_.find(first))] = 1;
      for (std::size_t i = 1; i < 4; ++i) {
        const int a = sets_.find(first), b = sets_.find(number(m, i));
        const char stopped = is_stopped_[at(a)] | is_stopped_[at(b)];
        sets_.unite(a, b);
        is_stopped_[at(sets_.find(first))] = stopped;
      }
    }
    std::vector<std::vector<int>> members(particles_.size());
    for (std::size_t i = 0; i < particles_.size(); ++i)
      members[at(sets_.find(static_cast<int>(i)))].push_back(static_cast<int>(i));
    for (std::size_t root = 0; root < members.size(); ++root)
      if (members[root].size() > 1) move_as_one(members[root], is_stopped_[root] != 0, report);
  }

 private:
  struct Particle {
    int body = 0, vertex = 0;
  };

  static std::size_t count(const std::vector<SoupBody>& bodies) {
    std::size_t sum = 0;
    for (const SoupBody& body : bodies) sum += body.positions.size();
    return sum;
  }
  int number(const Meeting& m, std::size_t i) const { return begin_[at(m.bodies[i])] + m.particles[i]; }

  void move_as_one(const std::vector<int>& zone, bool stands_still, SoupReport& report) {
    double mass = 0.0;
    Vec3 centre = Vec3::Zero(), momentum = Vec3::Zero();
    for (const int i : zone) {
      const Particle& p = particles_[at(i)];
      const SoupBody& body = bodies_[at(p.body)];
      report.zoned[at(p.body)] = 1;
      if (body.inverse_masses[at(p.vertex)] == 0.0) {
        stands_still = true;
        continue;
      }
      const double m = 1.0 / body.inverse_masses[at(p.vertex)];
      mass += m;
      centre += m * body.positions[at(p.vertex)];
      momentum += m * body.velocities[at(p.vertex)];
    }
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
    if (!stands_still) {
      centre /= mass;
      velocity = momentum / mass;
      spin = common_spin(zone, centre);
    }
    for (const int i : zone) {
      const Particle& p = particles_[at(i)];
      SoupBody& body = bodies_[at(p.body)];
      body.velocities[at(p.vertex)] = velocity + spin.cross(body.positions[at(p.vertex)] - centre);
    }
  }

  Vec3 common_spin(const std::vector<int>& zone, const Vec3& centre) const {
    Mat3 inertia = Mat3::Zero();
    Vec3 angular = Vec3::Zero();
    for (const int i : zone) {
      const Particle& p = particles_[at(i)];
      const SoupBody& body = bodies_[at(p.body)];
      const double m = 1.0 / body.inverse_masses[at(p.vertex)];
      const Vec3 arm = body.positions[at(p.vertex)] - centre;
      inertia += m * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
      angular += m * arm.cross(body.velocities[at(p.vertex)]);
    }
    // Particles on a line have no inertia about it: a little everywhere leaves that spin out.
    inertia += (1e-9 * inertia.trace() + 1e-300) * Mat3::Identity();
    return inertia.ldlt().solve(angular);
  }

  std::vector<SoupBody>& bodies_;
  core::DisjointSets sets_;
  std::vector<int> begin_;           // per body: number of its first particle
  std::vector<Particle> particles_;  // all
  std::vector<char> is_stopped_;     // per root
};

}  // namespace

SoupReport collide_soup(double time_step, const std::vector<SoupPair>& pairs, std::vector<SoupBody>& bodies,
                        std::vector<SoupImpulse>& impulses) {
  SoupReport report;
  report.zoned.assign(bodies.size(), 0);
  Soup soup(time_step, pairs, bodies, impulses);
  const std::vector<Meeting> near = soup.find_near();
  report.near_features = static_cast<int>(near.size());
  for (const Meeting& m : near) {
    report.least_gap = std::min(report.least_gap, m.gap);
    soup.push(m, kRepulsionShare * (soup.pair(m.pair).thickness - m.gap) / time_step);
  }
  std::vector<Meeting> hits = soup.find_hits();
  for (; !hits.empty() && report.rounds < kMostRounds; ++report.rounds) {
    report.hits += static_cast<int>(hits.size());
    for (const Meeting& m : hits) soup.push(m, 0.0);
    hits = soup.find_hits();
  }
  for (RigidZones zones(bodies); !hits.empty(); hits = soup.find_hits()) zones.grow(hits, report);
  return report;
}

}  // namespace shatterbox::dynamics
