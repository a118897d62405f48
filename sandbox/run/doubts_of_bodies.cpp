#include <algorithm>

#include <fmt/format.h>

#include "engine/geometry/bvh.h"
#include "engine/material/tempering.h"
#include "sandbox/run/doubt_groups.h"
#include "sandbox/scene/build_mesh.h"

namespace shatterbox::sandbox::run {

namespace {

constexpr double kThick = 0.25;  // of the greatest extent: a shell that is thicker hardly is one

void doubt_thickness(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                     scene::Problems& doubts) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const auto* shell = std::get_if<world::ShellDescription>(&built.plan.bodies[i].description.form);
    if (shell == nullptr) continue;
    const geometry::Box box = geometry::box_of(shell->mesh);
    const double across = (box.high - box.low).maxCoeff();
    if (shell->thickness <= kThick * across) continue;
    scene::book(doubts, scene.bodies[i].place,
                fmt::format("the shell \"{}\" is {:.3g} m thick, and {:.3g} m across", scene.bodies[i].name,
                            shell->thickness, across),
                "thickness is in metres, 2 mm are 0.002; what is thick throughout is kind = \"solid\"");
  }
}

/// Sheets from files of so few triangles that they hardly bend: their stress is told far too low.
void doubt_triangles(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                     scene::Problems& doubts) {
  constexpr std::size_t kFewTriangles = 500;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const scene::BodyEntry& entry = scene.bodies[i];
    const scene::MeshForm* form = scene::find_mesh_form(entry.form);
    const auto* shell = std::get_if<world::ShellDescription>(&built.plan.bodies[i].description.form);
    if (form == nullptr || shell == nullptr || !scene::can_break(entry)) continue;
    if (!std::holds_alternative<scene::MeshFileShape>(form->shape)) continue;
    if (shell->mesh.triangles.size() >= kFewTriangles) continue;
    scene::book(doubts, entry.place,
                fmt::format("\"{}\" has {} triangles: so few hardly bend, and its stress is told too low",
                            entry.name, shell->mesh.triangles.size()),
                fmt::format("edge_length = {:.2g} divides them into some thousands",
                            scene::usual_edge_length(shell->mesh)));
  }
}

/// Things of a household that are as large as a house: their sizes were hardly meant in metres.
void doubt_sizes(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                 scene::Problems& doubts) {
  constexpr double kOfHouse = 5.0;  // m
  const auto is_of_household = [](const scene::MeshShape& shape) {
    return !std::holds_alternative<scene::MeshFileShape>(shape) &&
           !std::holds_alternative<scene::PaneShape>(shape) &&
           !std::holds_alternative<scene::SlabShape>(shape) &&
           !std::holds_alternative<scene::FigureShape>(shape) &&
           !std::holds_alternative<geometry::BoatSizes>(shape);
  };
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const scene::BodyEntry& entry = scene.bodies[i];
    const scene::MeshForm* form = scene::find_mesh_form(entry.form);
    const double across = 2.0 * built.plan.bodies[i].bounding_radius;
    if (form == nullptr || across < kOfHouse || !scene::can_break(entry) || !is_of_household(form->shape))
      continue;
    scene::book(doubts, entry.place, fmt::format("\"{}\" is {:.3g} m across", entry.name, across),
                "sizes are in metres: 30 cm are 0.3");
  }
}

/// Properties in other units than those of the SI: of anything that is solid they are far greater.
void doubt_materials(const scene::SceneDescription& scene, scene::Problems& doubts) {
  constexpr double kLeastStrength = 1e4, kLeastYoung = 1e6, kLeastDensity = 5.0;
  for (const scene::MaterialEntry& entry : scene.materials) {
    const material::Material& m = entry.material;
    const auto doubt = [&](const char* what, double value, const char* unit, const char* hint) {
      scene::book(doubts, entry.place, fmt::format("\"{}\" has a {} of {:g} {}", m.name, what, value, unit),
                  hint);
    };
    if (m.strength > 0.0 && m.strength < kLeastStrength)
      doubt("strength", m.strength, "Pa", "strengths are in pascals: 50 MPa are 50e6");
    if (m.young > 0.0 && m.young < kLeastYoung)
      doubt("young", m.young, "Pa", "moduli are in pascals: 70 GPa are 70e9");
    if (m.density > 0.0 && m.density < kLeastDensity)
      doubt("density", m.density, "kg/m3", "densities are in kg/m3: 2.5 g/cm3 are 2500");
  }
}

/// Toughened glass that is so thin that what is stored in it does not break it into dice.
void doubt_tempering(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                     scene::Problems& doubts) {
  constexpr double kStep = 1e6, kMost = 3e8;  // Pa
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const scene::BodyEntry& entry = scene.bodies[i];
    const auto* shell = std::get_if<world::ShellDescription>(&built.plan.bodies[i].description.form);
    material::Material material = scene.materials[static_cast<std::size_t>(entry.material)].material;
    if (shell == nullptr || !scene::can_break(entry) || !(material.surface_compression > 0.0)) continue;
    if (material::die_area(material, shell->thickness) > 0.0) continue;
    do material.surface_compression += kStep;
    while (material.surface_compression < kMost && !(material::die_area(material, shell->thickness) > 0.0));
    scene::book(
        doubts, entry.place,
        fmt::format("\"{}\" stores too little for dice: {:g} mm of {} break into large pieces", entry.name,
                    1e3 * shell->thickness, material.name),
        fmt::format("make it thicker, or its surface_compression {:.3g} Pa", material.surface_compression));
  }
}

/// What is to break, by its material, and cannot by its kind; where anything else moves, it may be the
/// thrower's choice. Told once.
void doubt_kinds(const scene::SceneDescription& scene, scene::Problems& doubts) {
  const auto moves = [](const scene::BodyEntry& body) { return body.motion == body::Motion::dynamic; };
  const auto name_of_kind = [](const scene::BodyEntry& body) {
    if (std::holds_alternative<scene::BoxForm>(body.form)) return "box";
    if (std::holds_alternative<scene::CapsuleForm>(body.form)) return "capsule";
    return std::holds_alternative<scene::SphereForm>(body.form) ? "sphere" : "";
  };
  const auto is_doubtful = [&](const scene::BodyEntry& body) {
    const std::string& material = scene.materials[static_cast<std::size_t>(body.material)].preset;
    return name_of_kind(body)[0] != '\0' && material.find("glass") != std::string::npos;
  };
  const auto first = std::find_if(scene.bodies.begin(), scene.bodies.end(), moves);
  if (first == scene.bodies.end() ||
      !std::all_of(scene.bodies.begin(), scene.bodies.end(),
                   [&](const scene::BodyEntry& body) { return !moves(body) || is_doubtful(body); }))
    return;
  const bool is_box = std::holds_alternative<scene::BoxForm>(first->form);
  scene::book(doubts, first->place,
              fmt::format("\"{}\" is a {} of {}, which never breaks", first->name, name_of_kind(*first),
                          scene.materials[static_cast<std::size_t>(first->material)].preset),
              is_box ? "what breaks is kind = \"solid\" with shape = \"slab\" and a size, or kind = \"shell\""
                     : "what breaks is kind = \"solid\" or kind = \"shell\" with shape = \"sphere\"");
}

/// Paths that go as fast as a shot, and strike as hard.
void doubt_paths(const scene::SceneDescription& scene, scene::Problems& doubts) {
  constexpr double kShot = 100.0;  // m/s
  for (const scene::BodyEntry& body : scene.bodies) {
    if (!body.path) continue;
    const std::vector<body::Keyframe>& keys = body.path->keys;
    const auto speed_to = [&](std::size_t k) {
      return (keys[k].position - keys[k - 1].position).norm() / (keys[k].time - keys[k - 1].time);
    };
    for (std::size_t k = 1; k < keys.size(); ++k) {
      if (speed_to(k) <= kShot) continue;
      scene::book(doubts, body.place,
                  fmt::format("\"{}\" goes to its keyframe at {:g} s at {:.0f} m/s, which drives what is in "
                              "its way as fast",
                              body.name, keys[k].time, speed_to(k)),
                  "give it more time; what is to hit that hard is thrown: do = \"projectile\"");
      break;
    }
  }
}

/// Told once: of the first body that would be dented.
void doubt_criterion(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                     scene::Problems& doubts) {
  if (scene.world.criterion != world::Criterion::paper) return;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const scene::BodyEntry& body = scene.bodies[i];
    const material::Material& material = scene.materials[static_cast<std::size_t>(body.material)].material;
    const auto& form = built.plan.bodies[i].description.form;
    const bool is_mesh = std::holds_alternative<world::SolidDescription>(form) ||
                         std::holds_alternative<world::ShellDescription>(form);
    if (!is_mesh || !(material.yield > 0.0)) continue;
    scene::book(
        doubts, body.place,
        fmt::format(
            "\"{}\" is of \"{}\", which yields, but criterion = \"paper\" knows neither dents nor holes",
            body.name, material.name),
        "it holds or breaks as if brittle; criterion = \"event\", the usual one, dents and perforates it");
    return;
  }
}

}  // namespace

void doubt_bodies(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                  scene::Problems& doubts) {
  doubt_thickness(scene, built, doubts);
  doubt_triangles(scene, built, doubts);
  doubt_sizes(scene, built, doubts);
  doubt_materials(scene, doubts);
  doubt_kinds(scene, doubts);
  doubt_tempering(scene, built, doubts);
  doubt_paths(scene, doubts);
  doubt_criterion(scene, built, doubts);
}

}  // namespace shatterbox::sandbox::run
