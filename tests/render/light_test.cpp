// Shadows, occlusion and the floor where geometry and arithmetic foretell them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "render/output/compare.h"
#include "render/pass/floor_pattern.h"
#include "render/renderer.h"
#include "tests/render/frames.h"

using namespace shatterbox::render;
using namespace shatterbox::render::testing;

namespace {

std::pair<Image, Image> with_and_without_shadow(Renderer& renderer, Frame frame) {
  frame.lights.casts_shadow = true;
  Image with = renderer.render(frame);
  frame.lights.casts_shadow = false;
  return {std::move(with), renderer.render(frame)};
}

}  // namespace

TEST_CASE("the shadow lies where the sun puts it, and only there") {
  Frame frame = plain_frame();
  frame.camera.position = {0.0F, 6.0F, 6.0F};
  frame.camera.target = {0.0F, 0.0F, 0.0F};
  frame.lights.sun_direction = {1.0F, 1.0F, 0.0F};
  frame.draws = {at(make_box(1, glm::vec3(0.5F)), {0.0F, 1.5F, 0.0F})};
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer(kSize, quality);
    const auto [with, without] = with_and_without_shadow(renderer, frame);
    const glm::ivec2 middle = pixel_of(frame, {-1.5F, 0.0F, 0.0F});
    CHECK(green(with, middle) < green(without, middle) - 40);
    for (const glm::vec3 lit : {glm::vec3(1.5F, 0, 0), glm::vec3(-1.5F, 0, 0.9F), glm::vec3(-2.6F, 0, 0)}) {
      CHECK(green(with, pixel_of(frame, lit)) == green(without, pixel_of(frame, lit)));
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
  frame.ground->pattern = GroundPattern::checker;
  frame.ground->pattern_size = 0.5F;
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

TEST_CASE("floors of planks and of concrete keep their colour in the mean, near and far, and repeat") {
  using pass::FloorPattern;
  for (const GroundPattern kind : {GroundPattern::planks, GroundPattern::concrete}) {
    const FloorPattern& pattern = FloorPattern::of(kind);
    const auto row_at = [&](double y, float depth, double x = 0.0) {
      std::vector<std::uint16_t> shares(512);
      pattern.find_row({x, y}, {1.0 / 512.0, 0.0}, depth, 0.0F, 512, shares.data());
      return shares;
    };
    for (const float depth : {0.0F, 2.5F, 6.0F}) {
      double sum = 0.0;
      int least = 65535, most = 0;
      for (int j = 0; j < 512; ++j) {
        for (const std::uint16_t share : row_at(j / 512.0, depth)) {
          sum += share;
          least = std::min<int>(least, share);
          most = std::max<int>(most, share);
        }
      }
      CHECK(sum / (512.0 * 512.0) == Approx(FloorPattern::kOne).epsilon(0.002));
      CHECK(most - least > 0.02 * FloorPattern::kOne);
    }
    CHECK(row_at(0.31, 0.7F) == row_at(-3.69, 0.7F, 5.0));
    for (const std::uint16_t share : row_at(0.3, FloorPattern::depth_of(1.0F)))
      CHECK(share == Approx(FloorPattern::kOne).epsilon(0.002));
  }
}

TEST_CASE(
    "a plank floor shows the same boards painted and under a shadow's edge, darkest where boards meet") {
  Frame frame = plain_frame();
  frame.camera.position = {0.25F, 4.0F, 4.0F};
  frame.camera.target = {0.25F, 0.0F, 0.0F};
  frame.ground->colour = glm::vec3(0.2F);
  frame.lights.sun_direction = {0.0F, 1.0F, 0.0F};
  const Draw slab = at(make_box(1, {0.2F, 0.01F, 0.2F}), {0.25F, 2.0F, 0.25F});
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer(kSize, quality);
    const auto picture = [&](GroundPattern pattern, bool has_shadow) {
      frame.ground->pattern = pattern;
      frame.ground->pattern_size = 0.5F;
      frame.draws.clear();
      if (has_shadow) frame.draws = {slab};
      return renderer.render(frame);
    };
    const Image plain = picture(GroundPattern::plain, false), boards = picture(GroundPattern::planks, false);
    const Image plain_dark = picture(GroundPattern::plain, true),
                boards_dark = picture(GroundPattern::planks, true);
    int dark = 0, unlike = 0;
    for (float z = -0.3F; z <= 0.3F; z += 0.02F) {  // across the shadow, and its edges
      for (float x = -0.1F; x <= 0.6F; x += 0.02F) {
        const auto light = [&](const Image& image) {
          return linear(green(image, pixel_of(frame, {x, 0.0F, z})));
        };
        dark += light(plain_dark) < 0.9 * light(plain) ? 1 : 0;
        const double lit_share = light(boards) / light(plain),
                     dark_share = light(boards_dark) / light(plain_dark);
        unlike += std::abs(lit_share - dark_share) > 0.06 ? 1 : 0;
      }
    }
    CHECK(dark > 60);
    CHECK(unlike <= dark / 20);
    const auto share_at = [&](float z) {
      const auto pixel = pixel_of(frame, {0.25F, 0.0F, z});
      return linear(green(boards, pixel)) / linear(green(plain, pixel));
    };
    for (const float seam : {0.5F, 1.0F}) {
      CHECK(share_at(seam) < share_at(seam - 0.1F));
      CHECK(share_at(seam) < share_at(seam + 0.1F));
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
    Frame tinted = frame;
    tinted.draws[0].looks = {glass({0.25F, 0.5F, 0.3F})};
    CHECK(green(renderer.render(tinted), middle) < least - 10);
  }
}

TEST_CASE("a shadow lies on cloudy glass, and not on clear glass, through which it falls") {
  Frame frame = plain_frame();
  frame.ground.reset();
  frame.camera = {glm::vec3(0, 6, 3), glm::vec3(0), glm::vec3(0, 0, -1), 40.0F};
  frame.lights.sun_direction = {1.0F, 1.0F, 0.0F};
  const auto with_slab = [&frame](const Look& look, float x) {
    Frame out = frame;
    out.draws = {at(make_box(1, {4.0F, 0.3F, 2.0F}), glm::vec3(0), look),
                 at(make_box(2, glm::vec3(0.5F)), {x, 1.0F, 0.0F})};
    return out;
  };
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer(kSize, quality);
    const glm::ivec2 shaded = pixel_of(frame, {-0.3F, 0.15F, 0}), lit = pixel_of(frame, {-1.2F, 0.15F, 0});
    for (const Look& look : {frosted_glass(glm::vec3(0.8F)), glass()}) {
      const auto [with, without] = with_and_without_shadow(renderer, with_slab(look, 0.55F));
      const bool is_cloudy = look.transmission < 0.9F;
      CHECK((green(with, shaded) < green(without, shaded) - 10) == is_cloudy);
      CHECK(std::abs(green(with, lit) - green(without, lit)) <= 1);
    }
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
      const auto [with, without] = with_and_without_shadow(renderer, frame);
      CHECK(compare(with, without).most <= 2);
    }
  }
}

TEST_CASE("what hardly rises from the floor has a shadow too, down to its foot") {
  Frame frame = plain_frame();
  frame.camera = {glm::vec3(0, 0.4F, 0.2F), glm::vec3(0), glm::vec3(0, 1, 0), 8.0F};
  frame.lights.sun_direction = {1, 1, 0};
  frame.draws = {at(make_box(1, {0.04F, 0.0012F, 0.04F}), {0, 0.0006F, 0})};
  for (const float side : {-0.5F, 0.5F})  // the map is as wide as that
    frame.draws.push_back(at(make_box(2, glm::vec3(0.05F)), {side, 0.025F, 0}));
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer(kSize, quality);
    const auto [with, without] = with_and_without_shadow(renderer, frame);
    const auto darkened = [&, &lit = without, &dark = with](float x) {
      const glm::ivec2 place = pixel_of(frame, {x, 0, 0});
      return green(lit, place) - green(dark, place);
    };
    CHECK(darkened(-0.0204F) > 30);
    CHECK(darkened(-0.026F) <= 2);
    CHECK(darkened(0.024F) <= 2);
  }
}

TEST_CASE("a lit ball has no specks of shadow on its lit side") {
  Frame frame = plain_frame();
  frame.camera = {glm::vec3(2, 2, 4), glm::vec3(0, 0.5F, 0), glm::vec3(0, 1, 0), 30.0F};
  frame.draws = {at(make_sphere(1, 0.5F, 64), {0, 0.5F, 0})};
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer(kSize, quality);
    const auto [with, without] = with_and_without_shadow(renderer, frame);
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

namespace {

// Two halves of a white block that is turned in the picture, dark within.
Frame cracked_block(float gap) {
  Frame frame = plain_frame();
  const auto half = make_cracked_box(1, {1.0F, 2.0F, 0.4F}, 0, 4);
  for (const float side : {-1.0F, 1.0F}) {
    Draw draw = at(half, {0, 0.8F, 0}, matt(glm::vec3(0.7F)));
    draw.world_from_body = glm::rotate(draw.world_from_body, 0.3F, glm::vec3(0, 0, 1));
    draw.world_from_body = glm::translate(draw.world_from_body, glm::vec3(side * 0.5F * (1.0F + gap), 0, 0));
    draw.looks[0].crack = glm::vec3(0.05F);
    frame.draws.push_back(draw);
  }
  return frame;
}

int count_dark(const Image& image, const Frame& frame, int than) {
  const glm::ivec2 middle = pixel_of(frame, {0, 0.8F, 0.2F});
  int count = 0;
  for (int y = -20; y <= 20; ++y)
    for (int x = -20; x <= 20; ++x) count += green(image, middle + glm::ivec2(x, y)) < than ? 1 : 0;
  return count;
}

// Of the same pixels.
int find_darkest(const Image& image, const Frame& frame) {
  int darkest = 255;
  while (darkest > 0 && count_dark(image, frame, darkest) > 0) --darkest;
  return darkest;
}

// Rows of them in which none is dark.
int count_broken_rows(const Image& image, const Frame& frame, int than) {
  const glm::ivec2 middle = pixel_of(frame, {0, 0.8F, 0.2F});
  int count = 0;
  for (int y = -20; y <= 20; ++y) {
    bool is_broken = true;
    for (int x = -20; x <= 20; ++x) is_broken = is_broken && green(image, middle + glm::ivec2(x, y)) >= than;
    count += is_broken ? 1 : 0;
  }
  return count;
}

}  // namespace

TEST_CASE(
    "a crack that is narrower than a pixel is an even line of shade and no dots, and a wider one is seen") {
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer(kSize, quality);
    const Frame whole = cracked_block(0.0F);
    const Image closed = renderer.render(whole);
    const int white = green(closed, pixel_of(whole, {0.3F, 0.8F, 0.2F}));
    const int darkest = find_darkest(closed, whole);
    CHECK(darkest < white - 20);
    CHECK(darkest > white - 40);
    for (const float gap : {0.0F, 0.0005F, 0.002F, 0.005F}) {  // a pixel is 24 mm wide
      const Image image = renderer.render(cracked_block(gap));
      INFO("gap " << gap << ", " << (quality == Quality::full ? "full" : "preview"));
      CHECK(count_broken_rows(image, whole, white - 12) == 0);
      CHECK(count_dark(image, whole, white - 12) <= 41 * 2);
      CHECK(find_darkest(image, whole) >= darkest - 8);
    }
    CHECK(count_dark(renderer.render(cracked_block(0.036F)), whole, white - 40) >= 40);
  }
}

TEST_CASE("a chip as small as a pixel is seen before a wall") {
  Frame frame = plain_frame();
  frame.draws = {at(make_box(1, {3.0F, 2.0F, 0.2F}), {0, 1, 0}, matt(glm::vec3(0.7F)))};
  Renderer renderer(kSize, Quality::preview);
  const Image without = renderer.render(frame);
  Draw chip = at(make_cracked_box(2, glm::vec3(0.03F), 0, 12), {0.1F, 0.9F, 0.4F});
  chip.looks[0].crack = glm::vec3(0.05F);
  chip.casts_shadow = false;
  frame.draws.push_back(chip);
  CHECK(compare(renderer.render(frame), without).most > 60);
}
