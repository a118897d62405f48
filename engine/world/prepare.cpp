// Factors made before the run: likely impacts are tried on every breakable form, so that the factors which a
// first hit would need are there. The answers are thrown away; the kept factors change no result.
#include <algorithm>
#include <array>
#include <set>

#include <Eigen/Eigenvalues>

#include "engine/core/parallel.h"
#include "engine/stress/contact_duration.h"
#include "engine/world/state.h"

namespace shatterbox::world {
namespace {

constexpr double kLikelySpeed = 3.0;  // m/s

/// Unlike ones that are tried on a held body; the factors of one serve many.
constexpr std::size_t kMostPartners = 16;

/// Masses of bodies that may come flying later, as shares of the struck body's own.
constexpr std::array<double, 3> kLikelyMasses{0.01, 0.1, 1.0};

struct Trial {
  const Fragile* fragile = nullptr;
  const fracture::ShellSubject* subject = nullptr;
  fracture::ImpactLoad load;
};

/// What a trial meets; without mass, a floor.
struct Partner {
  double mass = 0.0;   // kg
  double speed = 0.0;  // m/s
  stress::ContactSurface surface;
  bool operator==(const Partner&) const = default;
};

/// The vertex farthest along `direction`.
Vec3 farthest(const std::vector<Vec3>& points, const Vec3& direction) {
  return *std::max_element(points.begin(), points.end(),
                           [&](const Vec3& a, const Vec3& b) { return a.dot(direction) < b.dot(direction); });
}

Vec3 nearest_to_centre(const std::vector<Vec3>& points) {
  return *std::min_element(points.begin(), points.end(),
                           [](const Vec3& a, const Vec3& b) { return a.squaredNorm() < b.squaredNorm(); });
}

fracture::ImpactLoad make_load(const body::Body& struck, const Partner& partner, const Vec3& point,
                               const Vec3& direction) {
  fracture::ImpactLoad load;
  load.point_material = point + struck.shape->material_from_body;
  load.direction = direction;
  load.other_inverse_mass = partner.mass > 0.0 ? 1.0 / partner.mass : 0.0;
  load.effective_mass = 1.0 / (load.other_inverse_mass + struck.mobility(point, direction));
  load.closing_speed = std::max(kLikelySpeed, partner.speed);
  load.impulse = load.effective_mass * load.closing_speed;
  const double size = struck.shape->bounding_radius;
  const stress::HertzContact contact = stress::make_hertz_contact(
      {struck.young, struck.poisson, size}, partner.surface, struck.shape->thickness, size);
  const double force = stress::peak_force(contact, load.effective_mass, load.closing_speed);
  load.hertz_compliance = stress::hertz_compliance(contact, force);
  load.hertz_radius = stress::hertz_patch_radius(contact, force);
  return load;
}

/// Free bodies meet a floor with each of the six sides on which they can fall; held ones are hit in the
/// middle by what moves, or by what may come.
void add_trials(const body::Body& struck, const Fragile& fragile, std::span<const body::Body* const> movers,
                std::vector<Trial>& trials) {
  const auto* subject = std::get_if<fracture::ShellSubject>(&fragile.subject);
  const std::vector<Vec3>& points = struck.shape->surface.positions;
  if (struck.is_dynamic()) {
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {-1.0, 1.0}) {
        const Vec3 outward = sign * Vec3::Unit(axis);
        const Vec3 point = farthest(points, outward);
        if (struck.mobility(point, -outward) > 0.0)
          trials.push_back({&fragile, subject, make_load(struck, {}, point, -outward)});
      }
    return;
  }
  std::vector<Partner> partners;
  for (const body::Body* mover : movers) {
    const Partner partner{mover->shape->mass,
                          (mover->velocity - struck.velocity).norm(),
                          {mover->young, mover->poisson, mover->shape->radius}};
    if (std::find(partners.begin(), partners.end(), partner) == partners.end()) partners.push_back(partner);
    if (partners.size() == kMostPartners) break;
  }
  if (partners.empty())
    for (const double share : kLikelyMasses)
      partners.push_back({share * struck.shape->mass, 0.0, stress::ContactSurface{}});
  const Eigen::SelfAdjointEigenSolver<Mat3> inertia(struck.shape->inertia);
  const Vec3 across = inertia.eigenvectors().col(2);
  for (const Partner& partner : partners)
    trials.push_back({&fragile, subject, make_load(struck, partner, nearest_to_centre(points), across)});
}

}  // namespace

void World::prepare() {
  State& s = *state_;
  std::vector<const body::Body*> movers;
  for (const body::Body& body : s.moving.bodies)
    if (body.is_dynamic() && !s.moving.fragiles.count(body.id)) movers.push_back(&body);

  std::set<const stress::ShellSystemCache*> seen;
  std::vector<Trial> trials;
  std::vector<const fracture::SolidSubject*> solids;
  for (const auto& [id, fragile] : s.moving.fragiles) {
    if (const auto* solid = std::get_if<fracture::SolidSubject>(&fragile->subject)) solids.push_back(solid);
    // Solids keep no factors.
    const auto* shell = std::get_if<fracture::ShellSubject>(&fragile->subject);
    if (!shell || !seen.insert(shell->systems.get()).second) continue;
    add_trials(*body::find_body(s.moving.bodies, id), *fragile, movers, trials);
  }
  core::parallel_for(solids.size(), 1, [&](std::size_t i) { fracture::prepare_cracks(*solids[i]); });
  fracture::FractureSettings once;
  once.most_generations = 1;
  once.core_spacing = 0.0;  // what is crushed comes after the last solve
  core::parallel_for(trials.size(), 1, [&](std::size_t i) {
    fracture::Impact impact;
    impact.loads = {trials[i].load};
    if (s.settings.stress_window) impact.given_duration = s.settings.stress_window;
    if (trials[i].fragile->contact_duration) impact.given_duration = trials[i].fragile->contact_duration;
    fracture::decide_shell(*trials[i].subject, impact, once);
  });
}

}  // namespace shatterbox::world
