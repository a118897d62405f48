#include "engine/stress/front_factor.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <numeric>

#include "engine/core/parallel.h"
#include "engine/stress/front_tiles.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;

Size at(int i) {
  return static_cast<Size>(i);
}

/// A pivot this small beside its unfactored diagonal is rounding.
constexpr double kLeastPivot = 1e-15;
/// From so many multiplications on a front's rest matrix is worth several tasks.
constexpr double kParallelWork = 2e6;

constexpr std::array<int, NodeGraph::kElementNodes> kNodeUnknowns{3, 3, 3, 1, 1, 1};
constexpr int kElementUnknowns = 12;

/// Places in the front of an element's twelve unknowns, -1 for those that are not there.
std::array<int, kElementUnknowns> expand(const std::array<int, NodeGraph::kElementNodes>& nodes) {
  std::array<int, kElementUnknowns> places{};
  Size next = 0;
  for (Size node = 0; node < nodes.size(); ++node)
    for (int i = 0; i < kNodeUnknowns[node]; ++i) places[next++] = nodes[node] < 0 ? -1 : nodes[node] + i;
  return places;
}

/// Addresses of a front's entries: row i of the front, column j, i >= j.
class FrontView {
 public:
  FrontView(const Front& front, double* panel, double* rest) : front_(front), panel_(panel), rest_(rest) {}

  /// Begin of row i in the panel; column j is 4 j further on.
  double* panel_row(int i) const {
    const int pivots = front_.pivots;
    const int row = i < pivots ? i : i - pivots + tiles::kRows * static_cast<int>(tiles::strip_count(pivots));
    return panel_ + at(row / tiles::kRows) * at(tiles::kRows * pivots) + at(row % tiles::kRows);
  }
  /// Begin of row i (counted below the pivots) in the rest matrix; column j (counted likewise) is 4 j further
  /// on.
  double* rest_row(int i) const {
    return rest_ + tiles::rest_strip(at(i / tiles::kRows)) + at(i % tiles::kRows);
  }
  void add(int i, int j, double value) const {
    if (i < j) std::swap(i, j);
    if (j < front_.pivots)
      panel_row(i)[tiles::kRows * j] += value;
    else
      rest_row(i - front_.pivots)[tiles::kRows * (j - front_.pivots)] += value;
  }

 private:
  const Front& front_;
  double* panel_;
  double* rest_;
};

/// Everything that one factorisation reads and writes.
class Factorisation {
 public:
  Factorisation(const FrontTree& tree, const std::vector<double>& diagonal,
                const std::function<ElementEntries(int)>& element, const std::vector<Size>& first,
                std::vector<double>& entries)
      : tree_(tree),
        diagonal_(diagonal),
        element_(element),
        first_(first),
        entries_(entries),
        rests_(tree.fronts.size()) {
    find_least_pivots();
  }

  bool run() {
    // Disjoint subtrees at once, each in order by one thread; then what is above them. Which subtrees depends
    // on the tree alone, and nothing is summed across them but in the order of the children.
    const std::vector<int> roots = split();
    core::parallel_for(roots.size(), 1, [&](Size i) {
      const int root = roots[i];
      for (int f = tree_.fronts[at(root)].subtree_first; f <= root && !has_failed_; ++f) factor(f, false);
    });
    std::vector<char> is_done(tree_.fronts.size(), 0);
    for (const int root : roots)
      for (int f = tree_.fronts[at(root)].subtree_first; f <= root; ++f) is_done[at(f)] = 1;
    for (int f = 0; f < static_cast<int>(tree_.fronts.size()) && !has_failed_; ++f)
      if (is_done[at(f)] == 0) factor(f, true);
    return !has_failed_;
  }

 private:
  void find_least_pivots() {
    least_pivots_ = diagonal_;
    std::vector<int> front_of_row;
    for (const Front& front : tree_.fronts)
      for (int e = front.first_element; e < front.first_element + front.element_count; ++e) {
        const ElementEntries entries = element_(tree_.elements[at(e)]);
        const auto places = expand(tree_.element_local[at(e)]);
        Size entry = 0;
        for (Size i = 0; i < kElementUnknowns; entry += kElementUnknowns - i, ++i) {
          if (places[i] < 0) continue;
          const int row = places[i] - front.pivots;
          const int place =
              row < 0 ? front.first_pivot + places[i] : tree_.row_place[at(front.first_row + row)];
          least_pivots_[at(place)] += entries.factor * entries.lower[entry];
        }
      }
    for (double& pivot : least_pivots_) pivot *= kLeastPivot;
  }

  std::vector<int> split() const {
    std::vector<int> roots;
    double total = 0.0;
    for (int f = 0; f < static_cast<int>(tree_.fronts.size()); ++f)
      if (tree_.fronts[at(f)].parent < 0) total += tree_.fronts[at(f)].work;
    // The highest fronts whose subtree is at most a sixteenth of the work.
    for (int f = 0; f < static_cast<int>(tree_.fronts.size()); ++f) {
      const Front& front = tree_.fronts[at(f)];
      const auto is_small = [&](const Front& candidate) { return candidate.work <= total / 16.0; };
      if (is_small(front) && (front.parent < 0 || !is_small(tree_.fronts[at(front.parent)])))
        roots.push_back(f);
    }
    return roots;
  }

  void factor(int f, bool is_top) {
    const Front& front = tree_.fronts[at(f)];
    double* const panel = entries_.data() + first_[at(f)];
    const Size rest_size = tiles::rest_size(front.rows);
    rests_[at(f)] = std::unique_ptr<double[]>(new double[std::max<Size>(rest_size, 1)]());
    double* const rest = rests_[at(f)].get();
    const FrontView view(front, panel, rest);
    for (int j = 0; j < front.pivots; ++j) view.add(j, j, diagonal_[at(front.first_pivot + j)]);
    for (int e = front.first_element; e < front.first_element + front.element_count; ++e)
      add_element(e, view);
    for (int c = front.first_child; c < front.first_child + front.child_count; ++c)
      add_child(tree_.children[at(c)], front, view);

    if (!tiles::kernels().factor_panel(panel, front.pivots, front.rows, least_pivots_.data() + front.first_pivot)) {
      has_failed_ = true;
      return;
    }
    const double work = 0.5 * front.pivots * static_cast<double>(front.rows) * front.rows;
    const Size strips = tiles::strip_count(front.rows);
    if (is_top && work > kParallelWork)
      core::parallel_chunks(strips, 4, [&](Size begin, Size end) {
        tiles::kernels().subtract_products(panel, front.pivots, front.rows, rest, begin, end);
      });
    else
      tiles::kernels().subtract_products(panel, front.pivots, front.rows, rest, 0, strips);
  }

  void add_element(int e, const FrontView& view) const {
    const ElementEntries entries = element_(tree_.elements[at(e)]);
    const auto places = expand(tree_.element_local[at(e)]);
    Size entry = 0;
    for (Size j = 0; j < kElementUnknowns; ++j)
      for (Size i = j; i < kElementUnknowns; ++i, ++entry)
        if (places[i] >= 0 && places[j] >= 0)
          view.add(places[i], places[j], entries.factor * entries.lower[entry]);
  }

  void add_child(int c, const Front& parent, const FrontView& view) {
    const Front& child = tree_.fronts[at(c)];
    const int* const place = tree_.row_in_parent.data() + child.first_row;
    const int in_panel = static_cast<int>(std::lower_bound(place, place + child.rows, parent.pivots) - place);
    double* const rest = rests_[at(c)].get();
    const FrontView source(child, nullptr, rest);
    for (int i = 0; i < child.rows; ++i) {
      const double* const from = source.rest_row(i);
      double* const panel_row = view.panel_row(place[i]);
      const int columns = std::min(i + 1, in_panel);
      for (int j = 0; j < columns; ++j) panel_row[tiles::kRows * place[j]] += from[tiles::kRows * j];
      if (i < in_panel) continue;
      double* const rest_row = view.rest_row(place[i] - parent.pivots);
      for (int j = in_panel; j <= i; ++j)
        rest_row[tiles::kRows * (place[j] - parent.pivots)] += from[tiles::kRows * j];
    }
    rests_[at(c)].reset();
  }

  const FrontTree& tree_;
  const std::vector<double>& diagonal_;
  const std::function<ElementEntries(int)>& element_;
  const std::vector<Size>& first_;
  std::vector<double>& entries_;
  std::vector<std::unique_ptr<double[]>> rests_;
  std::vector<double> least_pivots_;
  std::atomic<bool> has_failed_ = false;
};

}  // namespace

std::optional<FrontFactor> FrontFactor::make(const FrontTree& tree, const std::vector<double>& diagonal,
                                             const std::function<ElementEntries(int element)>& element) {
  FrontFactor factor;
  factor.first_.resize(tree.fronts.size() + 1, 0);
  for (Size f = 0; f < tree.fronts.size(); ++f)
    factor.first_[f + 1] = factor.first_[f] + tiles::panel_size(tree.fronts[f].pivots, tree.fronts[f].rows);
  factor.entries_.assign(factor.first_.back(), 0.0);
  Factorisation work(tree, diagonal, element, factor.first_, factor.entries_);
  if (!work.run()) return std::nullopt;
  return factor;
}

}  // namespace shatterbox::stress
