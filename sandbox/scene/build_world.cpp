#include "sandbox/scene/build_world.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/core/elementary.h"
#include "engine/core/random.h"
#include "engine/geometry/mass_properties.h"
#include "sandbox/scene/build_mesh.h"

namespace shatterbox::sandbox::scene {

namespace {

std::optional<world::ShellDescription> describe_shell(const BodyEntry& body, const ShellForm& form,
                                                      const SceneDescription& scene, BodyPlan& plan,
                                                      std::vector<std::string>& notes, Problems& problems) {
  auto built = build_mesh(form, body.place, problems, notes);
  if (!built) return std::nullopt;
  world::ShellDescription shell;
  const auto& material = scene.materials[static_cast<std::size_t>(body.material)].material;
  shell.thickness = form.thickness.value_or(material.thickness);
  shell.is_breakable = form.is_breakable;
  shell.clamped = find_clamped(built->mesh, body.rotation, body.support, body.place, problems);
  for (const Vec3& p : built->mesh.positions) plan.bounding_radius = std::max(plan.bounding_radius, p.norm());
  plan.centre = geometry::shell_mass_properties(built->mesh, shell.thickness, 1.0).centre;
  shell.mesh = std::move(built->mesh);
  shell.parts = std::move(built->parts);
  return shell;
}

int group_number(std::vector<std::string>& groups, const std::string& name) {
  if (name.empty()) return -1;
  const auto found = std::find(groups.begin(), groups.end(), name);
  const auto number = found - groups.begin();
  if (found == groups.end()) groups.push_back(name);
  return static_cast<int>(number);
}

/// A uniformly distributed direction.
Vec3 random_direction(core::Random& random) {
  const double height = random.uniform(-1.0, 1.0);
  const double turn = random.uniform(0.0, 2.0 * core::kPi);
  const double ring = core::sqrt(std::max(0.0, 1.0 - height * height));
  return {ring * core::cos(turn), height, ring * core::sin(turn)};
}

std::optional<BodyPlan> plan_body(const BodyEntry& body, const SceneDescription& scene,
                                  std::vector<std::string>& groups, std::vector<std::string>& notes,
                                  Problems& problems) {
  BodyPlan plan;
  world::BodyDescription& description = plan.description;
  description.name = body.name;
  description.material = body.material;
  description.motion = body.motion;
  description.pose = {body.rotation, body.position};
  description.velocity = body.velocity;
  description.angular_velocity = body.angular_velocity;
  description.group = group_number(groups, body.group);
  description.density = body.density;
  description.contact_duration = body.contact_duration;
  if (const auto* box = std::get_if<BoxForm>(&body.form)) {
    description.form = world::BoxDescription{0.5 * box->size};
    plan.bounding_radius = 0.5 * box->size.norm();
  } else if (const auto* sphere = std::get_if<SphereForm>(&body.form)) {
    description.form = world::SphereDescription{sphere->radius};
    plan.bounding_radius = sphere->radius;
  } else if (const auto* form = std::get_if<ShellForm>(&body.form)) {
    auto shell = describe_shell(body, *form, scene, plan, notes, problems);
    if (!shell) return std::nullopt;
    description.form = std::move(*shell);
  } else {
    description.form = world::PlaneDescription{};
  }
  return plan;
}

void add_materials(const SceneDescription& scene, world::World& world, Problems& problems) {
  for (const MaterialEntry& entry : scene.materials) {
    const auto number = world.add_material(entry.material);
    if (!number) book(problems, entry.place, number.error(), "");
  }
  for (const PairEntry& pair : scene.pairs) {
    world.add_pair({pair.materials[0], pair.materials[1], pair.friction, pair.restitution});
  }
}

}  // namespace

std::vector<Pose> copy_poses(const BodyEntry& body, std::uint64_t seed, std::uint64_t body_number) {
  const Repeat& repeat = body.repeat;
  core::Random random(seed, 0x5ca77e2ULL + body_number);
  std::vector<Pose> poses;
  poses.reserve(static_cast<std::size_t>(repeat.total()));
  const auto for_each_copy = [&repeat](const auto& place) {
    for (int z = 0; z < repeat.count[2]; ++z) {
      for (int y = 0; y < repeat.count[1]; ++y) {
        for (int x = 0; x < repeat.count[0]; ++x) place(Vec3(x, y, z));
      }
    }
  };
  for_each_copy([&](const Vec3& index) {
    Pose pose{body.rotation, body.position};
    pose.translation +=
        repeat.is_row ? Vec3(index.x() * repeat.spacing) : Vec3(index.cwiseProduct(repeat.spacing));
    for (int axis = 0; axis < 3; ++axis) {
      const double share = random.uniform(-1.0, 1.0);
      pose.translation[axis] += share * repeat.jitter[axis];
    }
    const Vec3 axis = random_direction(random);
    const double half = random.uniform(-0.5, 0.5) * repeat.rotation_jitter * core::kPi / 180.0;
    if (repeat.rotation_jitter > 0.0) {
      const Vec3 v = core::sin(half) * axis;
      pose.rotation = Quat(core::cos(half), v.x(), v.y(), v.z()) * pose.rotation;
    }
    poses.push_back(pose);
  });
  return poses;
}

std::optional<ScenePlan> plan_bodies(const SceneDescription& scene, Problems& problems) {
  ScenePlan plan;
  std::vector<std::string> groups;
  const std::size_t before = problems.size();
  for (const BodyEntry& body : scene.bodies) {
    if (auto planned = plan_body(body, scene, groups, plan.notes, problems)) {
      plan.bodies.push_back(std::move(*planned));
    }
  }
  if (problems.size() > before) return std::nullopt;
  return plan;
}

std::optional<BuiltScene> build_world(const SceneDescription& scene, Problems& problems) {
  const std::size_t before = problems.size();
  auto plan = plan_bodies(scene, problems);
  if (!plan) return std::nullopt;
  BuiltScene built{world::World(scene.world), std::move(*plan), {}};
  add_materials(scene, built.world, problems);
  if (problems.size() > before) return std::nullopt;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const BodyEntry& body = scene.bodies[i];
    if (body.is_held_back) continue;
    const std::vector<Pose> poses = copy_poses(body, scene.world.seed, i);
    world::BodyDescription description = built.plan.bodies[i].description;
    for (std::size_t copy = 0; copy < poses.size(); ++copy) {
      description.pose = poses[copy];
      if (poses.size() > 1) description.name = fmt::format("{}[{}]", body.name, copy + 1);
      const auto id = built.world.add_body(description);
      if (!id) {
        book(problems, body.place, fmt::format("body \"{}\": {}", description.name, id.error()), "");
        break;
      }
      built.entries[id.value()] = static_cast<int>(i);
    }
  }
  if (problems.size() > before) return std::nullopt;
  return built;
}

}  // namespace shatterbox::sandbox::scene
