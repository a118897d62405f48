// Which unknowns of an elimination belong together: the elimination tree of cliques of nodes, its postorder,
// and supernodes, successive nodes with the same structure below them. The first half of building a
// FrontTree.
#pragma once

#include <vector>

#include "engine/stress/front_tree.h"

namespace shatterbox::stress {

using ElementNodes = std::array<int, NodeGraph::kElementNodes>;

/// Entries of a dense lower trapezoid of so many columns and rows below them.
inline double trapezoid(double pivots, double rows) {
  return 0.5 * pivots * (pivots + 1.0) + pivots * rows;
}

/// Successive nodes with the same structure below them.
struct Supernode {
  int first = 0, last = 0;   // nodes, by postorder
  std::vector<int> below;    // nodes, unordered
  int pivots = 0, rows = 0;  // unknowns
  int parent = -1;           // supernode
  int merged_into = -1;
  double zeros = 0.0;  // entries that merging stores in vain
};

/// All nodes of a graph by their place in a postorder of the elimination tree of `order`.
struct EliminationOrder {
  std::vector<int> number;  // |N| of the graph: place, -1 for nodes in no element
  std::vector<int> size;    // |places|: unknowns
  std::vector<int> parent;  // |places|: in the elimination tree, -1 at a root
  std::vector<ElementNodes>
      elements;  // places of each element's nodes, ascending; absent ones at the end as -1
};
EliminationOrder order_by_elimination(const NodeGraph& graph, const std::vector<int>& order);

/// Supernodes, small ones joined to their parents: some stored zeros for fewer, larger dense blocks.
std::vector<Supernode> find_merged_supernodes(const EliminationOrder& elimination);

}  // namespace shatterbox::stress
