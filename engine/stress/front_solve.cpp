#include "engine/stress/front_solve.h"

#include <algorithm>
#include <array>

#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/stress/front_tiles.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kSharedEntries = 1e6;  // of a factor from which on threads share a solve

template <int kLanes>
class LaneSolver {
 public:
  LaneSolver(const FrontTree& tree, const FrontFactor& factor, std::vector<double>& x)
      : tree_(tree), factor_(factor), x_(x) {}

  void run_forward() {
    // A front is reached if it has a load of its own or a child that was reached.
    std::vector<char> is_reached(tree_.fronts.size(), 0);
    for (Size f = 0; f < tree_.fronts.size(); ++f) {
      const Front& front = tree_.fronts[f];
      if (is_reached[f] == 0 && are_zero(pivot(front, 0), front.pivots)) continue;
      forward(front, factor_.panel(f));
      if (front.parent >= 0) is_reached[at(front.parent)] = 1;
    }
  }

  // What is above disjoint subtrees, then these at once: each reads what is above it, and writes its own.
  void run_backward() {
    std::vector<char> is_reached(tree_.fronts.size(), 0);
    const std::vector<int> roots =
        tree_.entries > kSharedEntries ? small_subtrees(tree_, 16) : std::vector<int>{};
    auto root = roots.rbegin();
    for (int f = static_cast<int>(tree_.fronts.size()) - 1; f >= 0;) {
      if (root != roots.rend() && *root == f) {
        f = tree_.fronts[at(f)].subtree_first - 1;
        ++root;
        continue;
      }
      go_back(f--, is_reached);
    }
    core::parallel_for(roots.size(), 1, [&](Size i) {
      for (int f = roots[i]; f >= tree_.fronts[at(roots[i])].subtree_first; --f) go_back(f, is_reached);
    });
  }

 private:
  void go_back(int f, std::vector<char>& is_reached) {
    const Front& front = tree_.fronts[at(f)];
    const bool has_parent = front.parent >= 0 && is_reached[at(front.parent)] != 0;
    if (!has_parent && are_zero(pivot(front, 0), front.pivots)) return;
    is_reached[at(f)] = 1;
    backward(front, factor_.panel(at(f)));
  }

  using Lanes = std::array<double, static_cast<Size>(kLanes)>;

  static bool are_zero(const double* x, int pivots) {
    return std::all_of(x, x + kLanes * pivots, [](double value) { return value == 0.0; });
  }
  double* pivot(const Front& front, int j) { return x_.data() + at(kLanes * (front.first_pivot + j)); }
  double* row(const Front& front, int i) {
    return x_.data() + at(kLanes) * at(tree_.row_place[at(front.first_row + i)]);
  }

  /// sums[i] = row i of a strip times the first `columns` pivots.
  void multiply_strip(const double* strip, const double* pivots, int columns,
                      std::array<Lanes, 4>& sums) const {
    if constexpr (kLanes == 4) {
      tiles::kernels().multiply_lanes(strip, pivots, columns, sums.front().data());
      return;
    }
    sums = {};
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
      tiles::kernels().subtract_lanes(strip, rows.front().data(), columns, pivots);
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
  const FrontFactor& factor_;
  std::vector<double>& x_;
};

}  // namespace

void solve_forward(const FrontTree& tree, const FrontFactor& factor, SolveLanes& x) {
  if (x.lanes == 1)
    LaneSolver<1>(tree, factor, x.values).run_forward();
  else
    LaneSolver<SolveLanes::kMost>(tree, factor, x.values).run_forward();
}

void solve_backward(const FrontTree& tree, const FrontFactor& factor, SolveLanes& x) {
  if (x.lanes == 1)
    LaneSolver<1>(tree, factor, x.values).run_backward();
  else
    LaneSolver<SolveLanes::kMost>(tree, factor, x.values).run_backward();
}

}  // namespace shatterbox::stress
