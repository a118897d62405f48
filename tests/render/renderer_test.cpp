// Pictures whose content geometry and arithmetic foretell.
#include "render/renderer.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "render/output/compare.h"
#include "tests/render/frames.h"

using namespace shatterbox::render;
using namespace shatterbox::render::testing;

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

TEST_CASE("glass is seen through glass, whichever is drawn first, as deep as the quality looks") {
  const auto red_behind = [](int count, bool is_nearest_first, Quality quality) {
    Frame frame = plain_frame();
    frame.camera = {glm::vec3(0, 1, 6), glm::vec3(0, 1, 0), glm::vec3(0, 1, 0), 30.0F};
    frame.draws = {at(make_box(1, {2.0F, 2.0F, 0.1F}), {0, 1, -1}, matt({0.6F, 0.6F, 0.6F}))};
    for (int i = 0; i < count; ++i) {
      const int place = is_nearest_first ? i : count - 1 - i;
      const auto pane = make_pane(static_cast<std::uint64_t>(2 + place), 0.8F, 0.8F);
      frame.draws.push_back(
          at(pane, {0, 1, 1.0F - 0.3F * static_cast<float>(place)}, glass({0.4F, 0.8F, 0.8F})));
    }
    Renderer renderer(kSize, quality);
    return static_cast<int>(renderer.render(frame).at(160, 90)[0]);
  };
  for (const Quality quality : {Quality::preview, Quality::full}) {
    const int seen = quality == Quality::full ? 3 : 2;
    for (int count = 1; count <= seen + 1; ++count) {
      const int red = red_behind(count, true, quality), fewer = red_behind(count - 1, true, quality);
      CAPTURE(count, red, fewer);
      CHECK(red == red_behind(count, false, quality));
      if (count <= seen)
        CHECK(red < fewer - 10);
      else
        CHECK(red == fewer);
    }
  }
}

TEST_CASE("a ball of clear glass on a pale ground has a dark outline, one of frosted glass has none") {
  Frame frame = plain_frame();
  frame.camera = {glm::vec3(0, 5, 5), glm::vec3(0, 1, 0), glm::vec3(0, 1, 0), 30.0F};
  Renderer renderer(kSize, Quality::full);
  const Image ground = renderer.render(frame);
  const glm::vec3 right(0.95F, 1.0F, 0.0F);  // on the ball of radius 1 as seen, a twentieth from its outline
  const glm::ivec2 middle = pixel_of(frame, {0, 1, 0}), edge = pixel_of(frame, right);
  frame.draws = {at(make_sphere(1, 1.0F), {0, 1, 0}, glass())};
  const Image clear = renderer.render(frame);
  CHECK(green(clear, edge) < green(ground, edge) - 25);
  CHECK(std::abs(green(clear, middle) - green(ground, middle)) < 30);
  frame.draws = {at(make_sphere(1, 1.0F), {0, 1, 0}, frosted_glass(glm::vec3(0.9F)))};
  CHECK(green(renderer.render(frame), edge) > green(clear, edge) + 15);
}

TEST_CASE(
    "a post of chrome is darker at its foot, where it mirrors the floor in its own dark, and not black") {
  Frame frame = plain_frame();
  frame.camera = {glm::vec3(0, 1.5F, 4), glm::vec3(0, 0.5F, 0), glm::vec3(0, 1, 0), 30.0F};
  frame.draws = {at(make_box(1, {0.2F, 1.0F, 0.2F}), {0, 0.5F, 0}, metal(glm::vec3(0.8F), 0.05F))};
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer(kSize, quality);
    const Image image = renderer.render(frame);
    const int middle = green(image, pixel_of(frame, {0, 0.5F, 0.1F})),
              foot = green(image, pixel_of(frame, {0, 0.02F, 0.1F}));
    CHECK(foot < middle);
    CHECK(foot > middle / 2);
  }
}

TEST_CASE("clouds lie between their two colours, fade into the mean far away") {
  Look look = matt(glm::vec3(0.6F));
  look.pattern = Pattern::clouds;
  look.pattern_colour = glm::vec3(0.2F);
  look.pattern_size = 0.3F;
  Frame frame = plain_frame();
  frame.lights.casts_shadow = false;
  Renderer renderer(kSize, Quality::preview);
  const auto levels = [&](const Look& worn, float distance) {
    frame.camera = {glm::vec3(0, 1, distance), glm::vec3(0, 1, 0), glm::vec3(0, 1, 0), 20.0F};
    frame.draws = {at(make_box(1, {2.0F, 0.9F, 0.1F}), {0, 1, 0}, worn)};
    const Image image = renderer.render(frame);
    int least = 255, most = 0;
    for (int y = 80; y <= 100; ++y)
      for (int x = 150; x <= 170; ++x) {
        least = std::min(least, green(image, {x, y}));
        most = std::max(most, green(image, {x, y}));
      }
    return std::pair(least, most);
  };
  const auto [dark, dark_too] = levels(matt(glm::vec3(0.2F)), 4.0F);
  const auto [pale, pale_too] = levels(matt(glm::vec3(0.6F)), 4.0F);
  const auto [least, most] = levels(look, 4.0F);
  CHECK(least >= dark - 1);
  CHECK(most <= pale_too + 1);
  CHECK(most - least > (pale - dark_too) / 3);
  look.pattern_size = 0.001F;
  const auto [far_least, far_most] = levels(look, 4.0F);
  CHECK(far_most - far_least <= pale_too - pale + dark_too - dark + 4);
  CHECK(far_least > dark_too + 10);
}

TEST_CASE("wood changes across its fibres, hardly along them, and fades into its mean far away") {
  Look look = matt(glm::vec3(0.6F));
  look.pattern_colour = glm::vec3(0.2F);
  Frame frame = plain_frame();
  frame.lights.casts_shadow = false;
  Renderer renderer(kSize, Quality::full);
  // Mean steps between neighbours in a row and in a column.
  const auto steps = [&](Pattern pattern, float ring) {
    look.pattern = pattern;
    look.pattern_size = ring;
    frame.camera = {glm::vec3(0, 1, 4), glm::vec3(0, 1, 0), glm::vec3(0, 1, 0), 20.0F};
    frame.draws = {at(make_box(1, {2.0F, 0.9F, 0.1F}), {0, 1, 0}, look)};
    const Image image = renderer.render(frame);
    int across = 0, down = 0;
    for (int y = 70; y < 110; ++y)
      for (int x = 140; x < 180; ++x) {
        across += std::abs(green(image, {x + 1, y}) - green(image, {x, y}));
        down += std::abs(green(image, {x, y + 1}) - green(image, {x, y}));
      }
    return std::pair(across / 1600.0, down / 1600.0);
  };
  const auto [along_x, across_x] = steps(Pattern::grain_x, 0.1F);
  CHECK(across_x > 2.5);
  CHECK(across_x > 3.0 * along_x);
  const auto [across_y, along_y] = steps(Pattern::grain_y, 0.1F);
  CHECK(across_y > 2.5);
  CHECK(across_y > 3.0 * along_y);
  CHECK(steps(Pattern::grain_x, 0.001F).second < 0.5);
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
  frame.overlay.kind = OverlayKind::heat;
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

TEST_CASE("groups have a colour each and no scale, wires are drawn where no body hides them") {
  Frame frame = plain_frame();
  frame.camera = {glm::vec3(0, 1, 6), glm::vec3(0, 1, 0), glm::vec3(0, 1, 0), 30.0F};
  const auto box = make_box(1, glm::vec3(1.0F));
  for (int i = 0; i < 2; ++i) {
    frame.draws.push_back(at(box, {2.0F * static_cast<float>(i) - 1.0F, 1, 0}));
    frame.draws.back().scalars = std::make_shared<std::vector<float>>(8, i == 0 ? 0.1F : 0.6F);
  }
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer(kSize, quality);
    const Image plain = renderer.render(frame);
    Frame groups = frame;
    groups.overlay.kind = OverlayKind::groups;
    const Image grouped = renderer.render(groups);
    const std::uint8_t* one = grouped.at(pixel_of(frame, {-1, 1, 0.5F}).x, 90);
    const std::uint8_t* two = grouped.at(pixel_of(frame, {1, 1, 0.5F}).x, 90);
    CHECK(std::abs(one[0] - two[0]) + std::abs(one[1] - two[1]) + std::abs(one[2] - two[2]) > 60);
    // The faces' diagonals are seen, the edges behind them are not; then the picture is as it was.
    Frame wires = frame;
    wires.overlay.has_wires = true;
    const Image wired = renderer.render(wires);
    CHECK_FALSE(wired == plain);
    CHECK(renderer.render(wires) == wired);
    CHECK(Renderer(kSize, quality).render(wires) == wired);
    CHECK(renderer.render(frame) == plain);
    int changed = 0, in_box = 0;
    const auto low = pixel_of(frame, {-1.35F, 0.65F, 0.5F}), high = pixel_of(frame, {-0.65F, 1.35F, 0.5F});
    for (int y = std::min(low.y, high.y); y < std::max(low.y, high.y); ++y)
      for (int x = low.x; x < high.x; ++x, ++in_box)
        changed += plain.at(x, y)[0] != wired.at(x, y)[0] ? 1 : 0;
    // Within a face one diagonal alone: about a pixel in each row.
    CHECK(changed >= (high.x - low.x) / 2);
    CHECK(changed <= 4 * (high.x - low.x));
    CHECK(changed < in_box / 4);
  }
}

TEST_CASE("a title is written in the middle above the lower edge, as dense as it is told") {
  Frame frame = plain_frame();
  Renderer renderer(kSize, Quality::preview);
  const Image plain = renderer.render(frame);
  const auto ink = [&](float opacity) {
    frame.title = {"broken", opacity};
    const Image titled = renderer.render(frame);
    long sum = 0, moment = 0;
    for (int y = 0; y < titled.height; ++y)
      for (int x = 0; x < titled.width; ++x) {
        const int change = std::abs(titled.at(x, y)[0] - plain.at(x, y)[0]);
        if (change != 0) CHECK(y > titled.height / 2);
        sum += change;
        moment += static_cast<long>(change) * x;
      }
    if (sum > 0)
      CHECK(static_cast<double>(moment) / static_cast<double>(sum) == Approx(0.5 * titled.width).margin(6));
    return sum;
  };
  const long full = ink(1.0F), half = ink(0.5F);
  CHECK(ink(0.0F) == 0);
  CHECK(full > 1000);
  CHECK(static_cast<double>(half) == Approx(0.5 * static_cast<double>(full)).epsilon(0.15));
}

TEST_CASE("meshes stay on the GPU while frames name them and leave it after") {
  Renderer renderer(kSize, Quality::preview);
  static_cast<void>(renderer.render(busy_frame()));
  CHECK(renderer.mesh_count() == 7);
  static_cast<void>(renderer.render(plain_frame()));
  CHECK(renderer.mesh_count() == 0);
}

TEST_CASE("no light that casts, no shadow maps, and they come with the first that does") {
  Frame frame = busy_frame();
  frame.lights.casts_shadow = false;
  Renderer renderer(kSize, Quality::preview);
  const Image flat = renderer.render(frame);
  CHECK_FALSE(renderer.has_shadow_maps());
  frame.lights.casts_shadow = true;
  const Image shaded = renderer.render(frame);
  CHECK(renderer.has_shadow_maps());
  CHECK(shaded == Renderer(kSize, Quality::preview).render(frame));
  CHECK_FALSE(shaded == flat);
  frame.lights.casts_shadow = false;
  CHECK(renderer.render(frame) == flat);
}

TEST_CASE("each pass is timed when asked and only then") {
  Renderer renderer(kSize, Quality::preview);
  static_cast<void>(renderer.render(busy_frame()));
  CHECK(renderer.pass_times().passes.empty());
  renderer.set_timing(true);
  renderer.forget();  // or it would be kept whole
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
