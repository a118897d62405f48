// Symbolic part of the multifrontal Cholesky factorisation: which unknowns are eliminated together (a front),
// which others each front touches, and how fronts hang together. Works on nodes (1 or 3 unknowns each) and
// elements; the matrix itself is never assembled. (J. W. H. Liu, The multifrontal method, SIAM Review 34,
// 1992.)
#pragma once

#include <array>
#include <vector>

namespace shatterbox::stress {

/// The unknowns of a problem made of elements: each couples up to six nodes.
struct NodeGraph {
  static constexpr int kElementNodes = 6;
  /// Of an element's first, second, ... node; none where there are fewer nodes. At most 12 in all.
  std::array<int, kElementNodes> element_unknowns{3, 3, 3, 1, 1, 1};
  std::vector<int> node_size;                            // |N|: 1 or 3 unknowns
  std::vector<std::array<int, kElementNodes>> elements;  // node numbers, -1 for none
};

/// A dense lower trapezoid: `pivots` columns that are eliminated, `rows` further unknowns below them.
struct Front {
  int first_pivot = 0;                       // place of the first pivot in the order of elimination
  int pivots = 0;                            // unknowns
  int rows = 0;                              // unknowns below
  int first_row = 0;                         // begin in FrontTree::row_place and row_in_parent
  int parent = -1;                           // number of the front that takes the rest, -1 at a root
  int first_element = 0, element_count = 0;  // in FrontTree::elements
  int first_child = 0, child_count = 0;      // in FrontTree::children
  int subtree_first = 0;                     // the fronts of its subtree are [subtree_first, itself]
  double work = 0.0;                         // multiplications, of the whole subtree
};

struct FrontTree {
  int unknowns = 0;
  std::array<int, NodeGraph::kElementNodes> element_unknowns{};  // of the graph
  std::vector<Front> fronts;                                     // children before parents
  std::vector<int> children;                                     // front numbers
  std::vector<int> row_place;  // place in the order of elimination of each row below the pivots, ascending
  std::vector<int> row_in_parent;  // the same row's place in the parent front: pivots first, then rows
  std::vector<int> node_place;     // |N|: place of a node's first unknown, -1 if it is in no element
  std::vector<int> elements;       // element numbers by front
  std::vector<std::array<int, NodeGraph::kElementNodes>>
      element_local;     // |elements|: place of each node in that front
  double entries = 0.0;  // of the factor

  double bytes() const;  // of memory
};

/// Fronts for a given order of the nodes (all that occur in elements; others may be left out).
FrontTree build_front_tree(const NodeGraph& graph, const std::vector<int>& order);

/// The highest fronts whose subtrees are each at most 1 / `share` of the work, ascending: roots of disjoint
/// subtrees that threads may take.
std::vector<int> small_subtrees(const FrontTree& tree, int share);

}  // namespace shatterbox::stress
