// Events that wait for something to happen.
#include <map>
#include <string>

#include <catch2/catch.hpp>

#include "sandbox/script/script.h"
#include "tests/sandbox/script/building.h"

using namespace shatterbox;
using namespace shatterbox::sandbox;

namespace {

/// The step border at which there is one body more than there was; -1 if that does not come.
long find_entry(const std::string& text, long most_steps) {
  const auto reading = scene::read(text);
  auto built = build(reading);
  script::Script script(*reading.scene);
  for (long step = 0; step < most_steps; ++step) {
    const std::size_t count = built->world.bodies().size();
    CHECK(script.play(*built).empty());
    if (built->world.bodies().size() > count) return step;
    built->world.step();
  }
  return -1;
}

const std::string kDrop = "do = \"drop\"\nbody = {kind = \"sphere\", radius = 0.01}\nposition = [5,5,0]\n";

}  // namespace

TEST_CASE("an event that waits for rest comes half a second after all is quiet, and its delay later") {
  // The ball lies on the floor from the start; at 0.1 s it is kicked up at 1 m/s and is in the air for 0.2 s.
  const std::string lying =
      "[[pair]]\nbetween = [\"steel\", \"steel\"]\nrestitution = 0\n"
      "[[body]]\nkind = \"plane\"\nmaterial = \"steel\"\n"
      "[[body]]\nname = \"a\"\nkind = \"box\"\nsize = 0.1\nposition = [0,0.05,0]\nmaterial = \"steel\"\n";
  const std::string kick = "[[event]]\nat = 0.1\ndo = \"push\"\nbody = \"a\"\nimpulse = [0,7.85,0]\n";
  const long still = find_entry(lying + "[[event]]\nwhen = \"rest\"\n" + kDrop, 400);
  CHECK(still >= 120);
  CHECK(still <= 125);
  const long delayed = find_entry(lying + "[[event]]\nwhen = \"rest\"\nafter = 0.25\n" + kDrop, 400);
  CHECK(delayed == still + 60);
  const long kicked = find_entry(lying + kick + "[[event]]\nwhen = \"rest\"\n" + kDrop, 600);
  CHECK(kicked >= 24 + 48 + 120 - 2);
  CHECK(kicked <= 24 + 48 + 120 + 40);
  // The same where nobody sleeps.
  const long awake =
      find_entry("[scene]\nsleep = false\n" + lying + kick + "[[event]]\nwhen = \"rest\"\n" + kDrop, 600);
  CHECK(awake >= 24 + 48 + 120 - 2);
  CHECK(awake <= 24 + 48 + 120 + 40);
}

TEST_CASE("what flies never rests, and a world in which nothing can move does not either") {
  CHECK(find_entry("[scene]\ngravity = [0,0,0]\n[[body]]\nkind = \"sphere\"\nvelocity = [1,0,0]\n"
                   "[[event]]\nwhen = \"rest\"\n" +
                       kDrop,
                   300) == -1);
  CHECK(find_entry("[[body]]\nkind = \"plane\"\n[[event]]\nwhen = \"rest\"\n" + kDrop, 300) == -1);
}

TEST_CASE("an event that waits for the first break comes on the border after its step") {
  const std::string text =
      "[[body]]\nkind = \"plane\"\n[[body]]\nname = \"ball\"\nkind = \"shell\"\nshape = \"sphere\"\n"
      "radius = 0.05\nthickness = 0.0006\nedge_length = 0.012\nmaterial = \"glass\"\nposition = [0,0.1,0]\n"
      "velocity = [0,-6,0]\n";
  auto built = build(scene::read(text));
  while (built->world.report().breaks.empty() && built->world.steps() < 100) built->world.step();
  const long broken = built->world.steps();
  CHECK(find_entry(text + "[[event]]\nwhen = \"first break\"\n" + kDrop, 100) == broken);
  CHECK(find_entry(text + "[[event]]\nwhen = \"first break\"\nafter = 0.05\n" + kDrop, 100) == broken + 12);
}

TEST_CASE("an event may wait for the first break of one body, of one of its copies, or of what is thrown") {
  const auto glass = [](const std::string& name, const std::string& more) {
    return "[[body]]\nname = \"" + name +
           "\"\nkind = \"shell\"\nshape = \"sphere\"\nradius = 0.05\nthickness = 0.0006\n"
           "edge_length = 0.012\nmaterial = \"glass\"\n" +
           more;
  };
  const auto waits = [](const std::string& name, const std::string& of) {
    return "[[event]]\nname = \"" + name + "\"\nwhen = \"first break\"\n" + of +
           "do = \"caption\"\ntext = \"crack\"\n";
  };
  const auto reading = scene::read(
      "[[body]]\nkind = \"plane\"\n" +
      glass("cup",
            "velocity = [0,-6,0]\nposition = [0,0.1,0]\nrepeat = {count = 2, spacing = [0.3,0.12,0]}\n") +
      glass("jar", "") +
      "[[event]]\nat = 0.05\ndo = \"projectile\"\nbody = \"jar\"\nfrom = [1,0.3,0]\n"
      "at_point = [1,0,0]\nspeed = 6\n" +
      waits("thrown", "of = \"jar\"\n") + waits("second", "of = \"cup[2]\"\n") +
      waits("either", "of = \"cup\"\n") + waits("any", ""));
  auto built = build(reading);
  script::Script script(*reading.scene);
  std::map<std::string, long> came, broke;  // steps
  while (built->world.steps() < 60) {
    CHECK(script.play(*built).empty());
    for (const scene::Cue& cue : script.take_cues()) came[cue.event->name] = built->world.steps();
    built->world.step();
    for (const world::BreakRow& row : built->world.report().breaks)
      broke.emplace(row.body, built->world.steps());
  }
  CHECK(came.size() == 4);
  CHECK(came["any"] == broke.at("cup[1]"));
  CHECK(came["either"] == broke.at("cup[1]"));
  CHECK(came["second"] == broke.at("cup[2]"));
  CHECK(came["thrown"] == broke.at("jar"));
  CHECK(came["either"] < came["second"]);
  CHECK(came["second"] < came["thrown"]);
}
