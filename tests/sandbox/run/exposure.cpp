// Shutter and lens: what moves is drawn out, what is out of focus is spread, and the world knows nothing of
// it.
#include "sandbox/run/exposure.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "render/output/image_file.h"
#include "tests/sandbox/run/running.h"

using namespace shatterbox;
using namespace shatterbox::sandbox::run;

namespace {

// White balls before a dark backdrop, lit from everywhere, without gravity.
const std::string kFlying =
    "# a ball flies by\n[scene]\nseconds = 0.2\ngravity = [0, 0, 0]\n"
    "[[body]]\nname = \"ball\"\nkind = \"sphere\"\nradius = 0.05\nvelocity = [6, 0, 0]\nposition = [-0.5, 0, "
    "0]\n"
    "look = \"matt\"\ncolour = \"#ffffff\"\n"
    "[camera]\nposition = [0, 0, 2]\ntarget = [0, 0, 0]\nfov = 40\n"
    "[light]\nsky = 2\nshadow = false\n[render]\nbackdrop = \"dark\"\n";

struct Extent {
  int width = 0, height = 0;
};

/// Of what is brighter than the backdrop.
Extent bright_extent(const Folder& folder, const std::string& file) {
  const auto image = render::read_image(folder / file);
  REQUIRE(image.has_value());
  int left = image->width, right = -1, top = image->height, bottom = -1;
  for (int y = 0; y < image->height; ++y) {
    for (int x = 0; x < image->width; ++x) {
      if (image->at(x, y)[1] < 110) continue;
      left = std::min(left, x), right = std::max(right, x);
      top = std::min(top, y), bottom = std::max(bottom, y);
    }
  }
  REQUIRE(right >= left);
  return {right - left + 1, bottom - top + 1};
}

}  // namespace

TEST_CASE("a frame's time is divided so that the samples fill the shutter's share of it") {
  sandbox::scene::CameraEntry camera;
  CHECK(Exposure(camera).samples() == 1);
  CHECK(Exposure(camera).slots() == 1);
  camera.shutter = 0.5;
  CHECK(Exposure(camera).samples() == 16);
  CHECK(Exposure(camera).slots() == 32);
  camera.shutter = 1.0;
  CHECK(Exposure(camera).slots() == 16);
  camera.shutter = 0.0;
  camera.aperture = 0.02;
  CHECK(Exposure(camera).samples() == 16);
  CHECK(Exposure(camera).slots() == 1);
}

TEST_CASE("the samples look through points that fill the lens evenly, early and late ones alike") {
  sandbox::scene::CameraEntry camera;
  camera.aperture = 0.02;
  camera.samples = 64;
  const Exposure exposure(camera);
  glm::dvec2 sum(0.0), early(0.0);
  double square = 0.0, early_square = 0.0;
  for (int k = 0; k < 64; ++k) {
    const glm::dvec2 p = exposure.lens_point(k);
    CHECK(glm::length(p) <= 1.0 + 1e-6);
    sum += p;
    square += glm::dot(p, p);
    if (k < 32) early += p, early_square += glm::dot(p, p);
  }
  CHECK(glm::length(sum) / 64 < 0.03);
  CHECK(square / 64 == Approx(0.5).epsilon(0.02));  // of a disc
  CHECK(glm::length(early) / 32 < 0.15);
  CHECK(early_square / 32 == Approx(0.5).epsilon(0.1));
}

TEST_CASE(
    "an open shutter draws out what moves by its way, and changes neither the world nor the film's length") {
  const Folder folder;
  folder.write("flying.toml", kFlying);
  const std::string run = "run flying.toml --size 320x180 --quality full --report r.json --frames ";
  REQUIRE(program(folder, run + "sharp").status == 0);
  const auto sharp_report = read_json(folder / "r.json");
  REQUIRE(program(folder, run + "blurred --set camera.shutter=1 --set camera.samples=24").status == 0);
  const auto blurred_report = read_json(folder / "r.json");
  CHECK(sharp_report["state_hash"] == blurred_report["state_hash"]);
  CHECK(sharp_report["frame_hashes"].size() == blurred_report["frame_hashes"].size());
  const Extent sharp = bright_extent(folder, "sharp/frame_000006.png"),
               blurred = bright_extent(folder, "blurred/frame_000006.png");
  // 6 m/s for a sixtieth of a second, at 180 pixels for 2 tan 20 degrees times 2 m; its ends are faint.
  const double way = 0.1 * 180.0 / (4.0 * std::tan(20.0 * 3.14159265 / 180.0));
  CHECK(sharp.width == Approx(sharp.height).margin(2));
  CHECK(blurred.height == Approx(sharp.height).margin(2));
  CHECK(blurred.width < sharp.width + way + 2);
  CHECK(blurred.width > sharp.width + 0.4 * way);
}

TEST_CASE("a wide lens spreads what is out of focus, and not what is in focus") {
  const Folder folder;
  std::string still = kFlying;
  still.replace(still.find("velocity = [6, 0, 0]"), 20, "velocity = [0, 0, 0]");
  still.replace(still.find("position = [-0.5, 0, 0]"), 23, "position = [0.1, 0, 0]");
  folder.write("still.toml", still);
  const std::string run = "run still.toml --size 320x180 --quality full --stills 0 --frames ";
  const auto extent_with = [&](const std::string& name, const std::string& settings) {
    const Outcome outcome = program(folder, run + name + settings);
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    return bright_extent(folder, name + "/frame_000000.png");
  };
  const Extent sharp = extent_with("sharp", "");
  const std::string lens = " --set camera.aperture=0.2 --set camera.samples=48";
  for (const char* focus : {"", " --set camera.focus=2.0", " --set camera.focus='\"ball\"'"}) {
    const Extent focused =
        extent_with(std::string("focused") + std::to_string(std::string(focus).size()), lens + focus);
    CHECK(focused.width == Approx(sharp.width).margin(2));
    CHECK(focused.height == Approx(sharp.height).margin(2));
  }
  // Focused at 1 m: the disc of confusion is as wide as the lens at twice the distance, seen from 2 m.
  const Extent spread = extent_with("spread", lens + " --set camera.focus=1.0");
  const double disc = 0.2 * 180.0 / (4.0 * std::tan(20.0 * 3.14159265 / 180.0));
  CHECK(spread.width < sharp.width + disc + 2);
  CHECK(spread.width > sharp.width + 0.2 * disc);
  CHECK(spread.width == Approx(spread.height).margin(4));
}

TEST_CASE("lens and shutter that cannot be are refused with a hint") {
  const Folder folder;
  folder.write("flying.toml", kFlying);
  const auto complaint = [&](const std::string& setting) {
    const Outcome outcome = program(folder, "check flying.toml --set " + setting);
    CHECK(outcome.status == 2);
    return outcome.err;
  };
  CHECK(complaint("camera.focus=1").find("add aperture") != std::string::npos);
  CHECK(complaint("camera.samples=8").find("without shutter and aperture") != std::string::npos);
  CHECK(complaint("camera.shutter=1.5").find("from 0 to 1") != std::string::npos);
  CHECK(complaint("camera.aperture=0.1 --set camera.focus='\"bal\"'").find("\"ball\"") != std::string::npos);
}
