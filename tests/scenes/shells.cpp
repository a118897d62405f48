// Scenes of infinitely thin things, stepped here: nothing crosses at the start or at any step's end, and each
// does what its first line says.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>

#include "engine/geometry/crossings.h"
#include "sandbox/scene/build_world.h"
#include "sandbox/scene/find_scene.h"
#include "sandbox/scene/read_scene.h"
#include "sandbox/script/script.h"

using namespace shatterbox;
using namespace shatterbox::sandbox;

namespace {

/// A scene that came along, with changes as of --set, its world and its script.
struct Play {
  scene::SceneDescription scene;
  std::optional<scene::BuiltScene> built;

  explicit Play(const std::string& name, const std::vector<std::string>& changes = {}) {
    scene::Problems problems;
    auto read = scene::read_scene_file(scene::find_scene(name, problems), {changes, ""}, problems);
    INFO(scene::describe(problems));
    REQUIRE(read.has_value());
    scene = std::move(*read);
    built = scene::build_world(scene, problems);
    INFO(scene::describe(problems));
    REQUIRE(built.has_value());
  }

  world::World& world() { return built->world; }

  /// Steps for `seconds`, or until it is enough; `look` after each step.
  void run(
      double seconds, const std::function<void()>& look,
      const std::function<bool()>& is_enough = [] { return false; }) {
    script::Script script(scene);
    const double end = world().time() + seconds - 1e-9;
    while (world().time() < end && !is_enough()) {
      for (const std::string& word : script.play(*built)) {
        INFO(word);  // what flies about may be where something would come in
        CHECK(word.find(" waits at ") != std::string::npos);
      }
      world().step();
      look();
    }
  }

  const body::Body& named(const std::string& name) {
    const auto bodies = world().bodies();
    const auto found =
        std::find_if(bodies.begin(), bodies.end(), [&](const body::Body& b) { return b.name == name; });
    REQUIRE(found != bodies.end());
    return *found;
  }
};

long count_crossings(std::span<const body::Body> bodies) {
  std::vector<geometry::TriangleMesh> meshes;
  for (const body::Body& body : bodies) {
    if (body.shape->kind != body::ShapeKind::shell) continue;
    meshes.push_back(body.shape->surface);
    for (Vec3& p : meshes.back().positions) p = body.pose.apply(p);
  }
  return geometry::count_crossing_pairs(meshes);
}

}  // namespace

TEST_CASE("no scene begins with shells that cross") {
  for (const char* name : {"boats_pile", "boats_edge", "ornaments", "card_house", "plate_stack", "bowls",
                           "rain", "champagne_tower"}) {
    INFO(name);
    Play play(name);
    CHECK(count_crossings(play.world().bodies()) == 0);
  }
}

TEST_CASE("boats_edge: the boats meet, and neither is in the other at any step's end, at any speed") {
  for (const char* speed : {"1", "10", "100"}) {
    INFO(speed << " m/s");
    Play play("boats_edge", {std::string("upper.velocity=[0,-") + speed + ",0]"});
    long crossings = 0;
    double most_contacts = 0.0, least_height = 1e9;
    play.run(0.7, [&] {
      crossings += count_crossings(play.world().bodies());
      most_contacts = std::max<double>(most_contacts, play.world().report().contact.contacts);
      least_height = std::min(least_height, play.named("upper").pose.translation.y());
    });
    CHECK(crossings == 0);
    CHECK(most_contacts > 0);
    CHECK(least_height < 0.6);
  }
}

TEST_CASE("rain: no ball gets through a plate that holds") {
  Play play("rain");
  const body::Body plate = play.named("held[1]");  // all are turned alike
  struct Track {
    Vec3 last = Vec3::Zero();
    bool is_known = false;
  };
  std::map<body::BodyId, Track> tracks;
  std::vector<Pose> plates;
  for (const body::Body& body : play.world().bodies())
    if (body.name.rfind("held[", 0) == 0) plates.push_back(body.pose);
  REQUIRE(plates.size() == 6);
  long passages = 0;
  std::size_t balls = 0;
  play.run(1.8, [&] {
    for (const body::Body& body : play.world().bodies()) {
      if (body.shape->kind != body::ShapeKind::sphere) continue;
      Track& track = tracks[body.id];
      for (const Pose& pose : plates) {
        if (!track.is_known) break;
        const Vec3 from = pose.apply_inverse(track.last), to = pose.apply_inverse(body.pose.translation);
        if ((from.z() > 0.0) == (to.z() > 0.0)) continue;
        const Vec3 at = from + (to - from) * (from.z() / (from.z() - to.z()));
        if (std::abs(at.x()) < 0.18 && std::abs(at.y()) < 0.25) ++passages;
      }
      track = {body.pose.translation, true};
    }
    balls = tracks.size();
  });
  CHECK(balls == 72);
  CHECK(passages == 0);
}

TEST_CASE("card_house: stands by friction alone, and a ball ends it") {
  Play standing("card_house");
  const double top = standing.named("left_4").pose.translation.y();
  standing.run(0.5, [] {});
  CHECK(standing.named("left_4").pose.translation.y() == Approx(top).margin(0.004));
  Play hit("card_house", {"throw.at=0", "throw.from=[-0.3,0.15,0.03]"});
  hit.run(1.0, [] {});
  CHECK(hit.named("left_4").pose.translation.y() < 0.5 * top);
}

TEST_CASE("bowls: what is poured into the large bowl stays in it, and nothing is in anything else") {
  Play play("bowls", {"small.repeat.count=10"});
  long crossings = 0;
  int step = 0;
  play.run(1.5, [&] {
    if (++step % 10 == 0) crossings += count_crossings(play.world().bodies());
  });
  CHECK(crossings == 0);
  int inside = 0;
  for (const body::Body& body : play.world().bodies()) {
    if (body.name.rfind("small", 0) != 0) continue;
    const Vec3& p = body.pose.translation;
    inside += p.y() > 0.0 && p.y() < 0.3 && std::hypot(p.x(), p.z()) < 0.32 ? 1 : 0;
  }
  CHECK(inside == 10);
}

TEST_CASE("plate_stack: stands whole until the ball comes, which breaks some plates and leaves others") {
  // Three plates of either kind instead of five, hit at the same height below the top; until it has broken.
  Play play("plate_stack", {"throw.at=0.25", "dinner.repeat.count=3", "dessert.repeat.count=3",
                            "throw.from=[-1.2,0.287,0.5]", "throw.at_point=[-0.06,0.082,0.02]"});
  const auto breaks = [&] { return play.world().report().breaks.size(); };
  const double top = play.named("dessert[3]").pose.translation.y();
  play.run(0.25, [] {});
  CHECK(breaks() == 0);
  CHECK(play.named("dessert[3]").pose.translation.y() == Approx(top).margin(0.01));
  play.run(
      0.2, [] {}, [&] { return breaks() > 0; });
  CHECK(breaks() > 0);
  int whole = 0;
  for (const body::Body& body : play.world().bodies())
    whole += body.shape->kind == body::ShapeKind::shell && play.world().ancestry(body.id).parent == 0 ? 1 : 0;
  CHECK(whole >= 2);
  CHECK(whole < 6);
}

TEST_CASE("champagne_tower: glasses stand on the rims of those below, until one of these is shattered") {
  std::vector<std::string> settings{"throw.at=0.3"};
  for (const char* storey : {"lower", "middle", "top"})
    settings.push_back(storey + std::string(".edge_length=0.007"));
  Play play("champagne_tower", settings);
  const Vec3 top = play.named("top").pose.translation;
  const auto breaks = [&] { return play.world().report().breaks.size(); };
  play.run(0.3, [] {});
  CHECK(breaks() == 0);
  CHECK((play.named("top").pose.translation - top).norm() < 1e-3);
  play.run(
      0.2, [] {}, [&] { return breaks() > 0; });
  CHECK(breaks() > 0);
  CHECK(play.named("top").pose.translation.y() > 0.28);
}

TEST_CASE("ornaments: ten thousand triangles each, and enough pieces of each") {
  Play play("ornaments", {"ornaments.repeat.count=1"});
  const body::Body& ornament = play.named("ornaments");
  CHECK(ornament.shape->surface.triangles.size() > 10000);
  CHECK(ornament.shape->surface.triangles.size() < 11000);
  const auto count = [&] { return play.world().bodies().size(); };
  play.run(
      0.45, [] {}, [&] { return count() > 20; });
  CHECK(count() > 20);  // and the floor
}
