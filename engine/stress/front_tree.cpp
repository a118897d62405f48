#include "engine/stress/front_tree.h"

#include <algorithm>

#include "engine/core/buckets.h"
#include "engine/core/bytes.h"
#include "engine/core/index.h"
#include "engine/stress/supernodes.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

class TreeBuilder {
 public:
  TreeBuilder(const NodeGraph& graph, const EliminationOrder& elimination)
      : graph_(graph),
        placed_(elimination.elements),
        size_(elimination.size),
        number_(elimination.number),
        supernodes_(find_merged_supernodes(elimination)) {}

  FrontTree build() {
    number_fronts();
    for (Size f = 0; f < tree_.fronts.size(); ++f) add_rows(static_cast<int>(f));
    link_children();
    const core::Buckets by_front(tree_.fronts.size(), placed_.size(), [&](Size e) {
      return placed_[e][0] < 0 ? -1 : front_of_node_[at(placed_[e][0])];
    });
    tree_.elements = by_front.items;
    tree_.element_local.resize(by_front.items.size());
    local_.assign(size_.size(), -1);
    for (Size f = 0; f < tree_.fronts.size(); ++f) set_local_places(static_cast<int>(f), by_front);
    return std::move(tree_);
  }

  /// Place of a node's first unknown, by its number in the postorder.
  const std::vector<int>& place() const { return place_; }

 private:
  void number_fronts() {
    front_of_supernode_.assign(supernodes_.size(), -1);
    for (Size s = 0; s < supernodes_.size(); ++s)
      if (supernodes_[s].merged_into < 0) {
        front_of_supernode_[s] = static_cast<int>(top_.size());
        top_.push_back(static_cast<int>(s));
      }
    const core::Buckets members(top_.size(), supernodes_.size(),
                                [&](Size s) { return front_of(static_cast<int>(s)); });
    tree_.fronts.resize(top_.size());
    place_.assign(size_.size(), -1);
    front_of_node_.assign(size_.size(), -1);
    nodes_of_front_first_.push_back(0);
    for (Size f = 0; f < top_.size(); ++f) {
      Front& front = tree_.fronts[f];
      front.first_pivot = tree_.unknowns;
      for (int m = members.first[f]; m < members.first[f + 1]; ++m) {
        const Supernode& s = supernodes_[at(members.items[at(m)])];
        for (int node = s.first; node <= s.last; ++node) {
          place_[at(node)] = tree_.unknowns;
          front_of_node_[at(node)] = static_cast<int>(f);
          tree_.unknowns += size_[at(node)];
          pivot_nodes_.push_back(node);
        }
      }
      nodes_of_front_first_.push_back(static_cast<int>(pivot_nodes_.size()));
      front.pivots = tree_.unknowns - front.first_pivot;
      const int parent = supernodes_[at(top_[f])].parent;
      front.parent = parent < 0 ? -1 : front_of(parent);
    }
  }

  int front_of(int supernode) const {
    const int merged = supernodes_[at(supernode)].merged_into;
    return front_of_supernode_[at(merged < 0 ? supernode : merged)];
  }

  void add_rows(int f) {
    Front& front = tree_.fronts[at(f)];
    std::vector<int>& below = supernodes_[at(top_[at(f)])].below;
    std::sort(below.begin(), below.end(), [&](int a, int b) { return place_[at(a)] < place_[at(b)]; });
    front.first_row = static_cast<int>(tree_.row_place.size());
    for (const int node : below)
      for (int i = 0; i < size_[at(node)]; ++i) tree_.row_place.push_back(place_[at(node)] + i);
    front.rows = static_cast<int>(tree_.row_place.size()) - front.first_row;
    tree_.entries += trapezoid(front.pivots, front.rows);
    const double k = front.pivots, r = front.rows;
    front.work += k * k * k / 6.0 + 0.5 * k * k * r + 0.5 * k * r * r + 0.5 * r * r;
    if (front.parent >= 0) tree_.fronts[at(front.parent)].work += front.work;
  }

  void link_children() {
    const core::Buckets children(tree_.fronts.size(), tree_.fronts.size(),
                                 [&](Size f) { return tree_.fronts[f].parent; });
    tree_.children = children.items;
    for (Size f = 0; f < tree_.fronts.size(); ++f) {
      Front& front = tree_.fronts[f];
      front.first_child = children.first[f];
      front.child_count = children.first[f + 1] - children.first[f];
      front.subtree_first = static_cast<int>(f);
      if (front.child_count > 0)
        front.subtree_first = tree_.fronts[at(children.items[at(front.first_child)])].subtree_first;
    }
  }

  /// Where the nodes of the front's own elements, and its children's rows, are in it.
  void set_local_places(int f, const core::Buckets& by_front) {
    Front& front = tree_.fronts[at(f)];
    for (int i = nodes_of_front_first_[at(f)]; i < nodes_of_front_first_[at(f) + 1]; ++i)
      local_[at(pivot_nodes_[at(i)])] = place_[at(pivot_nodes_[at(i)])] - front.first_pivot;
    int next = front.pivots;
    for (const int node : supernodes_[at(top_[at(f)])].below) {
      local_[at(node)] = next;
      next += size_[at(node)];
    }
    front.first_element = by_front.first[at(f)];
    front.element_count = by_front.first[at(f) + 1] - front.first_element;
    for (int e = front.first_element; e < front.first_element + front.element_count; ++e) {
      const ElementNodes& nodes = graph_.elements[at(tree_.elements[at(e)])];
      for (Size i = 0; i < nodes.size(); ++i)
        tree_.element_local[at(e)][i] = nodes[i] < 0 ? -1 : local_[at(number_[at(nodes[i])])];
    }
    tree_.row_in_parent.resize(tree_.row_place.size());
    for (int c = front.first_child; c < front.first_child + front.child_count; ++c) {
      const int child_number = tree_.children[at(c)];
      int row = tree_.fronts[at(child_number)].first_row;
      for (const int node : supernodes_[at(top_[at(child_number)])].below)
        for (int i = 0; i < size_[at(node)]; ++i) tree_.row_in_parent[at(row++)] = local_[at(node)] + i;
    }
  }

  const NodeGraph& graph_;
  const std::vector<ElementNodes>& placed_;
  const std::vector<int>& size_;
  const std::vector<int>& number_;  // of each node of the graph, in the postorder
  std::vector<Supernode> supernodes_;
  std::vector<int> top_, front_of_supernode_, front_of_node_, place_, local_;
  std::vector<int> pivot_nodes_, nodes_of_front_first_;
  FrontTree tree_;
};

}  // namespace

FrontTree build_front_tree(const NodeGraph& graph, const std::vector<int>& order) {
  const EliminationOrder elimination = order_by_elimination(graph, order);
  TreeBuilder builder(graph, elimination);
  FrontTree tree = builder.build();
  tree.element_unknowns = graph.element_unknowns;
  tree.node_place.assign(elimination.number.size(), -1);
  for (Size node = 0; node < elimination.number.size(); ++node)
    if (const int number = elimination.number[node]; number >= 0)
      tree.node_place[node] = builder.place()[at(number)];
  return tree;
}

double FrontTree::bytes() const {
  return core::bytes_in(fronts, children, row_place, row_in_parent, node_place, elements, element_local);
}

std::vector<int> small_subtrees(const FrontTree& tree, int share) {
  std::vector<int> roots;
  double total = 0.0;
  for (const Front& front : tree.fronts)
    if (front.parent < 0) total += front.work;
  const auto is_small = [&](const Front& front) { return front.work <= total / share; };
  for (int f = 0; f < static_cast<int>(tree.fronts.size()); ++f) {
    const Front& front = tree.fronts[at(f)];
    if (is_small(front) && (front.parent < 0 || !is_small(tree.fronts[at(front.parent)]))) roots.push_back(f);
  }
  return roots;
}

}  // namespace shatterbox::stress
