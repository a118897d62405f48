// The camera as the script moves it: cuts, dollies, orbits, and bodies that it follows, one upon the other.
#pragma once

#include <optional>
#include <vector>

#include "render/frame/frame.h"
#include "sandbox/view/camera.h"
#include "sandbox/view/moment.h"

namespace shatterbox::sandbox::view {

class CameraRig {
 public:
  CameraRig(const scene::CameraEntry& camera, const Subject& subject) : entry_(camera), subject_(subject) {}

  /// A move begins at `film` (s of the film); `who`: to follow. What it does not say stays as
  /// it is. All moves before a cut are over.
  void begin(const scene::CameraChange& change, scene::BodyRef who, double film, const Moment& moment,
             const Whereabouts& where);

  const Subject& subject() const { return subject_; }

  Viewpoint view_at(const Moment& moment, const Whereabouts& where);
  /// The same in the picture's terms.
  render::Camera at(const Moment& moment, const Whereabouts& where);

 private:
  /// A move that goes on, on top of those before it.
  struct Shot {
    scene::CameraChange change;
    scene::BodyRef who;
    double film = 0.0;
    std::optional<Vec3> last_seen;  // of the body that is followed
  };

  void apply(Shot& shot, double film, const Whereabouts& where, Viewpoint& view) const;

  scene::CameraEntry entry_;
  Subject subject_;
  std::optional<Viewpoint> cut_;  // instead of the scene's own camera
  std::vector<Shot> shots_;
  std::optional<Vec3> last_seen_;  // of the body that the scene's own camera follows
};

}  // namespace shatterbox::sandbox::view
