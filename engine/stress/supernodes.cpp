#include "engine/stress/supernodes.h"

#include "engine/core/buckets.h"
#include "engine/core/index.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

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
  const core::Buckets links(count, placed.size() * kLinks,
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

std::vector<Supernode> find_supernodes(const std::vector<ElementNodes>& placed,
                                       const std::vector<int>& parent, const std::vector<int>& size) {
  const Size count = parent.size();
  const core::Buckets starting(count, placed.size(), [&](Size e) { return placed[e][0]; });
  std::vector<int> child_count(count, 0), mark(count, -1), owner(count, -1);
  for (const int p : parent)
    if (p >= 0) ++child_count[at(p)];
  const core::Buckets children(count, count, [&](Size i) { return parent[i]; });

  std::vector<Supernode> supernodes;
  std::vector<int> below;  // of the last one, its own nodes among them
  const auto finish = [&] {
    if (supernodes.empty()) return;
    Supernode& s = supernodes.back();
    std::erase_if(below, [&](int node) { return node <= s.last; });
    for (const int node : below) s.rows += size[at(node)];
    s.below.assign(below.begin(), below.end());
    below.clear();
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
        below.push_back(node);
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

}  // namespace

EliminationOrder order_by_elimination(const NodeGraph& graph, const std::vector<int>& order) {
  std::vector<char> is_used(graph.node_size.size(), 0);
  for (const ElementNodes& nodes : graph.elements)
    for (const int node : nodes)
      if (node >= 0) is_used[at(node)] = 1;
  EliminationOrder result;
  result.number.assign(graph.node_size.size(), -1);
  int count = 0;
  for (const int node : order)
    if (is_used[at(node)]) result.number[at(node)] = count++;

  result.elements = place_elements(graph, result.number);
  const std::vector<int> parent = build_elimination_tree(at(count), result.elements);
  const std::vector<int> post = postorder(parent);
  result.parent.resize(parent.size());
  for (Size i = 0; i < parent.size(); ++i)
    result.parent[at(post[i])] = parent[i] < 0 ? -1 : post[at(parent[i])];
  for (ElementNodes& nodes : result.elements)
    for (int& node : nodes)
      if (node >= 0) node = post[at(node)];  // ascending still: a clique is a path in the tree
  result.size.resize(at(count));
  for (Size node = 0; node < result.number.size(); ++node)
    if (int& number = result.number[node]; number >= 0) {
      number = post[at(number)];
      result.size[at(number)] = graph.node_size[node];
    }
  return result;
}

std::vector<Supernode> find_merged_supernodes(const EliminationOrder& elimination) {
  std::vector<Supernode> supernodes =
      find_supernodes(elimination.elements, elimination.parent, elimination.size);
  merge_supernodes(supernodes);
  return supernodes;
}

}  // namespace shatterbox::stress
