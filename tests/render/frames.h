// Frames that the tests draw, and what they read in the pictures.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>

#include "render/renderer.h"

namespace shatterbox::render::testing {

inline constexpr Size kSize{320, 180};

inline Draw at(std::shared_ptr<const Mesh> mesh, glm::vec3 place, Look look = matt(glm::vec3(0.5F))) {
  Draw draw;
  draw.mesh = std::move(mesh);
  draw.world_from_body = glm::translate(glm::mat4(1.0F), place);
  draw.looks = {look};
  return draw;
}

// A box whose triangles from `first` to `end` are crack faces.
inline std::shared_ptr<const Mesh> make_cracked_box(std::uint64_t id, glm::vec3 size, std::size_t first,
                                                    std::size_t end) {
  auto box = std::make_shared<Mesh>(*make_box(id, size));
  box->cracks.assign(box->triangles.size(), 0);
  for (std::size_t t = first; t < end; ++t) box->cracks[t] = kCrackFace;
  return box;
}

// With cracked edges.
inline std::shared_ptr<const Mesh> make_pane(std::uint64_t id, float width, float height) {
  auto pane = std::make_shared<Mesh>();
  pane->id = id;
  pane->thickness = 0.02F;
  const glm::vec3 x(0.5F * width, 0, 0), y(0, 0.5F * height, 0);
  pane->positions = {-x - y, x - y, x + y, -x + y};
  pane->triangles = {{0, 1, 2}, {0, 2, 3}};
  pane->cracks = {kCrackEdge0, kCrackEdge1};
  return pane;
}

inline Frame plain_frame() {
  Frame frame;
  frame.camera.position = {0.0F, 2.0F, 6.0F};
  frame.camera.target = {0.0F, 0.5F, 0.0F};
  frame.camera.vertical_fov = 40.0F;
  return frame;
}

inline Frame busy_frame() {
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
inline glm::ivec2 pixel_of(const Frame& frame, glm::vec3 p) {
  const Camera& c = frame.camera;
  const glm::vec4 clip = glm::perspective(glm::radians(c.vertical_fov), 320.0F / 180.0F, 0.1F, 100.0F) *
                         glm::lookAt(c.position, c.target, c.up) * glm::vec4(p, 1.0F);
  return {static_cast<int>((clip.x / clip.w * 0.5F + 0.5F) * 320.0F),
          static_cast<int>((0.5F - clip.y / clip.w * 0.5F) * 180.0F)};
}

inline int green(const Image& image, glm::ivec2 p) {
  return image.at(p.x, p.y)[1];
}

inline int srgb(double linear) {
  return static_cast<int>(std::lround(
      255.0 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055)));
}

inline double linear(int code) {
  const double x = code / 255.0;
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

}  // namespace shatterbox::render::testing
