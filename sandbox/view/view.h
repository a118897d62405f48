// World -> render::Frame: the one bridge between engine and render, and between Eigen and GLM. A frame is a
// value: the world may step on while it is drawn.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/body/shape.h"
#include "render/frame/frame.h"
#include "sandbox/scene/build_world.h"
#include "sandbox/scene/scene_description.h"
#include "sandbox/view/camera_rig.h"
#include "sandbox/view/level_set_slice.h"
#include "sandbox/view/moment.h"
#include "sandbox/view/overlays.h"
#include "sandbox/view/wardrobe.h"

namespace shatterbox::sandbox::view {

class View {
 public:
  /// `scene` and `built` must outlive the view. Views whose frames one renderer draws have different numbers
  /// of their `shot`.
  View(const scene::SceneDescription& scene, const scene::BuiltScene& built, int shot = 0);

  /// What the script asks of the picture, not later than `moment`.
  void begin(const scene::Cue& cue, const Moment& moment);

  /// Where the camera is at a moment, which is now or at most a step ago.
  render::Camera camera_at(const Moment& moment);
  /// The picture of a moment, which is now or at most a step ago.
  /// `lens`: through which point of the lens, whose radius is 1 (only where [camera] has an aperture).
  render::Frame make_frame(const Moment& moment, glm::vec2 lens = {0.0F, 0.0F});
  /// The picture of the world as it is now.
  render::Frame make_frame();

  /// What has been made for overlays: level sets of what is in the last frame, with kept triangles' work; and
  /// bodies with something laid over them, with its bytes, in the frame that had most.
  std::vector<world::PartCount> inventory() const;

 private:
  struct DrawnShape {
    std::shared_ptr<const body::Shape> shape;  // kept, so that its address is not used again
    std::shared_ptr<const render::Mesh> mesh;
    std::optional<GrainMesh> grains;
    std::unique_ptr<SliceShelf> slices;  // only where the overlay has asked
    std::uint64_t last_frame = 0;
  };

  DrawnShape& drawn_of(const std::shared_ptr<const body::Shape>& shape);
  world::PartCount level_sets() const;
  void count_laid_over(const render::Frame& frame);
  /// Where body number `entry` is at a moment.
  Whereabouts whereabouts(const Moment& moment) const;
  /// Time, bodies, pieces, and how fast the film goes where it is not as the world does.
  std::string standard_caption(const Moment& moment) const;
  void add_body(const body::Body& body, render::Frame& frame);
  /// What the overlay makes of a draw.
  void lay_over(const body::Body& body, DrawnShape& drawn, const render::Camera& camera, render::Draw& draw);
  void cut_open(const body::Body& body, DrawnShape& drawn, const Vec3& eye, render::Draw& draw);
  /// Balls where impacts were evaluated a moment ago.
  void mark_impacts(const Moment& moment, render::Frame& frame);
  render::Title title_at(double film) const;
  /// Moves the eye across the lens and turns it so that what is in focus stays where it is in the picture.
  void look_through(glm::vec2 lens, const Moment& moment, render::Camera& camera) const;

  const scene::SceneDescription& scene_;
  const scene::BuiltScene& built_;
  CameraRig camera_;
  Wardrobe wardrobe_;
  Overlays overlays_;
  render::Frame stage_;  // everything but the bodies
  scene::Cue caption_;   // the last one; its event is null before the first
  std::map<const body::Shape*, DrawnShape> shapes_;
  std::map<std::size_t, geometry::LevelSetSpace> level_set_spaces_;  // by entries of the scene
  std::shared_ptr<const render::Mesh> marker_;
  world::PartCount laid_over_{"overlays", 0, 0.0};
  std::uint64_t next_mesh_;
  std::uint64_t frame_ = 0;
};

/// The mesh to draw of a shape; `id` as render::Mesh wants it. Planes become a wide slab below their surface.
std::shared_ptr<const render::Mesh> make_mesh(const body::Shape& shape, std::uint64_t id);
/// Where that slab is.
Pose pose_of_slab(const Pose& plane);

}  // namespace shatterbox::sandbox::view
