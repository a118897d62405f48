#include "engine/stress/front_factor.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <numeric>

#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/stress/front_tiles.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

/// A pivot this small beside its unfactored diagonal is rounding.
constexpr double kLeastPivot = 1e-15;
/// From so many multiplications on a front's rest matrix is worth several tasks.
constexpr double kParallelWork = 2e6;
/// Entries to a block of memory: of one far larger no allocator keeps what is freed for the next factor.
constexpr Size kBlockEntries = Size{1} << 20;

using NodeNumbers = std::array<int, NodeGraph::kElementNodes>;
constexpr int kMostElementUnknowns = 12;

/// Places in the front of an element's unknowns, -1 for those that are not there.
struct ElementPlaces {
  std::array<int, kMostElementUnknowns> at{};
  Size count = 0;

  ElementPlaces(const NodeNumbers& nodes, const NodeNumbers& unknowns) {
    for (Size node = 0; node < nodes.size(); ++node)
      for (int i = 0; i < unknowns[node]; ++i) at[count++] = nodes[node] < 0 ? -1 : nodes[node] + i;
  }
};

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

 private:
  const Front& front_;
  double* panel_;
  double* rest_;
};

/// Everything that one factorisation reads and writes.
class Factorisation {
 public:
  Factorisation(const FrontTree& tree, const std::vector<double>& diagonal,
                const std::function<ElementEntries(int)>& element, const std::vector<double*>& panels)
      : tree_(tree),
        diagonal_(diagonal),
        element_(element),
        panels_(panels),
        rests_(tree.fronts.size()),
        own_(tree.fronts.size()) {
    find_least_pivots();
  }

  bool run() {
    // Disjoint subtrees at once, each in order by one thread; then what is above them, level by level. What
    // runs when depends on the tree alone, and nothing is summed across fronts but in the order of the
    // children.
    const std::vector<int> roots = small_subtrees(tree_, 16);
    core::parallel_for(roots.size(), 1, [&](Size i) { factor_subtree(roots[i]); });
    for (const std::vector<int>& level : levels_above(roots)) {
      if (has_failed_) break;
      core::parallel_for(level.size(), 1, [&](Size i) { factor_alone(level[i], true); });
    }
    return !has_failed_;
  }

 private:
  void find_least_pivots() {
    least_pivots_ = diagonal_;
    std::vector<int> front_of_row;
    for (const Front& front : tree_.fronts)
      for (int e = front.first_element; e < front.first_element + front.element_count; ++e) {
        const ElementEntries entries = element_(tree_.elements[at(e)]);
        const ElementPlaces places(tree_.element_local[at(e)], tree_.element_unknowns);
        Size entry = 0;
        for (Size i = 0; i < places.count; entry += places.count - i, ++i) {
          const int own = places.at[i];
          if (own < 0) continue;
          const int row = own - front.pivots;
          const int place = row < 0 ? front.first_pivot + own : tree_.row_place[at(front.first_row + row)];
          least_pivots_[at(place)] += entries.factor * entries.lower[entry];
        }
      }
    for (double& pivot : least_pivots_) pivot *= kLeastPivot;
  }

  /// The fronts that are in none of the subtrees, by the length of the longest way down to one that is.
  std::vector<std::vector<int>> levels_above(const std::vector<int>& roots) const {
    std::vector<char> is_done(tree_.fronts.size(), 0);
    for (const int root : roots)
      for (int f = tree_.fronts[at(root)].subtree_first; f <= root; ++f) is_done[at(f)] = 1;
    std::vector<Size> height(tree_.fronts.size(), 0);
    std::vector<std::vector<int>> levels;
    for (int f = 0; f < static_cast<int>(tree_.fronts.size()); ++f) {
      if (is_done[at(f)] != 0) continue;
      if (levels.size() <= height[at(f)]) levels.resize(height[at(f)] + 1);
      levels[height[at(f)]].push_back(f);
      if (const int parent = tree_.fronts[at(f)].parent; parent >= 0)
        height[at(parent)] = std::max(height[at(parent)], height[at(f)] + 1);
    }
    return levels;
  }

  Size rest_size(int f) const { return tiles::rest_size(tree_.fronts[at(f)].rows); }

  /// A front whose rest has memory of its own, until the parent has taken it.
  void factor_alone(int f, bool is_top) {
    own_[at(f)] = std::unique_ptr<double[]>(new double[rest_size(f)]);
    rests_[at(f)] = own_[at(f)].get();
    factor(f, is_top);
    const Front& front = tree_.fronts[at(f)];
    for (int c = front.first_child; c < front.first_child + front.child_count; ++c)
      own_[at(tree_.children[at(c)])].reset();
  }

  /// One front after the other, the rests in between on two stacks, those of fronts at an even depth on one:
  /// the children of the front at work are then on top of the other.
  void factor_subtree(int root) {
    const int first = tree_.fronts[at(root)].subtree_first;
    std::vector<Size> stack(at(root - first + 1), 0);
    for (int f = root - 1; f >= first; --f)
      stack[at(f - first)] = 1 - stack[at(tree_.fronts[at(f)].parent - first)];
    std::vector<Size> begin(stack.size());
    std::array<Size, 2> used{}, most{};
    for (int f = first; f < root; ++f) {
      const Size own = stack[at(f - first)];
      begin[at(f - first)] = used[own];
      used[own] += rest_size(f);
      most[own] = std::max(most[own], used[own]);
      const Front& front = tree_.fronts[at(f)];
      for (int c = front.first_child; c < front.first_child + front.child_count; ++c)
        used[1 - own] -= rest_size(tree_.children[at(c)]);
    }
    const std::array<std::unique_ptr<double[]>, 2> memory{std::unique_ptr<double[]>(new double[most[0]]),
                                                          std::unique_ptr<double[]>(new double[most[1]])};
    for (int f = first; f < root && !has_failed_; ++f) {
      rests_[at(f)] = memory[stack[at(f - first)]].get() + begin[at(f - first)];
      factor(f, false);
    }
    if (!has_failed_) factor_alone(root, false);
  }

  void factor(int f, bool is_top) {
    const Front& front = tree_.fronts[at(f)];
    double* const panel = panels_[at(f)];
    std::fill_n(panel, tiles::panel_size(front.pivots, front.rows), 0.0);
    double* const rest = rests_[at(f)];
    std::fill_n(rest, rest_size(f), 0.0);
    const FrontView view(front, panel, rest);
    for (int j = 0; j < front.pivots; ++j)
      view.panel_row(j)[tiles::kRows * j] += diagonal_[at(front.first_pivot + j)];
    for (int e = front.first_element; e < front.first_element + front.element_count; ++e)
      add_element(e, front, view);
    for (int c = front.first_child; c < front.first_child + front.child_count; ++c)
      add_child(tree_.children[at(c)], front, view);

    if (!tiles::kernels().factor_panel(panel, front.pivots, front.rows,
                                       least_pivots_.data() + front.first_pivot)) {
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

  void add_element(int e, const Front& front, const FrontView& view) const {
    const ElementEntries entries = element_(tree_.elements[at(e)]);
    const ElementPlaces all(tree_.element_local[at(e)], tree_.element_unknowns);
    const auto& places = all.at;
    std::array<double*, kMostElementUnknowns> panel_rows{}, rest_rows{};
    for (Size i = 0; i < all.count; ++i) {
      if (places[i] < 0) continue;
      panel_rows[i] = view.panel_row(places[i]);
      if (places[i] >= front.pivots) rest_rows[i] = view.rest_row(places[i] - front.pivots);
    }
    Size entry = 0;
    for (Size j = 0; j < all.count; ++j)
      for (Size i = j; i < all.count; ++i, ++entry) {
        if (places[i] < 0 || places[j] < 0) continue;
        const bool is_below = places[i] >= places[j];
        const Size row = is_below ? i : j;
        const int column = is_below ? places[j] : places[i];
        double* const to = column < front.pivots ? panel_rows[row] + tiles::kRows * column
                                                 : rest_rows[row] + tiles::kRows * (column - front.pivots);
        *to += entries.factor * entries.lower[entry];
      }
  }

  /// Four entries of a column of a strip to the same column of four rows.
  static void add_column(const double* entries, const std::array<double*, tiles::kRows>& rows, int column) {
    const std::ptrdiff_t offset = tiles::kRows * std::ptrdiff_t{column};
    rows[0][offset] += entries[0];
    rows[1][offset] += entries[1];
    rows[2][offset] += entries[2];
    rows[3][offset] += entries[3];
  }

  void add_child(int c, const Front& parent, const FrontView& view) {
    const Front& child = tree_.fronts[at(c)];
    const int* const place = tree_.row_in_parent.data() + child.first_row;
    const int in_panel = static_cast<int>(std::lower_bound(place, place + child.rows, parent.pivots) - place);
    const double* const rest = rests_[at(c)];
    // Strip by strip: its four rows mostly go to four successive ones.
    for (int first = 0; first < child.rows; first += tiles::kRows) {
      const int count = std::min(tiles::kRows, child.rows - first);
      const double* const strip = rest + tiles::rest_strip(at(first / tiles::kRows));
      std::array<double*, tiles::kRows> panel_rows{}, rest_rows{};
      for (int r = 0; r < count; ++r) {
        panel_rows[at(r)] = view.panel_row(place[first + r]);
        if (first + r >= in_panel) rest_rows[at(r)] = view.rest_row(place[first + r] - parent.pivots);
      }
      // Columns that all rows of the strip have, then the triangle at its end.
      const int whole = count == tiles::kRows ? first + 1 : 0;
      const int whole_in_panel = std::min(whole, in_panel);
      for (int j = 0; j < whole_in_panel; ++j) add_column(strip + tiles::kRows * j, panel_rows, place[j]);
      const int whole_in_rest = first >= in_panel ? whole : whole_in_panel;
      for (int j = whole_in_panel; j < whole_in_rest; ++j)
        add_column(strip + tiles::kRows * j, rest_rows, place[j] - parent.pivots);
      for (int r = 0; r < count; ++r)
        for (int j = whole_in_rest; j <= first + r; ++j)
          if (j < in_panel)
            panel_rows[at(r)][tiles::kRows * place[j]] += strip[tiles::kRows * j + r];
          else
            rest_rows[at(r)][tiles::kRows * (place[j] - parent.pivots)] += strip[tiles::kRows * j + r];
    }
  }

  const FrontTree& tree_;
  const std::vector<double>& diagonal_;
  const std::function<ElementEntries(int)>& element_;
  const std::vector<double*>& panels_;
  std::vector<double*> rests_;                  // of the fronts that wait for their parents
  std::vector<std::unique_ptr<double[]>> own_;  // memory of those that no stack has
  std::vector<double> least_pivots_;
  std::atomic<bool> has_failed_ = false;
};

}  // namespace

std::optional<FrontFactor> FrontFactor::make(const FrontTree& tree, const std::vector<double>& diagonal,
                                             const std::function<ElementEntries(int element)>& element) {
  FrontFactor factor;
  factor.panels_.resize(tree.fronts.size());
  const auto size_of = [&](Size f) { return tiles::panel_size(tree.fronts[f].pivots, tree.fronts[f].rows); };
  for (Size begin = 0, end = 0; begin < tree.fronts.size(); begin = end) {
    Size size = size_of(end++);
    while (end < tree.fronts.size() && size + size_of(end) <= kBlockEntries) size += size_of(end++);
    factor.size_ += size;
    double* next = factor.blocks_.emplace_back(new double[size]).get();  // each front zeroes its own
    for (Size f = begin; f < end; ++f) {
      factor.panels_[f] = next;
      next += size_of(f);
    }
  }
  Factorisation work(tree, diagonal, element, factor.panels_);
  if (!work.run()) return std::nullopt;
  return factor;
}

}  // namespace shatterbox::stress
