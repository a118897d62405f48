// Cuts a solid's complex along surfaces that are the zeros of fields, linear in each element: any number of
// them through one element, continuous over faces. What is decided about a vertex or an edge is decided once,
// for all cells about it.
#pragma once

#include <vector>

#include "engine/core/disjoint_sets.h"
#include "engine/core/vec.h"
#include "engine/geometry/solid_complex.h"

namespace shatterbox::geometry {

/// One surface: where a field is zero, in the cells it is active in.
struct SolidCut {
  std::vector<double> node_values;    // |nodes of the element mesh|, any unit; read at active elements only
  std::vector<double> vertex_values;  // |vertices of the complex|, or empty: then the field is linear in each
                                      // element, as given by its nodes
  std::vector<int> cells;  // active ones: the others are not cut, and hold together what touches them
  FacetKind kind = FacetKind::crack;  // or grain
  int id = 0;                         // tag of the new facets
  std::int16_t plane = -1;            // and the number of the plane in which they lie
};

class SolidCutter {
 public:
  /// `snap`: a vertex nearer to the surface than this share of the field's change over its edges is on it, so
  /// that no sliver is narrower. At least kLeastSnap, at most a quarter.
  explicit SolidCutter(SolidComplex& complex, double snap = kUsualSnap);

  static constexpr double kUsualSnap = 1e-3;
  static constexpr double kLeastSnap = 1e-9;

  /// Divides the active cells into their parts on both sides. A cell keeps its number for its first part;
  /// others get new ones. Faces that lie in the surface between two active cells become facets of its kind.
  void cut(const SolidCut& cut);

  /// Of the last cut: 1 or -1 for cells that were active or come from such, by the sign of the field; else 0.
  int side_of(int cell) const;

  /// The cells of an element, the oldest first.
  std::vector<int> cells_of(int element) const;

  const SolidComplex& complex() const { return complex_; }

 private:
  struct Mark {
    int stamp = 0;
    int sign = 0;
    double value = 0.0;
  };
  struct EdgeMark {
    int stamp = 0;
    int net = 0;                // how often facets of the positive side run along it, less those against it
    int plus = -1, minus = -1;  // local facets on both sides
  };
  struct CapLoop {
    std::vector<int> sides;
    std::vector<Vec2> points;
    int group = -1;
  };

  void grow();
  void measure_reach(const SolidCut& cut);
  int sign_of(int vertex, const SolidCut& cut);
  void split_edges(int facet, const SolidCut& cut, bool is_border);
  void split_facet(int facet);
  void set_facet_sign(int facet);
  void divide_cell(int cell, const SolidCut& cut);
  bool collect_facets(int cell);
  int sign_of_facet_in_surface(int cell, int facet_side) const;
  void collect_loops();
  void group_loops();
  void splice_touching_loops(std::vector<CapLoop*>& loops) const;
  void cap(std::vector<CapLoop*> loops, const SolidCut& cut, std::vector<int>& caps);
  int new_edge(int from, int to);
  int add_facet(const std::vector<int>& sides, const SolidCut& cut);
  void join_cavities(core::DisjointSets& parts, const std::vector<std::vector<int>>& caps) const;
  void assign_parts(int cell, const SolidCut& cut);
  void open_facets_in_surface(const SolidCut& cut);

  SolidComplex& complex_;
  double snap_;
  std::vector<int> first_cell_, next_cell_;  // per element; per cell
  int stamp_ = 0, cell_stamp_ = 0;
  std::vector<Mark> vertex_marks_, facet_marks_, cell_marks_;
  std::vector<EdgeMark> edge_marks_;
  std::vector<int> element_stamp_, node_stamp_;
  std::vector<double> reach_;  // per node: greatest change of the field along its edges

  // Of one cell while it is divided.
  std::vector<int> local_facets_, local_signs_, loop_sides_;
  std::vector<CapLoop> loops_;
  Vec3 axis_ = Vec3::Zero();
  int group_count_ = 0;
  std::vector<int> touched_, in_surface_, scratch_;
};

/// Moves node values away from zero, to at least `share` of the field's greatest change over an edge of the
/// elements of `cells` at the node: then no cut passes through a node, and cut elements keep their shape.
/// Zero goes to the positive side.
void keep_off_nodes(const SolidComplex& complex, double share, SolidCut& cut);

}  // namespace shatterbox::geometry
