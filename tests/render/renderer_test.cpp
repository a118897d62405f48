// Pictures whose content geometry and arithmetic foretell.
#include "render/renderer.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <stdexcept>

#include "render/output/compare.h"

using namespace shatterbox::render;

namespace {

constexpr Size kSize{320, 180};

Draw at(std::shared_ptr<const Mesh> mesh, glm::vec3 place, Look look = matt(glm::vec3(0.5F))) {
  Draw draw;
  draw.mesh = std::move(mesh);
  draw.world_from_body = glm::translate(glm::mat4(1.0F), place);
  draw.looks = {look};
  return draw;
}

Frame plain_frame() {
  Frame frame;
  frame.camera.position = {0.0F, 2.0F, 6.0F};
  frame.camera.target = {0.0F, 0.5F, 0.0F};
  frame.camera.vertical_fov = 40.0F;
  return frame;
}

Frame busy_frame() {
  Frame frame = plain_frame();
  for (int i = 0; i < 6; ++i) {
    const auto x = static_cast<float>(i) - 2.5F;
    frame.draws.push_back(at(make_sphere(static_cast<std::uint64_t>(i) + 1, 0.4F), {x, 0.4F, 0.3F * x},
                             i % 2 == 0 ? ornament({0.5F, 0.02F, 0.03F}) : ceramic({0.1F, 0.3F, 0.4F})));
  }
  frame.draws.push_back(at(make_box(10, {3.0F, 1.5F, 0.02F}), {0.0F, 1.0F, 1.0F}, glass()));
  frame.caption = "t = 0.1 s";
  return frame;
}

// The pixel that a point of the world falls on.
glm::ivec2 pixel_of(const Frame& frame, glm::vec3 p) {
  const Camera& c = frame.camera;
  const glm::vec4 clip = glm::perspective(glm::radians(c.vertical_fov), 320.0F / 180.0F, 0.1F, 100.0F) *
                         glm::lookAt(c.position, c.target, c.up) * glm::vec4(p, 1.0F);
  return {static_cast<int>((clip.x / clip.w * 0.5F + 0.5F) * 320.0F),
          static_cast<int>((0.5F - clip.y / clip.w * 0.5F) * 180.0F)};
}

int green(const Image& image, glm::ivec2 p) {
  return image.at(p.x, p.y)[1];
}

int srgb(double linear) {
  return static_cast<int>(std::lround(
      255.0 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055)));
}

double linear(int code) {
  const double x = code / 255.0;
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

}  // namespace

TEST_CASE("the driver is the one that pictures are compared on") {
  const Renderer renderer(kSize, Quality::preview);
  CHECK(renderer.is_llvmpipe());
  CHECK(renderer.size().width == 320);
}

TEST_CASE("the same frame gives the same bytes, again and from another renderer") {
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer one(kSize, quality), other(kSize, quality);
    const Image first = one.render(busy_frame());
    static_cast<void>(one.render(plain_frame()));
    CHECK(one.render(busy_frame()) == first);
    CHECK(other.render(busy_frame()) == first);
  }
}

TEST_CASE("a linear value below the shoulder is shown as its sRGB code") {
  Frame frame = plain_frame();
  frame.ground.reset();
  frame.backdrop = {glm::vec3(0.2F, 0.5F, 0.05F), glm::vec3(0.2F, 0.5F, 0.05F), 0.0F, 0.0F};
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer(kSize, quality);
    const Image image = renderer.render(frame);
    for (const int x : {0, 100, 319}) {
      CHECK(std::abs(image.at(x, 90)[0] - srgb(0.2)) <= 1);
      CHECK(std::abs(image.at(x, 90)[1] - srgb(0.5)) <= 1);
      CHECK(std::abs(image.at(x, 90)[2] - srgb(0.05)) <= 1);
    }
  }
}

TEST_CASE("a sphere covers the pixels that its projection says") {
  Frame frame;
  frame.ground.reset();
  frame.backdrop = {glm::vec3(0.0F), glm::vec3(0.0F), 0.0F, 0.0F};
  frame.camera = {glm::vec3(0, 0, 5), glm::vec3(0), glm::vec3(0, 1, 0), 30.0F};
  frame.draws = {at(make_sphere(1, 1.0F, 128), glm::vec3(0.0F))};
  frame.exposure = 1e4F;  // white to its edge
  // On the axis the outline is a circle of tangent r / sqrt(d^2 - r^2).
  const double radius = 90.0 * (1.0 / std::sqrt(24.0)) / std::tan(0.5 * 30.0 * 3.14159265358979 / 180.0);
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer(kSize, quality);
    const Image image = renderer.render(frame);
    double covered = 0;  // the light of an edge pixel is the share of it that the sphere covers
    for (std::size_t i = 0; i < image.pixels.size(); i += 3) covered += linear(image.pixels[i + 1]);
    CHECK(covered == Approx(3.14159265 * radius * radius).epsilon(0.005));
  }
}

TEST_CASE("the shadow lies where the sun puts it, and only there") {
  Frame frame = plain_frame();
  frame.camera.position = {0.0F, 6.0F, 6.0F};
  frame.camera.target = {0.0F, 0.0F, 0.0F};
  frame.lights.sun_direction = {1.0F, 1.0F, 0.0F};
  frame.draws = {at(make_box(1, glm::vec3(0.5F)), {0.0F, 1.5F, 0.0F})};
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer(kSize, quality);
    const Image with = renderer.render(frame);
    frame.lights.casts_shadow = false;
    const Image without = renderer.render(frame);
    frame.lights.casts_shadow = true;
    const glm::ivec2 middle = pixel_of(frame, {-1.5F, 0.0F, 0.0F});
    CHECK(green(with, middle) < green(without, middle) - 40);
    for (const glm::vec3 lit : {glm::vec3(1.5F, 0, 0), glm::vec3(-1.5F, 0, 0.9F), glm::vec3(-2.6F, 0, 0)}) {
      CHECK(green(with, pixel_of(frame, lit)) == green(without, pixel_of(frame, lit)));
    }
  }
}

TEST_CASE("a frame drawn alone equals the same frame in a sequence") {
  std::vector<Frame> frames;
  for (int i = 0; i < 5; ++i) {
    const auto t = static_cast<float>(i);
    frames.push_back(busy_frame());
    if (i > 0) frames.back().draws[0].world_from_body[3].y += 0.2F * t;
    if (i > 2) frames.back().camera.position.x += 0.1F * t;  // stays for two frames, then moves
    if (i == 4) frames.back().draws.pop_back();              // the pane is gone
  }
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer one(kSize, quality);
    for (const Frame& frame : frames) {
      Renderer other(kSize, quality);
      CHECK(one.render(frame) == other.render(frame));
    }
  }
}

TEST_CASE("the floor fades into the backdrop evenly in one over the distance into the picture") {
  for (const float height : {0.15F, 1.0F, 6.0F}) {
    Frame frame;
    frame.camera.position = {0.5F, height, 5.0F};
    frame.camera.target = {0.0F, 0.3F, 0.0F};
    frame.camera.vertical_fov = 40.0F;
    frame.backdrop = {glm::vec3(0.5F), glm::vec3(0.5F), 0.0F, 0.0F};
    frame.ground->colour = glm::vec3(0.0F);
    frame.ground->fade_from = 3.0F;
    frame.ground->fade_to = 20.0F;
    const glm::vec2 way = glm::normalize(glm::vec2(-0.5F, -5.0F));  // level, from the eye to the target
    const glm::mat4 world_from_clip =
        glm::inverse(glm::perspective(glm::radians(40.0F), 320.0F / 180.0F, 0.1F, 100.0F) *
                     glm::lookAt(frame.camera.position, frame.camera.target, frame.camera.up));
    Renderer renderer(kSize, Quality::preview);
    const Image image = renderer.render(frame);
    int most = 0;
    for (int y = 0; y < 180; ++y) {
      for (int x = 0; x < 320; ++x) {
        const glm::vec4 far =
            world_from_clip * glm::vec4((static_cast<float>(x) + 0.5F) / 160.0F - 1.0F,
                                        1.0F - (static_cast<float>(y) + 0.5F) / 90.0F, 1.0F, 1.0F);
        const glm::vec3 ray = glm::vec3(far) / far.w - frame.camera.position;
        const glm::vec3 p = frame.camera.position - ray * (height / ray.y);
        const double into = glm::dot(glm::vec2(p.x - 0.5F, p.z - 5.0F), way);
        const double share =
            ray.y < 0.0F ? std::clamp((1.0 / 3.0 - 1.0 / into) / (1.0 / 3.0 - 1.0 / 20.0), 0.0, 1.0) : 1.0;
        most =
            std::max(most, std::abs(green(image, {x, y}) - srgb(0.5 * share * share * (3.0 - 2.0 * share))));
      }
    }
    CHECK(most <= 2);
  }
}

TEST_CASE("a sweep goes from the floor's colour into a darker wall of its hue, without an edge") {
  for (const float height : {0.4F, 2.0F, 5.0F}) {
    Frame frame = plain_frame();
    frame.camera.position.y = height;
    frame.ground->colour = {0.5F, 0.3F, 0.1F};
    frame.backdrop = {glm::vec3(0.0F), glm::vec3(0.0F), 0.0F, 0.0F, 1.0F};
    for (const Quality quality : {Quality::preview, Quality::full}) {
      Renderer renderer(kSize, quality);
      const Image image = renderer.render(frame);
      int steepest = 0, brightening = 0;
      for (int y = 1; y < 180; ++y) {
        steepest = std::max(steepest, green(image, {160, y}) - green(image, {160, y - 1}));
        brightening = std::max(brightening, green(image, {160, y - 1}) - green(image, {160, y}));
        CHECK(std::abs(green(image, {10, y}) - green(image, {310, y})) <= 1);  // level
      }
      CHECK(steepest <= 6);
      CHECK(brightening <= 1);
      CHECK(green(image, {160, 0}) < green(image, {160, 179}) - 20);
      CHECK(image.at(160, 0)[0] > image.at(160, 0)[2] + 20);  // still brown
    }
  }
}

TEST_CASE("a checkered floor's squares lie where their size says, painted or under a shadow's edge") {
  Frame frame = plain_frame();
  frame.camera.position = {0.25F, 4.0F, 4.0F};
  frame.camera.target = {0.25F, 0.0F, 0.0F};
  frame.ground->checker = 0.5F;
  frame.ground->colour = glm::vec3(0.2F);
  frame.lights.sun_direction = {0.0F, 1.0F, 0.0F};
  for (const bool has_shadow : {false, true}) {
    if (has_shadow) frame.draws = {at(make_box(1, {0.2F, 0.01F, 0.2F}), {0.25F, 2.0F, 0.25F})};
    for (const Quality quality : {Quality::preview, Quality::full}) {
      Renderer renderer(kSize, quality);
      const Image image = renderer.render(frame);
      const auto light_at = [&](float x, float z) {
        return linear(green(image, pixel_of(frame, {x, 0.0F, z})));
      };
      const double bright = light_at(0.05F, 0.45F), dark = light_at(0.55F, 0.45F);
      CHECK(std::min(bright, dark) / std::max(bright, dark) == Approx(0.72).epsilon(0.03));
      CHECK(light_at(0.55F, -0.05F) == Approx(bright).epsilon(0.03));
      CHECK(light_at(0.05F, -0.05F) == Approx(dark).epsilon(0.03));
    }
  }
}

TEST_CASE("a low slab darkens the floor at its foot, and not far from it") {
  Frame frame;
  frame.camera = {glm::vec3(0, 0.6F, 1.0F), glm::vec3(0), glm::vec3(0, 1, 0), 25.0F};
  frame.lights.sun_strength = 0.0F;
  frame.draws = {at(make_box(1, {0.2F, 0.006F, 0.1F}), {0.0F, 0.003F, 0.0F})};  // two pixels high
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer(kSize, quality);
    const Image with = renderer.render(frame);
    frame.draws.clear();
    const Image without = renderer.render(frame);
    frame.draws = {at(make_box(1, {0.2F, 0.006F, 0.1F}), {0.0F, 0.003F, 0.0F})};
    const auto darker = [&](glm::vec3 p) {
      return green(without, pixel_of(frame, p)) - green(with, pixel_of(frame, p));
    };
    CHECK(darker({0.0F, 0.0F, 0.055F}) >= 4);
    CHECK(darker({0.0F, 0.0F, 0.13F}) <= 1);
    CHECK(darker({0.25F, 0.0F, 0.0F}) <= 1);
  }
}

TEST_CASE("the shadow of a pane of glass is even and light") {
  Frame frame;
  frame.camera = {glm::vec3(0, 6, 0.01F), glm::vec3(0), glm::vec3(0, 0, -1), 40.0F};
  frame.lights.sun_direction = {1.0F, 1.0F, 0.3F};
  auto pane = std::make_shared<Mesh>();
  pane->id = 1;
  pane->thickness = 0.01F;
  pane->positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
  pane->triangles = {{0, 1, 2}, {0, 2, 3}};
  frame.draws = {at(pane, {2.0F, 2.5F, 0.6F}, glass())};
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer(kSize, quality);
    const Image image = renderer.render(frame);
    const glm::ivec2 middle = pixel_of(frame, {-0.5F, 0, -0.15F}), lit = pixel_of(frame, {-2.4F, 0, -1.2F});
    int least = 255, most = 0;
    for (int y = -12; y <= 12; ++y) {
      for (int x = -12; x <= 12; ++x) {
        const int here = green(image, middle + glm::ivec2(x, y));
        least = std::min(least, here);
        most = std::max(most, here);
      }
    }
    CHECK(most - least <= 2);
    CHECK(most < green(image, lit) - 8);
    CHECK(least > green(image, lit) - 40);
  }
}

TEST_CASE("a lit plane that casts shadows has none of its own") {
  Frame frame;
  frame.ground.reset();
  frame.backdrop.vignette = 0.0F;
  frame.lights.softbox_strength = 0.0F;
  for (const glm::vec3 sun : {glm::vec3(0, 1, 0), glm::vec3(0.5F, 1, 0.2F), glm::vec3(2.0F, 1, 1.0F)}) {
    frame.lights.sun_direction = sun;
    frame.camera = {glm::vec3(0, 8, 0.01F), glm::vec3(0), glm::vec3(0, 0, -1), 30.0F};
    Look look = matt(glm::vec3(0.4F));
    look.roughness = 1.0F;
    frame.draws = {at(make_box(1, {20.0F, 0.2F, 20.0F}), {0, -0.1F, 0}, look)};
    for (const Quality quality : {Quality::preview, Quality::full}) {
      Renderer renderer(kSize, quality);
      const Image image = renderer.render(frame);
      frame.lights.casts_shadow = false;
      const Image unshadowed = renderer.render(frame);
      frame.lights.casts_shadow = true;
      CHECK(compare(image, unshadowed).most <= 2);
    }
  }
}

TEST_CASE("a lit ball has no specks of shadow on its lit side") {
  Frame frame = plain_frame();
  frame.camera = {glm::vec3(2, 2, 4), glm::vec3(0, 0.5F, 0), glm::vec3(0, 1, 0), 30.0F};
  frame.draws = {at(make_sphere(1, 0.5F, 64), {0, 0.5F, 0})};
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer(kSize, quality);
    const Image with = renderer.render(frame);
    frame.lights.casts_shadow = false;
    const Image without = renderer.render(frame);
    frame.lights.casts_shadow = true;
    const glm::vec3 sun = glm::normalize(frame.lights.sun_direction);
    int looked_at = 0;
    for (int i = 0; i < 400; ++i) {
      const float a = 0.7F * static_cast<float>(i), y = static_cast<float>(i) / 200.0F - 1.0F;
      const glm::vec3 n(std::sqrt(1 - y * y) * std::cos(a), y, std::sqrt(1 - y * y) * std::sin(a));
      const glm::vec3 p = glm::vec3(0, 0.5F, 0) + 0.5F * n;
      if (glm::dot(n, sun) < 0.25F || glm::dot(n, glm::normalize(frame.camera.position - p)) < 0.2F) continue;
      ++looked_at;
      CHECK(std::abs(green(with, pixel_of(frame, p)) - green(without, pixel_of(frame, p))) <= 2);
    }
    CHECK(looked_at > 50);
  }
}

TEST_CASE("glass lets the picture behind it through, tinted") {
  Frame frame = plain_frame();
  frame.camera = {glm::vec3(0, 1, 6), glm::vec3(0, 1, 0), glm::vec3(0, 1, 0), 30.0F};
  frame.draws = {at(make_box(1, {2.0F, 2.0F, 0.1F}), {0, 1, -1}, matt({0.6F, 0.05F, 0.05F}))};
  Renderer renderer(kSize, Quality::full);
  const Image without = renderer.render(frame);
  auto pane = std::make_shared<Mesh>();
  pane->id = 2;
  pane->thickness = 0.01F;
  pane->positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  pane->triangles = {{0, 1, 2}, {0, 2, 3}};
  frame.draws.push_back(at(pane, {0, 1, 1}, glass()));
  const Image with = renderer.render(frame);
  const std::uint8_t* a = without.at(160, 90);
  const std::uint8_t* b = with.at(160, 90);
  CHECK(std::abs(a[0] - b[0]) < 40);
  CHECK(b[0] > b[1] + 40);  // still red
  CHECK_FALSE(with == without);
}

TEST_CASE("the stress overlay paints the scale's colours and the pieces overlay tells pieces apart") {
  Frame frame = plain_frame();
  frame.camera = {glm::vec3(0, 1, 6), glm::vec3(0, 1, 0), glm::vec3(0, 1, 0), 30.0F};
  const auto box = make_box(1, glm::vec3(1.0F));
  for (int i = 0; i < 2; ++i) {
    frame.draws.push_back(at(box, {2.0F * static_cast<float>(i) - 1.0F, 1, 0}));
    frame.draws.back().scalars = std::make_shared<std::vector<float>>(8, i == 0 ? 0.0F : 30.0F);
    frame.draws.back().colour_index = static_cast<std::uint32_t>(i);
  }
  Renderer renderer(kSize, Quality::preview);
  frame.overlay.kind = OverlayKind::stress;
  frame.overlay.most = 30.0F;
  const Image stress = renderer.render(frame);
  const std::uint8_t* low = stress.at(pixel_of(frame, {-1, 1, 0.5F}).x, 90);
  const std::uint8_t* high = stress.at(pixel_of(frame, {1, 1, 0.5F}).x, 90);
  CHECK(low[2] > low[0] + 30);    // blue
  CHECK(high[0] > high[2] + 60);  // red
  frame.overlay.kind = OverlayKind::pieces;
  const Image pieces = renderer.render(frame);
  const std::uint8_t* one = pieces.at(pixel_of(frame, {-1, 1, 0.5F}).x, 90);
  const std::uint8_t* two = pieces.at(pixel_of(frame, {1, 1, 0.5F}).x, 90);
  CHECK(std::abs(one[0] - two[0]) + std::abs(one[1] - two[1]) + std::abs(one[2] - two[2]) > 60);
}

TEST_CASE("meshes stay on the GPU while frames name them and leave it after") {
  Renderer renderer(kSize, Quality::preview);
  static_cast<void>(renderer.render(busy_frame()));
  CHECK(renderer.mesh_count() == 7);
  static_cast<void>(renderer.render(plain_frame()));
  CHECK(renderer.mesh_count() == 0);
}

TEST_CASE("each pass is timed when asked and only then") {
  Renderer renderer(kSize, Quality::preview);
  static_cast<void>(renderer.render(busy_frame()));
  CHECK(renderer.pass_times().passes.empty());
  renderer.set_timing(true);
  static_cast<void>(renderer.render(busy_frame()));
  CHECK(renderer.pass_times().passes.size() >= 6);
}

TEST_CASE("odd sizes, empty frames and bodies around the eye are drawn, nonsense is refused") {
  Frame frame = busy_frame();
  frame.camera.position = {0.1F, 0.4F, 0.0F};  // inside a body
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer({101, 57}, quality);
    CHECK(renderer.render(frame).width == 101);
    Frame empty;
    empty.ground.reset();
    CHECK(renderer.render(empty).height == 57);
    frame.draws.emplace_back();
    CHECK_THROWS_AS(renderer.render(frame), std::invalid_argument);
    frame.draws.pop_back();
    CHECK(renderer.render(frame).height == 57);
  }
  CHECK_THROWS_AS(Renderer({0, 10}, Quality::full), std::runtime_error);
}
