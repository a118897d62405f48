#include "engine/stress/front_tree.h"

#include <algorithm>
#include <numeric>

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using ElementNodes = std::array<int, NodeGraph::kElementNodes>;

Size at(int i) {
  return static_cast<Size>(i);
}

/// Groups `count` items by key in [0, keys): items of key k are [first[k], first[k + 1]) of `items`,
/// ascending.
struct Buckets {
  std::vector<int> first, items;

  template <class Key>
  Buckets(Size keys, Size count, const Key& key) : first(keys + 1, 0) {
    for (Size i = 0; i < count; ++i)
      if (const int k = key(i); k >= 0) ++first[at(k) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    items.resize(at(first.back()));
    std::vector<int> fill(first.begin(), first.end() - 1);
    for (Size i = 0; i < count; ++i)
      if (const int k = key(i); k >= 0) items[at(fill[at(k)]++)] = static_cast<int>(i);
  }
};

/// Elements by places in the order of elimination, ascending; absent nodes at the end as -1.
std::vector<ElementNodes> place_elements(const NodeGraph& graph, const std::vector<int>& place) {
  std::vector<ElementNodes> placed(graph.elements.size());
  for (Size e = 0; e < placed.size(); ++e) {
    ElementNodes& nodes = placed[e];
    nodes.fill(-1);
    Size count = 0;
    for (const int node : graph.elements[e]) {
      if (node < 0) continue;
      Size k = count++;
      for (; k > 0 && nodes[k - 1] > place[at(node)]; --k) nodes[k] = nodes[k - 1];
      nodes[k] = place[at(node)];
    }
  }
  return placed;
}

/// Elimination tree (Liu's algorithm): an element's nodes are a clique, so links between successive ones are
/// enough.
std::vector<int> build_elimination_tree(Size count, const std::vector<ElementNodes>& placed) {
  constexpr Size kLinks = NodeGraph::kElementNodes - 1;
  const Buckets links(count, placed.size() * kLinks,
                      [&](Size i) { return placed[i / kLinks][i % kLinks + 1]; });
  std::vector<int> parent(count, -1);
  std::vector<int> ancestor(count, -1);
  for (Size j = 0; j < count; ++j)
    for (int l = links.first[j]; l < links.first[j + 1]; ++l) {
      const Size link = at(links.items[at(l)]);
      int i = placed[link / kLinks][link % kLinks];
      while (i != -1 && i != static_cast<int>(j)) {
        const int next = ancestor[at(i)];
        ancestor[at(i)] = static_cast<int>(j);
        if (next == -1) parent[at(i)] = static_cast<int>(j);
        i = next;
      }
    }
  return parent;
}

/// Number of each node in a postorder of the forest.
std::vector<int> postorder(const std::vector<int>& parent) {
  const Size count = parent.size();
  std::vector<int> child(count, -1), sibling(count, -1), number(count, -1), stack;
  int root = -1;
  for (Size i = count; i-- > 0;) {
    int& head = parent[i] < 0 ? root : child[at(parent[i])];
    sibling[i] = head;
    head = static_cast<int>(i);
  }
  int next = 0;
  for (; root >= 0; root = sibling[at(root)]) {
    stack.push_back(root);
    while (!stack.empty()) {
      const int top = stack.back();
      if (int& first = child[at(top)]; first >= 0) {
        stack.push_back(first);
        first = sibling[at(first)];
      } else {
        number[at(top)] = next++;
        stack.pop_back();
      }
    }
  }
  return number;
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

std::vector<Supernode> find_supernodes(const std::vector<ElementNodes>& placed,
                                       const std::vector<int>& parent, const std::vector<int>& size) {
  const Size count = parent.size();
  const Buckets starting(count, placed.size(), [&](Size e) { return placed[e][0]; });
  std::vector<int> child_count(count, 0), mark(count, -1), owner(count, -1);
  for (const int p : parent)
    if (p >= 0) ++child_count[at(p)];
  const Buckets children(count, count, [&](Size i) { return parent[i]; });

  std::vector<Supernode> supernodes;
  const auto finish = [&] {
    if (supernodes.empty()) return;
    Supernode& s = supernodes.back();
    std::erase_if(s.below, [&](int node) { return node <= s.last; });
    for (const int node : s.below) s.rows += size[at(node)];
  };
  for (int j = 0; j < static_cast<int>(count); ++j) {
    const int stamp = static_cast<int>(supernodes.size()) - 1;
    bool continues = j > 0 && parent[at(j) - 1] == j && child_count[at(j)] == 1;
    for (int k = starting.first[at(j)]; continues && k < starting.first[at(j) + 1]; ++k)
      for (const int node : placed[at(starting.items[at(k)])])
        continues = continues && (node < 0 || mark[at(node)] == stamp);
    if (!continues) {
      finish();
      supernodes.emplace_back();
      Supernode& s = supernodes.back();
      s.first = j;
      const int fresh = stamp + 1;
      mark[at(j)] = fresh;
      const auto add = [&](int node) {
        if (node <= j || mark[at(node)] == fresh) return;
        mark[at(node)] = fresh;
        s.below.push_back(node);
      };
      for (int k = starting.first[at(j)]; k < starting.first[at(j) + 1]; ++k)
        for (const int node : placed[at(starting.items[at(k)])]) add(node);
      for (int k = children.first[at(j)]; k < children.first[at(j) + 1]; ++k)
        for (const int node : supernodes[at(owner[at(children.items[at(k)])])].below) add(node);
    }
    Supernode& s = supernodes.back();
    s.last = j;
    s.pivots += size[at(j)];
    owner[at(j)] = static_cast<int>(supernodes.size()) - 1;
  }
  finish();
  for (Supernode& s : supernodes)
    if (parent[at(s.last)] >= 0) s.parent = owner[at(parent[at(s.last)])];
  return supernodes;
}

double trapezoid(double pivots, double rows) {
  return 0.5 * pivots * (pivots + 1.0) + pivots * rows;
}

/// Joins small supernodes to their parents: some stored zeros for fewer, larger dense blocks.
void merge_supernodes(std::vector<Supernode>& supernodes) {
  for (Size i = 0; i < supernodes.size(); ++i) {
    Supernode& s = supernodes[i];
    if (s.parent < 0) continue;
    Supernode& p = supernodes[at(s.parent)];
    const double joined = trapezoid(s.pivots + p.pivots, p.rows);
    const double zeros =
        joined - trapezoid(s.pivots, s.rows) - trapezoid(p.pivots, p.rows) + s.zeros + p.zeros;
    const int pivots = s.pivots + p.pivots;
    const double allowed = pivots <= 16 ? 0.2 : pivots <= 32 ? 0.08 : pivots <= 64 ? 0.04 : 0.015;
    if (zeros > allowed * joined) continue;
    s.merged_into = s.parent;
    p.pivots = pivots;
    p.zeros = zeros;
  }
  // What the parent pointer names may itself have been merged; parents come later, so resolve from the end.
  for (Size i = supernodes.size(); i-- > 0;) {
    Supernode& s = supernodes[i];
    if (s.parent >= 0 && supernodes[at(s.parent)].merged_into >= 0)
      s.parent = supernodes[at(s.parent)].merged_into;
    if (s.merged_into >= 0) s.merged_into = s.parent;
  }
}

class TreeBuilder {
 public:
  TreeBuilder(const NodeGraph& graph, std::vector<ElementNodes> placed, std::vector<int> size,
              std::vector<Supernode> supernodes)
      : graph_(graph),
        placed_(std::move(placed)),
        size_(std::move(size)),
        supernodes_(std::move(supernodes)) {}

  FrontTree build() {
    number_fronts();
    for (Size f = 0; f < tree_.fronts.size(); ++f) add_rows(static_cast<int>(f));
    link_children();
    const Buckets by_front(tree_.fronts.size(), placed_.size(), [&](Size e) {
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

  void set_node_numbers(std::vector<int> number) { number_ = std::move(number); }

 private:
  void number_fronts() {
    front_of_supernode_.assign(supernodes_.size(), -1);
    for (Size s = 0; s < supernodes_.size(); ++s)
      if (supernodes_[s].merged_into < 0) {
        front_of_supernode_[s] = static_cast<int>(top_.size());
        top_.push_back(static_cast<int>(s));
      }
    const Buckets members(top_.size(), supernodes_.size(),
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
    const Buckets children(tree_.fronts.size(), tree_.fronts.size(),
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
  void set_local_places(int f, const Buckets& by_front) {
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
  std::vector<ElementNodes> placed_;
  std::vector<int> size_;
  std::vector<Supernode> supernodes_;
  std::vector<int> number_;  // of each node of the graph, in the postorder
  std::vector<int> top_, front_of_supernode_, front_of_node_, place_, local_;
  std::vector<int> pivot_nodes_, nodes_of_front_first_;
  FrontTree tree_;
};

}  // namespace

FrontTree build_front_tree(const NodeGraph& graph, const std::vector<int>& order) {
  std::vector<char> is_used(graph.node_size.size(), 0);
  for (const ElementNodes& nodes : graph.elements)
    for (const int node : nodes)
      if (node >= 0) is_used[at(node)] = 1;
  std::vector<int> number(graph.node_size.size(), -1);
  int count = 0;
  for (const int node : order)
    if (is_used[at(node)]) number[at(node)] = count++;

  std::vector<ElementNodes> placed = place_elements(graph, number);
  std::vector<int> parent = build_elimination_tree(at(count), placed);
  const std::vector<int> post = postorder(parent);
  std::vector<int> post_parent(parent.size());
  for (Size i = 0; i < parent.size(); ++i)
    post_parent[at(post[i])] = parent[i] < 0 ? -1 : post[at(parent[i])];
  for (ElementNodes& nodes : placed)
    for (int& node : nodes)
      if (node >= 0) node = post[at(node)];  // ascending still: a clique is a path in the tree
  std::vector<int> size(at(count));
  for (Size node = 0; node < number.size(); ++node)
    if (number[node] >= 0) {
      number[node] = post[at(number[node])];
      size[at(number[node])] = graph.node_size[node];
    }

  std::vector<Supernode> supernodes = find_supernodes(placed, post_parent, size);
  merge_supernodes(supernodes);
  TreeBuilder builder(graph, std::move(placed), std::move(size), std::move(supernodes));
  builder.set_node_numbers(number);
  FrontTree tree = builder.build();
  tree.node_place.assign(number.size(), -1);
  for (Size node = 0; node < number.size(); ++node)
    if (number[node] >= 0) tree.node_place[node] = builder.place()[at(number[node])];
  return tree;
}

}  // namespace shatterbox::stress
