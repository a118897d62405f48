// A frame of which parts are kept from the last one equals the same frame drawn wholly, to the bit.
#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "render/renderer.h"
#include "tests/render/frames.h"

using namespace shatterbox::render;
using namespace shatterbox::render::testing;

namespace {

// Bodies near, far, before and behind each other, on the floor and above it; some cast shadows on others.
Frame still_life() {
  Frame frame = plain_frame();
  frame.draws.push_back(at(make_box(1, {3.0F, 1.2F, 0.2F}), {-0.5F, 0.6F, -1.0F}, matt({0.6F, 0.5F, 0.4F})));
  frame.draws.push_back(at(make_sphere(2, 0.4F), {-1.2F, 0.4F, 0.5F}, ornament({0.5F, 0.02F, 0.03F})));
  frame.draws.push_back(at(make_sphere(3, 0.25F), {0.3F, 1.1F, 0.6F}, ceramic({0.1F, 0.3F, 0.4F})));
  frame.draws.push_back(at(make_pane(4, 0.8F, 0.6F), {0.9F, 0.7F, 0.4F}, glass()));
  frame.draws.push_back(at(make_pane(5, 0.5F, 0.9F), {0.2F, 0.5F, 1.2F}, glass()));
  frame.draws.push_back(
      at(make_box(9, {1.0F, 0.1F, 0.7F}), {-1.2F, 0.05F, 1.3F}, frosted_glass({0.7F, 0.8F, 0.9F})));
  frame.draws.push_back(at(make_pane(6, 0.7F, 0.5F), {1.9F, 0.3F, -0.6F}, stone({0.5F, 0.5F, 0.45F})));
  frame.draws.push_back(at(make_sphere(7, 0.15F), {2.6F, 0.15F, -3.0F}, metal({0.7F, 0.7F, 0.7F}, 0.05F)));
  // About all that moves: the shadow map keeps its place, and what it shows is told apart by who casts it.
  const auto post = make_sphere(8, 0.05F);
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 corner((i & 1) ? 3.4F : -3.4F, (i & 2) ? 2.3F : -0.1F, (i & 4) ? 2.5F : -4.5F);
    frame.draws.push_back(at(post, corner));
  }
  return frame;
}

class Change {
 public:
  explicit Change(unsigned seed) : draw_(seed) {}

  // Something of all that a scene does from frame to frame.
  void apply(Frame& frame) {
    for (unsigned count = below(3); count > 0 && !frame.draws.empty(); --count) change_body(frame);
    switch (below(12)) {
      case 0:
        return add_body(frame);
      case 1:
        if (const unsigned gone = below_moving(frame); frame.draws.size() > 12)
          frame.draws.erase(frame.draws.begin() + gone);
        return;
      case 2:
        frame.caption = frame.caption.empty() ? "t = 0.1 s" : "";
        return;
      default:
        return;
    }
  }

  unsigned below(unsigned end) { return static_cast<unsigned>(draw_() % end); }
  float within(float least, float most) {
    return least + (most - least) * static_cast<float>(draw_() % 10000U) / 10000.0F;
  }

 private:
  // A body that is not a post.
  unsigned below_moving(const Frame& frame) {
    unsigned body = 0;
    do {
      body = below(static_cast<unsigned>(frame.draws.size()));
    } while (frame.draws[body].mesh->id == 8);
    return body;
  }

  void change_body(Frame& frame) {
    Draw& body = frame.draws[below_moving(frame)];
    switch (below(9)) {
      case 0:
        body.looks = {matt({within(0, 1), within(0, 1), within(0, 1)})};
        return;
      case 1:
        body.looks = {below(2) == 0 ? glass() : frosted_glass({0.8F, 0.9F, 0.8F})};
        return;
      case 2:
        body.casts_shadow = !body.casts_shadow;
        return;
      case 3:  // far
        body.world_from_body[3] = glm::vec4(within(-3, 3), within(0.1F, 1.6F), within(-4, 2), 1);
        return;
      case 4:
        body.world_from_body =
            glm::rotate(body.world_from_body, within(-0.5F, 0.5F), glm::vec3(0.3F, 0.5F, 0.81F));
        return;
      default:
        body.world_from_body[3] +=
            glm::vec4(within(-0.1F, 0.1F), within(-0.1F, 0.1F), within(-0.1F, 0.1F), 0);
        return;
    }
  }

  void add_body(Frame& frame) {
    Draw body = frame.draws[below_moving(frame)];  // shares its mesh
    body.scalars = nullptr;
    if (below(3) == 0) body.mesh = make_pane(next_mesh_++, within(0.1F, 0.9F), within(0.1F, 0.9F));
    body.world_from_body[3] = glm::vec4(within(-2, 2), within(0.1F, 1.4F), within(-2, 1.5F), 1);
    frame.draws.push_back(std::move(body));
  }

  std::mt19937 draw_;
  std::uint64_t next_mesh_ = 100;
};

// Draws the film twice: keeping, and forgetting before each frame. What share of it was kept, of all frames.
double compare_films(Size size, Quality quality, Frame frame, int frames,
                     const std::function<void(Frame&, int)>& change) {
  Renderer keeping(size, quality), forgetting(size, quality);
  double kept = 0.0;
  for (int i = 0; i < frames; ++i) {
    if (i > 0) change(frame, i);
    forgetting.forget();
    const Image wanted = forgetting.render(frame);
    REQUIRE(forgetting.drawn_share() == 1.0);
    const Image got = keeping.render(frame);
    INFO("frame " << i);
    REQUIRE(got == wanted);
    kept += (1.0 - keeping.drawn_share()) / frames;
  }
  return kept;
}

constexpr Quality kQualities[] = {Quality::preview, Quality::full};

}  // namespace

TEST_CASE("a renderer that forgets draws as a new one does") {
  Frame frame = still_life();
  for (const Quality quality : kQualities) {
    Renderer one(kSize, quality), other(kSize, quality);
    static_cast<void>(one.render(still_life()));
    frame.draws[2].world_from_body[3].x += 0.2F;
    frame.draws.erase(frame.draws.begin());
    one.forget();
    CHECK(one.render(frame) == other.render(frame));
  }
}

TEST_CASE("kept pictures of random changes equal pictures drawn wholly") {
  for (const Quality quality : kQualities) {
    for (const unsigned seed : {1U, 2U, 3U}) {
      Change change(seed);
      const double kept =
          compare_films(kSize, quality, still_life(), 30, [&](Frame& frame, int) { change.apply(frame); });
      CHECK(kept > 0.1);
    }
  }
}

TEST_CASE("kept pictures under a low sun, a low camera and none of the floor") {
  for (const Quality quality : kQualities) {
    for (const unsigned seed : {4U, 5U, 6U}) {
      Frame frame = still_life();
      if (seed == 4U) frame.lights.sun_direction = {1.0F, 0.25F, 0.3F};
      if (seed == 5U) frame.camera.position = {0.5F, 0.15F, 3.0F};
      if (seed == 6U) frame.ground.reset();
      Change change(seed);
      static_cast<void>(compare_films(kSize, quality, frame, 16, [&](Frame& f, int) { change.apply(f); }));
    }
  }
}

TEST_CASE("kept pictures of odd sizes") {
  for (const Quality quality : kQualities) {
    Change change(7);
    static_cast<void>(
        compare_films({211, 119}, quality, still_life(), 16, [&](Frame& f, int) { change.apply(f); }));
  }
}

TEST_CASE("kept pictures while camera, light, overlay and patterns change") {
  for (const Quality quality : kQualities) {
    Change change(8);
    static_cast<void>(compare_films(kSize, quality, still_life(), 40, [&](Frame& frame, int i) {
      change.apply(frame);
      if (i % 9 == 4) frame.camera.position.x += 0.3F;
      if (i % 11 == 6) frame.exposure *= 1.1F;
      if (i % 13 == 5) frame.lights.casts_shadow = !frame.lights.casts_shadow;
      if (i % 7 == 3) {
        frame.overlay.kind = static_cast<OverlayKind>(change.below(4));
        for (Draw& draw : frame.draws) {
          draw.colour_index = change.below(5);
          draw.scalars =
              std::make_shared<std::vector<float>>(draw.mesh->positions.size(), change.within(0, 1));
        }
      }
      if (i % 8 == 1) {
        frame.draws.back().looks.front().pattern = i % 16 == 1 ? Pattern::speckle : Pattern::checker;
        frame.draws.back().looks.front().pattern_size = 0.1F;
      }
    }));
  }
}

// What a moving body does to others, alone: it must be seen where it is done. The shadows of the rows of
// bodies far to the right fall on the box's left half.
TEST_CASE("kept pictures of one body's way past others") {
  struct Way {
    glm::vec3 from, step;
    std::size_t body;
  };
  const Way ways[] = {
      {{2.0F, 1.5F, 1.2F}, {0.03F, 0.02F, 0.0F}, 2},     // its shadow on the box, among others'
      {{2.0F, 1.5F, 1.2F}, {0.03F, 0.02F, 0.0F}, 3},     // the same of glass
      {{2.8F, 1.5F, 1.2F}, {-0.02F, 0.05F, 0.0F}, 5},    // large
      {{-1.2F, 0.3F, -0.4F}, {0.12F, 0.0F, -0.02F}, 2},  // it occludes the box
      {{-1.5F, 0.8F, 2.2F}, {0.14F, 0.0F, 0.0F}, 3},     // glass before the others
      {{1.4F, 1.4F, 0.8F}, {-0.12F, -0.06F, -0.1F}, 4},  // glass behind glass, down to the floor
      {{-2.0F, 0.15F, 2.0F}, {0.2F, 0.0F, 0.0F}, 6},     // along the floor, near the eye
  };
  for (const Quality quality : kQualities) {
    for (const Way& way : ways) {
      Frame frame = still_life();
      frame.lights.sun_direction = {0.8F, 0.3F, 0.6F};
      frame.lights.sun_size = 12.0F;
      for (int i = 0; i < 6; ++i) {
        const auto x = 1.7F + 0.2F * static_cast<float>(i);
        frame.draws.push_back(at(make_box(20, {0.04F, 0.5F, 0.04F}), {x, 1.6F, 1.3F}));
      }
      frame.draws[way.body].world_from_body[3] = glm::vec4(way.from, 1.0F);
      const double kept = compare_films(kSize, quality, frame, 14, [&](Frame& f, int) {
        f.draws[way.body].world_from_body[3] += glm::vec4(way.step, 0.0F);
      });
      UNSCOPED_INFO("body " << way.body << " kept " << kept);
      CHECK(kept > 0.2);
    }
  }
}

// What is beside a crack's pixel may decide what it shows, and lie in another tile.
TEST_CASE("kept pictures of a crack that opens, wherever it lies among the tiles") {
  constexpr float kPixel = 0.0243F;
  for (const Quality quality : kQualities) {
    for (int shift = 0; shift < 17; ++shift) {
      Frame frame = still_life();
      const float x = kPixel * static_cast<float>(shift);
      frame.draws.push_back(at(make_cracked_box(20, {1.0F, 0.9F, 0.2F}, 0, 4), {x, 0.9F, 1.0F}));
      frame.draws.push_back(at(make_cracked_box(20, {1.0F, 0.9F, 0.2F}, 0, 4), {x + 1.0005F, 0.9F, 1.0F}));
      compare_films(kSize, quality, frame, 4,
                    [](Frame& f, int) { f.draws.back().world_from_body[3].x += 0.3F * kPixel; });
    }
  }
}

TEST_CASE("glass that is gone is not seen again where other glass comes near") {
  for (const Quality quality : kQualities) {
    Frame frame = plain_frame();
    frame.draws.push_back(at(make_pane(1, 0.3F, 0.3F), {1.0F, 1.0F, 0.0F}, glass()));
    static_cast<void>(compare_films(kSize, quality, frame, 5, [&](Frame& f, int i) {
      if (i == 1) f.draws.clear();
      if (i != 3) return;
      f.draws.push_back(
          at(make_pane(2, 3.0F, 0.1F), {0.6F, 0.6F, 0.0F}, glass()));  // aslant, past that place
      f.draws.back().world_from_body = glm::rotate(f.draws.back().world_from_body, -0.6F, glm::vec3(0, 0, 1));
    }));
  }
}

TEST_CASE("glass that comes into a film without any is seen where it is, and nowhere else") {
  for (const Quality quality : kQualities) {
    Frame frame = plain_frame();
    frame.draws.clear();
    static_cast<void>(compare_films(kSize, quality, frame, 4, [&](Frame& f, int i) {
      if (i == 1) f.draws.push_back(at(make_pane(2, 3.0F, 0.1F), {0.6F, 0.9F, 0.0F}, glass()));
      f.draws.back().world_from_body = glm::rotate(f.draws.back().world_from_body, -0.3F, glm::vec3(0, 0, 1));
    }));
  }
}

TEST_CASE("a shadow that moves over cloudy glass leaves nothing where it was") {
  for (const Quality quality : kQualities) {
    Frame frame = plain_frame();
    frame.lights.sun_direction = {1.0F, 1.0F, 0.0F};
    frame.draws = {at(make_box(1, {2.0F, 0.2F, 1.0F}), {-0.6F, 0.6F, 0.0F}, frosted_glass(glm::vec3(0.8F))),
                   at(make_sphere(2, 0.2F), {0.6F, 1.6F, 0.0F})};
    const auto post = make_sphere(8, 0.05F);
    for (const float x : {-3.0F, 3.0F}) frame.draws.push_back(at(post, {x, 2.2F, 0.0F}));
    const double kept = compare_films(kSize, quality, frame, 4,
                                      [](Frame& f, int) { f.draws[1].world_from_body[3].z += 0.15F; });
    CHECK(kept > 0.1);
  }
}

TEST_CASE("a still frame is kept whole, a small change draws little, a camera's way draws all") {
  Frame frame = still_life();
  Renderer renderer(kSize, Quality::preview);
  const Image first = renderer.render(frame);
  CHECK(renderer.drawn_share() == 1.0);
  CHECK(renderer.render(frame) == first);
  CHECK(renderer.drawn_share() == 0.0);
  frame.caption = "written on the picture";
  CHECK_FALSE(renderer.render(frame) == first);
  CHECK(renderer.drawn_share() == 0.0);
  frame.caption.clear();
  CHECK(renderer.render(frame) == first);
  frame.draws[2].world_from_body[3].y += 0.02F;
  static_cast<void>(renderer.render(frame));
  CHECK(renderer.drawn_share() > 0.0);
  CHECK(renderer.drawn_share() < 0.6);
  frame.camera.position.x += 0.01F;
  static_cast<void>(renderer.render(frame));
  CHECK(renderer.drawn_share() == 1.0);
}

TEST_CASE("what flies off does not move the shadow map in each frame") {
  Frame frame = plain_frame();
  frame.draws.push_back(at(make_box(1, {3.0F, 1.2F, 0.2F}), {-0.5F, 0.6F, -1.0F}));
  frame.draws.push_back(at(make_sphere(2, 0.1F), {0.3F, 0.8F, 1.5F}));
  Renderer renderer(kSize, Quality::preview);
  int drawn_wholly = 0;
  for (int i = 0; i < 100; ++i) {
    frame.draws[1].world_from_body[3].z -= 0.12F;
    static_cast<void>(renderer.render(frame));
    drawn_wholly += renderer.drawn_share() == 1.0 ? 1 : 0;
  }
  CHECK(drawn_wholly < 40);
}

TEST_CASE("a frame that was refused is forgotten") {
  Frame frame = still_life(), broken = frame;
  Renderer renderer(kSize, Quality::preview);
  const Image first = renderer.render(frame);
  broken.draws[0].looks = {matt({1.0F, 0.0F, 0.0F})};
  broken.draws.emplace_back();
  CHECK_THROWS_AS(renderer.render(broken), std::invalid_argument);
  CHECK(renderer.render(frame) == first);
}
