// Fewer triangles, the same surface: what must not move, and how far the rest may.
#include "render/frame/simplify.h"

#include <algorithm>
#include <array>
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

// A cube of 1 m about the origin, n squares a side on each face; that at x = 1/2 is a crack's.
Mesh make_cube(std::uint32_t n) {
  Mesh mesh;
  mesh.id = 2;
  mesh.surface = Surface::solid;
  std::map<std::array<int, 3>, std::uint32_t> known;
  const auto vertex = [&](std::array<int, 3> at) {
    const auto [found, is_new] = known.emplace(at, static_cast<std::uint32_t>(mesh.positions.size()));
    const auto place = [n](int i) { return static_cast<float>(i) / static_cast<float>(n) - 0.5F; };
    if (is_new) mesh.positions.emplace_back(place(at[0]), place(at[1]), place(at[2]));
    return found->second;
  };
  const int last = static_cast<int>(n);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int side : {0, last}) {
      for (int i = 0; i < last; ++i) {
        for (int j = 0; j < last; ++j) {
          const auto at = [&](int along, int across) {
            std::array<int, 3> place{};
            place[axis] = side;
            place[(axis + 1) % 3] = i + (side == 0 ? across : along);
            place[(axis + 2) % 3] = j + (side == 0 ? along : across);
            return vertex(place);
          };
          const std::uint32_t a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
          mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
          const bool is_crack = axis == 0 && side == last;
          mesh.cracks.insert(mesh.cracks.end(), 2, is_crack ? kCrackFace : std::uint8_t{0});
        }
      }
    }
  }
  return mesh;
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
  for (const float tolerance : {1e-3F, 4e-3F, 16e-3F}) {
    const Mesh after = simplify(before, tolerance);
    CHECK(after.triangles.size() < before.triangles.size() / (tolerance < 2e-3F ? 4 : 8));
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

TEST_CASE("a solid stays closed, with its edges sharp and its crack's face where it was") {
  const Mesh before = make_cube(8), after = simplify(before, 1e-3F);
  CHECK(after.triangles.size() < before.triangles.size() / 16);
  for (const auto& [edge, count] : find_edges(after)) CHECK(count == 2);
  CHECK(find_area(after) == Approx(6.0F));
  float cracked = 0.0F;
  for (std::size_t t = 0; t < after.triangles.size(); ++t) {
    const glm::vec3 a = after.positions[after.triangles[t].x];
    const glm::vec3 area = 0.5F * glm::cross(after.positions[after.triangles[t].y] - a,
                                             after.positions[after.triangles[t].z] - a);
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(glm::dot(after.normals[3 * t + k], glm::normalize(area)) == Approx(1.0F));
    if ((after.cracks[t] & kCrackFace) != 0) cracked += area.x;
  }
  CHECK(cracked == Approx(1.0F));
  const Mesh ball = *make_sphere(3, 0.5F, 64), coarse = simplify(ball, 15e-3F);
  CHECK(coarse.triangles.size() < ball.triangles.size() / 4);
  for (const glm::uvec3& t : coarse.triangles) {
    const glm::vec3 middle = (coarse.positions[t.x] + coarse.positions[t.y] + coarse.positions[t.z]) / 3.0F;
    CHECK(std::abs(glm::length(middle) - 0.5F) < 22.5e-3F);
  }
}

TEST_CASE("a crack's lip is as sharp of what is simplified, however flat it is") {
  Mesh ball = *make_sphere(4, 0.5F, 64);
  ball.normals.clear();
  ball.cracks.assign(ball.triangles.size(), 0);
  for (std::size_t t = 0; t < ball.triangles.size(); ++t)
    if (ball.positions[ball.triangles[t].x].x > 0.45F) ball.cracks[t] = kCrackFace;
  const Mesh after = simplify(ball, 1e-7F);
  REQUIRE(after.triangles.size() == ball.triangles.size());
  const std::vector<glm::vec3> expected = find_corner_normals(ball);
  ball.cracks.clear();
  const std::vector<glm::vec3> smooth = find_corner_normals(ball);
  int sharp = 0;
  for (std::size_t c = 0; c < expected.size(); ++c) {
    CHECK(glm::distance(after.normals[c], expected[c]) < 1e-6F);
    sharp += glm::distance(smooth[c], expected[c]) > 1e-2F ? 1 : 0;
  }
  CHECK(sharp > 50);
}

TEST_CASE("simplifying is the same each time, makes up no position, and leaves what cannot be simpler") {
  const Mesh before = make_arch(20);
  const Mesh one = simplify(before, 3e-3F), two = simplify(before, 3e-3F);
  CHECK(one.triangles == two.triangles);
  CHECK(one.positions.size() < before.positions.size());
  std::size_t next = 0;  // some of those given, in their order
  for (const glm::vec3& p : one.positions) {
    while (next < before.positions.size() && before.positions[next] != p) ++next;
    CHECK(next < before.positions.size());
  }
  CHECK(simplify(make_grid(1), 0.1F).triangles.size() == 2);
  Mesh wrong = make_grid(1);
  wrong.triangles.push_back({0, 1, 99});
  wrong.parts.push_back(0);
  wrong.cracks.push_back(0);
  CHECK_THROWS_AS(simplify(wrong, 1.0F), std::invalid_argument);
}

TEST_CASE("triangles in any disorder come through, and what lies about an edge of three stays") {
  Mesh three = make_grid(8);
  three.parts.clear();
  three.positions.emplace_back(0.5F, 0.5F, 0.5F);
  const std::uint32_t middle = 4 * 9 + 4;
  three.triangles.push_back({middle, middle + 1, 81});
  three.cracks.push_back(0);
  const Mesh after = simplify(three, 0.01F);
  CHECK(after.triangles.size() < three.triangles.size() / 2);
  const auto stays = [&after](glm::vec3 p) {
    return std::find(after.positions.begin(), after.positions.end(), p) != after.positions.end();
  };
  for (const std::uint32_t v : {middle, middle + 1, 81U}) CHECK(stays(three.positions[v]));
  std::uint32_t seed = 1;
  const auto draw = [&seed](std::uint32_t below) {
    seed = seed * 1664525U + 1013904223U;
    return (seed >> 8U) % below;
  };
  for (int round = 0; round < 200; ++round) {
    Mesh soup;
    soup.surface = round % 2 == 0 ? Surface::shell : Surface::solid;
    for (int v = 0; v < 12; ++v) {
      const auto place = [&] { return static_cast<float>(draw(4)) / 4.0F; };
      const float x = place(), y = place(), z = place();
      soup.positions.emplace_back(x, y, z);
    }
    const std::uint32_t count = 4 + draw(30);
    for (std::uint32_t t = 0; t < count; ++t) {
      const std::uint32_t a = draw(12), b = draw(12), c = draw(12);
      soup.triangles.emplace_back(a, b, c);
    }
    const Mesh simple = simplify(soup, 0.5F);
    CHECK(simple.triangles.size() <= soup.triangles.size());
    CHECK_NOTHROW(expand(simple));
  }
}
