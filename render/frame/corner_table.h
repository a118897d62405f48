// Who is beside whom in a triangle mesh, for work that changes it: each corner knows the corner across its
// triangle's far edge, so that one walks about a vertex without a search (Rossignac 2001).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "render/frame/mesh.h"

namespace shatterbox::render {

// Corners are numbered 4 * triangle + 0, 1 or 2: the last two bits tell which it is without a division.
class CornerTable {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffU, kSeveral = 0xfffffffeU;
  static std::uint32_t next(std::uint32_t c) { return (c & 3U) == 2 ? c - 2 : c + 1; }
  static std::uint32_t previous(std::uint32_t c) { return (c & 3U) == 0 ? c + 2 : c - 1; }
  static std::uint32_t triangle(std::uint32_t c) { return c / 4; }

  // The corners at a vertex that is not odd, counter-clockwise; from the outline on, if it lies there.
  struct Fan {
    static constexpr std::size_t kMost = 24;
    std::uint32_t corners[kMost];
    std::uint32_t around[kMost + 1];  // neighbours: corner i's triangle lies between i and i + 1
    std::size_t count = 0;            // of triangles
    bool is_outline = false;
    // On the outline there is a neighbour more than triangles.
    std::span<const std::uint32_t> neighbours() const { return {around, count + (is_outline ? 1U : 0U)}; }
  };

  void read(const Mesh& mesh);  // keeps the memory it had

  std::uint32_t vertex(std::uint32_t c) const { return vertex_[c]; }
  // Across the triangle's far edge: kNone at the outline, kSeveral where it is not one corner.
  std::uint32_t opposite(std::uint32_t c) const { return opposite_[c]; }
  std::uint32_t corner_of(std::uint32_t v) const {
    return corner_of_[v];
  }  // one of them; kNone if it has none
  bool is_gone(std::uint32_t triangle) const { return vertex_[4 * std::size_t{triangle}] == kNone; }
  // The triangles about it are neither one disc nor half of one, are too many, or their senses differ: no
  // walk. To be asked before anything collapses.
  bool find_odd(std::uint32_t v, Fan& fan);                       // otherwise the fan is v's
  bool is_odd(std::uint32_t v) const { return is_odd_[v] != 0; }  // as found

  // False if they are more than there is room for.
  bool walk(std::uint32_t v, Fan& fan) const;

  // v, whose fan it is, becomes its neighbour i: the triangles of their edge go.
  void collapse(const Fan& fan, std::uint32_t v, std::size_t i);

 private:
  void match_edges();
  void pair_or_mark(std::uint32_t c, std::uint32_t earlier);
  void take_away(std::uint32_t corner_v, std::uint32_t corner_u);

  std::vector<std::uint32_t> vertex_, opposite_, corner_of_;
  std::vector<std::uint32_t> counts_;  // of each vertex's corners in the mesh read
  std::vector<char> is_odd_;
  // While it is read: edges by their lesser vertex, as chains of the corners across from them.
  struct Link {
    std::uint32_t greater, older;
  };
  std::vector<std::uint32_t> newest_;
  std::vector<Link> links_;
};

}  // namespace shatterbox::render
