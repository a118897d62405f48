#include "render/pass/truth.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <limits>

namespace shatterbox::render::pass {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

// The floor is no mesh: each ray that met nothing meets it where it comes down to it.
void lay_ground(const FrameBlock& values, std::uint32_t id, Truth& truth) {
  const glm::vec3 eye(values.eye_exposure), forward(values.view_forward);
  const glm::vec3 right(values.view_right), up(values.view_up);
  const float height = values.ground_place.x;
  if (eye.y <= height) return;
  for (int y = 0; y < truth.height; ++y) {
    const float down = 1.0F - (2.0F * static_cast<float>(y) + 1.0F) / static_cast<float>(truth.height);
    for (int x = 0; x < truth.width; ++x) {
      const auto pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(truth.width) + static_cast<std::size_t>(x);
      if (truth.ids[pixel] != 0) continue;
      const float along = (2.0F * static_cast<float>(x) + 1.0F) / static_cast<float>(truth.width) - 1.0F;
      const float slope = forward.y + along * right.y + down * up.y;
      if (slope >= 0.0F) continue;
      truth.depths[pixel] = (height - eye.y) / slope;  // the ray goes one metre forward
      truth.normals[pixel] = {0.0F, 1.0F, 0.0F};
      truth.ids[pixel] = id;
    }
  }
}

}  // namespace

void TruthPass::make(int width, int height) {
  normal_depth_ = gpu::Texture(width, height, GL_RGBA32F, gpu::Filter::nearest);
  id_ = gpu::Texture(width, height, GL_R32UI, gpu::Filter::nearest);
  depth_ = gpu::Texture(width, height, GL_DEPTH_COMPONENT32F, gpu::Filter::nearest);
  target_ = gpu::Framebuffer({&normal_depth_, &id_}, &depth_);
  program_ = gpu::Program("truth.vert", "truth.frag");
}

void TruthPass::read(Truth& truth) const {
  const auto width = static_cast<std::size_t>(truth.width), height = static_cast<std::size_t>(truth.height);
  std::vector<glm::vec4> seen(width * height);
  std::vector<std::uint32_t> ids(width * height);
  glGetTextureImage(normal_depth_.name(), 0, GL_RGBA, GL_FLOAT,
                    static_cast<GLsizei>(seen.size() * sizeof(glm::vec4)), seen.data());
  glGetTextureImage(id_.name(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT,
                    static_cast<GLsizei>(ids.size() * sizeof(std::uint32_t)), ids.data());
  for (std::size_t row = 0; row < height; ++row) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t from = (height - 1 - row) * width + x;  // GL's rows run from below
      truth.depths.push_back(seen[from].w);
      truth.normals.emplace_back(seen[from]);
      truth.ids.push_back(ids[from]);
    }
  }
}

Truth TruthPass::run(const MeshStore& meshes, const FrameBlock& values, std::uint32_t ground_id) {
  Truth truth;
  truth.width = static_cast<int>(values.viewport.x);
  truth.height = static_cast<int>(values.viewport.y);
  if (program_.name() == 0) make(truth.width, truth.height);
  target_.bind();
  const std::array<float, 4> empty{0.0F, 0.0F, 0.0F, kNothing};
  const std::array<GLuint, 4> nobody{};
  const float far = 1.0F;
  glDepthMask(GL_TRUE);
  glClearNamedFramebufferfv(target_.name(), GL_COLOR, 0, empty.data());
  glClearNamedFramebufferuiv(target_.name(), GL_COLOR, 1, nobody.data());
  glClearNamedFramebufferfv(target_.name(), GL_DEPTH, 0, &far);
  program_.use();
  glEnable(GL_CULL_FACE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  meshes.bind_vertices();
  for (const Item& item : meshes.items())
    if (item.is_on_screen && item.id != 0) meshes.draw(item, Part::all);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  read(truth);
  if (ground_id != 0) lay_ground(values, ground_id, truth);
  const glm::vec3 forward(values.view_forward), right = glm::normalize(glm::vec3(values.view_right));
  truth.world_from_camera =
      glm::mat4(glm::vec4(right, 0.0F), glm::vec4(glm::cross(right, forward), 0.0F),
                glm::vec4(-forward, 0.0F), glm::vec4(glm::vec3(values.eye_exposure), 1.0F));
  truth.focal = 0.5F * values.viewport.y / values.view_ray.y;
  return truth;
}

}  // namespace shatterbox::render::pass
