// The film as an animated model, glTF 2.0: a static mesh a body or piece, which is there from its birth to
// its end (scale 0 or 1, in steps) and whose pose has a key a frame. Metres, y up, as everywhere here.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/frame/frame.h"
#include "sandbox/model/glb_file.h"
#include "sandbox/model/track.h"
#include "sandbox/view/moment.h"
#include "sandbox/view/wardrobe.h"

namespace shatterbox::sandbox::model {

class ModelFilm {
 public:
  /// `scene` and `built` must outlive it. `aspect`: width over height of the pictures.
  ModelFilm(const scene::SceneDescription& scene, const scene::BuiltScene& built, int frames_per_second,
            double aspect);

  /// The next frame: what is there, and who looks at it.
  void add(const view::Moment& moment, const render::Camera& camera);

  /// A sentence if it cannot be written, else empty. Once, after the last frame.
  std::string write(const std::string& path);

 private:
  struct Actor {
    std::string name;
    int mesh = 0;
    int first = 0, last = 0;  // frames
    Json extras;
    Track<glm::vec3> places;
    Track<glm::vec4> turns;  // quaternions: x, y, z, w
    void add(int frame, const glm::vec3& place, const glm::vec4& turn);
  };
  /// The vertices of a shape on file, and its triangles by the face and part they show.
  struct Geometry {
    std::shared_ptr<const body::Shape> shape;  // kept, so that its address is not used again
    int positions = 0, normals = 0;
    std::vector<std::pair<std::uint32_t, int>> groups;  // face and part as render::DrawnVertex; indices
  };

  void add_body(const body::Body& body);
  /// The level plane, as far as the picture may show it.
  void add_floor(const render::Camera& camera);
  void add_camera(const render::Camera& camera);
  const Geometry& geometry_of(const std::shared_ptr<const body::Shape>& shape);
  Geometry add_geometry(const render::Mesh& mesh);
  int mesh_of(const body::Body& body, const std::string& owner);
  int add_mesh(const Geometry& geometry, const std::vector<render::Look>& looks, const std::string& name);
  int material_of(const render::Look& look, std::uint32_t face, const std::string& name);
  int add_node(const Actor& actor);
  void animate(int node, const char* path, const std::vector<int>& frames, int values, const char* how);

  const scene::SceneDescription& scene_;
  const scene::BuiltScene& built_;
  view::Wardrobe wardrobe_;
  int frames_per_second_;
  double aspect_;
  int frame_ = -1;  // the last one
  GlbFile file_;
  std::map<std::string, Geometry> geometries_;
  std::map<std::string, int> materials_;                    // by what they are
  std::map<std::pair<int, std::vector<int>>, int> meshes_;  // by positions and materials
  std::map<body::BodyId, Actor> actors_;
  std::optional<Actor> camera_, floor_;
  std::vector<Json> channels_, samplers_;
};

}  // namespace shatterbox::sandbox::model
