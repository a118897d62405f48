// A triangle mesh to draw: a thin shell's mid-surface, or a solid's closed surface. Immutable; uploaded once
// per id.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

namespace shatterbox::render {

enum class Surface : std::uint8_t {
  shell,  // mid-surface: drawn as two faces at +-thickness/2 with a rim along the boundary
  solid,  // closed, wound outwards
};

// Bits of Mesh::cracks.
constexpr std::uint8_t kCrackEdge0 =
    1;  // shell: edge from corner 0 to 1 is a crack; drawn if it is a boundary edge
constexpr std::uint8_t kCrackEdge1 = 2;  // corner 1 to 2
constexpr std::uint8_t kCrackEdge2 = 4;  // corner 2 to 0
constexpr std::uint8_t kCrackFace = 8;   // solid: this triangle is a crack face

struct Mesh {
  std::uint64_t id = 0;  // unique for the life of a Renderer; the same id means the same contents
  Surface surface = Surface::shell;
  float thickness = 0.0F;             // m, shells only; the drawn one
  float crease_angle = 40.0F;         // degrees; triangles that meet at more stay sharp
  std::vector<glm::vec3> positions;   // |V|, body space, m
  std::vector<glm::uvec3> triangles;  // |T|, counter-clockwise seen from outside
  std::vector<std::uint8_t> parts;    // |T| or empty: index into Draw::looks
  std::vector<std::uint8_t> cracks;   // |T| or empty: the bits above
  std::vector<glm::vec3> normals;     // 3|T| by corner, or empty: computed with the crease angle
  std::vector<glm::vec3>
      pattern_positions;  // |V| or empty (= positions): where a painted pattern is looked up;
                          // give pieces their parent's rest positions and the paint stays whole
};

// Analytic bodies, about the origin. Each call's mesh bears the id given.
std::shared_ptr<const Mesh> make_box(std::uint64_t id, glm::vec3 size);
std::shared_ptr<const Mesh> make_sphere(std::uint64_t id, float radius, int segments = 48);
std::shared_ptr<const Mesh> make_capsule(std::uint64_t id, float radius, float length,
                                         int segments = 32);  // along y

}  // namespace shatterbox::render
