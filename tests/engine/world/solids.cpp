// Solids as bodies: the inside of a closed mesh has mass, its surface meets others.
#include <catch2/catch.hpp>

#include "engine/audit/audit.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/mass_properties.h"
#include "engine/world/world.h"

using namespace shatterbox;

namespace {

world::BodyDescription make_slab(const Vec3& half_extent, const Vec3& offset) {
  world::BodyDescription body;
  body.name = "slab";
  world::SolidDescription solid;
  solid.is_breakable = false;
  solid.mesh = geometry::make_box_surface(half_extent);
  for (Vec3& p : solid.mesh.positions) p += offset;
  body.form = solid;
  return body;
}

}  // namespace

TEST_CASE("a solid has the mass of its inside, about its centre of mass") {
  world::World w{world::WorldSettings{}};
  material::Material material;
  material.density = 1800.0;
  REQUIRE(w.add_material(material).ok());
  const Vec3 half(0.3, 0.1, 0.2), offset(1.0, -2.0, 0.5);
  world::BodyDescription slab = make_slab(half, offset);
  slab.pose.translation = Vec3(5.0, 6.0, 7.0);
  REQUIRE(w.add_body(slab).ok());
  const body::Body& body = w.bodies()[0];
  const auto expected = geometry::box_mass_properties(half, 1800.0);
  CHECK(body.shape->mass == Approx(expected.mass).epsilon(1e-13));
  CHECK((body.shape->inertia - expected.inertia).norm() < 1e-12 * expected.inertia.norm());
  CHECK((body.pose.translation - Vec3(6.0, 4.0, 7.5)).norm() < 1e-13);
}

TEST_CASE("solids tumble onto each other and come to rest, as boxes do") {
  world::WorldSettings settings;
  world::World w(settings);
  REQUIRE(w.add_material(*material::find_preset("ceramic")).ok());
  world::BodyDescription ground;
  ground.form = world::PlaneDescription{};
  REQUIRE(w.add_body(ground).ok());
  for (int i = 0; i < 4; ++i) {
    world::BodyDescription slab = make_slab(Vec3(0.15, 0.05, 0.1), Vec3::Zero());
    slab.pose.translation = Vec3(0.02 * i, 0.2 + 0.3 * i, 0.01 * i);
    slab.pose.rotation = Quat(Eigen::AngleAxisd(0.3 + 0.1 * i, Vec3(1, 2, 3).normalized()));
    REQUIRE(w.add_body(slab).ok());
  }
  w.keep_ways();
  audit::Audit audit;
  for (int step = 0; step < 720; ++step) {
    audit.begin_step(w.bodies());
    w.step();
    audit.end_step(w.bodies(), {}, w.ways(), w.time());
  }
  CHECK(audit.report().crossings == 0);
  CHECK(audit.report().passages == 0);
  const double energy = 4 * w.bodies()[1].shape->mass * 9.81 * 0.65;
  CHECK(w.report().conservation.greatest_energy_rise < 1e-3 * energy);
  for (const body::Body& body : w.bodies()) CHECK((!body.is_dynamic() || !body.is_awake));
  for (const body::Body& body : w.bodies())
    for (const Vec3& p : body.shape->surface.positions) CHECK(body.pose.apply(p).y() > 0.0);
}

TEST_CASE("a solid that is open, flat or inside out is refused in words") {
  world::World w{world::WorldSettings{}};
  REQUIRE(w.add_material(material::Material{}).ok());
  const auto refusal = [&](const auto& change) {
    world::BodyDescription body = make_slab(Vec3(0.1, 0.1, 0.1), Vec3::Zero());
    change(std::get<world::SolidDescription>(body.form).mesh);
    const auto id = w.add_body(body);
    REQUIRE(!id.ok());
    return id.error();
  };
  using geometry::TriangleMesh;
  CHECK(refusal([](TriangleMesh& m) { m.triangles.pop_back(); }).find("closed") != std::string::npos);
  CHECK(refusal([](TriangleMesh& m) {
          for (auto& t : m.triangles) std::swap(t[0], t[1]);
        }).find("inside out") != std::string::npos);
  CHECK(refusal([](TriangleMesh& m) {
          for (Vec3& p : m.positions) p.y() = 0.0;
        }).find("flat") != std::string::npos);
}
