#include "sandbox/model/model_film.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/core/elementary.h"
#include "render/frame/expand.h"
#include "sandbox/report/text_file.h"
#include "sandbox/view/to_glm.h"
#include "sandbox/view/view.h"

namespace shatterbox::sandbox::model {

namespace {

constexpr double kFloorWidth = 4.0;    // of the way from the camera to what it looks at
constexpr double kFloorDepth = 0.01;   // of its width
constexpr double kNearestSeen = 0.01;  // of that way

glm::vec4 to_quaternion(const Quat& rotation) {
  const Quat q = rotation.normalized();
  return {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()),
          static_cast<float>(q.w())};
}

Json array(const glm::vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

Json array(const glm::vec4& v) {
  return Json::array({v.x, v.y, v.z, v.w});
}

Json colour(const glm::vec3& c) {
  const glm::vec3 held = glm::clamp(c, 0.0F, 1.0F);
  return Json::array({held.x, held.y, held.z, 1.0F});
}

/// A camera looks along its -z, y up.
Quat turn_of(const render::Camera& camera) {
  const auto vector = [](const glm::vec3& v) -> Vec3 { return Vec3(v.x, v.y, v.z); };
  const Vec3 back = (vector(camera.position) - vector(camera.target)).normalized();
  const Vec3 right = vector(camera.up).cross(back).normalized();
  Mat3 axes;
  axes << right, back.cross(right), back;
  return Quat(axes);
}

Json material_json(const render::Look& look, render::Face face) {
  const bool is_crack = face == render::Face::crack, is_inside = face == render::Face::inside;
  const float metal = is_crack ? 0.0F : is_inside ? look.inside_metalness : look.metalness;
  const float rough = is_crack ? look.crack_roughness : is_inside ? look.inside_roughness : look.roughness;
  const float coat = is_crack ? 0.0F : is_inside ? 0.5F * look.clear_coat : look.clear_coat;
  const float clear = is_crack ? 0.25F * look.transmission : look.transmission;
  Json json;
  json["pbrMetallicRoughness"] = {{"baseColorFactor", colour(is_crack    ? look.crack
                                                             : is_inside ? look.inside
                                                                         : look.outside)},
                                  {"metallicFactor", std::clamp(metal, 0.0F, 1.0F)},
                                  {"roughnessFactor", std::clamp(rough, 0.0F, 1.0F)}};
  if (clear > 0.0F) json["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", clear}};
  if (coat > 0.0F)
    json["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", coat},
                                                     {"clearcoatRoughnessFactor", look.clear_coat_roughness}};
  return json;
}

}  // namespace

void ModelFilm::Actor::add(int frame, const glm::vec3& place, const glm::vec4& turn) {
  last = frame;
  places.add(frame, place);
  // A quaternion and its opposite are one turn; between keys it goes the short way round.
  const bool is_opposite = !turns.values().empty() && glm::dot(turns.last(), turn) < 0.0F;
  turns.add(frame, is_opposite ? -turn : turn);
}

ModelFilm::ModelFilm(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                     int frames_per_second, double aspect)
    : scene_(scene),
      built_(built),
      wardrobe_(scene, built),
      frames_per_second_(frames_per_second),
      aspect_(aspect) {}

void ModelFilm::add(const view::Moment& moment, const render::Camera& camera) {
  ++frame_;
  if (frame_ == 0) add_floor(camera);
  add_camera(camera);
  for (const body::Body& body : moment.bodies)
    if (!view::is_drawn_as_ground(body) && !wardrobe_.is_hidden(body.id)) add_body(body);
}

void ModelFilm::add_body(const body::Body& body) {
  Actor& actor = actors_[body.id];
  if (actor.name.empty()) {
    const world::Ancestry ancestry = built_.world.ancestry(body.id);
    actor.name = fmt::format("{}#{}", body.name, body.id);
    actor.first = frame_;
    actor.mesh = mesh_of(body, body.name);
    actor.extras = {{"body", body.id}, {"birth_s", ancestry.birth_time}, {"mass_kg", body.shape->mass}};
    if (ancestry.parent != 0) actor.extras["parent"] = ancestry.parent;
    if (ancestry.parent != 0) actor.extras["original"] = ancestry.original;
    actor.extras["material"] = built_.world.material(body.material).name;
  }
  const bool is_plane = body.shape->kind == body::ShapeKind::plane;
  const Pose pose = is_plane ? view::pose_of_slab(body.pose) : body.pose;
  actor.add(frame_, view::to_glm(pose.translation), to_quaternion(pose.rotation));
}

void ModelFilm::add_floor(const render::Camera& camera) {
  const std::optional<render::Ground> ground = view::find_ground(scene_, built_);
  if (!ground) return;
  const auto width = static_cast<float>(kFloorWidth) * glm::distance(camera.position, camera.target);
  const float depth = static_cast<float>(kFloorDepth) * width;
  floor_ = Actor();
  floor_->name = "floor";
  floor_->extras = {{"plane", true}};
  floor_->mesh = add_mesh(add_geometry(*render::make_box(1, {width, depth, width})),
                          {render::matt(ground->colour)}, "floor");
  floor_->add(0, {camera.target.x, ground->height - 0.5F * depth, camera.target.z}, {0, 0, 0, 1});
}

void ModelFilm::add_camera(const render::Camera& camera) {
  if (!camera_) {
    camera_ = Actor();
    camera_->name = "camera";
    const double away = glm::distance(camera.position, camera.target);
    file_.json["cameras"] =
        Json::array({{{"type", "perspective"},
                      {"perspective",
                       {{"aspectRatio", aspect_},
                        {"yfov", 2.0 * core::atan2(camera.slope(static_cast<float>(aspect_)), 1.0)},
                        {"znear", kNearestSeen * away}}}}});
  }
  camera_->add(frame_, camera.position, to_quaternion(turn_of(camera)));
}

const ModelFilm::Geometry& ModelFilm::geometry_of(const std::shared_ptr<const body::Shape>& shape) {
  // Meshes are told apart by their address, boxes and spheres by what they are: each has a shape of its own.
  const bool is_mesh = body::is_mesh(shape->kind);
  const Vec3& h = shape->half_extent;
  const std::string key = is_mesh ? fmt::format("{}", static_cast<const void*>(shape.get()))
                                  : fmt::format("{} {} {} {} {}", static_cast<int>(shape->kind), h.x(), h.y(),
                                                h.z(), shape->radius);
  const auto [place, is_new] = geometries_.try_emplace(key);
  if (is_new) {
    place->second = add_geometry(*view::make_mesh(*shape, 1));
    place->second.shape = shape;
  }
  return place->second;
}

ModelFilm::Geometry ModelFilm::add_geometry(const render::Mesh& mesh) {
  const render::DrawnMesh drawn = render::expand(mesh);
  std::vector<glm::vec3> positions, normals;
  for (const render::DrawnVertex& vertex : drawn.vertices) {
    positions.push_back(vertex.position);
    normals.push_back(glm::normalize(glm::vec3(vertex.normal[0], vertex.normal[1], vertex.normal[2])));
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> groups;
  const std::size_t end = drawn.outer.count + drawn.inner.count + drawn.rim.count;
  for (std::size_t i = 0; i < end; i += 3) {
    std::vector<std::uint32_t>& group = groups[drawn.vertices[drawn.indices[i]].face_part];
    for (std::size_t k = 0; k < 3; ++k) group.push_back(drawn.indices[i + k]);
  }
  Geometry geometry;
  geometry.positions = file_.add_positions(positions);
  geometry.normals = file_.add_normals(normals);
  for (const auto& [face_part, indices] : groups)
    geometry.groups.emplace_back(face_part, file_.add_indices(indices));
  return geometry;
}

int ModelFilm::mesh_of(const body::Body& body, const std::string& owner) {
  return add_mesh(geometry_of(body.shape), wardrobe_.looks_of(body.id), owner);
}

int ModelFilm::add_mesh(const Geometry& geometry, const std::vector<render::Look>& looks,
                        const std::string& name) {
  // Pieces have their whole's materials, copies one.
  const std::string owner = name.substr(0, name.find_first_of("/["));
  std::vector<int> materials;
  for (const auto& [face_part, indices] : geometry.groups) {
    const std::size_t part = std::min<std::size_t>(face_part >> 8U, looks.size() - 1);
    materials.push_back(material_of(looks[part], face_part & 255U, owner));
  }
  const auto [place, is_new] =
      meshes_.try_emplace({geometry.positions, materials}, static_cast<int>(meshes_.size()));
  if (!is_new) return place->second;
  Json primitives = Json::array();
  for (std::size_t i = 0; i < materials.size(); ++i)
    primitives.push_back({{"attributes", {{"POSITION", geometry.positions}, {"NORMAL", geometry.normals}}},
                          {"indices", geometry.groups[i].second},
                          {"material", materials[i]}});
  file_.json["meshes"].push_back({{"name", name}, {"primitives", std::move(primitives)}});
  return place->second;
}

int ModelFilm::material_of(const render::Look& look, std::uint32_t face, const std::string& name) {
  constexpr std::array<const char*, 3> kFaceNames{"outside", "inside", "crack"};
  Json json = material_json(look, static_cast<render::Face>(face));
  json["name"] = fmt::format("{} {}", name, kFaceNames[face]);
  const auto [place, is_new] = materials_.try_emplace(json.dump(), static_cast<int>(materials_.size()));
  if (!is_new) return place->second;
  const Json extensions = json.value("extensions", Json::object());
  for (const auto& [extension, values] : extensions.items()) {
    Json& used = file_.json["extensionsUsed"];
    if (std::find(used.begin(), used.end(), extension) == used.end()) used.push_back(extension);
  }
  file_.json["materials"].push_back(std::move(json));
  return place->second;
}

void ModelFilm::animate(int node, const char* path, const std::vector<int>& frames, int values,
                        const char* how) {
  std::vector<float> times;
  for (const int frame : frames)
    times.push_back(static_cast<float>(static_cast<double>(frame) / frames_per_second_));
  samplers_.push_back({{"input", file_.add_times(times)}, {"interpolation", how}, {"output", values}});
  channels_.push_back({{"sampler", samplers_.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
}

int ModelFilm::add_node(const Actor& actor) {
  Json& nodes = file_.json["nodes"];
  const int node = static_cast<int>(nodes.size());
  nodes.push_back({{"name", actor.name},
                   {"translation", array(actor.places.first())},
                   {"rotation", array(actor.turns.first())}});
  if (actor.places.moves())
    animate(node, "translation", actor.places.frames(), file_.add_values(actor.places.values()), "LINEAR");
  if (actor.turns.moves())
    animate(node, "rotation", actor.turns.frames(), file_.add_values(actor.turns.values()), "LINEAR");
  return node;
}

std::string ModelFilm::write(const std::string& path) {
  file_.json["asset"] = {{"version", "2.0"},
                         {"generator", "Shatterbox " SHATTERBOX_VERSION},
                         {"extras",
                          {{"scene", scene_.name},
                           {"seed", scene_.world.seed},
                           {"frames", frame_ + 1},
                           {"frames_per_second", frames_per_second_}}}};
  if (camera_) file_.json["nodes"][static_cast<std::size_t>(add_node(*camera_))]["camera"] = 0;
  if (floor_) {
    Json& node = file_.json["nodes"][static_cast<std::size_t>(add_node(*floor_))];
    node["mesh"] = floor_->mesh;
    node["extras"] = floor_->extras;
  }
  for (auto& [id, actor] : actors_) {
    const int number = add_node(actor);
    Json& node = file_.json["nodes"][static_cast<std::size_t>(number)];
    node["mesh"] = actor.mesh;
    node["extras"] = std::move(actor.extras);
    if (actor.first > 0) node["scale"] = Json::array({0, 0, 0});
    std::vector<int> frames;
    std::vector<glm::vec3> scales;
    const auto show = [&](int frame, float scale) {
      frames.push_back(frame);
      scales.emplace_back(scale);
    };
    if (actor.first > 0) show(0, 0.0F);
    if (actor.first > 0 || actor.last < frame_) show(actor.first, 1.0F);
    if (actor.last < frame_) show(actor.last + 1, 0.0F);
    if (!frames.empty()) animate(number, "scale", frames, file_.add_values(scales), "STEP");
  }
  if (file_.json.contains("nodes")) {
    Json roots = Json::array();
    for (std::size_t i = 0; i < file_.json["nodes"].size(); ++i) roots.push_back(i);
    file_.json["scene"] = 0;
    file_.json["scenes"] = Json::array({{{"name", scene_.name}, {"nodes", std::move(roots)}}});
  }
  if (!channels_.empty())
    file_.json["animations"] =
        Json::array({{{"name", "film"}, {"channels", channels_}, {"samplers", samplers_}}});
  const std::string bytes = file_.bytes();
  if (bytes.empty()) return path + " cannot be written: it would be greater than 4 GB, the most of a .glb";
  return report::write_text(path, bytes);
}

}  // namespace shatterbox::sandbox::model
