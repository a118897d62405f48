// The scenes that come along look as they did, and the tolerance by which that is judged tells what matters
// from what does not.
#include <catch2/catch.hpp>

#include "render/output/image_file.h"
#include "render/renderer.h"
#include "sandbox/compare/tolerance.h"
#include "sandbox/scene/build_world.h"
#include "sandbox/scene/read_scene.h"
#include "sandbox/view/view.h"
#include "tests/sandbox/run/running.h"

using namespace shatterbox;
using namespace shatterbox::sandbox;
using run::Folder;
using run::program;

namespace {

const std::string kGoldens = SHATTERBOX_SOURCE_DIR "/tests/golden/goldens";
/// The smallest: 160 x 90.
const std::string kOrnament = kGoldens + "/ornament";
constexpr const char* kBroken = "frame_000033.png";  // 0.55 s

render::Image golden_picture(const std::string& file) {
  std::string error;
  auto image = render::read_image(kOrnament + "/" + file, &error);
  INFO(error);
  REQUIRE(image.has_value());
  return *image;
}

bool passes(const render::Image& expected, const render::Image& actual) {
  return compare::find_excess(render::compare(expected, actual), compare::Tolerance{}).empty();
}

}  // namespace

TEST_CASE("the scenes that come along end in the same state and look the same") {
  const Folder folder;
  const auto outcome = program(folder, "golden check '" + kGoldens + "'");
  INFO(outcome.out << outcome.err);
  CHECK(outcome.status == 0);
}

TEST_CASE("a processor that rounds otherwise passes, though its pictures are others") {
  const Folder folder;
  const std::string other =
      "GALLIUM_OVERRIDE_CPU_CAPS=nosse MESA_SHADER_CACHE_DISABLE=true " SHATTERBOX_PROGRAM;
  const auto outcome = shell(folder, other + " golden check '" + kGoldens + "' window");
  INFO(outcome.out << outcome.err);
  CHECK(outcome.status == 0);
  CHECK(outcome.out.find("within the tolerance") != std::string::npos);
}

TEST_CASE("a lost shadow fails") {
  const Folder folder;
  REQUIRE(program(folder,
                  "run ornament --size 160x90 --quality full --seconds 0.6 --stills 0.55 --frames f --set "
                  "light.shadow=false")
              .status == 0);
  const auto without = render::read_image(folder / "f" / kBroken);
  REQUIRE(without);
  CHECK_FALSE(passes(golden_picture(kBroken), *without));
}

TEST_CASE("a shift by one pixel fails, in either direction, of the fallen and of the whole ornament") {
  for (const char* file : {"frame_000021.png", kBroken}) {
    const render::Image picture = golden_picture(file);
    for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}}) {
      render::Image shifted = picture;
      for (int y = dy; y < picture.height; ++y)
        for (int x = dx; x < picture.width; ++x) std::copy_n(picture.at(x - dx, y - dy), 3, shifted.at(x, y));
      CHECK_FALSE(passes(picture, shifted));
    }
  }
}

TEST_CASE("a colour that is off by three levels fails, by one it passes") {
  const render::Image picture = golden_picture("frame_000021.png");
  for (const int levels : {1, 3}) {
    render::Image tinted = picture;
    // The red of the ball alone, some percent of the picture.
    long pixels = 0;
    for (std::size_t i = 0; i < tinted.pixels.size(); i += 3)
      if (tinted.pixels[i] > 2 * tinted.pixels[i + 1] && tinted.pixels[i] < 250) {
        tinted.pixels[i] = static_cast<std::uint8_t>(tinted.pixels[i] + levels);
        ++pixels;
      }
    REQUIRE(pixels > 50);
    CHECK(passes(picture, tinted) == (levels == 1));
  }
}

TEST_CASE("a missing shard fails, any that covers more than four pixels") {
  scene::Problems problems;
  const auto description =
      scene::read_scene_file(SHATTERBOX_SOURCE_DIR "/scenes/ornament.toml", {}, problems);
  REQUIRE(description);
  auto built = scene::build_world(*description, problems);
  REQUIRE(built);
  built->world.prepare();
  while (built->world.steps() < 33 * 4) built->world.step();
  view::View view(*description, *built);
  const render::Frame frame = view.make_frame();
  render::Renderer renderer({160, 90}, render::Quality::full);
  const render::Image whole = renderer.render(frame);
  REQUIRE(passes(golden_picture(kBroken), whole));
  int found = 0;
  for (std::size_t missing = 0; missing < frame.draws.size(); ++missing) {
    render::Frame less = frame;
    less.draws.erase(less.draws.begin() + static_cast<std::ptrdiff_t>(missing));
    const render::Image without = renderer.render(less);
    const bool is_found = !passes(whole, without);
    found += is_found ? 1 : 0;
    INFO("draw " << missing << ": " << render::compare(whole, without).pixels_beyond << " pixels");
    CHECK((is_found || render::compare(whole, without).pixels_beyond <= 4));
  }
  CHECK(found > static_cast<int>(frame.draws.size()) / 2);
}
