// A surface with fewer triangles that looks the same from where it is seen: edges are collapsed while it
// stays within a tolerance (Garland, Heckbert 1997).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "render/frame/corner_table.h"
#include "render/frame/mesh.h"

namespace shatterbox::render {

// Keeps its memory from mesh to mesh: for many of them.
class Simplifier {
 public:
  // Some of the positions, in their order, and fewer triangles; normals (3|T|) are those of the mesh given,
  // computed there if it has none. Outline, creases, borders between parts and of cracks stay where they are
  // within `tolerance` (m). The same mesh gives the same triangles. What lies about edges of more than two
  // triangles stays. Throws std::invalid_argument as check() does.
  Mesh simplify(const Mesh& mesh, float tolerance);

 private:
  // Sum of squared distances to planes, as a form in the distance from the vertex whose it is:
  // x A x + 2 b x + c.
  struct Quadric {
    std::array<double, 6> a{};  // xx xy xz yy yz zz
    glm::dvec3 b{0.0};
    double c = 0.0, planes = 0.0;
    void add_plane(glm::dvec3 normal);  // through the vertex
    glm::dvec3 times(glm::dvec3 x) const;
    double mean_at(glm::dvec3 x) const;
    void add(const Quadric& other, glm::dvec3 from_other);
  };
  enum class Place : std::uint8_t { inside, on_line, stays };  // on a line: outline, crease, or border
  using Fan = CornerTable::Fan;

  void read(const Mesh& mesh);
  void find_faces();
  bool find_places();
  bool find_normals(std::uint32_t v, const Fan& fan);
  void weigh(std::uint32_t v, const Fan& fan, std::size_t step);
  int take_round();
  Mesh result() const;

  glm::vec3 position(std::uint32_t v) const { return mesh_->positions[v]; }
  glm::vec3 normal(std::uint32_t c) const { return (*normals_)[normal_of_[c]]; }
  bool is_cracked(std::uint32_t c) const;
  int group(std::uint32_t c) const;
  bool is_line(const Fan& fan, std::size_t i) const;
  bool collapse(std::uint32_t v);
  bool find_ends(Fan& fan, std::size_t& middle) const;
  bool may_move(const Fan& fan, std::uint32_t v, std::size_t i, std::size_t middle);
  bool is_link_simple(const Fan& fan, std::uint32_t v, std::size_t i);
  bool keeps_shape(const Fan& fan, std::uint32_t v, std::uint32_t u) const;
  bool keeps_normals(const Fan& fan, std::size_t i, std::size_t middle) const;
  void move(const Fan& fan, std::uint32_t v, std::size_t i, std::size_t middle);
  void hand_on_crack(std::uint32_t at_u, std::uint32_t edge_u);
  std::uint32_t corner_beside(const Fan& fan, std::size_t i, bool is_after) const;

  const Mesh* mesh_ = nullptr;
  double tolerance_squared_ = 0.0;
  CornerTable corners_;
  const std::vector<glm::vec3>* normals_ = nullptr;
  std::vector<glm::vec3> own_normals_;  // of the vertices, then of corners at creases
  std::vector<glm::vec3> units_;        // of the triangles given
  std::vector<float> weights_;          // of a triangle's normal at its corners
  float crease_cosine_ = 0.0F;
  bool has_groups_ = false;               // more than one
  std::vector<std::uint32_t> normal_of_;  // by corner, among those given
  std::vector<std::uint8_t> cracks_;
  std::vector<Quadric> quadrics_;
  std::vector<Place> places_;
  enum class State : std::uint8_t { ready, waits, settled };  // until the next round; until something changes
  std::vector<State> states_;
  std::vector<std::uint32_t> left_;    // vertices that may still collapse
  std::vector<std::uint32_t> stamps_;  // equal to stamp_: a neighbour of the vertex in question
  std::uint32_t stamp_ = 0;
};

// One mesh.
Mesh simplify(const Mesh& mesh, float tolerance);

}  // namespace shatterbox::render
