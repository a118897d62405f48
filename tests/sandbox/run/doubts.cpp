// What a scene can hardly mean is told with its place, and what it may well mean is not.
#include <catch2/catch.hpp>

#include "sandbox/run/doubts.h"
#include "sandbox/run/foresee.h"
#include "sandbox/run/projector.h"
#include "tests/sandbox/script/building.h"

using namespace shatterbox::sandbox;

namespace {

/// All doubts, as a person sees them.
std::string doubts_of(const std::string& text) {
  const auto reading = scene::read(text);
  const auto built = build(reading);
  return scene::describe(run::find_doubts(*reading.scene, *built));
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

constexpr const char* kFloor = "[[body]]\nname = \"floor\"\nkind = \"plane\"\n";
constexpr const char* kCrate =
    "[[body]]\nname = \"crate\"\nkind = \"box\"\nsize = 0.2\nposition = [0, 0.1, 0]\n";

}  // namespace

TEST_CASE("a shell that is nearly as thick as wide is doubted") {
  const std::string bowl = "[[body]]\nname = \"cup\"\nkind = \"shell\"\nshape = \"bowl\"\nthickness = ";
  CHECK(has(doubts_of(bowl + "3\n"), "t.toml:1:1: the shell \"cup\" is 3 m thick, and 0.16 m across"));
  CHECK(doubts_of(bowl + "0.003\n").empty());
}

TEST_CASE("a sheet from a file of few triangles is doubted, until they are divided") {
  const std::string stone = std::string("[[body]]\nname = \"tank\"\nkind = \"shell\"\nmesh = \"") +
                            SHATTERBOX_SOURCE_DIR + "/scenes/meshes/voussoir.obj\"\nthickness = 0.003\n";
  const std::string doubt = doubts_of(stone);
  CHECK(has(doubt, "t.toml:1:1: \"tank\" has 12 triangles: so few hardly bend"));
  CHECK(has(doubt, "edge_length = "));
  CHECK(doubts_of(stone + "edge_length = 0.02\n").empty());
  CHECK(doubts_of(stone + "breakable = false\n").empty());
  CHECK(has(scene::describe(scene::read(stone + "edge_length = -1\n").problems), "edge_length"));
}

TEST_CASE("properties in other units, and glass of a kind that never breaks, are doubted") {
  const auto bowl_of = [](const std::string& lines) {
    return "[[material]]\nname = \"my\"\nlike = \"glass\"\n" + lines +
           "[[body]]\nname = \"cup\"\nshape = \"bowl\"\nmaterial = \"my\"\n";
  };
  CHECK(has(doubts_of(bowl_of("strength = 50\n")), "t.toml:1:1: \"my\" has a strength of 50 Pa"));
  CHECK(has(doubts_of(bowl_of("young = 70\n")), "70 GPa are 70e9"));
  CHECK(has(doubts_of(bowl_of("density = 2.5\n")), "2.5 g/cm3 are 2500"));
  CHECK(doubts_of(bowl_of("density = 2500\nyoung = 1e6\nstrength = 1e4\n")).empty());
  const std::string ball =
      "[[body]]\nname = \"ball\"\nkind = \"sphere\"\nradius = 0.05\nmaterial = \"glass\"\nposition = [0, 2, "
      "0]\n";
  CHECK(has(doubts_of(ball), "t.toml:1:1: \"ball\" is a sphere of glass, which never breaks"));
  CHECK(has(doubts_of(ball), "kind = \"shell\" with shape = \"sphere\""));
  CHECK(doubts_of(ball + "motion = \"static\"\n").empty());
  CHECK(doubts_of(ball + bowl_of("")).empty());
}

TEST_CASE("toughened glass too thin for dice is doubted, with what would do") {
  const auto pane_of = [](const char* thickness) {
    return std::string(
               "[[body]]\nname = \"pane\"\nshape = \"pane\"\nwidth = 0.6\nheight = 0.6\nsupport = \"edge\"\n"
               "material = \"tempered_glass\"\nthickness = ") +
           thickness + "\n";
  };
  const std::string doubt = doubts_of(pane_of("0.004"));
  CHECK(has(doubt, "t.toml:1:1: \"pane\" stores too little for dice: 4 mm of tempered_glass"));
  CHECK(has(doubt, "its surface_compression 1.2"));
  CHECK(doubts_of(pane_of("0.006")).empty());
}

TEST_CASE("nobody is told to move a camera that he has not placed") {
  const std::string above =
      "[[body]]\nname = \"ceiling\"\nkind = \"plane\"\nposition = [0, 2, 0]\n"
      "[[body]]\nname = \"cup\"\nshape = \"bowl\"\nposition = [0, 1, 0]\n";
  CHECK(!has(doubts_of(above), "camera"));
  CHECK(has(doubts_of(above + "[camera]\nposition = [0, 1, 2]\n"), "the camera is below the floor"));
}

TEST_CASE(
    "bowls that stand in each other are told to settle into one, what stands apart or is solid is not") {
  const auto told = [](const std::string& form, const std::string& spacing, const std::string& more = "") {
    return doubts_of("[[body]]\nname = \"bowl\"\n" + form + "position = [0, 0.2, 0]\nrepeat = {count = 3, " +
                     spacing + "}\n" + more);
  };
  const std::string sheet = "kind = \"shell\"\nshape = \"bowl\"\nheight = 0.07\nthickness = 0.004\n";
  const std::string in_each_other = "spacing = [0, 0.02, 0]";
  const std::string doubt = told(sheet, in_each_other);
  CHECK(has(doubt, "t.toml:1:1: \"bowl[2]\" stands in \"bowl[1]\", 20 mm above it, and settles into it"));
  CHECK(doubt.find("settles") == doubt.rfind("settles"));  // once
  CHECK(has(doubt, "shape = \"lathe\""));
  CHECK(told(sheet, "spacing = [0, 0.075, 0]").empty());
  CHECK(told(sheet, "spacing = [0.3, 0.02, 0]").empty());
  CHECK(told(sheet + "motion = \"static\"\n", in_each_other).empty());
  CHECK(told(sheet, in_each_other, "[scene]\ngravity = [0, 0, 0]\n").empty());
  CHECK(told("kind = \"shell\"\nshape = \"pane\"\nthickness = 0.004\nrotation = [90, 0, 0]\n",
             "spacing = [0, 0.006, 0]")
            .empty());
  CHECK(
      told("kind = \"solid\"\nshape = \"lathe\"\nprofile = [[0, 0], [0.05, 0], [0.08, 0.07], [0.076, 0.07], "
           "[0.046, 0.004], [0, 0.004]]\nelement_size = 0.01\n",
           in_each_other)
          .empty());
}

TEST_CASE(
    "a joint far from both whom it holds is doubted, and what waits for a break where nothing can break") {
  const std::string crate = kCrate;
  const std::string hook =
      "[[body]]\nname = \"hook\"\nkind = \"sphere\"\nradius = 0.05\nposition = [0, 1, 0]\nmotion = "
      "\"static\"\n";
  const std::string joint =
      "[[joint]]\nname = \"rope\"\nkind = \"point\"\nbetween = [\"crate\", \"hook\"]\nat = ";
  CHECK(doubts_of(crate + hook + joint + "[0, 0.95, 0]\n").empty());
  CHECK(doubts_of(crate + hook + joint + "[0, 0.6, 0]\n").empty());  // on an arm that is not seen
  CHECK(has(doubts_of(crate + hook + joint + "[50, 0, 0]\n"),
            "joint \"rope\" is far from both: 50 m from \"crate\" and 50 m from \"hook\""));
  const std::string waits =
      "[[event]]\nname = \"slow\"\nwhen = \"first break\"\ndo = \"speed\"\nfactor = 0.1\n";
  CHECK(
      has(doubts_of(crate + waits), "event \"slow\" waits for the first break, and nothing here can break"));
  const std::string cup = "[[body]]\nname = \"cup\"\nshape = \"bowl\"\nposition = [3, 0, 0]\n";
  CHECK(doubts_of(cup + waits).empty());
  CHECK(doubts_of(crate + cup + waits + "of = \"cup\"\n").empty());
  CHECK(has(doubts_of(crate + cup + waits + "of = \"crate\"\n"),
            "event \"slow\" waits for the first break, and \"crate\" cannot break"));
}

TEST_CASE("what is moved or let go with no hand on it is doubted") {
  const std::string crate = "[[body]]\nname = \"crate\"\nkind = \"box\"\nsize = 1\nposition = [0, 0.5, 0]\n";
  const auto event = [](const std::string& verb, const std::string& at, const std::string& more = "") {
    return "[[event]]\nname = \"" + verb + "\"\ndo = \"" + verb + "\"\nat = " + at + "\nbody = \"crate\"\n" +
           more;
  };
  const std::string grab = event("grab", "0.1"), move = event("move", "0.2", "to = [0, 2, 0]\n"),
                    release = event("release", "0.3"), later = event("move", "0.4", "to = [0, 1, 0]\n");
  CHECK(doubts_of(crate + grab + move + release).empty());
  CHECK(has(doubts_of(crate + move), "event \"move\" moves \"crate\", and no hand holds it then"));
  CHECK(has(doubts_of(crate + release), "event \"release\" lets go of \"crate\", and no hand holds it then"));
  CHECK(has(doubts_of(crate + grab + release + later), "moves \"crate\", and no hand holds it then"));
  CHECK(has(doubts_of(crate + event("grab", "0.5") + move), "moves \"crate\""));
  const std::string egg =
      "[[body]]\nname = \"egg\"\nkind = \"shell\"\nshape = \"egg\"\nthickness = 0.0004\nposition = [0, 3, "
      "0]\n";
  CHECK(doubts_of(crate + egg + "[[event]]\ndo = \"grab\"\nbody = \"crate\"\nwhen = \"first break\"\n" + move)
            .empty());
}

TEST_CASE("the paper's criterion says that what yields gets neither dents nor holes") {
  const std::string slab =
      "[[body]]\nname = \"slab\"\nkind = \"solid\"\nshape = \"slab\"\nsize = [0.2, 0.2, 0.02]\n"
      "element_size = 0.05\nmaterial = ";
  const std::string paper = "[scene]\ncriterion = \"paper\"\n";
  CHECK(
      has(doubts_of(paper + slab + "\"steel\"\n"),
          "t.toml:3:1: \"slab\" is of \"steel\", which yields, but criterion = \"paper\" knows neither dents "
          "nor holes"));
  CHECK(doubts_of(paper + slab + "\"concrete\"\n").empty());
  CHECK(doubts_of(slab + "\"steel\"\n").empty());
}

TEST_CASE("bodies that begin in each other or in the floor are doubted, what touches or is nested is not") {
  const std::string floor = kFloor, crate = kCrate;
  CHECK(doubts_of(floor + crate).empty());  // it stands on the floor, exactly
  CHECK(doubts_of(floor + crate + "repeat = {count = [2, 2, 1], spacing = 0.2}\n").empty());
  CHECK(has(doubts_of(floor + crate + "repeat = {count = 2, spacing = [0.1, 0, 0]}\n"),
            "t.toml:4:1: \"crate[1]\" begins inside \"crate[2]\""));
  CHECK(has(doubts_of(crate + "[[body]]\nname = \"seed\"\nkind = \"sphere\"\nradius = 0.05\nposition = [0, "
                              "0.1, 0]\n"),
            "\"seed\" begins inside \"crate\""));
  const std::string brick =
      "[[body]]\nname = \"brick\"\nkind = \"solid\"\nshape = \"slab\"\nsize = [0.2, 0.1, 0.1]\nelement_size "
      "= "
      "0.05\nmaterial = \"brick\"\nposition = [0, 0.05, 0]\n";
  CHECK(doubts_of(floor + brick + "repeat = {count = [2, 2, 1], spacing = [0.2, 0.1, 0]}\n").empty());
  CHECK(has(doubts_of(floor + brick + "repeat = {count = [3, 1, 1], spacing = [0.19, 0, 0]}\n"),
            "t.toml:4:1: \"brick[1]\" begins inside \"brick[2]\", and 1 more such pair"));
  CHECK(has(doubts_of(floor + crate + "rotation = [45, 0, 0]\n"),
            "t.toml:4:1: \"crate\" begins inside the plane \"floor\""));
  const std::string bowls =
      "[[body]]\nname = \"bowl\"\nkind = \"shell\"\nshape = \"bowl\"\nthickness = 0.001\nposition = [0, 0.2, "
      "0]\n";
  CHECK(!has(doubts_of(bowls + "repeat = {count = 2, spacing = [0, 0.004, 0]}\n"), "begins"));
  CHECK(has(doubts_of(bowls + "repeat = {count = 2, spacing = [0.02, 0, 0]}\n"), "begins inside"));
  for (const std::string& twice : {bowls, brick})
    CHECK(has(doubts_of(twice + "repeat = {count = 2, spacing = 0}\n"), "begins exactly in"));
  CHECK(doubts_of(crate + "motion = \"static\"\n[[body]]\nkind = \"sphere\"\nmotion = \"static\"\n").empty());
}

TEST_CASE(
    "a table that would fall with what is on it is doubted, one that stands or that nothing is on is not") {
  const std::string table =
      "[[body]]\nname = \"table\"\nkind = \"box\"\nsize = [1, 0.04, 0.6]\nposition = [0, 0.7, 0]\n";
  const std::string ball =
      "[[body]]\nname = \"ball\"\nkind = \"sphere\"\nradius = 0.05\nposition = [0.2, 0.771, 0]\n";
  const std::string legs =
      "[[body]]\nname = \"legs\"\nkind = \"box\"\nsize = [0.1, 0.68, 0.1]\nposition = [0, 0.34, 0]\n";
  const std::string floor = kFloor;
  CHECK(has(doubts_of(floor + table + ball),
            "t.toml:4:1: \"table\" lies on nothing, and falls with \"ball\" on it"));
  CHECK(doubts_of(floor + table).empty());
  CHECK(doubts_of(floor + table + "motion = \"static\"\n" + ball).empty());
  CHECK(doubts_of(floor + table + ball + legs).empty());
  CHECK(doubts_of(floor + kCrate + "[[body]]\nkind = \"sphere\"\nradius = 0.05\nposition = [0, 0.251, 0]\n")
            .empty());
}

TEST_CASE("a path as fast as a shot is doubted, at the first keyframe that is reached so") {
  const std::string ram = kCrate + std::string(
                                       "motion = \"scripted\"\nkeyframes = [{at = 0, position = [3, 1, "
                                       "0]}, {at = 1, position = [2, 1, 0]}, {at = ");
  CHECK(has(doubts_of(ram + "1.01, position = [-2, 1, 0]}]\n"),
            "t.toml:1:1: \"crate\" goes to its keyframe at 1.01 s at 400 m/s"));
  CHECK(doubts_of(ram + "1.1, position = [-2, 1, 0]}]\n").empty());
}

TEST_CASE("a vase as large as a house is doubted, a pane is not") {
  const std::string vase = "[[body]]\nname = \"vase\"\nkind = \"shell\"\nthickness = 0.01\nshape = ";
  CHECK(has(doubts_of(vase + "\"wine_glass\"\nheight = 20\n"), "t.toml:1:1: \"vase\" is "));
  CHECK(doubts_of(vase + "\"wine_glass\"\nheight = 0.2\n").empty());
  CHECK(doubts_of(vase + "\"pane\"\nwidth = 8\nheight = 6\n").empty());
}

TEST_CASE("a camera in a body is doubted, at its start, on its path and where events put it") {
  const std::string scene = std::string(kFloor) + kCrate + "motion = \"static\"\n";
  const std::string camera = scene + "[camera]\ntarget = [0, 0, 5]\nposition = ";
  CHECK(has(doubts_of(camera + "[0.05, 0.1, 0]\n"),
            "t.toml:10:1: the camera is inside \"crate\" at [0.05, 0.1, 0]"));
  CHECK(has(doubts_of(camera + "[1, -0.5, 0]\n"), "below the floor"));
  CHECK(doubts_of(camera + "[1, 0.5, 0]\n").empty());
  CHECK(has(doubts_of(camera + "[1, 0.5, 0]\npath = [{at = 0}, {at = 1, position = [0, 0.1, 0.05]}]\n"),
            "inside \"crate\""));
  CHECK(has(
      doubts_of(scene + "[[event]]\nat = 1\ndo = \"camera\"\nmove = \"cut\"\nposition = [0, 0.1, 0.05]\n"),
      "t.toml:10:1: the camera is inside"));
}

TEST_CASE("a throw that can meet nothing is doubted before the run, and told after it") {
  const std::string scene = std::string("[scene]\nseconds = 0.8\n") + kFloor + kCrate;
  const auto shot = [&scene](const std::string& aim) {
    return scene +
           "[[event]]\nname = \"shot\"\nat = 0.1\ndo = \"projectile\"\nfrom = [0, 1, 3]\nspeed = 10\n" + aim;
  };
  const auto after = [](const std::string& text) {
    const auto reading = scene::read(text);
    auto built = build(reading);
    run::Recorder recorder;
    run::Projector projector(*reading.scene, *built, recorder, false, 60);
    while (projector.next()) {
    }
    projector.finish();
    std::string all;
    for (const std::string& warning : recorder.record.warnings) all += warning + "\n";
    return all;
  };
  const std::string miss = shot("at_point = [4, 0.1, 0]\n"), hit = shot("at_point = [0, 0.1, 0]\n");
  CHECK(has(doubts_of(miss), "t.toml:11:1: event \"shot\" throws past everything: "));
  CHECK(has(doubts_of(miss), "at_body = \"crate\" aims at it"));
  CHECK(has(after(miss), "t.toml:11:1: what event \"shot\" threw hit nothing but the floor"));
  CHECK(doubts_of(hit).empty());
  CHECK(after(hit).empty());
  const std::string late = shot("at_point = [0, 0.1, 0]\n").replace(0, 21, "[scene]\nseconds = 0.3");
  CHECK(has(after(late), "what event \"shot\" threw is still on its way at the end"));
  CHECK(has(after(late), "it is at its target after 0.4"));
  CHECK(doubts_of(shot("at_body = \"crate\"\n")).empty());
  // Who falls, or may be pushed away, is where nobody can tell.
  CHECK(
      doubts_of(miss + "[[event]]\nat = 0\ndo = \"push\"\nbody = \"crate\"\nimpulse = [9, 0, 0]\n").empty());
}

TEST_CASE(
    "a trial that takes longer than one has patience for is given up in the middle of a step and says so") {
  const auto reading = scene::read(std::string("[scene]\nseconds = 0.1\n") + kFloor +
                                   "[[body]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 0.05\n"
                                   "thickness = 0.0006\nedge_length = 0.02\nmaterial = \"glass\"\n"
                                   "position = [0, 0.1, 0]\n");
  const auto built = build(reading);
  for (const double patience : {0.0, 600.0}) {
    const auto all = run::foresee(*reading.scene, built->plan, 1, patience);
    REQUIRE(all.size() == 1);
    INFO(run::describe(all.front()));
    CHECK(all.front().was_given_up == (patience == 0.0));
    CHECK(all.front().given_up_at == 0.0);
    CHECK(has(run::describe(all.front()), "given up") == (patience == 0.0));
    CHECK(all.front().pieces == 0);
  }
}

TEST_CASE(
    "after a run: a solid whose elements are too large for a crack is told, one that is not stressed is "
    "not") {
  const auto afterthoughts = [](const std::string& size, int steps) {
    const auto reading =
        scene::read(std::string(kFloor) +
                    "[[body]]\nname = \"vase\"\nkind = \"solid\"\nshape = \"vase\"\nheight = 0.3\nmaterial = "
                    "\"ceramic\"\nposition = [0, 0.8, 0]\nrotation = [0, 0, 100]\n" +
                    size);
    auto built = build(reading);
    for (int step = 0; step < steps; ++step) built->world.step();
    return scene::describe(run::find_afterthoughts(*reading.scene, *built));
  };
  CHECK(afterthoughts("element_size = 0.012\n", 60).empty());
  const std::string told = afterthoughts("element_size = 0.012\n", 96);
  CHECK(has(told, "t.toml:4:1: \"vase\" held, stressed to 1."));
  CHECK(has(told, "--set vase.element_size=0.006 looks closer"));
}

TEST_CASE(
    "after a run: a solid that held because its material is tough is not told to have smaller elements") {
  const auto reading = scene::read(
      "[[body]]\nname = \"left\"\nkind = \"box\"\nsize = [0.05, 0.2, 0.2]\nposition = [-0.45, 0.1, 0]\n"
      "material = \"steel\"\nmotion = \"static\"\n"
      "[[body]]\nname = \"right\"\nkind = \"box\"\nsize = [0.05, 0.2, 0.2]\nposition = [0.45, 0.1, 0]\n"
      "material = \"steel\"\nmotion = \"static\"\n"
      "[[body]]\nname = \"beam\"\nkind = \"solid\"\nshape = \"slab\"\nsize = [1, 0.1, 0.1]\n"
      "material = \"concrete\"\nposition = [0, 0.25001, 0]\nelement_size = 0.04\n"
      "[[body]]\nname = \"weight\"\nkind = \"box\"\nsize = [0.1, 0.1, 0.1]\nmaterial = \"steel\"\n"
      "density = 400000\nposition = [0, 0.35002, 0]\n");
  auto built = build(reading);
  for (int step = 0; step < 8; ++step) built->world.step();
  const std::string told = scene::describe(run::find_afterthoughts(*reading.scene, *built));
  CAPTURE(told);
  CHECK(has(told, "\"beam\" held, stressed to 1."));
  CHECK(has(told, "concrete is so tough that a crack needs 0.1"));
  CHECK_FALSE(has(told, "element_size"));
}

TEST_CASE("after a run: that all fell and met nothing is told, where something was met it is not") {
  const auto afterthoughts = [](const std::string& more) {
    const auto reading = scene::read(kCrate + more);
    auto built = build(reading);
    for (int step = 0; step < 120; ++step) built->world.step();
    return scene::describe(run::find_afterthoughts(*reading.scene, *built));
  };
  const std::string told = afterthoughts("");
  CHECK(has(told, "t.toml:1:1: nothing met anything: \"crate\" falls at 4.9 m/s at the end"));
  CHECK(has(told, "kind = \"plane\""));
  CHECK(afterthoughts(kFloor).empty());
  CHECK(afterthoughts("[scene]\ngravity = [0, 0, 0]\n").empty());
  CHECK(afterthoughts(
            "[[body]]\nkind = \"sphere\"\nradius = 0.1\nposition = [0, -0.5, 0]\nvelocity = [0, 9, 0]\n")
            .empty());
}
