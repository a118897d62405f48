// A camera without a place pulls back and turns to what leaves its picture: what is knocked off a table,
// swings on a chain, or falls when what held it is gone.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "engine/geometry/bvh.h"
#include "sandbox/scene/build_world.h"
#include "sandbox/view/framing.h"
#include "sandbox/view/subject.h"

namespace shatterbox::sandbox::view {

class Reframing {
 public:
  /// All must outlive it; `built` as it is before its first step.
  Reframing(const scene::SceneDescription& scene, const scene::BuiltScene& built, const Subject& subject);

  /// After each step of the world.
  void look();

  /// How far the camera has gone from where it would be, at a share of the last step.
  Shift shift(double share = 1.0) const;

 private:
  /// The picture of the usual eye.
  struct Seen;

  bool is_followed(const body::Body& body) const;
  Vec3 place_ahead(const body::Body& body) const;
  /// About it, in the camera's axes.
  geometry::Box box_of(const body::Body& body);
  /// About all that is followed, in the camera's axes; notes what leaves the picture.
  geometry::Box survey(const Seen& seen);
  /// Where the eye is at a time, s, unless it goes after something.
  Viewpoint usual_at(double time) const;
  Shift wanted(const Viewpoint& usual) const;

  const scene::SceneDescription& scene_;
  const scene::BuiltScene& built_;
  const Subject& subject_;
  std::vector<char> follows_;  // by bodies of the scene
  std::vector<Pose> floors_;   // planes
  Viewpoint usual_;            // at the start
  geometry::Box room_;         // beyond it nothing is followed
  Mat3 axes_;                  // right, up and towards the eye, in rows
  geometry::Box stage_;        // in those axes: where all that is followed is, and was while it moved
  double least_side_ = 0.0;    // m, of the stage's longest
  std::map<body::BodyId, geometry::Box> boxes_;  // in the bodies' own axes
  std::set<body::BodyId> met_;                   // bodies of the scene that have been in the picture
  bool is_off_ = false;                          // the eye has begun to go after something
  Shift first_, before_, now_;  // as the eye begins to go; then as it goes, before the last step and after
};

}  // namespace shatterbox::sandbox::view
