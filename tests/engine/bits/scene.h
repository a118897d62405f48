// A small world in which most of what a world does happens within a few steps: a glass ball and a block of
// plaster break, boxes stand on each other and are struck, mortar holds two of them, two thin boats meet.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/geometry/generators.h"
#include "engine/world/world.h"

namespace shatterbox::test {

inline world::World make_everything() {
  world::World w{world::WorldSettings{}};
  material::Material glass = *material::find_preset("glass");
  glass.flaw_area = 1e-3;
  const int glass_number = w.add_material(glass).value(),
            plaster_number = w.add_material(*material::find_preset("plaster")).value();
  const auto add = [&w](world::BodyDescription description, int material, const Vec3& place,
                        const Vec3& velocity) {
    description.material = material;
    description.pose.translation = place;
    description.velocity = velocity;
    return w.add_body(description).value();
  };
  geometry::Meshing meshing;
  meshing.edge_length = 0.012;
  world::BodyDescription ground, ball, slab, box, boat;
  ground.form = world::PlaneDescription{};
  add(ground, 0, Vec3::Zero(), Vec3::Zero());
  world::ShellDescription shell;
  shell.mesh = geometry::make_sphere(0.04, meshing).value();
  shell.thickness = 0.5e-3;
  ball.form = shell;
  add(ball, glass_number, Vec3(0, 0.045, 0), Vec3(0, -2, 0));
  world::SolidDescription solid;
  solid.mesh = geometry::make_box_surface(Vec3(0.08, 0.02, 0.05));
  solid.element_size = 0.04;
  slab.form = solid;
  slab.pose.rotation = Quat(Eigen::Quaterniond(0.97, 0.1, 0.15, 0.16).normalized());
  add(slab, plaster_number, Vec3(0.3, 0.07, 0), Vec3(0, -10, 0));
  box.form = world::BoxDescription{Vec3::Constant(0.02)};
  std::vector<body::BodyId> stack;
  for (int k = 0; k < 3; ++k)
    stack.push_back(add(box, plaster_number, Vec3(-0.2, 0.0201 + 0.0402 * k, 0), Vec3::Zero()));
  world::JointDescription mortar;
  mortar.body_a = stack[1];
  mortar.body_b = stack[2];
  mortar.form = world::MortarDescription{};
  w.add_joint(mortar).value();
  world::BodyDescription shot;
  shot.form = world::SphereDescription{0.01};
  add(shot, glass_number, Vec3(-0.24, 0.1, 0.003), Vec3(5, 0, 0));
  meshing.edge_length = 0.03;
  shell.mesh = geometry::make_pane(0.1, 0.08, meshing).value();
  shell.is_breakable = false;
  boat.form = shell;
  add(boat, glass_number, Vec3(0, 0.3, 0.4), Vec3(0, 0, 3));
  boat.pose.rotation = Quat(Eigen::Quaterniond(0.8, 0.1, 0.58, 0.05).normalized());
  add(boat, glass_number, Vec3(0.01, 0.31, 0.43), Vec3(0, 0, -3));
  return w;
}

inline constexpr int kBitSteps = 4;

/// The chained hash behind each of the steps.
inline std::vector<std::uint64_t> play_hashes(int steps = kBitSteps) {
  world::World w = make_everything();
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < steps; ++i) {
    w.step();
    hashes.push_back(w.state_hash());
  }
  return hashes;
}

}  // namespace shatterbox::test
