#include "engine/world/perforation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/world/dent_room.h"

namespace shatterbox::world {
namespace {

constexpr double kBeforeHit = 0.06;      // of the striker's diameter: how far from it a part begins, at most
constexpr double kSurelyBefore = 0.002;  // and at least, so that rounding does not put the hit a part earlier
constexpr int kMostHoleParts = 4096;     // of one step
constexpr double kHoleLengths = 3.0;     // of its own, and of the hole, that a striker goes until he is gone
// The same, until what he dents on his way has room: by then he is out, and ahead of it.
constexpr double kClearLengths = 1.6;
constexpr double kPlugAhead = 0.1;    // of the striker's diameter, that a sheet's plug begins ahead
constexpr double kPlugRoom = 1e-6;    // of it, that it keeps from others there
constexpr double kLongestWay = 30.0;  // times as long as at his first speed, that this takes at most

/// s: when striker and plug have gone so many lengths of the striker and of the hole.
double time_after(double lengths, const fracture::Perforation& hole) {
  const double way = lengths * (section_of(hole.striker).diameter + hole.thickness);
  const double left = hole.striker.speed * (1.0 - hole.momentum_share()) * hole.striker.mass /
                      (hole.striker.mass + hole.plug_mass);
  return hole.striker.time + way / std::max(left, hole.striker.speed / kLongestWay);
}

/// A plug is inside of all the hole's sides.
bool is_plug(const body::Shape& shape, const fracture::Perforation& hole) {
  return std::all_of(shape.surface.positions.begin(), shape.surface.positions.end(), [&](const Vec3& p) {
    const Vec3 place = p + shape.material_from_body;
    return std::all_of(hole.sides.begin(), hole.sides.end(), [&](const geometry::PunchSide& side) {
      return side.normal.dot(place) <= side.offset + hole.slack;
    });
  });
}

void log_push(const body::Body& pushed, const body::Body& striker, const Vec3& point, const Vec3& impulse,
              double closing, double mass, body::ImpulseLog& log) {
  body::LoggedImpulse entry =
      body::log_impulse(body::ImpulseKind::fracture, pushed.id, pushed.pose, striker.id, striker.pose, point,
                        impulse.normalized(), impulse);
  entry.closing_speed = closing;
  entry.effective_mass = mass;
  log.push_back(entry);
}

/// Where a sheet is not square to the way, its plug's rim would lie beside the hole's as it begins to move,
/// and contact, which tells two edges by one plane, would hold it there: it begins a little ahead, as far as
/// is free.
void set_ahead(const MovingState& moving, const fracture::Perforation& hole, const Vec3& direction,
               body::Body& plug) {
  if (plug.shape->kind != body::ShapeKind::shell) return;
  const double diameter = section_of(hole.striker).diameter;
  const Vec3 shift = kPlugAhead * diameter * direction;
  MovingSurface way;
  way.triangles = plug.shape->surface.triangles;
  for (const Vec3& p : plug.shape->surface.positions) {
    way.start.push_back(plug.pose.apply(p));
    way.end.push_back(way.start.back() + shift);
  }
  double share = 1.0;
  for (const body::Body& other : moving.bodies)
    if (other.id != plug.id && other.id != hole.striker.number && plug.collides_with(other))
      share = std::min(share, find_room(way, other, kPlugRoom * diameter).share);
  plug.pose.translation += share * shift;
}

}  // namespace

const fracture::Perforation* find_perforation(const EvaluatedImpact& impact) {
  return std::visit([](const auto& decision) { return decision.perforation.get(); }, impact.decision);
}

const fracture::Perforation* find_hole(const EvaluatedImpact& impact) {
  const fracture::Perforation* asked = find_perforation(impact);
  return asked && asked->is_through() ? asked : nullptr;
}

double time_behind(const fracture::Perforation& hole) {
  return time_after(kHoleLengths, hole);
}

bool waits_for_striker(const EvaluatedImpact& impact, std::span<const EvaluatedImpact> impacts) {
  const fracture::Perforation* hole = find_hole(impact);
  if (!hole) return false;
  return std::any_of(impacts.begin(), impacts.end(), [&](const EvaluatedImpact& other) {
    if (other.id == impact.id) return false;
    if (other.id == hole->striker.number)
      return other.figures().verdict.outcome == fracture::Outcome::broke && !other.is_cracked_only();
    const fracture::Perforation* earlier = find_hole(other);
    return earlier && earlier->striker.number == hole->striker.number &&
           (earlier->striker.time < hole->striker.time ||
            (earlier->striker.time == hole->striker.time && other.id < impact.id));
  });
}

std::optional<dynamics::StepPart> divide_before_holes(std::span<const EvaluatedImpact> impacts,
                                                      const dynamics::StepPart& part, double begin,
                                                      double step) {
  const fracture::Perforation* first = nullptr;
  for (const EvaluatedImpact& impact : impacts) {
    const fracture::Perforation* hole = find_hole(impact);
    if (hole && (!first || hole->striker.time < first->striker.time)) first = hole;
  }
  if (!first) return std::nullopt;
  const double part_time = step / part.count;
  const double way = first->striker.speed * part_time;  // m, in the part
  const double share = (first->striker.time - begin - part_time * part.number) / part_time;
  const double diameter = section_of(first->striker).diameter;
  if (share * way <= kBeforeHit * diameter) return std::nullopt;
  // The fewest parts of which one begins in time; or, of those that there may be, the one that comes nearest.
  std::optional<dynamics::StepPart> best;
  double nearest = share * way;
  for (int parts = 2; part.count * parts <= kMostHoleParts; ++parts) {
    const double place = share * parts;
    const double left = (place - std::floor(place)) * way / parts;
    if (left < kSurelyBefore * diameter || left >= nearest) continue;
    nearest = left;
    best = dynamics::StepPart{part.number * parts, part.count * parts};
    if (left <= kBeforeHit * diameter) break;
  }
  return best;
}

void pay_for_hole(MovingState& moving, const EvaluatedImpact& impact, body::ImpulseLog& log) {
  const fracture::Perforation& hole = *find_hole(impact);
  body::Body* struck = body::find_body(moving.bodies, impact.id);
  body::Body* striker = body::find_body(moving.bodies, hole.striker.number);
  if (!struck || !striker) return;
  const Vec3 direction = struck->pose.rotation * hole.striker.direction;
  const Vec3 point = striker->pose.translation;
  const double mass = effective_mass(*struck, striker, point, direction);
  const double closing = (striker->velocity - struck->velocity_at(point)).dot(direction);
  if (!(mass > 0.0) || !(closing > 0.0)) return;
  const double left = std::sqrt(std::max(0.0, closing * closing - 2.0 * hole.needed / mass));
  const Vec3 impulse = mass * (closing - left) * direction;
  struck->push(impulse, point);
  striker->push(-impulse, point);
  log_push(*struck, *striker, point, impulse, closing, mass, log);
}

void take_plug_along(MovingState& moving, const EvaluatedImpact& impact, const BreakRow& row,
                     body::ImpulseLog& log) {
  const fracture::Perforation& hole = *find_hole(impact);
  body::Body* striker = body::find_body(moving.bodies, hole.striker.number);
  if (!striker) return;
  std::vector<body::Body*> plugs;
  double mass = 0.0;
  Vec3 momentum = Vec3::Zero();
  for (const body::BodyId id : row.born) {
    body::Body* born = body::find_body(moving.bodies, id);
    if (!born->is_dynamic() || !is_plug(*born->shape, hole)) continue;
    plugs.push_back(born);
    mass += born->shape->mass;
    momentum += born->shape->mass * born->velocity;
  }
  if (plugs.empty()) return;
  const Vec3 direction = plugs.front()->pose.rotation * hole.striker.direction;
  // Of both together; what goes a scripted way keeps its own.
  const double common = (striker->velocity + striker->inverse_mass * momentum).dot(direction) /
                        (1.0 + striker->inverse_mass * mass);
  for (body::Body* plug : plugs) {
    const double gain = common - plug->velocity.dot(direction);
    if (!(gain > 0.0)) continue;
    const Vec3 impulse = plug->shape->mass * gain * direction;
    const double closing = (striker->velocity - plug->velocity).dot(direction);
    const Vec3 point = plug->pose.translation;
    plug->velocity += plug->inverse_mass * impulse;
    striker->velocity -= striker->inverse_mass * impulse;
    log_push(*plug, *striker, point, impulse, closing, 1.0 / (plug->inverse_mass + striker->inverse_mass),
             log);
    set_ahead(moving, hole, direction, *plug);
  }
}

void leave_dent(MovingState& moving, const EvaluatedImpact& impact, const BreakRow& row, bool keeps_dents) {
  const fracture::Perforation& hole = *find_hole(impact);
  for (const body::BodyId id : row.born) {
    if (is_plug(*body::find_body(moving.bodies, id)->shape, hole)) continue;
    moving.memories[id].keeps_dents = keeps_dents;
    if (!keeps_dents) continue;
    std::visit(
        [&](const auto& decision) {
          if (decision.dent)
            moving.memories[id].dents.push_back({decision.dent, decision.verdict.von_mises,
                                                 decision.verdict.yield, hole.striker.place,
                                                 time_after(kClearLengths, hole)});
        },
        impact.decision);
  }
}

std::string describe_perforation(const fracture::Perforation& perforation) {
  char text[96];
  const char* form = perforation.is_through() ? "perforated: %.3g times the energy it takes"
                                              : "%.3g of the energy that perforates";
  std::snprintf(text, sizeof text, form, perforation.ratio());
  return text;
}

}  // namespace shatterbox::world
