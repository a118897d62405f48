#include "sandbox/scene/build_world.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/core/elementary.h"
#include "engine/core/random.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/mesh_diagnosis.h"
#include "engine/material/tempering.h"
#include "engine/world/forms.h"
#include "sandbox/scene/build_joints.h"
#include "sandbox/scene/build_mesh.h"
#include "sandbox/scene/clean_solid.h"
#include "sandbox/scene/limits.h"
#include "sandbox/scene/wall_thickness.h"

namespace shatterbox::sandbox::scene {

namespace {

constexpr double kMostDice = 2000.0;   // that are played without a word
constexpr double kFinestGrain = 1.8;   // elements that it takes to tell a grain
constexpr double kThinnestWall = 2.0;  // the same of a wall,
constexpr double kThinnestTold = 0.5;  // and where their size is told
constexpr double kOwnWall = 0.1;       // of the size of a closed sheet: it is no vessel, but a wall

/// About the frame's origin and about the centre of mass, which is known.
void measure_mesh(const geometry::TriangleMesh& mesh, BodyPlan& plan) {
  plan.box = geometry::box_of(mesh);
  for (const Vec3& p : mesh.positions) {
    plan.bounding_radius = std::max(plan.bounding_radius, p.norm());
    plan.reach = std::max(plan.reach, (p - plan.centre).norm());
  }
}

/// Of a file: a mesh with an inside and an outside, each of which would be a sheet.
void note_own_wall(const BodyEntry& body, const ShellForm& form, const geometry::TriangleMesh& mesh,
                   double thickness, std::vector<std::string>& notes) {
  if (!std::holds_alternative<MeshFileShape>(form.shape)) return;
  if (!geometry::diagnose(mesh, {.allow_loose_parts = true}).is_closed) return;
  const geometry::Box box = geometry::box_of(mesh);
  const double wall = wall_thickness(mesh);
  if (wall > kOwnWall * (box.high - box.low).norm()) return;
  notes.push_back(fmt::format(
      "the mesh of \"{}\" has a wall of its own, {:.2g} m thick, both sides of which are sheets of {:.2g} "
      "m here: kind = \"solid\" takes the wall as it is, and a sheet is one side alone",
      body.name, wall, thickness));
}

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
  plan.centre = geometry::shell_mass_properties(built->mesh, shell.thickness, 1.0).centre;
  if (const double die = material::die_area(material, shell.thickness); die > 0.0 && form.is_breakable) {
    const double dice = geometry::surface_area(built->mesh) / die;
    if (dice > kMostDice)
      notes.push_back(fmt::format(
          "\"{}\" would break into about {:.2g} dice of {:.2g} mm2: so many bodies at once take minutes a "
          "second; it may be smaller, thicker, or of less surface_compression",
          body.name, dice, 1e6 * die));
  }
  measure_mesh(built->mesh, plan);
  note_own_wall(body, form, built->mesh, shell.thickness, notes);
  shell.mesh = std::move(built->mesh);
  shell.parts = std::move(built->parts);
  return shell;
}

/// A crack goes round grains by way of the elements' nodes.
void note_fine_grains(const BodyEntry& body, const world::SolidDescription& solid,
                      const SceneDescription& scene, std::vector<std::string>& notes) {
  const double grain = scene.materials[static_cast<std::size_t>(body.material)].material.grain_size;
  if (!solid.is_breakable || !(grain > 0.0)) return;
  const double size = solid.grading * world::element_size_of(solid);
  if (grain < kFinestGrain * size)
    notes.push_back(
        fmt::format("the grains of \"{}\" are {:.3g} m wide and its elements {:.3g} m: cracks cannot tell "
                    "them; element_size = {:.2g} can",
                    body.name, grain, size, grain / kFinestGrain / solid.grading));
}

/// What can be a sheet as well, which needs no elements across its wall, in words; empty if it cannot.
std::string describe_sheet_for(const BodyEntry& body, double wall) {
  const MeshForm* form = find_mesh_form(body.form);
  const char* what = nullptr;
  if (std::holds_alternative<geometry::BottleSizes>(form->shape) ||
      std::holds_alternative<geometry::VaseSizes>(form->shape))
    what = "a sheet (kind = \"shell\"";
  if (std::holds_alternative<SlabShape>(form->shape)) what = "a sheet (kind = \"shell\", shape = \"pane\"";
  if (std::holds_alternative<MeshFileShape>(form->shape))
    what = "one side of its wall alone, as a sheet (kind = \"shell\"";
  if (what == nullptr) return {};
  return fmt::format("{}, thickness = {:.2g}) needs none across and is quick; ", what, wall);
}

/// Bent across one element it is too stiff. Who tells the size of elements has chosen, up to
/// twice the wall.
void note_thin_wall(const BodyEntry& body, const world::SolidDescription& solid,
                    std::vector<std::string>& notes) {
  if (!solid.is_breakable) return;
  const double size = world::element_size_of(solid), wall = wall_thickness(solid.mesh);
  if (wall >= (solid.element_size > 0.0 ? kThinnestTold : kThinnestWall) * size) return;
  notes.push_back(
      fmt::format("the wall of \"{}\" is {:.2g} m thick and its elements {:.2g} m: its stress is told too "
                  "low; {}element_size = {:.2g} is finer, and takes {:.0f} times as many",
                  body.name, wall, size, describe_sheet_for(body, wall), wall / kThinnestWall,
                  std::ceil(std::pow(size * kThinnestWall / wall, 2))));
}

void measure(const world::SolidDescription& solid, BodyPlan& plan) {
  plan.bounding_radius = plan.reach = 0.0;
  plan.centre = geometry::solid_mass_properties(solid.mesh, 1.0).centre;
  measure_mesh(solid.mesh, plan);
}

/// A solid's mesh has an inside: closed, of one or several parts that each enclose some.
std::optional<world::SolidDescription> describe_solid(const BodyEntry& body, const SolidForm& form,
                                                      const SceneDescription& scene, BodyPlan& plan,
                                                      std::vector<std::string>& notes, Problems& problems) {
  auto built = build_mesh(form, body.place, problems, notes);
  if (!built) return std::nullopt;
  world::SolidDescription solid;
  solid.is_breakable = form.is_breakable;
  solid.element_size = form.element_size.value_or(0.0);
  solid.grading = form.grading.value_or(1);
  solid.mesh = std::move(built->mesh);
  solid.parts = std::move(built->parts);
  if (!geometry::diagnose(solid.mesh, {.allow_loose_parts = true}).is_closed) {
    const auto closed = close_holes(solid);
    if (!closed) {
      book(problems, body.place,
           fmt::format("body \"{}\" is a solid, but its mesh has an open border: {}", body.name,
                       closed.error()),
           "close the mesh's holes, or write kind = \"shell\" with a thickness");
      return std::nullopt;
    }
    notes.push_back(fmt::format("the mesh of \"{}\" has an open border: {}", body.name, closed.value()));
  }
  measure(solid, plan);
  solid.held = find_held(solid.mesh, body.rotation, body.support, body.place, problems);
  note_fine_grains(body, solid, scene, notes);
  note_thin_wall(body, solid, notes);
  return solid;
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
  description.force = body.force;
  description.torque = body.torque;
  description.locked = body.locked;
  description.group = group_number(groups, body.group);
  description.density = body.density;
  description.contact_duration = body.contact_duration;
  if (const auto* box = std::get_if<BoxForm>(&body.form)) {
    description.form = world::BoxDescription{0.5 * box->size};
    plan.box = {-0.5 * box->size, 0.5 * box->size};
    plan.bounding_radius = plan.reach = 0.5 * box->size.norm();
  } else if (const auto* sphere = std::get_if<SphereForm>(&body.form)) {
    description.form = world::SphereDescription{sphere->radius};
    plan.box = {Vec3::Constant(-sphere->radius), Vec3::Constant(sphere->radius)};
    plan.bounding_radius = plan.reach = sphere->radius;
  } else if (const auto* capsule = std::get_if<CapsuleForm>(&body.form)) {
    description.form = world::CapsuleDescription{capsule->radius, capsule->length};
    const Vec3 half(capsule->radius, 0.5 * capsule->length, capsule->radius);
    plan.box = {-half, half};
    plan.bounding_radius = plan.reach = 0.5 * capsule->length;
  } else if (const auto* form = std::get_if<ShellForm>(&body.form)) {
    auto shell = describe_shell(body, *form, scene, plan, notes, problems);
    if (!shell) return std::nullopt;
    description.form = std::move(*shell);
  } else if (const auto* solid_form = std::get_if<SolidForm>(&body.form)) {
    auto solid = describe_solid(body, *solid_form, scene, plan, notes, problems);
    if (!solid) return std::nullopt;
    description.form = std::move(*solid);
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

/// The cells of one layer, from its middle outwards: equally far ones by their numbers, x fastest.
std::vector<Vec3> layer_offsets(const Repeat& repeat) {
  std::vector<Vec3> cells;
  for (int z = 0; z < repeat.layer[1]; ++z)
    for (int x = 0; x < repeat.layer[0]; ++x)
      cells.emplace_back((x - 0.5 * (repeat.layer[0] - 1)) * repeat.spacing.x(), 0.0,
                         (z - 0.5 * (repeat.layer[1] - 1)) * repeat.spacing.z());
  std::stable_sort(cells.begin(), cells.end(),
                   [](const Vec3& a, const Vec3& b) { return a.squaredNorm() < b.squaredNorm(); });
  return cells;
}

/// Where the copies stand from the body's own place, before jitter.
std::vector<Vec3> offsets_of(const Repeat& repeat) {
  std::vector<Vec3> offsets;
  if (repeat.layout == Layout::row) {
    for (int i = 0; i < repeat.count[0]; ++i) offsets.emplace_back(i * repeat.spacing);
  } else if (repeat.layout == Layout::grid) {
    for (int z = 0; z < repeat.count[2]; ++z)
      for (int y = 0; y < repeat.count[1]; ++y)
        for (int x = 0; x < repeat.count[0]; ++x)
          offsets.push_back(Vec3(x + y % 2 * repeat.bond, y, z).cwiseProduct(repeat.spacing));
  } else {
    const std::vector<Vec3> cells = layer_offsets(repeat);
    const int a_layer = static_cast<int>(cells.size());
    for (int i = 0; i < repeat.count[0]; ++i) {
      const Vec3 up(0.0, i / a_layer * repeat.spacing.y(), 0.0);
      offsets.push_back(cells[static_cast<std::size_t>(i % a_layer)] + up);
    }
  }
  return offsets;
}

}  // namespace

std::vector<Pose> copy_poses(const BodyEntry& body, std::uint64_t seed, std::uint64_t body_number) {
  const Repeat& repeat = body.repeat;
  core::Random random(seed, 0x5ca77e2ULL + body_number);
  std::vector<Pose> poses;
  poses.reserve(static_cast<std::size_t>(repeat.total()));
  for (const Vec3& offset : offsets_of(repeat)) {
    Pose pose{body.rotation, body.position + offset};
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
  }
  return poses;
}

world::PathDescription path_of(const BodyEntry& body, const Pose& pose) {
  world::PathDescription path{body.path->keys, body.path->between, pose.rotation * body.rotation.conjugate(),
                              body.path->pivot};
  for (body::Keyframe& key : path.keys) key.position += pose.translation - body.position;
  return path;
}

std::vector<BodyTetrahedra> find_tetrahedra(const BuiltScene& built) {
  std::map<int, geometry::TetQuality> found;
  for (const auto& [id, origin] : built.origins)
    if (found.count(origin.entry) == 0)
      if (const auto quality = built.world.tetrahedra(id)) found.emplace(origin.entry, *quality);
  std::vector<BodyTetrahedra> all;
  for (const auto& [entry, quality] : found) all.push_back({entry, quality});
  return all;
}

std::string copy_name(const BodyEntry& body, int copy) {
  return body.repeat.total() > 1 ? fmt::format("{}[{}]", body.name, copy + 1) : body.name;
}

std::optional<ScenePlan> plan_bodies(const SceneDescription& scene, Problems& problems) {
  ScenePlan plan;
  std::vector<std::string> groups;
  const std::size_t before = problems.size();
  for (const BodyEntry& body : scene.bodies) {
    std::vector<std::string> notes;
    if (auto planned = plan_body(body, scene, groups, notes, problems)) {
      plan.bodies.push_back(std::move(*planned));
    }
    for (std::string& note : notes)  // many bodies may be of one mesh
      if (std::find(plan.notes.begin(), plan.notes.end(), note) == plan.notes.end())
        plan.notes.push_back(std::move(note));
  }
  if (problems.size() > before) return std::nullopt;
  return plan;
}

namespace {

/// What the engine cannot divide into tetrahedra as it is may be one of which it can tell what is inside.
/// False, with why not in `fault`, if it is not.
bool clean_crossings(const BodyEntry& body, BodyPlan& plan, std::vector<std::string>& notes,
                     std::string& fault) {
  auto* solid = std::get_if<world::SolidDescription>(&plan.description.form);
  if (!solid || !solid->is_breakable) return false;
  const auto done = unite_crossings(*solid);
  if (!done) {
    if (!done.error().empty()) fault += " (" + done.error() + ")";
    return false;
  }
  notes.push_back(fmt::format("of the mesh of \"{}\", {}", body.name, done.value()));
  measure(*solid, plan);
  return true;
}

std::string describe_making(const BodyEntry& body, const world::BodyDescription& description) {
  const auto* solid = std::get_if<world::SolidDescription>(&description.form);
  return solid && solid->is_breakable ? fmt::format("dividing \"{}\" into tetrahedra", body.name)
                                      : fmt::format("making \"{}\"", body.name);
}

}  // namespace

std::optional<BuiltScene> build_world(const SceneDescription& scene, Problems& problems,
                                      const BuildWatch& watch) {
  auto plan = plan_bodies(scene, problems);
  if (!plan) return std::nullopt;
  return raise_world(scene, std::move(*plan), problems, watch);
}

std::optional<BuiltScene> raise_world(const SceneDescription& scene, ScenePlan plan, Problems& problems,
                                      const BuildWatch& watch) {
  const std::size_t before = problems.size();
  BuiltScene built{world::World(scene.world), std::move(plan), {}};
  add_materials(scene, built.world, problems);
  if (problems.size() > before) return std::nullopt;
  std::optional<world::World> trial;  // of what comes in later
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const BodyEntry& body = scene.bodies[i];
    if (watch) watch(static_cast<int>(i), describe_making(body, built.plan.bodies[i].description));
    const auto refuse = [&](const std::string& name, std::string fault) {
      const std::string own = "body '" + name + "': ";  // as the engine begins
      if (fault.starts_with(own)) fault.erase(0, own.size());
      book(problems, body.place, fmt::format("body \"{}\": {}", name, fault), "");
    };
    if (body.is_held_back) {
      std::string fault;
      clean_crossings(body, built.plan.bodies[i], built.plan.notes, fault);
      if (!trial) trial = built.world.copy();
      const auto id = trial->add_body(built.plan.bodies[i].description);
      if (!id) refuse(body.name, id.error());
      continue;
    }
    const std::vector<Pose> poses = copy_poses(body, scene.world.seed, i);
    world::BodyDescription description = built.plan.bodies[i].description;
    const std::size_t now = body.repeat.every > 0.0 ? 1 : poses.size();  // the script brings in the others
    for (std::size_t copy = 0; copy < now; ++copy) {
      description.pose = poses[copy];
      if (body.path) description.path = path_of(body, poses[copy]);
      description.name = copy_name(body, static_cast<int>(copy));
      auto id = built.world.add_body(description);
      std::string fault = id ? "" : id.error();
      if (!id && clean_crossings(body, built.plan.bodies[i], built.plan.notes, fault)) {
        description.form = built.plan.bodies[i].description.form;
        id = built.world.add_body(description);
        if (!id) fault = id.error();
      }
      if (!id) {
        refuse(description.name, fault);
        break;
      }
      built.origins[id.value()] = {static_cast<int>(i), static_cast<int>(copy)};
    }
  }
  if (problems.size() > before) return std::nullopt;
  add_joints(scene, built, problems);
  if (problems.size() > before) return std::nullopt;
  for (std::string& sentence : find_limits(scene.world, built.world.bodies()))
    built.plan.notes.push_back(std::move(sentence));
  return built;
}

}  // namespace shatterbox::sandbox::scene
