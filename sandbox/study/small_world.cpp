#include "sandbox/study/small_world.h"

#include <cmath>
#include <stdexcept>

#include "sandbox/study/stopwatch.h"

namespace shatterbox::sandbox::study {

material::Material plain_material(double friction, double restitution) {
  material::Material material;
  material.name = "plain";
  material.friction = friction;
  material.restitution = restitution;
  return material;
}

int add_material(world::World& world, const material::Material& material) {
  const auto number = world.add_material(material);
  if (!number) throw std::runtime_error(number.error());
  return number.value();
}

body::BodyId add_body(world::World& world, const world::BodyDescription& description) {
  const auto id = world.add_body(description);
  if (!id) throw std::runtime_error(id.error());
  return id.value();
}

world::BodyDescription box_description(const Vec3& half_extent, const Vec3& place, int material) {
  world::BodyDescription box;
  box.name = "box";
  box.form = world::BoxDescription{half_extent};
  box.material = material;
  box.pose.translation = place;
  return box;
}

world::BodyDescription ball_description(double radius, const Vec3& place, int material) {
  world::BodyDescription ball;
  ball.name = "ball";
  ball.form = world::SphereDescription{radius};
  ball.material = material;
  ball.pose.translation = place;
  return ball;
}

world::BodyDescription floor_description(int material) {
  world::BodyDescription floor;
  floor.name = "floor";
  floor.form = world::PlaneDescription{};
  floor.material = material;
  floor.motion = body::Motion::fixed;
  return floor;
}

long steps_in(const world::World& world, double seconds) {
  return std::lround(seconds * world.settings().steps_per_second);
}

double advance(world::World& world, double seconds) {
  const long steps = steps_in(world, seconds);
  const Stopwatch watch;
  for (long i = 0; i < steps; ++i) world.step();
  return watch.seconds();
}

}  // namespace shatterbox::sandbox::study
