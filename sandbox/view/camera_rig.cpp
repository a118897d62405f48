#include "sandbox/view/camera_rig.h"

#include <algorithm>

#include "engine/dynamics/free_motion.h"
#include "sandbox/view/to_glm.h"

namespace shatterbox::sandbox::view {

namespace {

/// How much of a move is done at `film`.
double share_of(const scene::CameraChange& change, double begin, double film) {
  if (!(change.duration > 0.0)) return 1.0;
  const double x = std::clamp((film - begin) / change.duration, 0.0, 1.0);
  return change.is_smooth ? x * x * (3.0 - 2.0 * x) : x;
}

void go(Vec3& from, const Vec3& to, double share) {
  from += share * (to - from);
}

}  // namespace

void CameraRig::apply(Shot& shot, double film, const Whereabouts& where, Viewpoint& view) const {
  const scene::CameraChange& change = shot.change;
  const double share = share_of(change, shot.film, film);
  switch (change.move) {
    case scene::CameraMove::cut:
    case scene::CameraMove::dolly:
      if (change.position) {
        go(view.position, *change.position, share);
        view.least_aspect *= 1.0 - share;
      }
      if (change.target) go(view.target, *change.target, share);
      if (change.fov) view.fov += share * (*change.fov - view.fov);
      break;
    case scene::CameraMove::orbit:
      view.position = view.target + dynamics::rotation_by(share * change.angle * entry_.up.normalized()) *
                                        (view.position - view.target);
      break;
    case scene::CameraMove::follow:
      if (const auto place = where(shot.who)) shot.last_seen = place;
      if (!shot.last_seen) break;
      go(view.target, *shot.last_seen, share);
      if (change.offset) go(view.position, *shot.last_seen + *change.offset, share);
      break;
  }
}

Viewpoint CameraRig::view_at(const Moment& moment, const Whereabouts& where) {
  Viewpoint view = cut_ ? *cut_ : viewpoint_at(entry_, subject_, moment.time);
  if (!cut_) {
    view.position += moment.shift.position;
    view.target += moment.shift.target;
  }
  if (!cut_ && entry_.follow.body >= 0) {
    if (const auto place = where(entry_.follow)) last_seen_ = place;
    if (last_seen_) {
      view.target = *last_seen_;
      if (entry_.offset) view.position = *last_seen_ + *entry_.offset;
    }
  }
  for (Shot& shot : shots_) apply(shot, moment.film, where, view);
  return view;
}

void CameraRig::begin(const scene::CameraChange& change, scene::BodyRef who, double film,
                      const Moment& moment, const Whereabouts& where) {
  Shot shot{change, who, film, std::nullopt};
  if (change.move == scene::CameraMove::cut) {
    Viewpoint view = view_at(moment, where);
    apply(shot, film, where, view);
    cut_ = view;
    shots_.clear();
    return;
  }
  shots_.push_back(shot);
}

render::Camera CameraRig::at(const Moment& moment, const Whereabouts& where) {
  Viewpoint view = view_at(moment, where);
  // Moves that meet in one point leave no way to look: level ahead then.
  if ((view.target - view.position).norm() < 1e-9) view.target.z() -= 1.0;
  render::Camera camera;
  camera.up = to_glm(entry_.up);
  camera.position = to_glm(view.position);
  camera.target = to_glm(view.target);
  camera.vertical_fov = static_cast<float>(view.fov);
  camera.least_aspect = static_cast<float>(view.least_aspect);
  return camera;
}

}  // namespace shatterbox::sandbox::view
