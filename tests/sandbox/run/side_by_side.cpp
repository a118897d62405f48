// --compare: several worlds in one film, each as if it were alone.
#include "sandbox/run/side_by_side.h"

#include <catch2/catch.hpp>

#include "render/output/image_file.h"
#include "tests/sandbox/run/running.h"

using namespace shatterbox;
using namespace shatterbox::sandbox::run;

TEST_CASE("a setting's values are told apart by the commas that are not within brackets or quotes") {
  sandbox::scene::Problems problems;
  using Settings = std::vector<std::string>;
  CHECK(compared_settings("pane.thickness=0.003,0.006", problems) ==
        Settings{"pane.thickness=0.003", "pane.thickness=0.006"});
  CHECK(compared_settings("ball.velocity=[0,0,-1],[0,0,-2]", problems) ==
        Settings{"ball.velocity=[0,0,-1]", "ball.velocity=[0,0,-2]"});
  CHECK(compared_settings("a.sun={direction=[0,1,0],size=1},[0,1,0]", problems) ==
        Settings{"a.sun={direction=[0,1,0],size=1}", "a.sun=[0,1,0]"});
  CHECK(compared_settings("a.look=\"x,y\",'z'", problems) == Settings{"a.look=\"x,y\"", "a.look='z'"});
  CHECK(problems.empty());
  for (const char* wrong : {"pane.thickness", "pane.thickness=1", "a.b=1,2,3,4,5"}) {
    problems.clear();
    CHECK(compared_settings(wrong, problems).empty());
    CHECK(problems.size() == 1);
  }
}

TEST_CASE("worlds beside each other are as they are alone, in one picture") {
  const Folder folder;
  folder.write("balls.toml", kSmallScene);
  const std::string run = "run balls.toml --seconds 0.2 --size 64x48 --report r.json ";
  REQUIRE(program(folder, run + "--compare balls.radius=0.05,0.03,0.04 --frames both -o both.mp4").status ==
          0);
  const auto both = read_json(folder / "r.json");
  REQUIRE(both["shots"].size() == 3);
  CHECK(both["shots"][1]["scene"].get<std::string>().find("balls.radius=0.03") != std::string::npos);
  CHECK(count_frames(folder, "both.mp4") == 12);
  const auto picture = render::read_image(folder / "both/frame_000011.png");
  REQUIRE(picture.has_value());
  CHECK(picture->width == 3 * 64);
  CHECK(picture->height == 48);
  int panel = 0;
  for (const char* radius : {"0.05", "0.03", "0.04"}) {
    REQUIRE(program(folder, run + "--frames alone --set balls.radius=" + radius).status == 0);
    CHECK(read_json(folder / "r.json")["state_hash"] == both["shots"][panel]["state_hash"]);
    const auto alone = render::read_image(folder / "alone/frame_000011.png");
    REQUIRE(alone.has_value());
    int unlike = 0;  // above the label, right of the line
    for (int y = 0; y < 24; ++y)
      for (int x = 1; x < 64; ++x)
        for (int i = 0; i < 3; ++i) unlike += alone->at(x, y)[i] != picture->at(64 * panel + x, y)[i] ? 1 : 0;
    CHECK(unlike == 0);
    ++panel;
  }
}

TEST_CASE("who is over first waits for the others, and four stand in two rows") {
  const Folder folder;
  folder.write("balls.toml", kSmallScene);
  REQUIRE(program(folder,
                  "run balls.toml --size 64x48 --compare scene.seconds=0.1,0.2,0.1,0.05 -o four.mp4 "
                  "--frames four --report r.json")
              .status == 0);
  CHECK(count_frames(folder, "four.mp4") == 12);
  const auto picture = render::read_image(folder / "four/frame_000011.png");
  REQUIRE(picture.has_value());
  CHECK(picture->width == 128);
  CHECK(picture->height == 96);
  CHECK(read_json(folder / "r.json")["shots"][3]["simulated_seconds"].get<double>() ==
        Approx(0.05).margin(0.005));
}

TEST_CASE("what cannot be compared is refused with a hint") {
  const Folder folder;
  folder.write("balls.toml", kSmallScene);
  const auto complaint = [&](const std::string& arguments) {
    const Outcome outcome = program(folder, "run balls.toml " + arguments);
    CHECK(outcome.status == 2);
    return outcome.err;
  };
  CHECK(complaint("--compare balls.radius=0.1").find("NAME.key=a,b") != std::string::npos);
  CHECK(complaint("--compare balls.radus=0.1,0.2").find("radius") != std::string::npos);
  CHECK(complaint("--compare balls.radius=0.1,0.2 --export x.glb").find("holds one world") !=
        std::string::npos);
  CHECK(complaint("--compare balls.radius=0.1,0.2 --resume").find("--resume") != std::string::npos);
}
