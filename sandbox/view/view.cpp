#include "sandbox/view/view.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/core/elementary.h"
#include "sandbox/scene/parts.h"
#include "sandbox/scene/words.h"
#include "sandbox/view/looks.h"
#include "sandbox/view/to_glm.h"

namespace shatterbox::sandbox::view {

namespace {

constexpr double kSlabWidth = 40.0;  // m: how much of a tilted plane is drawn
constexpr double kSlabDepth = 0.4;   // m

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
    if (!shape.crack_faces.empty())
      mesh->cracks.push_back(shape.crack_faces[t] != 0 ? render::kCrackFace : std::uint8_t{0});
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

render::Lights make_lights(const scene::LightEntry& entry) {
  render::Lights lights = make_light(entry.preset);
  if (entry.sun_direction) lights.sun_direction = to_glm(*entry.sun_direction);
  if (entry.sun_colour) lights.sun_colour = linear_colour(*entry.sun_colour);
  if (entry.sun_strength) lights.sun_strength = static_cast<float>(*entry.sun_strength);
  if (entry.sun_size) lights.sun_size = static_cast<float>(*entry.sun_size);
  if (entry.sky) lights.sky_strength = static_cast<float>(*entry.sky);
  lights.casts_shadow = entry.casts_shadow;
  return lights;
}

}  // namespace

std::shared_ptr<const render::Mesh> make_mesh(const body::Shape& shape, std::uint64_t id) {
  switch (shape.kind) {
    case body::ShapeKind::box:
      return render::make_box(id, to_glm(2.0 * shape.half_extent));
    case body::ShapeKind::sphere:
      return render::make_sphere(id, static_cast<float>(shape.radius));
    case body::ShapeKind::capsule:
      return render::make_capsule(id, static_cast<float>(shape.radius),
                                  static_cast<float>(2.0 * shape.half_length));
    case body::ShapeKind::plane:
      return render::make_box(id, to_glm(Vec3(kSlabWidth, kSlabDepth, kSlabWidth)));
    case body::ShapeKind::shell:
    case body::ShapeKind::solid:
      break;
  }
  return make_surface_mesh(shape, id);
}

Pose pose_of_slab(const Pose& plane) {
  return {plane.rotation, plane.apply(Vec3(0.0, -0.5 * kSlabDepth, 0.0))};
}

View::View(const scene::SceneDescription& scene, const scene::BuiltScene& built, int shot)
    : scene_(scene),
      built_(built),
      camera_(scene.camera, find_subject(scene, built.plan)),
      wardrobe_(scene, built),
      overlays_(scene, built),
      next_mesh_((static_cast<std::uint64_t>(shot) << 32U) + 1) {
  stage_.lights = make_lights(scene.light);
  stage_.ground = find_ground(scene, built);
  stage_.backdrop = make_backdrop(scene.render.backdrop.empty() ? usual_backdrop(scene.light.preset)
                                                                : scene.render.backdrop);
  stage_.exposure = static_cast<float>(scene.render.exposure);
}

View::DrawnShape& View::drawn_of(const std::shared_ptr<const body::Shape>& shape) {
  DrawnShape& drawn = shapes_[shape.get()];
  if (!drawn.mesh) {
    drawn.shape = shape;
    drawn.mesh = make_mesh(*shape, next_mesh_++);
  }
  drawn.last_frame = frame_;
  return drawn;
}

void View::add_body(const body::Body& body, render::Frame& frame) {
  if (is_drawn_as_ground(body)) return;
  if (wardrobe_.is_hidden(body.id)) return;
  render::Draw draw;
  DrawnShape& drawn = drawn_of(body.shape);
  draw.mesh = drawn.mesh;
  draw.id = body.id;
  const bool is_plane = body.shape->kind == body::ShapeKind::plane;
  const Pose pose = is_plane ? pose_of_slab(body.pose) : body.pose;
  draw.world_from_body = to_glm(pose);
  draw.looks = wardrobe_.looks_of(body.id);
  const bool is_piece = built_.world.ancestry(body.id).parent != 0;
  draw.colour_index = is_piece ? body.id : render::Draw::kNoColour;
  lay_over(body, drawn, frame.camera, draw);
  frame.draws.push_back(std::move(draw));
}

void View::lay_over(const body::Body& body, DrawnShape& drawn, const render::Camera& camera,
                    render::Draw& draw) {
  const std::string& name = overlays_.name();
  const bool is_mesh = body::is_mesh(body.shape->kind);
  if (name == "stress" && is_mesh)
    draw.scalars = vertex_stress(*body.shape, built_.world.stress_picture(body.id).triangle_stress);
  if (name == "velocity" && body.shape->kind != body::ShapeKind::plane)
    draw.scalars = vertex_speed(body, *drawn.mesh);
  if (name == "level_set" && body.shape->kind == body::ShapeKind::solid)
    cut_open(body, drawn, Vec3(camera.position.x, camera.position.y, camera.position.z), draw);
  if (name != "grains" || !is_mesh) return;
  if (!drawn.grains) drawn.grains = make_grain_mesh(*body.shape, *drawn.mesh, next_mesh_++);
  if (!drawn.grains) return;
  draw.mesh = drawn.grains->mesh;
  draw.scalars = drawn.grains->groups;
}

void View::cut_open(const body::Body& body, DrawnShape& drawn, const Vec3& eye, render::Draw& draw) {
  const scene::Origin* origin = scene::origin_of(built_, body.id);
  if (origin == nullptr) return;
  const auto entry = static_cast<std::size_t>(origin->entry);
  const auto [space, is_new] = level_set_spaces_.try_emplace(entry);
  if (is_new) space->second = geometry::make_level_set_space(2.0 * built_.plan.bodies[entry].bounding_radius);
  if (!drawn.slices) drawn.slices = std::make_unique<SliceShelf>();
  if (drawn.slices->level_set(*body.shape, space->second) == nullptr) return;
  const Slice& slice =
      drawn.slices->slice(*body.shape, side_towards(body.pose.apply_inverse(eye)), next_mesh_);
  draw.mesh = slice.mesh;
  draw.scalars = slice.distances;
}

void View::mark_impacts(const Moment& moment, render::Frame& frame) {
  constexpr double kShown = 0.3;      // s of the world
  constexpr double kRadius = 0.012;   // of the picture's height at the impact
  constexpr std::size_t kMost = 300;  // a film of marks shows nothing
  if (!marker_) marker_ = render::make_sphere(next_mesh_++, 1.0F, 16);
  const Vec3 eye(frame.camera.position.x, frame.camera.position.y, frame.camera.position.z);
  const double slope = 2.0 * std::tan(frame.camera.vertical_fov * core::kPi / 360.0);
  const auto& impacts = built_.world.report().impacts;
  std::size_t count = 0;
  for (std::size_t i = impacts.size(); i > 0 && count < kMost; --i) {
    const world::ImpactRow& row = impacts[i - 1];
    const double age = moment.time - row.time;
    if (age > kShown) break;
    if (age < 0.0) continue;
    const auto radius = static_cast<float>(kRadius * slope * (row.place - eye).norm() * (1.0 - age / kShown));
    render::Draw draw;
    draw.mesh = marker_;
    draw.world_from_body = glm::mat4(radius);
    draw.world_from_body[3] = glm::vec4(to_glm(row.place), 1.0F);
    draw.scalars =
        std::make_shared<const std::vector<float>>(marker_->positions.size(), static_cast<float>(row.ratio));
    draw.casts_shadow = false;
    frame.draws.push_back(std::move(draw));
    ++count;
  }
}

Whereabouts View::whereabouts(const Moment& moment) const {
  return [this, &moment](scene::BodyRef who) { return scene::centre_of(built_, moment.bodies, who); };
}

void View::begin(const scene::Cue& cue, const Moment& moment) {
  const scene::EventEntry& event = *cue.event;
  if (const auto* change = std::get_if<scene::CameraChange>(&event.action))
    camera_.begin(*change, event.who, cue.film, moment, whereabouts(moment));
  if (const auto* change = std::get_if<scene::OverlayChange>(&event.action))
    overlays_.show(change->name, change->most);
  if (std::holds_alternative<scene::Caption>(event.action)) caption_ = cue;
}

render::Title View::title_at(double film) const {
  if (caption_.event == nullptr) return {};
  const auto& caption = std::get<scene::Caption>(caption_.event->action);
  const double since = film - caption_.film, left = caption.duration - since;
  if (since < 0.0 || left < 0.0) return {};
  double opacity = 1.0;
  if (caption.fade > 0.0) opacity = std::min({1.0, since / caption.fade, left / caption.fade});
  return {caption.text, static_cast<float>(opacity)};
}

std::string View::standard_caption(const Moment& moment) const {
  const auto pieces =
      std::count_if(moment.bodies.begin(), moment.bodies.end(),
                    [this](const body::Body& body) { return built_.world.ancestry(body.id).parent != 0; });
  std::string text = fmt::format("{:.2f} s   {}", moment.time,
                                 scene::counted(static_cast<long>(moment.bodies.size()), "body", "bodies"));
  if (pieces > 0) text += "   " + scene::counted(static_cast<long>(pieces), "piece");
  if (std::abs(moment.factor - 1.0) > 5e-4) text += fmt::format("   speed {:.3g}", moment.factor);
  return text;
}

render::Camera View::camera_at(const Moment& moment) {
  return camera_.at(moment, whereabouts(moment));
}

void View::look_through(glm::vec2 lens, const Moment& moment, render::Camera& camera) const {
  const scene::CameraEntry& entry = scene_.camera;
  const glm::vec3 way = camera.target - camera.position, forward = glm::normalize(way);
  float distance = glm::length(way);
  if (const double* metres = std::get_if<double>(&entry.focus)) distance = static_cast<float>(*metres);
  if (const scene::BodyRef* body = std::get_if<scene::BodyRef>(&entry.focus))
    if (const auto centre = whereabouts(moment)(*body))
      distance = std::max(glm::dot(to_glm(*centre) - camera.position, forward), 1e-3F * distance);
  const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
  camera.target = camera.position + distance * forward;
  camera.position += static_cast<float>(0.5 * entry.aperture) * (lens.x * right + lens.y * up);
}

render::Frame View::make_frame(const Moment& moment, glm::vec2 lens) {
  ++frame_;
  render::Frame frame = stage_;
  frame.camera = camera_at(moment);
  if (scene_.camera.aperture > 0.0) look_through(lens, moment, frame.camera);
  frame.overlay = overlays_.overlay();
  frame.title = title_at(moment.film);
  for (const body::Body& body : moment.bodies) add_body(body, frame);
  if (overlays_.name() == "impacts") mark_impacts(moment, frame);
  if (overlays_.name() != "none") count_laid_over(frame);
  std::erase_if(shapes_, [this](const auto& entry) { return entry.second.last_frame != frame_; });
  if (scene_.render.has_caption) frame.caption = standard_caption(moment);
  return frame;
}

void View::count_laid_over(const render::Frame& frame) {
  double bytes = 0.0;
  for (const render::Draw& draw : frame.draws)
    if (draw.scalars) bytes += static_cast<double>(draw.scalars->size() * sizeof(float));
  laid_over_.count = std::max(laid_over_.count, static_cast<long>(frame.draws.size()));
  laid_over_.bytes = std::max(laid_over_.bytes, bytes);
}

std::vector<world::PartCount> View::inventory() const {
  return {level_sets(), laid_over_};
}

world::PartCount View::level_sets() const {
  world::PartCount count{"level_sets", 0, 0.0};
  for (const auto& [shape, drawn] : shapes_) {
    if (!drawn.slices) continue;
    count.count += drawn.slices->bytes() > 0.0 ? 1 : 0;
    count.bytes += drawn.slices->bytes();
  }
  for (const auto& [entry, space] : level_set_spaces_) count.bytes += space.patches->figures().bytes;
  return count;
}

render::Frame View::make_frame() {
  const double time = built_.world.time();
  return make_frame({time, time, 1.0, built_.world.bodies()});
}

}  // namespace shatterbox::sandbox::view
