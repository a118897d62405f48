// The bridge: poses, cracks and looks arrive in the frame; every name has its look.
#include "sandbox/view/view.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "engine/geometry/edge_topology.h"
#include "sandbox/view/looks.h"
#include "sandbox/view/wardrobe.h"
#include "tests/sandbox/script/building.h"

using namespace shatterbox;
using namespace shatterbox::sandbox;

TEST_CASE("a body's pose, mesh and look arrive in the frame") {
  const auto reading = scene::read(
      "[[body]]\nkind = \"plane\"\nposition = [0, 0.25, 0]\n"
      "[[body]]\nkind = \"box\"\nsize = [1, 2, 3]\nposition = [1, 2, 3]\nrotation = [0, 90, 0]\n"
      "[[body]]\nkind = \"shell\"\nshape = \"sphere\"\nradius = 0.2\nposition = [0, 1, 0]\nedge_length = "
      "0.1\n"
      "look = \"glossy\"\ncolour = \"#ff0000\"\nbreakable = false\n");
  const auto built = build(reading);
  view::View view(*reading.scene, *built);
  const render::Frame frame = view.make_frame();
  REQUIRE(frame.ground.has_value());
  CHECK(frame.ground->height == Approx(0.25F));
  REQUIRE(frame.draws.size() == 2);  // the level plane is the ground
  const glm::vec4 x = frame.draws[0].world_from_body * glm::vec4(1, 0, 0, 1);
  CHECK(x.x == Approx(1).margin(1e-6));
  CHECK(x.y == Approx(2));
  CHECK(x.z == Approx(2));  // x turned about y by 90 degrees points to -z
  CHECK(frame.draws[1].mesh->surface == render::Surface::shell);
  CHECK(frame.ground->id == built->world.bodies()[0].id);  // what truth images call them
  CHECK(frame.draws[0].id == built->world.bodies()[1].id);
  CHECK(frame.draws[1].looks[0].outside.r == Approx(1.0F));
  CHECK(frame.draws[1].looks[0].outside.g == Approx(0.0F));
  CHECK(frame.draws[0].mesh->id != frame.draws[1].mesh->id);
  // The same shape keeps its id, so that it is uploaded once.
  CHECK(view.make_frame().draws[1].mesh.get() == frame.draws[1].mesh.get());
}

TEST_CASE("crack edges become crack bits of the triangles they bound") {
  body::Shape shape;
  shape.kind = body::ShapeKind::shell;
  shape.surface.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  shape.surface.triangles = {{0, 1, 2}, {0, 2, 3}};
  shape.topology = geometry::build_edge_topology(shape.surface.triangles);
  shape.crack_edges.assign(shape.topology.edges.size(), 0);
  for (std::size_t e = 0; e < shape.topology.edges.size(); ++e) {
    if (shape.topology.edges[e] == std::array<int, 2>{2, 3}) shape.crack_edges[e] = 1;
  }
  shape.material_from_body = Vec3(0, 0, 5);
  const auto mesh = view::make_mesh(shape, 9);
  CHECK(mesh->id == 9);
  REQUIRE(mesh->cracks.size() == 2);
  CHECK(mesh->cracks[0] == 0);
  CHECK(mesh->cracks[1] == render::kCrackEdge1);
  CHECK(mesh->pattern_positions[0].z == Approx(5.0F));  // paint stays where it was on the whole
}

TEST_CASE("every name of the vocabulary means something") {
  for (const std::string& name : scene::kLookNames) {
    CHECK(view::make_looks(name, std::nullopt, 0.1, Vec3::Zero(), 0).size() == 4);
  }
  for (const std::string& name : scene::kGroundNames) {
    CHECK(view::make_ground(name, 0.0).has_value() == (name != "none"));
  }
  for (const material::Preset& preset : material::presets()) {
    CHECK(view::usual_look(preset.material.name) != "matt");
  }
}

TEST_CASE("glass of one colour is as dark as a sheet as it is as a block with its two faces") {
  const auto tint_of = [](const std::string& form, const std::string& look) {
    const auto reading = scene::read("[[body]]\nname = \"thing\"\nlook = \"" + look +
                                     "\"\ncolour = \"#88c0a0\"\nmaterial = \"glass\"\n" + form);
    const auto built = build(reading);
    return view::Wardrobe(*reading.scene, *built).looks_of(1).front().outside;
  };
  const std::string sheet =
      "kind = \"shell\"\nshape = \"pane\"\nwidth = 0.1\nheight = 0.1\nthickness = 0.004\n";
  const glm::vec3 once = view::linear_colour(Vec3(0x88, 0xc0, 0xa0) / 255.0);
  for (const std::string look : {"glass", "frosted", "ice"}) {
    CHECK(glm::distance(tint_of(sheet, look), once) < 1e-6F);
    for (const std::string block :
         {"kind = \"solid\"\nshape = \"slab\"\nsize = [0.1, 0.1, 0.01]\n", "kind = \"box\"\nsize = 0.1\n"}) {
      const glm::vec3 face = tint_of(block, look);
      CHECK(glm::distance(face * face, once) < 1e-6F);
    }
  }
  const glm::vec3 paint = tint_of("kind = \"box\"\nsize = 0.1\n", "glossy");
  CHECK(glm::distance(paint, once) < 1e-6F);
}

TEST_CASE("wood has its fibres along what it is longest") {
  const auto pattern_of = [](const std::string& form) {
    const auto reading = scene::read("[[body]]\nname = \"thing\"\nlook = \"wood\"\n" + form);
    const auto built = build(reading);
    return view::Wardrobe(*reading.scene, *built).looks_of(1).front().pattern;
  };
  CHECK(pattern_of("kind = \"box\"\nsize = [1, 0.1, 0.2]\n") == render::Pattern::grain_x);
  CHECK(pattern_of("kind = \"box\"\nsize = [0.1, 0.3, 0.2]\n") == render::Pattern::grain_y);
  CHECK(pattern_of("kind = \"capsule\"\nradius = 0.1\n") == render::Pattern::grain_y);
  CHECK(pattern_of("kind = \"shell\"\nshape = \"boat\"\n") == render::Pattern::grain_x);
}

TEST_CASE("bricks are not all of one colour unless they are given one") {
  const auto colours_of = [](const std::string& colour) {
    const auto reading = scene::read(
        "[[body]]\nkind = \"box\"\nsize = 0.1\nlook = \"brick\"\nrepeat = {count = 12, spacing = 0.2}\n" +
        colour);
    const auto built = build(reading);
    view::Wardrobe wardrobe(*reading.scene, *built);
    std::set<float> reds;
    for (const body::Body& body : built->world.bodies())
      reds.insert(wardrobe.looks_of(body.id).front().outside.r);
    return reds.size();
  };
  CHECK(colours_of("") > 2);
  CHECK(colours_of("colour = \"#a2543b\"\n") == 1);
}

TEST_CASE("a light preset is a sun with a sky and a backdrop that single keys override") {
  const auto frame_of = [](const std::string& tables) {
    const auto reading = scene::read("[[body]]\nkind = \"sphere\"\n" + tables);
    auto built = build(reading);
    return view::View(*reading.scene, *built).make_frame();
  };
  const render::Frame usual = frame_of(""), studio = frame_of("[light]\npreset = \"studio\"\n");
  CHECK(studio.lights.sun_direction == usual.lights.sun_direction);
  CHECK(studio.lights.sky_strength == usual.lights.sky_strength);
  CHECK(studio.backdrop.sweep == usual.backdrop.sweep);
  const std::string evening_text = "[light]\npreset = \"evening\"\n";
  const render::Frame evening = frame_of(evening_text);
  CHECK(evening.lights.sun_direction != usual.lights.sun_direction);
  CHECK(evening.backdrop.top == view::make_backdrop("evening").top);
  const render::Frame mixed =
      frame_of(evening_text + "sun = {strength = 0.5}\nsky = 0.7\n[render]\nbackdrop = \"white\"\n");
  CHECK(mixed.lights.sun_direction == evening.lights.sun_direction);
  CHECK(mixed.lights.sun_colour == evening.lights.sun_colour);
  CHECK(mixed.lights.sky_colour == evening.lights.sky_colour);
  CHECK(mixed.lights.sun_strength == Approx(0.5F));
  CHECK(mixed.lights.sky_strength == Approx(0.7F));
  CHECK(mixed.backdrop.top == view::make_backdrop("white").top);
  // Every light has a backdrop that exists.
  for (const std::string& light : scene::kLightNames) {
    const std::string backdrop = view::usual_backdrop(light);
    CHECK(std::count(scene::kBackdropNames.begin(), scene::kBackdropNames.end(), backdrop) == 1);
  }
}

TEST_CASE("the overlay stress shows what a sheet and a solid bore that hold") {
  const auto reading = scene::read(R"(
[[body]]
kind = "shell"
shape = "pane"
width = 0.4
height = 0.4
thickness = 0.01
edge_length = 0.05
rotation = [90, 0, 0]
position = [0, 1, 0]
material = "glass"
support = "edge"
[[body]]
kind = "sphere"
radius = 0.01
position = [0, 1.02, 0]
velocity = [0, -3, 0]
[[body]]
kind = "solid"
shape = "slab"
size = [0.4, 0.05, 0.4]
element_size = 0.03
position = [2, 1, 0]
material = "glass"
support = {box = [[-1, -1, -1], [1, -0.024, 1]]}
[[body]]
kind = "sphere"
radius = 0.01
position = [2.05, 1.04, 0.02]
velocity = [0, -3, 0]
[render]
overlay = "stress"
)");
  auto built = build(reading);
  view::View view(*reading.scene, *built);
  for (int step = 0; step < 48; ++step) built->world.step();
  REQUIRE(built->world.bodies().size() == 4);  // nothing broke
  const render::Frame frame = view.make_frame();
  REQUIRE(frame.draws.size() == 4);
  for (const std::size_t i : {0U, 2U}) {
    INFO(i);
    const body::Body& body = built->world.bodies()[i];
    const world::StressPicture picture = built->world.stress_picture(body.id);
    REQUIRE(picture.triangle_stress.size() == body.shape->surface.triangles.size());
    const double most = *std::max_element(picture.triangle_stress.begin(), picture.triangle_stress.end());
    CHECK(most > 0.0);
    CHECK(most < picture.strength);
    REQUIRE(frame.draws[i].scalars != nullptr);
    const std::vector<float>& shown = *frame.draws[i].scalars;
    CHECK(shown.size() == frame.draws[i].mesh->positions.size());
    CHECK(*std::max_element(shown.begin(), shown.end()) > 0.0F);
  }
}

TEST_CASE("the overlay level_set cuts solids open towards the eye and shows their distance to the surface") {
  const auto reading = scene::read(
      "[[body]]\nkind = \"solid\"\nshape = \"slab\"\nsize = [0.4, 0.2, 0.6]\nposition = [0, 1, 0]\nbreakable "
      "= "
      "false\n"
      "[[body]]\nkind = \"shell\"\nshape = \"sphere\"\nradius = 0.2\nposition = [2, 1, 0]\nedge_length = "
      "0.1\nbreakable = false\n"
      "[camera]\nposition = [0, 1.1, 3]\ntarget = [0, 1, 0]\n[render]\noverlay = \"level_set\"\n");
  const auto built = build(reading);
  view::View view(*reading.scene, *built);
  const render::Frame frame = view.make_frame();
  REQUIRE(frame.draws.size() == 2);
  CHECK(frame.overlay.kind == render::OverlayKind::heat);
  CHECK(frame.overlay.least == -frame.overlay.most);
  CHECK(frame.draws[1].scalars == nullptr);  // a shell has no inside
  const render::Draw& solid = frame.draws[0];
  REQUIRE(solid.scalars != nullptr);
  const auto& positions = solid.mesh->positions;
  REQUIRE(solid.scalars->size() == positions.size());
  float deepest = 0.0F, worst = 0.0F;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const glm::vec3 p = positions[v];
    CHECK(p.z <= 0.02F);  // the half towards the eye is left out
    const glm::vec3 room = glm::vec3(0.2F, 0.1F, 0.3F) - glm::abs(p);
    const glm::vec3 outside = glm::max(-room, glm::vec3(0.0F));
    const float distance = glm::length(outside) - std::max(0.0F, std::min({room.x, room.y, room.z}));
    worst = std::max(worst, std::abs((*solid.scalars)[v] - 1e3F * distance));
    deepest = std::min(deepest, (*solid.scalars)[v]);
  }
  CHECK(deepest == Approx(-100.0F).margin(3.0F));  // mm: half of the least side
  CHECK(worst < 3.5F);                             // a fifth of a cell of 15.6 mm
  const auto part = [](const view::View& shown, const std::string& name) {
    for (const world::PartCount& row : shown.inventory())
      if (row.part == name) return row;
    FAIL("no part is called " << name);
    return world::PartCount{};
  };
  CHECK(part(view, "level_sets").count == 1);
  CHECK(part(view, "level_sets").bytes > 1e5);
  CHECK(part(view, "overlays").count == 2);
  CHECK(part(view, "overlays").bytes >= sizeof(float) * static_cast<double>(positions.size()));
  auto plain = *reading.scene;
  plain.render.overlay = "stress";
  view::View without(plain, *built);
  CHECK(without.make_frame().draws.size() == 2);
  CHECK(part(without, "level_sets").count == 0);
  CHECK(part(without, "level_sets").bytes == 0.0);
  CHECK(part(without, "overlays").count == 2);
  plain.render.overlay = "none";
  view::View bare(plain, *built);
  CHECK(bare.make_frame().draws.size() == 2);
  for (const char* name : {"level_sets", "overlays"}) {
    CHECK(part(bare, name).count == 0);
    CHECK(part(bare, name).bytes == 0.0);
  }
  // The same cut is the same mesh.
  CHECK(view.make_frame().draws[0].mesh.get() == solid.mesh.get());
}
