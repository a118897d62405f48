// Boxes, spheres and capsules as closed meshes.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/frame/mesh.h"

namespace shatterbox::render {
namespace {

// Turns a profile (radius, height; from the bottom pole to the top pole) about the y axis. Poles are single
// vertices.
std::shared_ptr<const Mesh> revolve(std::uint64_t id, const std::vector<glm::vec2>& profile, int around) {
  auto mesh = std::make_shared<Mesh>();
  mesh->id = id;
  mesh->surface = Surface::solid;
  mesh->crease_angle = 60.0F;
  const auto n = static_cast<std::uint32_t>(around);
  const auto rings = static_cast<std::uint32_t>(profile.size()) - 2;
  mesh->positions.emplace_back(0.0F, profile.front().y, 0.0F);
  for (std::uint32_t r = 1; r <= rings; ++r) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const float a = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(n);
      mesh->positions.emplace_back(profile[r].x * std::cos(a), profile[r].y, -profile[r].x * std::sin(a));
    }
  }
  mesh->positions.emplace_back(0.0F, profile.back().y, 0.0F);
  const auto last = static_cast<std::uint32_t>(mesh->positions.size()) - 1;
  const auto at = [n](std::uint32_t ring, std::uint32_t i) { return 1 + ring * n + i % n; };
  for (std::uint32_t i = 0; i < n; ++i) {
    mesh->triangles.emplace_back(0, at(0, i + 1), at(0, i));
    for (std::uint32_t r = 0; r + 1 < rings; ++r) {
      mesh->triangles.emplace_back(at(r, i), at(r, i + 1), at(r + 1, i + 1));
      mesh->triangles.emplace_back(at(r, i), at(r + 1, i + 1), at(r + 1, i));
    }
    mesh->triangles.emplace_back(at(rings - 1, i), at(rings - 1, i + 1), last);
  }
  return mesh;
}

}  // namespace

std::shared_ptr<const Mesh> make_box(std::uint64_t id, glm::vec3 size) {
  auto mesh = std::make_shared<Mesh>();
  mesh->id = id;
  mesh->surface = Surface::solid;
  for (int i = 0; i < 8; ++i) {
    mesh->positions.push_back(0.5F * size * glm::vec3((i & 1) ? 1 : -1, (i & 2) ? 1 : -1, (i & 4) ? 1 : -1));
  }
  mesh->triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}

std::shared_ptr<const Mesh> make_capsule(std::uint64_t id, float radius, float length, int segments) {
  segments = std::max(segments, 8);
  const int half = segments / 4;
  std::vector<glm::vec2> profile;
  for (int side = -1; side <= 1; side += 2) {
    for (int i = 0; i <= half; ++i) {
      const int step = side < 0 ? i - half : i;
      if (side > 0 && i == 0 && length <= 0.0F) continue;
      const float a = 0.5F * std::numbers::pi_v<float> * static_cast<float>(step) / static_cast<float>(half);
      profile.emplace_back(radius * std::cos(a),
                           radius * std::sin(a) + 0.5F * length * static_cast<float>(side));
    }
  }
  return revolve(id, profile, segments);
}

std::shared_ptr<const Mesh> make_sphere(std::uint64_t id, float radius, int segments) {
  return make_capsule(id, radius, 0.0F, segments);
}

}  // namespace shatterbox::render
