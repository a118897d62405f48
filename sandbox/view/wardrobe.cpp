#include "sandbox/view/wardrobe.h"

#include <algorithm>

#include "engine/core/hash.h"
#include "engine/geometry/bvh.h"
#include "sandbox/view/looks.h"

namespace shatterbox::sandbox::view {

namespace {

/// The colour of one copy: drawn from the list by the numbers of the body and the copy. Bricks are never all
/// of one colour: a wall of them would be seen as one block.
std::optional<Vec3> colour_of(const scene::LookEntry& look, const std::string& name, std::size_t entry,
                              int copy) {
  static const std::vector<Vec3> kBricks{{0.635, 0.329, 0.231},
                                         {0.580, 0.282, 0.184},
                                         {0.678, 0.384, 0.271},
                                         {0.545, 0.290, 0.220},
                                         {0.690, 0.416, 0.298}};
  const std::vector<Vec3>& colours = look.colours.empty() && name == "brick" ? kBricks : look.colours;
  if (colours.empty()) return std::nullopt;
  const std::uint64_t draw =
      core::Hash(std::uint64_t{entry}).add(static_cast<std::uint64_t>(copy)).value() >> 16U;
  return colours[static_cast<std::size_t>(draw % colours.size())];
}

/// Along which a body is longest, in its shape's own frame.
int longest_axis(const world::BodyDescription& description) {
  Vec3 extent = Vec3::UnitY();
  const auto measure = [&extent](const geometry::TriangleMesh& mesh) {
    const geometry::Box box = geometry::box_of(mesh);
    extent = box.high - box.low;
  };
  if (const auto* box = std::get_if<world::BoxDescription>(&description.form)) extent = box->half_extent;
  if (const auto* shell = std::get_if<world::ShellDescription>(&description.form)) measure(shell->mesh);
  if (const auto* solid = std::get_if<world::SolidDescription>(&description.form)) measure(solid->mesh);
  int axis = 0;
  extent.maxCoeff(&axis);
  return axis;
}

bool is_level(const body::Body& body) {
  const Vec3 normal = body.pose.rotation * Vec3::UnitY();
  return normal.y() > 1.0 - 1e-9;
}

}  // namespace

body::BodyId Wardrobe::original_of(body::BodyId id) const {
  const body::BodyId original = built_.world.ancestry(id).original;
  return original != 0 ? original : id;
}

const std::vector<render::Look>& Wardrobe::looks_of(body::BodyId id) {
  const body::BodyId original = original_of(id);
  auto [place, is_new] = looks_.try_emplace(original);
  if (!is_new) return place->second;
  const auto found = built_.origins.find(original);
  if (found == built_.origins.end()) {
    place->second = make_looks("matt", std::nullopt, 0.1, Vec3::Zero(), 0);
    return place->second;
  }
  const auto number = static_cast<std::size_t>(found->second.entry);
  const scene::BodyEntry& entry = scene_.bodies[number];
  const scene::BodyPlan& plan = built_.plan.bodies[number];
  std::string name = entry.look.name.empty() ? scene_.render.look : entry.look.name;
  const auto& material = scene_.materials[static_cast<std::size_t>(entry.material)];
  if (name.empty()) name = usual_look(material.preset);
  const std::optional<Vec3> colour = colour_of(entry.look, name, number, found->second.copy);
  place->second = make_looks(name, colour, plan.bounding_radius, -plan.centre,
                             name == "wood" ? longest_axis(plan.description) : 0);
  if (colour && !std::holds_alternative<world::ShellDescription>(plan.description.form))
    share_tint_of_two_faces(place->second);
  return place->second;
}

bool Wardrobe::is_hidden(body::BodyId id) const {
  const auto found = built_.origins.find(original_of(id));
  return found != built_.origins.end() &&
         scene_.bodies[static_cast<std::size_t>(found->second.entry)].look.name == "hidden";
}

bool is_drawn_as_ground(const body::Body& body) {
  return body.shape->kind == body::ShapeKind::plane && is_level(body);
}

std::optional<render::Ground> find_ground(const scene::SceneDescription& scene,
                                          const scene::BuiltScene& built) {
  std::optional<double> height;
  body::BodyId id = 0;
  for (const body::Body& body : built.world.bodies()) {
    if (!is_drawn_as_ground(body)) continue;
    if (height && *height >= body.pose.translation.y()) continue;
    height = body.pose.translation.y();
    id = body.id;
  }
  if (!height) return std::nullopt;
  auto ground = make_ground(scene.render.ground.empty() ? "plain" : scene.render.ground, *height);
  if (!ground) return ground;
  ground->id = id;
  if (scene.render.ground_colour) ground->colour = linear_colour(*scene.render.ground_colour);
  if (scene.render.checker > 0.0) {
    ground->pattern = render::GroundPattern::checker;
    ground->pattern_size = static_cast<float>(scene.render.checker);
  }
  return ground;
}

}  // namespace shatterbox::sandbox::view
