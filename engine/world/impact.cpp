#include "engine/world/impact.h"

#include <algorithm>
#include <cmath>

#include "engine/core/elementary.h"

namespace shatterbox::world {
namespace {

/// The load in `loads` that `load` belongs to by body, place and direction, or nothing.
Load* find_place(std::vector<Load>& loads, const Load& load, double radius) {
  for (Load& candidate : loads) {
    if (candidate.other != load.other) continue;
    if ((candidate.point_body - load.point_body).squaredNorm() > radius * radius) continue;
    if (candidate.impulse_body.dot(load.impulse_body) <
        0.5 * candidate.impulse_body.norm() * load.impulse_body.norm())
      continue;
    return &candidate;
  }
  return nullptr;
}

void merge(Load& into, const Load& load) {
  const double weight = into.impulse_body.norm();
  const double other_weight = load.impulse_body.norm();
  const double sum = weight + other_weight;
  if (sum > 0.0) {
    const auto mean = [&](const Vec3& a, const Vec3& b) {
      return Vec3((weight * a + other_weight * b) / sum);
    };
    into.point_body = mean(into.point_body, load.point_body);
    into.other_point = mean(into.other_point, load.other_point);
    into.point_world = mean(into.point_world, load.point_world);
  }
  into.other_impulse += load.other_impulse;
  into.impulse_body += load.impulse_body;
  into.closing_speed = std::max(into.closing_speed, load.closing_speed);
  into.first_time = std::min(into.first_time, load.first_time);
  into.time = std::max(into.time, load.time);
  into.duration = std::max(into.duration, load.duration);
  into.spread = core::sqrt(into.spread * into.spread + load.spread * load.spread);  // areas add up
}

}  // namespace

bool take_charged(ImpactMemory& piece, const ImpactMemory* other_memory, Load& load) {
  if (load.time > piece.charged_until) return false;
  if (load.other != piece.charged_other)
    return other_memory && other_memory->charged_event == piece.charged_event &&
           load.time <= other_memory->charged_until;
  const double impulse = load.impulse_body.norm();
  const double taken = std::min(impulse, piece.charged_left);
  piece.charged_left -= taken;
  if (!(taken < impulse)) return true;
  load.impulse_body *= 1.0 - taken / impulse;
  load.other_impulse *= 1.0 - taken / impulse;
  return false;
}

bool is_seated(const body::Body& struck, const body::Body& other, const Load& load) {
  if (struck.family == 0 || struck.family != other.family) return false;
  const Vec3 here = load.point_body + struck.shape->material_from_body;
  const Vec3 there = load.other_point + other.shape->material_from_body;
  const double seat = struck.shape->seat;
  return (here - there).squaredNorm() < seat * seat;
}

void keep_own_share(std::vector<Load>& loads, const Vec3& passed_on) {
  Vec3 sum = Vec3::Zero();
  for (const Load& load : loads) sum += load.impulse_body;
  const double all = sum.squaredNorm();
  if (!(all > 0.0)) return;
  const double share = std::clamp((sum + passed_on).dot(sum) / all, 0.0, 1.0);
  for (Load& load : loads) {
    load.impulse_body *= share;
    load.other_impulse *= share;
  }
  std::erase_if(loads, [](const Load& load) { return !(load.impulse_body.squaredNorm() > 0.0); });
}

std::vector<OwnImpulses> sort_by_body(const body::ImpulseLog& log, const std::vector<body::BodyId>& ids) {
  std::vector<OwnImpulses> own(ids.size());
  for (const body::LoggedImpulse& entry : log)
    for (const body::BodyId id : {entry.body_a, entry.body_b}) {
      const auto found = std::lower_bound(ids.begin(), ids.end(), id);
      if (found != ids.end() && *found == id)
        own[static_cast<std::size_t>(found - ids.begin())].push_back(&entry);
    }
  return own;
}

std::vector<Load> gather_loads(const OwnImpulses& impulses, body::ImpulseKind kind, const body::Body& struck,
                               double radius, double step_start, const PassOver& pass_over) {
  std::vector<Load> loads;
  for (const body::LoggedImpulse* logged : impulses) {
    const body::LoggedImpulse& entry = *logged;
    if (entry.kind != kind) continue;
    const bool is_a = entry.body_a == struck.id;
    Load load;
    load.other = is_a ? entry.body_b : entry.body_a;
    load.point_body = is_a ? entry.point_a : entry.point_b;
    load.impulse_body = is_a ? entry.impulse_a : entry.impulse_b;
    load.other_point = is_a ? entry.point_b : entry.point_a;
    load.other_impulse = is_a ? entry.impulse_b : entry.impulse_a;
    load.point_world = entry.point_world;
    load.closing_speed = entry.closing_speed;
    load.first_time = load.time = step_start + entry.time;
    load.duration = entry.duration;
    load.spread = entry.spread;
    if (pass_over && pass_over(load)) continue;
    if (load.impulse_body.squaredNorm() > 0.0) loads.push_back(load);
  }
  // The greatest impulse founds its place first, so that places do not depend on the order of the log.
  std::stable_sort(loads.begin(), loads.end(), [](const Load& a, const Load& b) {
    return a.impulse_body.squaredNorm() > b.impulse_body.squaredNorm();
  });
  std::vector<Load> gathered;
  for (const Load& load : loads) {
    if (Load* place = find_place(gathered, load, radius))
      merge(*place, load);
    else
      gathered.push_back(load);
  }
  return gathered;
}

void add_to_event(std::vector<Load>& event, const std::vector<Load>& loads, double radius) {
  for (const Load& load : loads) {
    if (Load* place = find_place(event, load, radius))
      merge(*place, load);
    else
      event.push_back(load);
  }
}

double contact_average(double step) {
  return step * std::max(1.0, std::floor(kContactAverage / step + 0.5));
}

stress::HertzContact find_hertz_contact(const body::Body& struck, const body::Body* other) {
  const auto surface = [](const body::Body& body) {
    double radius = body.shape->bounding_radius;
    if (body::is_round(body.shape->kind)) radius = body.shape->radius;
    if (body.shape->kind == body::ShapeKind::plane || body.shape->kind == body::ShapeKind::box) radius = 0.0;
    return stress::ContactSurface{body.young, body.poisson, radius};
  };
  return stress::make_hertz_contact(surface(struck), other ? surface(*other) : stress::ContactSurface{},
                                    struck.shape->thickness, struck.shape->bounding_radius);
}

double effective_mass(const body::Body& struck, const body::Body* other, const Vec3& point_world,
                      const Vec3& direction_world) {
  const auto at_present = [&](const body::Body& body) {
    return body.mobility(body.pose.apply_inverse(point_world),
                         body.pose.rotation.conjugate() * direction_world);
  };
  const double inverse = at_present(struck) + (other ? at_present(*other) : 0.0);
  return inverse > 0.0 ? 1.0 / inverse : 0.0;
}

}  // namespace shatterbox::world
