// World -> render::Frame: the one bridge between engine and render, and between Eigen and GLM. A frame is a
// value: the world may step on while it is drawn.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/body/shape.h"
#include "render/frame/frame.h"
#include "sandbox/scene/build_world.h"
#include "sandbox/scene/scene_description.h"
#include "sandbox/view/camera.h"

namespace shatterbox::sandbox::view {

/// What a frame of the film shows.
struct Moment {
  double film = 0.0;    // s of the film
  double time = 0.0;    // s of the world
  double factor = 1.0;  // seconds of the world in a second of the film
  std::span<const body::Body> bodies;
};

class View {
 public:
  /// `scene` and `built` must outlive the view.
  View(const scene::SceneDescription& scene, const scene::BuiltScene& built);

  /// The picture of a moment, which is now or at most a step ago.
  render::Frame make_frame(const Moment& moment);
  /// The picture of the world as it is now.
  render::Frame make_frame();

 private:
  struct DrawnShape {
    std::shared_ptr<const body::Shape> shape;  // kept, so that its address is not used again
    std::shared_ptr<const render::Mesh> mesh;
    std::uint64_t last_frame = 0;
  };

  std::shared_ptr<const render::Mesh> mesh_of(const std::shared_ptr<const body::Shape>& shape);
  const std::vector<render::Look>& looks_of(body::BodyId original);
  bool is_hidden(body::BodyId original) const;
  /// Time, bodies, pieces, and how fast the film goes where it is not as the world does.
  std::string standard_caption(const Moment& moment) const;
  void add_body(const body::Body& body, render::Frame& frame);

  const scene::SceneDescription& scene_;
  const scene::BuiltScene& built_;
  Subject subject_;
  render::Frame stage_;  // everything but the bodies
  std::map<const body::Shape*, DrawnShape> shapes_;
  std::map<body::BodyId, std::vector<render::Look>> looks_;
  std::uint64_t next_mesh_ = 1;
  std::uint64_t frame_ = 0;
};

/// The mesh to draw of a shape; `id` as render::Mesh wants it. Planes become a wide slab below their surface.
std::shared_ptr<const render::Mesh> make_mesh(const body::Shape& shape, std::uint64_t id);

}  // namespace shatterbox::sandbox::view
