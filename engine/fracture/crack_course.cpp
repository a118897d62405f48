#include "engine/fracture/crack_course.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/elementary.h"
#include "engine/core/index.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kLeastEntry =
    0.156;                         // sine of the least angle at which a crack leaves an edge, about 9 degrees
constexpr double kMostTurn = 1.2;  // rad, in one element
constexpr double kTurnLength = 6.0;  // thicknesses, over which a crack turns to the stress
constexpr double kParallel = 0.9;    // cosine above which two cracks count as side by side
constexpr double kJoinPull = 0.8;    // how hard a crack turns to one that it is about to touch
constexpr double kLeadsAway = 0.1;   // sine of the angle above which a crack leads away from one beside it

Vec2 turned(const Vec2& d, double angle) {
  const double c = core::cos(angle);
  const double s = core::sin(angle);
  return {c * d.x() - s * d.y(), s * d.x() + c * d.y()};
}

/// Normal stress on a plane stress's cut along a unit direction.
double stress_across(const stress::PlaneStress& s, const Vec2& along) {
  const Vec2 n = left_of(along);
  return s.x() * n.x() * n.x() + s.y() * n.y() * n.y() + 2.0 * s.z() * n.x() * n.y();
}

double stress_intensity(const stress::PlaneStress& tensor, const Vec2& along, double length) {
  return std::max(0.0, stress_across(tensor, along)) * core::sqrt(0.5 * core::kPi * length);
}

}  // namespace

NearestLoad find_nearest_load(const TracerSetup& setup, const Vec3& p) {
  NearestLoad nearest;
  for (const LoadCentre& centre : setup.centres) {
    const double distance = std::max((p - centre.point).norm(), centre.radius);
    if (distance < nearest.distance) nearest = {&centre, distance};
  }
  return nearest;
}

Vec2 TipEntry::inwards(const Vec2& direction) const {
  const Vec2 inward = left_of(side);
  const double across = std::max(kLeastEntry, direction.dot(inward));
  const double along = std::min(1.0, std::max(-1.0, direction.dot(side)));
  return (inward * across + side * along).normalized();
}

CourseFinder::CourseFinder(const ShellCutter& cutter, const ExitFinder& exits, const TracerSetup& setup,
                           const CrackSet& present)
    : cutter_(cutter), exits_(exits), setup_(setup), present_(present), elements_(cutter.elements()) {
  toughness_ = core::sqrt(setup_.material->young * setup_.material->fracture_energy);
}

std::optional<TipEntry> CourseFinder::enter(const CrackTip& tip) const {
  const auto stretch = cutter_.find_stretch(tip.element, tip.edge, tip.parameter);
  if (!stretch) return std::nullopt;
  const CutCell& cell = cutter_.cell(stretch->cell);
  TipEntry entry;
  entry.stretch = *stretch;
  entry.plane = &setup_.planes->of(cell.element);
  const Size n = cell.polygon.size();
  const geometry::ShellCorner& corner = cell.polygon[at(stretch->side)];
  entry.start = {stretch->side, false,
                 barycentric_on_edge(elements_, cell.element, corner.side_id, tip.parameter)};
  entry.from = entry.plane->flat(entry.start.barycentric);
  entry.side = entry.plane->flat(cell.polygon[(at(stretch->side) + 1) % n].barycentric - corner.barycentric)
                   .normalized();
  const double along = std::min(1.0, std::max(-1.0, tip.heading.dot(entry.plane->direction(entry.side))));
  entry.heading = entry.inwards(along * entry.side + core::sqrt(1.0 - along * along) * left_of(entry.side));
  return entry;
}

std::optional<Course> CourseFinder::find(const LiveTip& tip, const TipEntry& entry,
                                         double crack_length) const {
  if (!(entry.plane->scale > 0.0)) return std::nullopt;
  const ElementPlane& plane = *entry.plane;
  const stress::PlaneStress stress =
      (*setup_.stresses)[at(cutter_.cell(entry.stretch.cell).origin)].at(tip.face);
  const stress::PrincipalStress principal = stress::principal_stress(stress);
  if (!(principal.first > 0.0)) return std::nullopt;
  const auto straight_on =
      exits_.find_exit(entry.stretch.cell, entry.stretch.side, entry.from, entry.heading);
  const double way =
      straight_on ? (plane.flat(straight_on->place.barycentric) - entry.from).norm() : 0.5 * plane.scale;
  Vec2 target = left_of(principal.direction);
  if (target.dot(entry.heading) < 0.0) target = -target;
  const double anisotropy =
      std::min(1.0, std::max(0.0, (principal.first - principal.second) / principal.first));
  double angle = core::atan2(cross(entry.heading, target), entry.heading.dot(target));
  angle = std::min(kMostTurn, std::max(-kMostTurn, angle + setup_.noise->at(plane.space(entry.from))));
  // Where both principal stresses are alike, and over less than some thicknesses, a crack goes straight on.
  angle *= 1.0 - core::exp(-anisotropy * anisotropy * way / (kTurnLength * setup_.thickness));
  Course course;
  course.heading = steer_to_neighbour(tip, entry, turned(entry.heading, angle), crack_length);
  if (setup_.grains && !setup_.grains->is_empty()) follow_grains(tip, entry, course);
  course.heading = entry.inwards(course.heading);
  course.intensity = course.release_share * stress_intensity(stress, course.heading, tip.driven_length);
  if (course.intensity < toughness_ * course.toughness_share) return std::nullopt;
  return course;
}

/// Two cracks that run towards each other side by side become one: the nearer they are, the harder they turn.
Vec2 CourseFinder::steer_to_neighbour(const LiveTip& tip, const TipEntry& entry, const Vec2& heading,
                                      double crack_length) const {
  const Vec3 p = entry.plane->space(entry.from);
  const Vec3 forward = entry.plane->direction(heading);
  const double reach = std::min(0.25 * crack_length, 0.3 * find_nearest_load(setup_, p).distance);
  double nearest = reach;
  Vec2 towards = Vec2::Zero();
  present_.visit_near(p, reach, [&](const CrackStretch& s, const Vec3& near, double distance) {
    if (s.piece != tip.piece || distance >= nearest || !(distance > 0.0)) return true;
    if (s.crack == tip.tip.crack) {
      const double apart =
          s.branch == tip.branch ? tip.branch_length - s.branch_length : tip.branch_length + s.branch_length;
      if (apart < 3.0 * reach) return true;
    }
    const Vec3 along = s.end - s.begin;
    const double length = along.norm();
    if (!(length > 0.0) || std::abs(along.dot(forward)) < kParallel * length) return true;
    if ((near - p).dot(forward) < -kLeadsAway * distance) return true;
    const Vec2 flat = entry.plane->flat_direction(near - p);
    if (!(flat.squaredNorm() > 0.0)) return true;
    nearest = distance;
    towards = flat.normalized();
    return true;
  });
  return (heading + kJoinPull * (1.0 - nearest / reach) * towards).normalized();
}

void CourseFinder::follow_grains(const LiveTip& tip, const TipEntry& entry, Course& course) const {
  const int element = cutter_.cell(entry.stretch.cell).element;
  // A crack that could run straight on with the energy release G turns by an angle into a weaker plane, where
  // it finds about G cos^4(angle / 2), if that is more of the plane's toughness (share^2 of the material's)
  // than G is of its own (M.-Y. He, J. W. Hutchinson, J. Appl. Mech. 56, 1989).
  const double share = setup_.material->grain_strength;
  const double weak = share * share;
  double best = 1.0;
  for (const GrainCrossing& crossing : find_grain_crossings(*setup_.grains, elements_, element)) {
    if (crossing.edge == tip.tip.edge) continue;
    const auto stretch = cutter_.find_stretch(element, crossing.edge, crossing.parameter);
    if (!stretch || stretch->cell != entry.stretch.cell) continue;
    const CrackExit exit = exits_.settle_on_edge(stretch->cell, stretch->side, crossing.parameter);
    const Vec2 along = entry.plane->flat(exit.place.barycentric) - entry.from;
    if (!(along.squaredNorm() > 0.0)) continue;
    const Vec2 direction = along.normalized();
    const double forward = direction.dot(course.heading);
    if (forward <= 0.0) continue;
    // On a boundary already: the chord lies on it if one of its two grains is at the other end too.
    const bool is_on_grain =
        tip.grain_a >= 0 && (crossing.grain_a == tip.grain_a || crossing.grain_a == tip.grain_b ||
                             crossing.grain_b == tip.grain_a || crossing.grain_b == tip.grain_b);
    const double release = 0.5 * (1.0 + forward);  // cos^2 of half the angle
    const double drive = release * release / (is_on_grain ? weak : 0.5 * (1.0 + weak));
    if (drive <= best) continue;
    best = drive;
    course.exit = exit;
    course.is_on_grain = is_on_grain;
    course.grain_a = crossing.grain_a;
    course.grain_b = crossing.grain_b;
    course.toughness_share = is_on_grain ? share : 1.0;
    course.release_share = release;
  }
}

}  // namespace shatterbox::fracture
