// Solves with a factor so great that threads share them, against the matrix itself.
#include "engine/stress/front_solve.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/core/random.h"
#include "engine/geometry/box_tets.h"
#include "engine/geometry/tet_mesh.h"
#include "engine/stress/elimination_order.h"

namespace shatterbox::stress {
namespace {

using core::at;

// One unknown a node of a box; elements draw their corners together, more or less.
struct Network {
  NodeGraph graph;
  FrontTree tree;
  std::vector<double> springs;  // per element
  std::vector<std::array<double, 10>> entries;

  explicit Network(double cell) {
    auto made = geometry::make_box_tets(Vec3(0.5, 0.5, 0.5), cell);
    REQUIRE(made.ok());
    geometry::SolidElements elements;
    elements.mesh = std::move(made.value());
    graph.element_unknowns = {1, 1, 1, 1, 0, 0};
    graph.node_size.assign(elements.mesh.positions.size(), 1);
    core::Random random(3);
    for (const geometry::Tetrahedron& t : elements.mesh.tetrahedra) {
      graph.elements.push_back({t[0], t[1], t[2], t[3], -1, -1});
      springs.push_back(random.uniform(0.1, 1.0));
      std::array<double, 10> lower{};
      std::size_t next = 0;
      for (int j = 0; j < 4; ++j)
        for (int i = j; i < 4; ++i) lower[next++] = springs.back() * (i == j ? 3.0 : -1.0);
      entries.push_back(lower);
    }
    const SolidVertexRank rank;
    const std::vector<int>& ranks = rank.of(elements);
    std::vector<int> order(ranks.size());
    for (std::size_t v = 0; v < ranks.size(); ++v) order[at(ranks[v])] = static_cast<int>(v);
    tree = build_front_tree(graph, order);
  }

  std::vector<double> times(const SolveLanes& x, int lane) const {
    std::vector<double> product(at(tree.unknowns));
    const auto value = [&](int node) { return x.values[at(x.lanes * tree.node_place[at(node)] + lane)]; };
    for (std::size_t i = 0; i < product.size(); ++i)
      product[i] = kHold * x.values[at(x.lanes) * i + at(lane)];
    for (std::size_t e = 0; e < graph.elements.size(); ++e)
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
          product[at(tree.node_place[at(graph.elements[e][i])])] +=
              springs[e] * (i == j ? 3.0 : -1.0) * value(graph.elements[e][j]);
    return product;
  }

  static constexpr double kHold = 0.01;
};

}  // namespace

TEST_CASE("small subtrees are disjoint, and what is in none of them lies above one that is") {
  const Network network(0.06);
  const FrontTree& tree = network.tree;
  const std::vector<int> roots = small_subtrees(tree, 16);
  REQUIRE(roots.size() > 4);
  std::vector<int> covered(tree.fronts.size(), 0);
  for (const int root : roots)
    for (int f = tree.fronts[at(root)].subtree_first; f <= root; ++f) ++covered[at(f)];
  CHECK(*std::max_element(covered.begin(), covered.end()) == 1);
  CHECK(std::is_sorted(roots.begin(), roots.end()));
  int strays = 0;  // above what is in no subtree nothing is
  for (std::size_t f = 0; f < tree.fronts.size(); ++f)
    if (covered[f] == 0 && tree.fronts[f].parent >= 0) strays += covered[at(tree.fronts[f].parent)];
  CHECK(strays == 0);
}

TEST_CASE("a great factor solves its matrix, with the same bits for any number of threads") {
  const Network network(0.04);
  REQUIRE(network.tree.entries > 1e6);
  const std::vector<double> hold(at(network.tree.unknowns), Network::kHold);
  const std::vector<std::size_t> counts = {1, 4};
  std::vector<SolveLanes> loads;
  for (const std::size_t count : counts) {
    core::Random random(8);
    SolveLanes& load = loads.emplace_back(network.tree, count);
    for (std::size_t i = 0; i < load.values.size(); i += 7) load.values[i] = random.uniform(-1.0, 1.0);
  }
  std::vector<std::vector<SolveLanes>> answers(counts.size());  // of each load, by each number of threads
  for (const int threads : {1, 2, 5}) {
    core::set_thread_count(threads);
    const auto factor = FrontFactor::make(network.tree, hold, [&](int e) {
      return ElementEntries{network.entries[at(e)].data(), 1.0};
    });
    REQUIRE(factor.has_value());
    for (std::size_t l = 0; l < loads.size(); ++l) {
      SolveLanes x = loads[l];
      solve_forward(network.tree, *factor, x);
      solve_backward(network.tree, *factor, x);
      answers[l].push_back(std::move(x));
    }
  }
  core::set_thread_count(0);
  for (std::size_t l = 0; l < loads.size(); ++l) {
    const SolveLanes &load = loads[l], &first = answers[l].front();
    for (const SolveLanes& answer : answers[l]) CHECK(answer.values == first.values);
    double left = 0.0;
    for (int lane = 0; lane < load.lanes; ++lane) {
      const std::vector<double> product = network.times(first, lane);
      for (std::size_t i = 0; i < product.size(); ++i)
        left = std::max(left, std::abs(product[i] - load.values[at(load.lanes) * i + at(lane)]));
    }
    CHECK(left < 1e-11);
  }
}

}  // namespace shatterbox::stress
