// What can be laid over the picture to see why things break: stress, pieces, grains, impacts, velocity,
// wires, level sets.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/body/body.h"
#include "render/frame/frame.h"
#include "sandbox/scene/build_world.h"
#include "sandbox/scene/scene_description.h"

namespace shatterbox::sandbox::view {

class Overlays {
 public:
  /// Begins with the scene's own. Both must outlive it.
  Overlays(const scene::SceneDescription& scene, const scene::BuiltScene& built);

  /// `name` of scene::kOverlayNames; `most`: top of its scale, in its unit.
  void show(const std::string& name, const std::optional<double>& most);

  const std::string& name() const { return name_; }
  render::Overlay overlay() const;

 private:
  const scene::SceneDescription& scene_;
  const scene::BuiltScene& built_;
  std::string name_;
  std::optional<double> most_;
};

/// A shell whose triangles share no vertex with another grain's, and a number for each vertex's grain.
struct GrainMesh {
  std::shared_ptr<const render::Mesh> mesh;
  std::shared_ptr<const std::vector<float>> groups;  // 0..1
};

/// Nothing if the shape has no grains.
std::optional<GrainMesh> make_grain_mesh(const body::Shape& shape, const render::Mesh& mesh,
                                         std::uint64_t id);

/// Stress in MPa at the vertices of a shape's surface: the mean of the triangles about each.
std::shared_ptr<const std::vector<float>> vertex_stress(const body::Shape& shape,
                                                        const std::vector<double>& triangle_stress);

/// How fast each vertex of a body's mesh is, m/s.
std::shared_ptr<const std::vector<float>> vertex_speed(const body::Body& body, const render::Mesh& mesh);

}  // namespace shatterbox::sandbox::view
