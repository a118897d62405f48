// The light presets on one still life: each shows what its name says, and none burns out or drowns.
#include <catch2/catch.hpp>

#include <map>

#include "render/renderer.h"
#include "sandbox/scene/build_world.h"
#include "sandbox/scene/read_scene.h"
#include "sandbox/view/view.h"

using namespace shatterbox;
using namespace shatterbox::sandbox;

namespace {

constexpr const char* kStillLife = R"([[body]]
kind = "plane"
[[body]]
kind = "sphere"
radius = 0.1
position = [0, 0.1, 0]
look = "porcelain"
[[body]]
kind = "box"
size = 0.12
position = [0.25, 0.06, 0]
look = "matt"
colour = "#2f6f86"
[camera]
position = [0.1, 0.35, 0.9]
target = [0.1, 0.06, 0]
[light]
preset = ")";

render::Image picture_of(const std::string& light, const std::string& more = "") {
  scene::Problems problems;
  const auto description = scene::read_scene(kStillLife + light + "\"\n" + more, "t.toml", {}, problems);
  INFO(scene::describe(problems));
  REQUIRE(description);
  auto built = scene::build_world(*description, problems);
  REQUIRE(built);
  view::View view(*description, *built);
  render::Renderer renderer({320, 180}, render::Quality::full);
  return renderer.render(view.make_frame());
}

/// Mean of a channel, levels.
double mean_of(const render::Image& image, std::size_t channel) {
  double sum = 0.0;
  for (std::size_t i = channel; i < image.pixels.size(); i += 3) sum += image.pixels[i];
  return 3.0 * sum / static_cast<double>(image.pixels.size());
}

/// By how many levels pixels of the lower half are darker at most than without shadows.
int deepest_shadow(const std::string& light) {
  const render::Image with = picture_of(light), without = picture_of(light, "shadow = false\n");
  int deepest = 0;
  for (std::size_t i = 0; i < with.pixels.size(); ++i)
    deepest = std::max(deepest, int{without.pixels[i]} - int{with.pixels[i]});
  return deepest;
}

}  // namespace

TEST_CASE("light presets are different lights that keep whites and blacks") {
  std::map<std::string, render::Image> pictures;
  for (const std::string& light : scene::kLightNames) pictures.emplace(light, picture_of(light));
  for (const auto& [light, image] : pictures) {
    INFO(light);
    int burnt = 0, drowned = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
      const auto [least, most] = std::minmax({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
      burnt += least >= 252 ? 1 : 0;
      drowned += most <= 8 ? 1 : 0;
    }
    CHECK(burnt < 60);  // a thousandth: the sun in glaze
    CHECK(drowned < 60);
    for (const auto& [other, other_image] : pictures) {
      if (other == light) continue;
      double apart = 0.0;
      for (std::size_t i = 0; i < image.pixels.size(); ++i)
        apart += std::abs(image.pixels[i] - other_image.pixels[i]);
      CHECK(apart / static_cast<double>(image.pixels.size()) > 8.0);
    }
  }
  // Evening is warm, noon's shadows are deep, an overcast sky hardly casts any.
  const auto warmth = [&pictures](const char* light) {
    return mean_of(pictures.at(light), 0) - mean_of(pictures.at(light), 2);
  };
  CHECK(warmth("evening") > warmth("studio") + 5.0);
  CHECK(warmth("noon") < warmth("evening"));
  CHECK(deepest_shadow("noon") > 2 * deepest_shadow("overcast"));
}
