// The triangles drawn for a mesh: closed, offset by half the thickness, wound outwards, with rims where a
// shell ends.
#include "render/frame/expand.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

using namespace shatterbox::render;

namespace {

Mesh square_shell(float thickness) {
  Mesh mesh;
  mesh.id = 1;
  mesh.thickness = thickness;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// Behind them are lines.
std::size_t triangle_corners(const DrawnMesh& drawn) {
  return drawn.outer.count + drawn.inner.count + drawn.rim.count;
}

double signed_volume(const DrawnMesh& drawn) {
  double sum = 0;
  for (std::size_t i = 0; i < triangle_corners(drawn); i += 3) {
    const glm::dvec3 a(drawn.vertices[drawn.indices[i]].position),
        b(drawn.vertices[drawn.indices[i + 1]].position), c(drawn.vertices[drawn.indices[i + 2]].position);
    sum += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return sum;
}

// Every directed edge, by place, is met once by its reverse.
bool is_closed(const DrawnMesh& drawn) {
  using Place = std::array<float, 3>;
  std::map<std::pair<Place, Place>, int> edges;
  const auto place = [&](std::size_t i) {
    const glm::vec3 p = drawn.vertices[drawn.indices[i]].position;
    return Place{p.x, p.y, p.z};
  };
  for (std::size_t i = 0; i < triangle_corners(drawn); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++edges[{place(i + k), place(i + (k + 1) % 3)}];
      --edges[{place(i + (k + 1) % 3), place(i + k)}];
    }
  }
  for (const auto& [edge, count] : edges) {
    if (count != 0) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("a shell is drawn as a closed slab of its area times its thickness") {
  const DrawnMesh drawn = expand(square_shell(0.1F));
  CHECK(is_closed(drawn));
  CHECK(signed_volume(drawn) == Approx(0.1).epsilon(1e-5));
  CHECK(drawn.outer.count == 6);
  CHECK(drawn.inner.count == 6);
  CHECK(drawn.rim.count == 4 * 6);
}

TEST_CASE("a line goes along every edge where a shell ends: a crack's in it, the others within the face") {
  Mesh mesh = square_shell(0.1F);
  mesh.cracks = {kCrackEdge0, 0};  // edge 0-1, at y = 0
  const DrawnMesh drawn = expand(mesh);
  REQUIRE(drawn.rim_lines.count == 4 * 2);
  REQUIRE(drawn.rim_lines.first == triangle_corners(drawn));
  CHECK(drawn.indices.size() == triangle_corners(drawn) + 4 * 2);
  const std::array<glm::vec3, 8> expected{{{0, 0, 0.05F},
                                           {1, 0, 0.05F},
                                           {0.95F, 0, 0.05F},
                                           {0.95F, 1, 0.05F},
                                           {1, 0.95F, 0.05F},
                                           {0, 0.95F, 0.05F},
                                           {0.05F, 1, 0.05F},
                                           {0.05F, 0, 0.05F}}};
  for (const glm::vec3& place : expected) {
    const bool is_there =
        std::any_of(drawn.indices.begin() + drawn.rim_lines.first, drawn.indices.end(),
                    [&](std::uint32_t i) { return glm::length(drawn.vertices[i].position - place) < 1e-6F; });
    CHECK(is_there);
  }
}

TEST_CASE("only cracked boundary edges take the look of the bare material") {
  Mesh mesh = square_shell(0.1F);
  mesh.cracks = {kCrackEdge0 | kCrackEdge2, 0};  // edge 0-1 is on the boundary, the diagonal is not
  const DrawnMesh drawn = expand(mesh);
  int crack_vertices = 0;
  for (const DrawnVertex& v : drawn.vertices) {
    if ((v.face_part & 255U) != static_cast<unsigned>(Face::crack)) continue;
    ++crack_vertices;
    CHECK(v.position.y == Approx(0.0));
    CHECK(v.normal[1] == -32767);  // out of the sheet, across the edge
  }
  CHECK(crack_vertices == 4);
}

TEST_CASE("corner normals stay sharp beyond the crease angle and smooth below it") {
  Mesh roof;
  roof.positions = {{0, 0, 0}, {0, 0, 1}, {1, -1, 0}, {-1, -1, 0}};
  roof.triangles = {{0, 1, 2}, {1, 0, 3}};  // they meet at 90 degrees along z
  roof.crease_angle = 80.0F;
  const auto sharp = find_corner_normals(roof);
  roof.crease_angle = 100.0F;
  const auto smooth = find_corner_normals(roof);
  CHECK(sharp[0].x == Approx(std::sqrt(0.5)));
  CHECK(smooth[0].y == Approx(1.0).epsilon(1e-4));
}

TEST_CASE("a crack's lip is sharp however flat it is: the outer face keeps its own light") {
  Mesh chip;
  chip.surface = Surface::solid;
  chip.positions = {{0, 0, 0}, {0, 0, 1}, {1, -0.1F, 0}, {-1, 0, 0}};
  chip.triangles = {{0, 1, 2}, {1, 0, 3}};
  chip.cracks = {kCrackFace, 0};
  const auto normals = find_corner_normals(chip);
  for (const std::size_t corner : {0U, 1U, 2U}) CHECK(normals[corner].x == Approx(0.0995).epsilon(1e-3));
  for (const std::size_t corner : {3U, 4U, 5U}) CHECK(normals[corner].x == Approx(0.0).margin(1e-7));
  chip.cracks = {kCrackFace, kCrackFace};
  CHECK(find_corner_normals(chip)[3].x > 0.02F);
}

TEST_CASE("analytic bodies are closed and hold the volume they should") {
  const DrawnMesh box = expand(*make_box(1, {1, 2, 3}));
  CHECK(is_closed(box));
  CHECK(signed_volume(box) == Approx(6.0));
  const DrawnMesh ball = expand(*make_sphere(2, 0.5F, 96));
  CHECK(is_closed(ball));
  CHECK(signed_volume(ball) == Approx(4.0 / 3.0 * 3.14159265 * 0.125).epsilon(0.005));
  const DrawnMesh capsule = expand(*make_capsule(3, 0.5F, 2.0F, 96));
  CHECK(is_closed(capsule));
  CHECK(signed_volume(capsule) == Approx(3.14159265 * (0.25 * 2.0 + 4.0 / 3.0 * 0.125)).epsilon(0.005));
}

TEST_CASE("a mesh that contradicts itself is refused in words") {
  Mesh mesh = square_shell(0.1F);
  mesh.triangles.emplace_back(0, 1, 9);
  CHECK_THROWS_AS(expand(mesh), std::invalid_argument);
  mesh = square_shell(0.1F);
  mesh.parts = {0};
  CHECK_THROWS_AS(expand(mesh), std::invalid_argument);
}

TEST_CASE("degenerate triangles and lone vertices draw nothing that is not a number") {
  Mesh mesh = square_shell(0.1F);
  mesh.positions.emplace_back(5, 5, 5);
  mesh.triangles.emplace_back(0, 0, 1);
  mesh.triangles.emplace_back(4, 4, 4);
  for (const DrawnVertex& v : expand(mesh).vertices) {
    CHECK(v.position == v.position);
    CHECK(v.normal != std::array<std::int16_t, 4>{});
  }
}
