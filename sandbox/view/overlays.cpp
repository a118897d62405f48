#include "sandbox/view/overlays.h"

#include <algorithm>
#include <limits>
#include <map>

#include "engine/core/elementary.h"
#include "engine/core/hash.h"
#include "engine/geometry/mass_properties.h"
#include "render/frame/expand.h"

namespace shatterbox::sandbox::view {

namespace {

/// MPa: of the strongest that can break, so that red means near breaking.
double greatest_strength(const scene::SceneDescription& scene) {
  double most = 0.0;
  for (const scene::BodyEntry& body : scene.bodies) {
    const scene::MeshForm* form = scene::find_mesh_form(body.form);
    if (form == nullptr || !form->is_breakable) continue;
    most = std::max(most, scene.materials[static_cast<std::size_t>(body.material)].material.strength * 1e-6);
  }
  return most;
}

/// m/s: as fast as things are thrown, or fall from where they are to the lowest of them.
double greatest_speed(const scene::SceneDescription& scene) {
  double most = 0.0;
  double least_height = std::numeric_limits<double>::max(), most_height = -least_height;
  for (const scene::BodyEntry& body : scene.bodies) {
    most = std::max(most, body.velocity.norm());
    const double height = -scene.world.gravity.normalized().dot(body.position);
    least_height = std::min(least_height, height);
    most_height = std::max(most_height, height);
  }
  for (const scene::EventEntry& event : scene.events)
    if (const auto* thrown = std::get_if<scene::Projectile>(&event.action))
      most = std::max(most, thrown->speed);
  if (least_height > most_height) return most;
  return std::max(most, core::sqrt(2.0 * scene.world.gravity.norm() * (most_height - least_height)));
}

/// mm: no ball inside a convex solid is larger than three times its volume over its surface.
double greatest_depth(const scene::ScenePlan& plan) {
  double most = 0.0;
  for (const scene::BodyPlan& body : plan.bodies) {
    const auto* solid = std::get_if<world::SolidDescription>(&body.description.form);
    if (solid == nullptr) continue;
    const double area = geometry::surface_area(solid->mesh);
    if (area > 0.0) most = std::max(most, 3e3 * geometry::enclosed_volume(solid->mesh) / area);
  }
  return most;
}

}  // namespace

Overlays::Overlays(const scene::SceneDescription& scene, const scene::BuiltScene& built)
    : scene_(scene), built_(built), name_(scene.render.overlay), most_(scene.render.overlay_most) {}

void Overlays::show(const std::string& name, const std::optional<double>& most) {
  name_ = name;
  most_ = most;
}

render::Overlay Overlays::overlay() const {
  render::Overlay overlay;
  const auto scale = [&](const char* title, const char* unit, double usual) {
    overlay.kind = render::OverlayKind::heat;
    overlay.title = title;
    overlay.unit = unit;
    overlay.most = static_cast<float>(most_.value_or(usual > 0.0 ? usual : 1.0));
  };
  if (name_ == "stress") scale("tension", "MPa", greatest_strength(scene_));
  if (name_ == "velocity") scale("speed", "m/s", greatest_speed(scene_));
  if (name_ == "impacts") scale("stress / strength", "", 1.0);
  if (name_ == "level_set") {
    scale("distance", "mm", greatest_depth(built_.plan));
    overlay.least = -overlay.most;
  }
  if (name_ == "pieces") overlay.kind = render::OverlayKind::pieces;
  if (name_ == "grains") overlay.kind = render::OverlayKind::groups;
  overlay.has_wires = name_ == "wireframe";
  return overlay;
}

std::optional<GrainMesh> make_grain_mesh(const body::Shape& shape, const render::Mesh& mesh,
                                         std::uint64_t id) {
  const std::vector<int>& grains = shape.triangle_grains;
  if (grains.size() != mesh.triangles.size()) return std::nullopt;
  if (std::all_of(grains.begin(), grains.end(), [](int grain) { return grain < 0; })) return std::nullopt;
  auto parted = std::make_shared<render::Mesh>(mesh);
  auto groups = std::make_shared<std::vector<float>>();
  parted->id = id;
  parted->normals = render::find_corner_normals(mesh);  // no crease where grains meet
  parted->positions.clear();
  parted->pattern_positions.clear();
  std::map<std::pair<unsigned, int>, unsigned> copies;
  for (std::size_t t = 0; t < grains.size(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const unsigned vertex = mesh.triangles[t][corner];
      const auto [copy, is_new] =
          copies.try_emplace({vertex, grains[t]}, static_cast<unsigned>(parted->positions.size()));
      parted->triangles[t][corner] = copy->second;
      if (!is_new) continue;
      parted->positions.push_back(mesh.positions[vertex]);
      if (!mesh.pattern_positions.empty())
        parted->pattern_positions.push_back(mesh.pattern_positions[vertex]);
      const std::uint64_t draw = core::Hash(static_cast<std::uint64_t>(grains[t] + 1)).value();
      groups->push_back(static_cast<float>(draw >> 56U) / 255.0F);
    }
  }
  return GrainMesh{std::move(parted), std::move(groups)};
}

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

std::shared_ptr<const std::vector<float>> vertex_speed(const body::Body& body, const render::Mesh& mesh) {
  const Mat3 rotation = body.pose.rotation.toRotationMatrix();
  auto values = std::make_shared<std::vector<float>>();
  values->reserve(mesh.positions.size());
  for (const glm::vec3& p : mesh.positions) {
    const Vec3 velocity = body.velocity + body.angular_velocity.cross(rotation * Vec3(p.x, p.y, p.z));
    values->push_back(static_cast<float>(velocity.norm()));
  }
  return values;
}

}  // namespace shatterbox::sandbox::view
