#include "sandbox/view/reframing.h"

#include <algorithm>
#include <cmath>

#include "engine/core/elementary.h"
#include "sandbox/scene/parts.h"
#include "sandbox/view/camera.h"
#include "sandbox/view/ways.h"

namespace shatterbox::sandbox::view {
namespace {

constexpr double kAhead = 0.3;     // s: so far it foresees where what falls will be
constexpr double kNext = 0.1;      // s, and what may yet stop
constexpr double kHaste = 0.12;    // s, of each of two lags, one behind the other
constexpr double kCalm = 0.5;      // s, of the coming closer
constexpr double kRoom = 0.15;     // of the longest side of what is followed, about it
constexpr double kRim = 0.95;      // of the picture's half: beyond it something leaves it
constexpr double kBigPiece = 0.5;  // times as far across as what it was a piece of: that is looked after
// Of the longest side of all that there is to see: so far aside, above and below it things are looked after.
constexpr double kAside = 0.5;
constexpr double kBelow = 3.0;

geometry::Box find_room(const std::vector<Vec3>& corners, const Vec3& gravity) {
  const geometry::Box box = box_about(corners);
  geometry::Box room = room_about(box, kAside);
  if (gravity.isZero(0.0)) return room;
  const double longest = (box.high - box.low).maxCoeff();
  room.include(box.low + kBelow * longest * gravity.normalized());
  room.include(box.high + kBelow * longest * gravity.normalized());
  return room;
}

// About all of it, in its own axes.
geometry::Box own_box(const body::Shape& shape) {
  if (body::is_mesh(shape.kind)) return geometry::box_of(shape.surface);
  const Vec3 half = shape.half_extent + Vec3::Constant(shape.radius) + shape.half_length * Vec3::UnitY();
  return {-half, half};
}

bool is_empty(const geometry::Box& box) {
  return box.low.x() > box.high.x();
}

geometry::Box moved(const geometry::Box& box, const Vec3& by) {
  return {box.low + by, box.high + by};
}

// Of each body of the scene whether the eye goes after it: what can break or hangs, or, where nothing does,
// whatever is there from the start.
std::vector<char> find_followed(const scene::SceneDescription& scene) {
  std::vector<char> follows;
  for (const scene::BodyEntry& body : scene.bodies) follows.push_back(scene::can_break(body) ? 1 : 0);
  for (const scene::JointEntry& joint : scene.joints)
    for (const scene::BodyRef& partner : joint.partners) follows[static_cast<std::size_t>(partner.body)] = 1;
  if (std::count(follows.begin(), follows.end(), 1) == 0)
    for (std::size_t i = 0; i < follows.size(); ++i) follows[i] = scene.bodies[i].is_held_back ? 0 : 1;
  return follows;
}

bool has_own_place(const scene::CameraEntry& camera) {
  return camera.position || camera.target || !camera.path.empty() || camera.follow.body >= 0;
}

}  // namespace

struct Reframing::Seen {
  Viewpoint view;
  Mat3 axes;
  double slope = 0.0;  // of the picture's upper rim

  Seen(const Viewpoint& eye, const Mat3& along) : view(eye), axes(along) {
    const double half = eye.fov * core::kPi / 360.0;
    slope = core::sin(half) / core::cos(half);
  }

  bool holds(const geometry::Box& box) const {
    const Vec3 p = 0.5 * (box.low + box.high) - axes * view.position, half = 0.5 * (box.high - box.low);
    const double up = -kRim * slope * p.z(), across = view.least_aspect * up;
    return std::abs(p.x()) + half.x() < across && std::abs(p.y()) + half.y() < up;
  }
};

Reframing::Reframing(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                     const Subject& subject)
    : scene_(scene), built_(built), subject_(subject) {
  if (has_own_place(scene.camera)) return;
  follows_ = find_followed(scene);
  for (const body::Body& body : built.world.bodies())
    if (body.shape->kind == body::ShapeKind::plane) floors_.push_back(body.pose);
  room_ = find_room(subject.corners, scene.world.gravity);
  usual_ = viewpoint_at(scene.camera, subject, 0.0);
  const Vec3 away = (usual_.position - usual_.target).normalized();
  const Vec3 right = scene.camera.up.cross(away).normalized();
  axes_ << right.transpose(), away.cross(right).transpose(), away.transpose();
  look();
}

bool Reframing::is_followed(const body::Body& body) const {
  if (!body.is_dynamic()) return false;
  const scene::Origin* origin = scene::origin_of(built_, body.id);
  if (origin == nullptr) return false;
  const auto entry = static_cast<std::size_t>(origin->entry);
  return follows_[entry] != 0 && body.shape->bounding_radius >= kBigPiece * built_.plan.bodies[entry].reach;
}

// Where it will be soon if it goes on as it does, but not below a floor above which it is.
Vec3 Reframing::place_ahead(const body::Body& body) const {
  const Vec3& gravity = scene_.world.gravity;
  const Vec3 here = body.pose.translation;
  Vec3 way = kNext * body.velocity;
  if (const double falls = body.velocity.dot(gravity); falls > 0.0)
    way += (kAhead - kNext) * falls / gravity.squaredNorm() * gravity;
  double share = 1.0;
  for (const Pose& floor : floors_) {
    const Vec3 normal = floor.rotation * Vec3::UnitY();
    const double height = normal.dot(here - floor.translation) - body.shape->bounding_radius;
    const double sinking = -normal.dot(way);
    if (sinking > 0.0) share = std::clamp(height / sinking, 0.0, share);
  }
  return (here + share * way).cwiseMax(room_.low).cwiseMin(room_.high);
}

Viewpoint Reframing::usual_at(double time) const {
  return subject_.fall ? viewpoint_at(scene_.camera, subject_, time) : usual_;
}

geometry::Box Reframing::box_of(const body::Body& body) {
  const auto [known, is_new] = boxes_.try_emplace(body.id);
  if (is_new) known->second = own_box(*body.shape);
  const Mat3 turned = axes_ * body.pose.rotation.toRotationMatrix();
  const Vec3 middle =
      turned * (0.5 * (known->second.low + known->second.high)) + axes_ * body.pose.translation;
  const Vec3 half = turned.cwiseAbs() * (0.5 * (known->second.high - known->second.low));
  return {middle - half, middle + half};
}

geometry::Box Reframing::survey(const Seen& seen) {
  geometry::Box all;
  for (const body::Body& body : built_.world.bodies()) {
    const Vec3 here = body.pose.translation;
    if (!is_followed(body) || !geometry::overlaps(room_, {here, here})) continue;
    const geometry::Box box = box_of(body);
    const geometry::Box ahead = moved(box, axes_ * (place_ahead(body) - here));
    const bool is_here = seen.holds(box);
    const body::BodyId original = built_.world.ancestry(body.id).original;
    if (is_here) met_.insert(original);
    if (met_.count(original) == 0) continue;
    // An eye that goes down with what falls will be there too.
    is_off_ |= !is_here || (!subject_.fall && !seen.holds(ahead));
    all.include(box);
    all.include(ahead);
  }
  return all;
}

// To where all of the stage is in the picture.
Shift Reframing::wanted(const Viewpoint& usual) const {
  if (!is_off_ || is_empty(stage_)) return {};
  const Vec3 sides = stage_.high - stage_.low;
  const double longest = sides.maxCoeff();
  const Vec3 room = Vec3::Constant(kRoom * longest + 0.5 * std::max(least_side_ - longest, 0.0));
  std::vector<Vec3> points;
  append(
      corners_of({stage_.low - room, stage_.high + room}, Pose{Quat(Mat3(axes_.transpose())), Vec3::Zero()}),
      points);
  const Framing framing{scene_.camera.up, scene_.camera.fov, std::nullopt, Vec3(axes_.row(2))};
  const Viewpoint all = frame_points(points, framing);
  return {all.position - usual.position, all.target - usual.target};
}

void Reframing::look() {
  if (follows_.empty()) return;
  const double time = built_.world.time(), step = 1.0 / scene_.world.steps_per_second;
  const Viewpoint usual = usual_at(time);
  const geometry::Box all = survey({usual, axes_});
  if (!is_empty(all)) {
    const bool is_first = is_empty(stage_);
    const double closer = step / (kCalm + step);
    if (!is_first) {
      stage_.low += closer * (all.low - stage_.low).cwiseMax(0.0);
      stage_.high += closer * (all.high - stage_.high).cwiseMin(0.0);
    }
    stage_.include(all);
    if (is_first) least_side_ = (stage_.high - stage_.low).maxCoeff();
  }
  const Shift goal = wanted(usual);
  const double share = step / (kHaste + step);
  before_ = now_;
  first_ = first_.towards(goal, share);
  now_ = now_.towards(first_, share);
}

Shift Reframing::shift(double share) const {
  return before_.towards(now_, share);
}

}  // namespace shatterbox::sandbox::view
