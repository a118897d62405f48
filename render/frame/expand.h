// From a mesh as given to the triangles as drawn: a shell gets its two faces and its rim, corners get their
// normals.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render/frame/mesh.h"

namespace shatterbox::render {

enum class Face : std::uint8_t { outside = 0, inside = 1, crack = 2 };

// As the vertex buffer holds it.
struct DrawnVertex {
  glm::vec3 position;                  // body space, m
  std::array<std::int16_t, 4> normal;  // body space, unit times 32767
  glm::vec3 pattern;                   // pattern space, m
  std::uint32_t source;                // index into Mesh::positions
  std::uint32_t face_part;             // Face in bits 0-7, part in bits 8-15
};

struct IndexRange {
  std::uint32_t first = 0, count = 0;
};

struct DrawnMesh {
  std::vector<DrawnVertex> vertices;
  std::vector<std::uint32_t> indices;
  IndexRange outer, inner, rim;  // of indices, in this order; solids have outer only
  IndexRange rim_lines;  // after them, pairs: boundary edges of the outer face, so that thin rims do not fray
  glm::vec3 centre{0.0F};  // of the bounding box, and the radius about it
  float radius = 0.0F;
  glm::vec3 box_least{0.0F}, box_most{0.0F};
};

// The triangle's unit normal, and its say at each corner: the area over the squares of the two edges there
// (Max 1999), which gives a sphere's normal where all corners lie on one.
struct FaceNormals {
  std::vector<glm::vec3> unit;  // |T|; zero if degenerate
  std::vector<float> weight;    // 3|T|, 1/m2
};
FaceNormals find_face_normals(const Mesh& mesh);

// Of the angle by which two triangles meet, with these unit normals; -1 across the lip of a solid's crack,
// which is sharp at any angle.
float crease_cosine(const Mesh& mesh, const std::vector<glm::vec3>& units, std::size_t a, std::size_t b);

// Corner normals (3|T|, unit): the weighted mean over the triangles about a vertex that meet this one at less
// than the crease angle; a crack's lip is sharp at any angle. Degenerate triangles get +y and weigh nothing.
std::vector<glm::vec3> find_corner_normals(const Mesh& mesh);

// Throws std::invalid_argument when an index is out of range or an array has a length its comment does not
// allow.
void check(const Mesh& mesh);

// Throws as check() does.
DrawnMesh expand(const Mesh& mesh);

}  // namespace shatterbox::render
