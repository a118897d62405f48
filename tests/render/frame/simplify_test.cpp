// Fewer triangles, the same surface: what must not move, and how far the rest may.
#include "render/frame/simplify.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "render/frame/expand.h"

using namespace shatterbox::render;

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// A square of 1 m in the plane y = 0, n squares a side; the edges at x = 1 are cracks, and where x > 1/2 is
// part 1.
Mesh make_grid(std::uint32_t n) {
  Mesh mesh;
  mesh.id = 1;
  mesh.thickness = 0.01F;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      mesh.positions.emplace_back(static_cast<float>(j) / static_cast<float>(n), 0.0F,
                                  static_cast<float>(i) / static_cast<float>(n));
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {b, c, d}});
      const std::uint8_t right = j + 1 == n ? kCrackEdge2 : std::uint8_t{0};  // d to b
      mesh.cracks.insert(mesh.cracks.end(), {std::uint8_t{0}, right});
      mesh.parts.insert(mesh.parts.end(), 2, j >= n / 2 ? std::uint8_t{1} : std::uint8_t{0});
    }
  }
  return mesh;
}

// The same sheet wound over a half cylinder of radius 1 / pi about z.
Mesh make_arch(std::uint32_t n) {
  Mesh mesh = make_grid(n);
  mesh.parts.clear();
  for (glm::vec3& p : mesh.positions) {
    const float angle = 3.14159265F * p.x;
    p = glm::vec3(-std::cos(angle) / 3.14159265F, std::sin(angle) / 3.14159265F, p.z);
  }
  return mesh;
}

std::map<Edge, int> find_edges(const Mesh& mesh) {
  std::map<Edge, int> edges;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
  }
  return edges;
}

float find_area(const Mesh& mesh) {
  float area = 0.0F;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 a = mesh.positions[t.x];
    area += 0.5F * glm::length(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
  }
  return area;
}

}  // namespace

TEST_CASE("a flat sheet of two paints keeps its outline and their border, and next to no triangles") {
  const Mesh before = make_grid(16), after = simplify(before, 1e-4F);
  CHECK(after.triangles.size() < before.triangles.size() / 8);
  CHECK(find_area(after) == Approx(1.0F));
  for (std::size_t t = 0; t < after.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const float x = after.positions[after.triangles[t][k]].x;
      CHECK((after.parts[t] == 1 ? x >= 0.5F : x <= 0.5F));
    }
  }
}

TEST_CASE("an outline's edges stay cracks where they were, and only there") {
  const Mesh after = simplify(make_grid(16), 1e-4F);
  const std::map<Edge, int> edges = find_edges(after);
  float cracked = 0.0F;
  for (std::size_t t = 0; t < after.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = after.triangles[t][k], b = after.triangles[t][(k + 1) % 3];
      const glm::vec3 from = after.positions[a], to = after.positions[b];
      if (edges.at(std::minmax(a, b)) != 1) continue;
      const bool is_right = from.x == 1.0F && to.x == 1.0F;
      CHECK(((after.cracks[t] & (1U << k)) != 0) == is_right);
      if (is_right) cracked += glm::distance(from, to);
    }
  }
  CHECK(cracked == Approx(1.0F));
}

TEST_CASE("a curved sheet stays within the tolerance of itself, in one sheet, with its own normals") {
  const Mesh before = make_arch(40);
  std::size_t last = before.triangles.size();
  for (const float tolerance : {1e-3F, 4e-3F, 16e-3F}) {
    const Mesh after = simplify(before, tolerance);
    CHECK(after.triangles.size() < last);
    last = after.triangles.size();
    float most = 0.0F;
    for (const glm::uvec3& t : after.triangles) {
      const glm::vec3 a = after.positions[t.x], b = after.positions[t.y], c = after.positions[t.z];
      for (const glm::vec3 p : {0.5F * (a + b), 0.5F * (b + c), 0.5F * (c + a), (a + b + c) / 3.0F}) {
        most = std::max(most, std::abs(std::hypot(p.x, p.y) - 1.0F / 3.14159265F));
      }
    }
    CHECK(most < 1.5F * tolerance + 2e-4F);  // the sheet given is itself off by 2e-4
    const std::map<Edge, int> edges = find_edges(after);
    std::set<std::uint32_t> vertices;
    for (const auto& [edge, count] : edges) {
      CHECK(count <= 2);
      vertices.insert({edge.first, edge.second});
    }
    CHECK(vertices.size() + after.triangles.size() == edges.size() + 1);  // Euler, of a disc
    for (std::size_t c = 0; c < 3 * after.triangles.size(); ++c) {
      const glm::vec3 p = after.positions[after.triangles[c / 3][static_cast<int>(c % 3)]];
      const glm::vec3 out = glm::normalize(glm::vec3(p.x, p.y, 0.0F));
      CHECK(std::abs(glm::dot(after.normals[c], out)) > 0.999F);
    }
  }
}

TEST_CASE("simplifying is the same each time, keeps positions, and leaves what cannot be simpler") {
  const Mesh before = make_arch(20);
  const Mesh one = simplify(before, 3e-3F), two = simplify(before, 3e-3F);
  CHECK(one.triangles == two.triangles);
  CHECK(one.positions == before.positions);
  CHECK(simplify(make_grid(1), 0.1F).triangles.size() == 2);
  Mesh wrong = make_grid(1);
  wrong.triangles.push_back({0, 1, 99});
  wrong.parts.push_back(0);
  wrong.cracks.push_back(0);
  CHECK_THROWS_AS(simplify(wrong, 1.0F), std::invalid_argument);
}
