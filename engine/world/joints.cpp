#include "engine/world/joints.h"

#include <algorithm>
#include <cstdio>

#include "engine/body/polyhedron.h"
#include "engine/collision/analytic_contact.h"
#include "engine/collision/feature_list.h"
#include "engine/core/index.h"
#include "engine/world/acts.h"
#include "engine/world/limits.h"
#include "engine/world/state.h"

namespace shatterbox::world {
namespace {

using core::at;

// Of those that are open at once, only who is overloaded at least this share of the most gives way: the
// others are judged again without them.
constexpr double kFirst = 0.5;

// Who is nearer to each other where they are hinged, as a share of the radius about the smaller one, touches
// there.
constexpr double kHinge = 1e-3;

// Times a piece's radius, from its centre: no joint holds it from further away.
constexpr double kHeld = 2.0;

/// The surface as triangles in the world; of a plane as much as lies before `other`.
geometry::TriangleMesh world_surface(const body::Body& body, const body::Body& other) {
  geometry::TriangleMesh mesh = body::find_polyhedron(*body.shape);
  for (Vec3& p : mesh.positions) p = body.pose.apply(p);
  if (body.shape->kind == body::ShapeKind::plane) {
    const double half = 2.0 * other.shape->bounding_radius;
    Vec3 middle = body.pose.apply_inverse(other.pose.translation);
    middle.y() = 0.0;
    for (const auto& [x, z] :
         {std::pair(-half, -half), std::pair(-half, half), std::pair(half, half), std::pair(half, -half)})
      mesh.positions.push_back(body.pose.apply(middle + Vec3(x, 0.0, z)));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  }
  return mesh;
}

double height_above(const body::Body& plane, const body::Body& body) {
  const auto collider = collision::make_collider(*body.shape);
  double least = 1e300;
  for (const Vec3& p : collision::place_collider(*collider, body.pose).start)
    least = std::min(least, plane.pose.apply_inverse(p).y());
  return least - collider->radius;
}

bool are_apart(const body::Body& a, const body::Body& b) {
  if (a.shape->kind == body::ShapeKind::plane) return height_above(a, b) > kHinge * b.shape->bounding_radius;
  if (b.shape->kind == body::ShapeKind::plane) return are_apart(b, a);
  const double gap = kHinge * std::min(a.shape->bounding_radius, b.shape->bounding_radius);
  Vec3 normal;
  if (collision::is_analytic_pair(a.shape->kind, b.shape->kind))
    return collision::analytic_gap(*a.shape, a.pose, *b.shape, b.pose, normal) > gap;
  const auto collider_a = collision::make_collider(*a.shape), collider_b = collision::make_collider(*b.shape);
  collision::FeatureList near;
  collision::list_near_features(collision::place_collider(*collider_a, a.pose),
                                collision::place_collider(*collider_b, b.pose), gap, near);
  return near.empty();
}

void wake(std::vector<body::Body>& bodies, const dynamics::Joint& joint) {
  for (const body::BodyId id : {joint.body_a, joint.body_b}) {
    body::Body* body = body::find_body(bodies, id);
    if (body == nullptr || !body->is_dynamic()) continue;
    body->wake();
  }
}

std::string words_of(const JointVerdict& verdict, bool opened) {
  char text[96];
  std::snprintf(text, sizeof text, "%s: %.3g of its strength%s", opened ? "opened" : "held", verdict.ratio,
                verdict.is_by_shear ? " in shear" : "");
  return text;
}

void book(const JointVerdict& verdict, JointRow& row) {
  row.most_ratio = verdict.ratio;
  row.force = verdict.force;
  row.moment = verdict.moment;
  row.tension = verdict.tension;
  row.shear = verdict.shear;
  row.is_struck = verdict.is_struck;
}

}  // namespace

geometry::FacingArea find_mortar_area(const body::Body& a, const body::Body& b, double gap) {
  return geometry::find_facing_area(world_surface(a, b), world_surface(b, a), gap);
}

std::vector<int> rehang(std::vector<dynamics::Joint>& joints, const body::Body& parent,
                        const std::vector<body::BodyId>& born, const std::vector<body::Body>& bodies) {
  std::vector<int> lost;
  for (dynamics::Joint& joint : joints) {
    const bool is_a = joint.body_a == parent.id;
    if (!is_a && joint.body_b != parent.id) continue;
    Pose& frame = is_a ? joint.frame_a : joint.frame_b;
    const Pose place{parent.pose.rotation * frame.rotation, parent.pose.apply(frame.translation)};
    const body::Body* piece = find_nearest(born, bodies, place.translation);
    if (piece == nullptr) continue;
    (is_a ? joint.body_a : joint.body_b) = piece->id;
    frame = {piece->pose.rotation.conjugate() * place.rotation, piece->pose.apply_inverse(place.translation)};
    if (frame.translation.norm() > kHeld * piece->shape->bounding_radius) lost.push_back(joint.number);
  }
  std::erase_if(joints, [&](const dynamics::Joint& joint) {
    return std::find(lost.begin(), lost.end(), joint.number) != lost.end();
  });
  return lost;
}

void World::hang_on(const body::Body& parent, const std::vector<body::BodyId>& born, double time) {
  State& s = *state_;
  regrip(s.hands, parent, born, s.moving.bodies);
  for (const int number : rehang(s.moving.contact.joints, parent, born, s.moving.bodies)) {
    JointRow& row = s.report.joints[at(number - 1)];
    row.opened = time;
    row.verdict = "opened: what it held is in pieces, and none of them reaches it";
    s.moving.joint_memories.erase(number);
  }
}

core::Result<int> World::add_joint(const JointDescription& description) {
  State& s = *state_;
  const auto refuse = [&](const std::string& why) {
    return core::Error{"joint '" + description.name + "': " + why};
  };
  const body::Body* a = body::find_body(s.moving.bodies, description.body_a);
  const body::Body* b = body::find_body(s.moving.bodies, description.body_b);
  if (a == nullptr || b == nullptr) return refuse("there is no such body");
  if (a == b) return refuse("it joins a body to itself");
  if (s.settings.contact == ContactScheme::paper) return refuse("the paper's contact knows no joints");
  if (!(description.strength > 0.0) || !(description.shear_strength > 0.0))
    return refuse("its strengths must be more than 0 Pa");
  if (!a->is_dynamic() && !b->is_dynamic()) return 0;
  dynamics::Joint joint;
  JointNature nature{0, description.name, description.strength, description.shear_strength, 0.0, {}};
  Pose place;
  if (const auto* pivot = std::get_if<PivotDescription>(&description.form)) {
    if (!is_positive(pivot->area)) return refuse("its area must be more than 0 m2");
    if (!is_within(pivot->point, kMostLength)) return refuse("its point is not within 1e6 m");
    place.translation = pivot->point;
    joint.is_pivot = true;
    joint.may_meet = are_apart(*a, *b);
    joint.area = pivot->area;
  } else {
    const double gap = std::get<MortarDescription>(description.form).gap;
    if (!is_positive(gap, kMostLength)) return refuse("its gap must be more than 0 m");
    const geometry::FacingArea face = find_mortar_area(*a, *b, gap);
    if (!(face.area > 0.0)) return 0;
    place = {Quat(face.axes), face.centre};
    joint.area = face.area;
    joint.moments = {face.moments.sum(), face.moments.x(), face.moments.y()};
    nature.outline = face.outline;
    nature.friction = dynamics::pair_material(*a, *b, s.contact_settings).friction;
  }
  joint.number = nature.number = static_cast<int>(s.joints.size()) + 1;
  joint.body_a = a->id;
  joint.body_b = b->id;
  const auto frame_in = [&place](const body::Body& body) {
    return Pose{body.pose.rotation.conjugate() * place.rotation, body.pose.apply_inverse(place.translation)};
  };
  joint.frame_a = frame_in(*a);
  joint.frame_b = frame_in(*b);
  JointRow& row = s.report.joints.emplace_back();
  row.number = joint.number;
  row.name = nature.name;
  row.body_a = a->name;
  row.body_b = b->name;
  row.area = joint.area;
  row.verdict = words_of({}, false);
  s.moving.contact.joints.push_back(joint);
  s.joints.push_back(std::move(nature));
  wake(s.moving.bodies, joint);
  s.is_disturbed = true;
  return joint.number;
}

std::vector<JointVerdict> World::judge_joints(const dynamics::StepPart& part, const body::ImpulseLog& log) {
  State& s = *state_;
  const double length = s.contact_settings.time_step / part.count;
  const PartTime when{time(), time() + part.number * length, length,
                      contact_average(s.contact_settings.time_step)};
  return s.report.stages.time("joints", [&] {
    return world::judge_joints(s.moving.contact.joints, s.joints, s.moving.bodies, log, s.settings,
                               s.contact_settings, when, s.moving.joint_memories);
  });
}

bool World::open_joints(std::span<const JointVerdict> verdicts, MovingState& snapshot, bool may_go_back) {
  State& s = *state_;
  double most = 0.0;
  for (const JointVerdict& verdict : verdicts) most = std::max(most, verdict.ratio);
  if (most < 1.0) {
    for (const JointVerdict& verdict : verdicts) {
      JointRow& row = s.report.joints[at(verdict.number - 1)];
      if (verdict.ratio > row.most_ratio) book(verdict, row);
      row.verdict = words_of({.ratio = row.most_ratio}, false);
    }
    return false;
  }
  const std::vector<int> opened =
      find_opening(verdicts, std::max(1.0, kFirst * most), s.moving.contact.joints, s.moving.bodies);
  keep_begin(snapshot);
  if (may_go_back) s.moving = std::move(snapshot);
  const double end_time = static_cast<double>(s.steps + 1) / s.settings.steps_per_second;
  for (const JointVerdict& verdict : verdicts) {
    if (!std::binary_search(opened.begin(), opened.end(), verdict.number)) continue;
    JointRow& row = s.report.joints[at(verdict.number - 1)];
    book(verdict, row);
    row.opened = end_time;
    row.verdict = words_of(verdict, true);
  }
  std::erase_if(s.moving.contact.joints, [&](const dynamics::Joint& joint) {
    const bool is_open = std::binary_search(opened.begin(), opened.end(), joint.number);
    if (is_open) wake(s.moving.bodies, joint);
    return is_open;
  });
  for (const int number : opened) s.moving.joint_memories.erase(number);
  s.is_disturbed = true;
  return may_go_back;
}

}  // namespace shatterbox::world
