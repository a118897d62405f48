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

    if (!tiles::factor_panel(panel, front.pivots, front.rows, least_pivots_.data() + front.first_pivot)) {
      has_failed_ = true;
      return;
    }
    const double work = 0.5 * front.pivots * static_cast<double>(front.rows) * front.rows;
    const Size strips = tiles::strip_count(front.rows);
    if (is_top && work > kParallelWork)
      core::parallel_chunks(strips, 4, [&](Size begin, Size end) {
        tiles::subtract_products(panel, front.pivots, front.rows, rest, begin, end);
      });
    else
      tiles::subtract_products(panel, front.pivots, front.rows, rest, 0, strips);
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

/// Solves for `kLanes` right-hand sides at once; x holds the lanes of an unknown side by side. Lanes never
/// mix, so a right-hand side gets the same bits whatever company it has.
template <int kLanes>
class LaneSolver {
 public:
  LaneSolver(const FrontTree& tree, const std::vector<Size>& first, const std::vector<double>& entries,
             std::vector<double>& x)
      : tree_(tree), first_(first), entries_(entries), x_(x) {}

  void run() {
    for (Size f = 0; f < tree_.fronts.size(); ++f) forward(tree_.fronts[f], entries_.data() + first_[f]);
    for (Size f = tree_.fronts.size(); f-- > 0;) backward(tree_.fronts[f], entries_.data() + first_[f]);
  }

 private:
  using Lanes = std::array<double, static_cast<Size>(kLanes)>;

  double* pivot(const Front& front, int j) { return x_.data() + at(kLanes * (front.first_pivot + j)); }
  double* row(const Front& front, int i) {
    return x_.data() + at(kLanes) * at(tree_.row_place[at(front.first_row + i)]);
  }

  /// sums[i] = row i of a strip times the first `columns` pivots.
  void multiply_strip(const double* strip, const double* pivots, int columns,
                      std::array<Lanes, 4>& sums) const {
    sums = {};
    if constexpr (kLanes == 4) {
      tiles::Pair wide[4][2] = {};
      for (int p = 0; p < columns; ++p, strip += tiles::kRows, pivots += kLanes) {
        const tiles::Pair low = *reinterpret_cast<const tiles::Pair*>(pivots);
        const tiles::Pair high = *reinterpret_cast<const tiles::Pair*>(pivots + 2);
        for (Size i = 0; i < 4; ++i) {
          const tiles::Pair factor = {strip[i], strip[i]};
          wide[i][0] += factor * low;
          wide[i][1] += factor * high;
        }
      }
      for (Size i = 0; i < 4; ++i)
        for (Size l = 0; l < 4; ++l) sums[i][l] = wide[i][l / 2][l % 2];
      return;
    }
    for (int p = 0; p < columns; ++p, strip += tiles::kRows, pivots += kLanes)
      for (Size i = 0; i < 4; ++i)
        for (Size l = 0; l < at(kLanes); ++l) sums[i][l] += strip[i] * pivots[l];
  }

  void forward(const Front& front, const double* panel) {
    const Size strip_size = at(tiles::kRows * front.pivots);
    std::array<Lanes, 4> sums;
    const double* strip = panel;
    for (int first = 0; first < front.pivots; first += tiles::kRows, strip += strip_size) {
      const int columns = std::min(tiles::kRows, front.pivots - first);
      multiply_strip(strip, pivot(front, 0), first, sums);
      const double* const tile = strip + tiles::kRows * first;
      for (int i = 0; i < columns; ++i)
        for (int l = 0; l < kLanes; ++l) {
          double value = pivot(front, first + i)[l] - sums[at(i)][at(l)];
          for (int q = 0; q < i; ++q) value -= tile[tiles::kRows * q + i] * pivot(front, first + q)[l];
          pivot(front, first + i)[l] = value * tile[tiles::kRows * i + i];
        }
    }
    for (int first = 0; first < front.rows; first += tiles::kRows, strip += strip_size) {
      multiply_strip(strip, pivot(front, 0), front.pivots, sums);
      for (int i = 0; i < std::min(tiles::kRows, front.rows - first); ++i)
        for (int l = 0; l < kLanes; ++l) row(front, first + i)[l] -= sums[at(i)][at(l)];
    }
  }

  /// pivots -= the first `columns` columns of a strip, transposed, times its four rows.
  void subtract_strip(const double* strip, const std::array<Lanes, 4>& rows, int columns,
                      double* pivots) const {
    if constexpr (kLanes == 4) {
      tiles::Pair r[4][2];
      for (Size i = 0; i < 4; ++i)
        for (Size h = 0; h < 2; ++h) r[i][h] = tiles::Pair{rows[i][2 * h], rows[i][2 * h + 1]};
      for (int p = 0; p < columns; ++p, strip += tiles::kRows, pivots += kLanes) {
        const tiles::Pair s0 = {strip[0], strip[0]}, s1 = {strip[1], strip[1]}, s2 = {strip[2], strip[2]},
                          s3 = {strip[3], strip[3]};
        for (Size h = 0; h < 2; ++h)
          *reinterpret_cast<tiles::Pair*>(pivots + 2 * h) -=
              ((s0 * r[0][h] + s1 * r[1][h]) + s2 * r[2][h]) + s3 * r[3][h];
      }
      return;
    }
    for (int p = 0; p < columns; ++p, strip += tiles::kRows, pivots += kLanes)
      for (Size l = 0; l < at(kLanes); ++l)
        pivots[l] -=
            ((strip[0] * rows[0][l] + strip[1] * rows[1][l]) + strip[2] * rows[2][l]) + strip[3] * rows[3][l];
  }

  void backward(const Front& front, const double* panel) {
    const Size strip_size = at(tiles::kRows * front.pivots);
    std::array<Lanes, 4> rows;
    const double* strip = panel + tiles::strip_count(front.pivots) * strip_size;
    for (int first = 0; first < front.rows; first += tiles::kRows, strip += strip_size) {
      rows = {};
      for (int i = 0; i < std::min(tiles::kRows, front.rows - first); ++i)
        std::copy_n(row(front, first + i), kLanes, rows[at(i)].begin());
      subtract_strip(strip, rows, front.pivots, pivot(front, 0));
    }
    for (int block = static_cast<int>(tiles::strip_count(front.pivots)) - 1; block >= 0; --block) {
      const int first = tiles::kRows * block;
      const int columns = std::min(tiles::kRows, front.pivots - first);
      strip = panel + at(block) * strip_size;
      const double* const tile = strip + tiles::kRows * first;
      rows = {};
      for (int i = columns - 1; i >= 0; --i)
        for (int l = 0; l < kLanes; ++l) {
          double value = pivot(front, first + i)[l];
          for (int q = i + 1; q < columns; ++q)
            value -= tile[tiles::kRows * i + q] * pivot(front, first + q)[l];
          rows[at(i)][at(l)] = pivot(front, first + i)[l] = value * tile[tiles::kRows * i + i];
        }
      subtract_strip(strip, rows, first, pivot(front, 0));
    }
  }

  const FrontTree& tree_;
  const std::vector<Size>& first_;
  const std::vector<double>& entries_;
  std::vector<double>& x_;
};

template <int kLanes>
void solve_lanes(const FrontTree& tree, const std::vector<Size>& first, const std::vector<double>& entries,
                 Eigen::MatrixXd& x, Eigen::Index column) {
  std::vector<double> lanes(at(tree.unknowns) * at(kLanes), 0.0);
  const Eigen::Index count = std::min<Eigen::Index>(kLanes, x.cols() - column);
  for (Eigen::Index l = 0; l < count; ++l)
    for (Eigen::Index i = 0; i < x.rows(); ++i) lanes[static_cast<Size>(kLanes * i + l)] = x(i, column + l);
  LaneSolver<kLanes>(tree, first, entries, lanes).run();
  for (Eigen::Index l = 0; l < count; ++l)
    for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, column + l) = lanes[static_cast<Size>(kLanes * i + l)];
}

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

void FrontFactor::solve(const FrontTree& tree, Eigen::MatrixXd& x) const {
  constexpr Eigen::Index kLanes = 4;
  const Size groups = static_cast<Size>((x.cols() + kLanes - 1) / kLanes);
  core::parallel_for(groups, 1, [&](Size group) {
    const Eigen::Index column = kLanes * static_cast<Eigen::Index>(group);
    if (x.cols() - column == 1)
      solve_lanes<1>(tree, first_, entries_, x, column);
    else
      solve_lanes<4>(tree, first_, entries_, x, column);
  });
}

}  // namespace shatterbox::stress
