#include "sandbox/view/view.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/core/hash.h"
#include "sandbox/view/looks.h"
#include "sandbox/view/to_glm.h"

namespace shatterbox::sandbox::view {

namespace {

constexpr double kSlabWidth = 40.0;  // m: how much of a tilted plane is drawn
constexpr double kSlabDepth = 0.4;   // m

bool is_level(const body::Body& body) {
  const Vec3 normal = body.pose.rotation * Vec3::UnitY();
  return normal.y() > 1.0 - 1e-9;
}

bool is_drawn_as_ground(const body::Body& body) {
  return body.shape->kind == body::ShapeKind::plane && is_level(body);
}

std::shared_ptr<const render::Mesh> make_surface_mesh(const body::Shape& shape, std::uint64_t id) {
  auto mesh = std::make_shared<render::Mesh>();
  mesh->id = id;
  mesh->surface = shape.kind == body::ShapeKind::solid ? render::Surface::solid : render::Surface::shell;
  mesh->thickness = static_cast<float>(shape.thickness);
  mesh->parts = shape.triangle_parts;
  for (const Vec3& p : shape.surface.positions) {
    mesh->positions.push_back(to_glm(p));
    mesh->pattern_positions.push_back(to_glm(p + shape.material_from_body));
  }
  const bool has_cracks =
      shape.crack_edges.size() == shape.topology.edges.size() && !shape.crack_edges.empty();
  for (std::size_t t = 0; t < shape.surface.triangles.size(); ++t) {
    const geometry::Triangle& triangle = shape.surface.triangles[t];
    mesh->triangles.emplace_back(triangle[0], triangle[1], triangle[2]);
    if (!has_cracks) continue;
    constexpr std::array<std::uint8_t, 3> kBits{render::kCrackEdge0, render::kCrackEdge1,
                                                render::kCrackEdge2};
    unsigned bits = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const int edge = shape.topology.triangle_edges[t][i];
      if (shape.crack_edges[static_cast<std::size_t>(edge)] != 0) bits |= kBits[i];
    }
    mesh->cracks.push_back(static_cast<std::uint8_t>(bits));
  }
  return mesh;
}

/// Stress in MPa at the vertices of a shell: the mean of the triangles about each.
std::shared_ptr<const std::vector<float>> vertex_stress(const body::Shape& shape,
                                                        const std::vector<double>& triangle_stress) {
  if (triangle_stress.size() != shape.surface.triangles.size() || triangle_stress.empty()) return nullptr;
  std::vector<double> sum(shape.surface.positions.size(), 0.0), count(sum.size(), 0.0);
  for (std::size_t t = 0; t < triangle_stress.size(); ++t) {
    for (const int corner : shape.surface.triangles[t]) {
      sum[static_cast<std::size_t>(corner)] += triangle_stress[t] * 1e-6;
      count[static_cast<std::size_t>(corner)] += 1.0;
    }
  }
  auto values = std::make_shared<std::vector<float>>();
  for (std::size_t v = 0; v < sum.size(); ++v) {
    values->push_back(count[v] > 0.0 ? static_cast<float>(sum[v] / count[v]) : 0.0F);
  }
  return values;
}

/// The colour of one copy: drawn from the list by the numbers of the body and the copy.
std::optional<Vec3> colour_of(const scene::LookEntry& look, std::size_t entry, int copy) {
  if (look.colours.empty()) return std::nullopt;
  const std::uint64_t draw =
      core::Hash(std::uint64_t{entry}).add(static_cast<std::uint64_t>(copy)).value() >> 16U;
  return look.colours[static_cast<std::size_t>(draw % look.colours.size())];
}

render::Lights make_lights(const scene::LightEntry& entry) {
  render::Lights lights;
  if (entry.sun_direction) lights.sun_direction = to_glm(*entry.sun_direction);
  if (entry.sun_colour) lights.sun_colour = linear_colour(*entry.sun_colour);
  if (entry.sun_strength) lights.sun_strength = static_cast<float>(*entry.sun_strength);
  if (entry.sun_size) lights.sun_size = static_cast<float>(*entry.sun_size);
  if (entry.sky) lights.sky_strength = static_cast<float>(*entry.sky);
  lights.casts_shadow = entry.casts_shadow;
  return lights;
}

std::optional<render::Ground> make_ground_of(const scene::SceneDescription& scene,
                                             const scene::BuiltScene& built) {
  std::optional<double> height;
  for (const body::Body& body : built.world.bodies()) {
    if (!is_drawn_as_ground(body)) continue;
    height = std::max(height.value_or(body.pose.translation.y()), body.pose.translation.y());
  }
  if (!height) return std::nullopt;
  auto ground = make_ground(scene.render.ground.empty() ? "plain" : scene.render.ground, *height);
  if (!ground) return ground;
  if (scene.render.ground_colour) ground->colour = linear_colour(*scene.render.ground_colour);
  if (scene.render.checker > 0.0) ground->checker = static_cast<float>(scene.render.checker);
  return ground;
}

/// The stress scale ends at the greatest strength of what can break, so that red means near breaking.
render::Overlay make_overlay(const scene::SceneDescription& scene) {
  render::Overlay overlay;
  if (scene.render.overlay == "pieces") overlay.kind = render::OverlayKind::pieces;
  if (scene.render.overlay != "stress") return overlay;
  overlay.kind = render::OverlayKind::stress;
  double most = 0.0;
  for (const scene::BodyEntry& body : scene.bodies) {
    const auto* shell = std::get_if<scene::ShellForm>(&body.form);
    if (shell == nullptr || !shell->is_breakable) continue;
    most = std::max(most, scene.materials[static_cast<std::size_t>(body.material)].material.strength * 1e-6);
  }
  overlay.most = static_cast<float>(scene.render.overlay_most.value_or(most > 0.0 ? most : 1.0));
  overlay.title = "tension";
  return overlay;
}

}  // namespace

std::shared_ptr<const render::Mesh> make_mesh(const body::Shape& shape, std::uint64_t id) {
  switch (shape.kind) {
    case body::ShapeKind::box:
      return render::make_box(id, to_glm(2.0 * shape.half_extent));
    case body::ShapeKind::sphere:
      return render::make_sphere(id, static_cast<float>(shape.radius));
    case body::ShapeKind::plane:
      return render::make_box(id, to_glm(Vec3(kSlabWidth, kSlabDepth, kSlabWidth)));
    case body::ShapeKind::shell:
    case body::ShapeKind::solid:
      break;
  }
  return make_surface_mesh(shape, id);
}

View::View(const scene::SceneDescription& scene, const scene::BuiltScene& built)
    : scene_(scene), built_(built), subject_(find_subject(scene, built.plan)) {
  stage_.lights = make_lights(scene.light);
  stage_.ground = make_ground_of(scene, built);
  stage_.backdrop = make_backdrop(scene.render.backdrop);
  stage_.overlay = make_overlay(scene);
  stage_.exposure = static_cast<float>(scene.render.exposure);
}

std::shared_ptr<const render::Mesh> View::mesh_of(const std::shared_ptr<const body::Shape>& shape) {
  DrawnShape& drawn = shapes_[shape.get()];
  if (!drawn.mesh) {
    drawn.shape = shape;
    drawn.mesh = make_mesh(*shape, next_mesh_++);
  }
  drawn.last_frame = frame_;
  return drawn.mesh;
}

const std::vector<render::Look>& View::looks_of(body::BodyId original) {
  auto [place, is_new] = looks_.try_emplace(original);
  if (!is_new) return place->second;
  const auto found = built_.origins.find(original);
  if (found == built_.origins.end()) {
    place->second = make_looks("matt", std::nullopt, 0.1, Vec3::Zero());
    return place->second;
  }
  const auto number = static_cast<std::size_t>(found->second.entry);
  const scene::BodyEntry& entry = scene_.bodies[number];
  const scene::BodyPlan& plan = built_.plan.bodies[number];
  std::string name = entry.look.name.empty() ? scene_.render.look : entry.look.name;
  const auto& material = scene_.materials[static_cast<std::size_t>(entry.material)];
  if (name.empty()) name = usual_look(material.preset);
  place->second =
      make_looks(name, colour_of(entry.look, number, found->second.copy), plan.bounding_radius, -plan.centre);
  return place->second;
}

/// A look "hidden" is for walls that would stand before the camera.
bool View::is_hidden(body::BodyId original) const {
  const auto found = built_.origins.find(original);
  return found != built_.origins.end() &&
         scene_.bodies[static_cast<std::size_t>(found->second.entry)].look.name == "hidden";
}

void View::add_body(const body::Body& body, render::Frame& frame) {
  if (is_drawn_as_ground(body)) return;
  const world::Ancestry ancestry = built_.world.ancestry(body.id);
  if (is_hidden(ancestry.original != 0 ? ancestry.original : body.id)) return;
  render::Draw draw;
  draw.mesh = mesh_of(body.shape);
  Pose pose = body.pose;
  if (body.shape->kind == body::ShapeKind::plane) {
    pose.translation = pose.apply(Vec3(0.0, -0.5 * kSlabDepth, 0.0));
  }
  draw.world_from_body = to_glm(pose);
  draw.looks = looks_of(ancestry.original != 0 ? ancestry.original : body.id);
  const bool is_piece = ancestry.parent != 0;
  draw.colour_index = is_piece ? body.id : render::Draw::kNoColour;
  if (frame.overlay.kind == render::OverlayKind::stress && body::is_mesh(body.shape->kind)) {
    draw.scalars = vertex_stress(*body.shape, built_.world.stress_picture(body.id).triangle_stress);
  }
  frame.draws.push_back(std::move(draw));
}

std::string View::standard_caption(const Moment& moment) const {
  const auto pieces =
      std::count_if(moment.bodies.begin(), moment.bodies.end(),
                    [this](const body::Body& body) { return built_.world.ancestry(body.id).parent != 0; });
  std::string text = fmt::format("{:.2f} s   {} bodies", moment.time, moment.bodies.size());
  if (pieces > 0) text += fmt::format("   {} pieces", pieces);
  if (std::abs(moment.factor - 1.0) > 5e-4) text += fmt::format("   speed {:.3g}", moment.factor);
  return text;
}

render::Frame View::make_frame(const Moment& moment) {
  ++frame_;
  render::Frame frame = stage_;
  frame.camera = camera_at(scene_.camera, subject_, moment.time);
  for (const body::Body& body : moment.bodies) add_body(body, frame);
  std::erase_if(shapes_, [this](const auto& entry) { return entry.second.last_frame != frame_; });
  if (scene_.render.has_caption) frame.caption = standard_caption(moment);
  return frame;
}

render::Frame View::make_frame() {
  const double time = built_.world.time();
  return make_frame({time, time, 1.0, built_.world.bodies()});
}

}  // namespace shatterbox::sandbox::view
