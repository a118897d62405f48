#include "engine/stress/block_gradients.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/core/stop.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kLeastSingleTolerance = 1e-4;  // of the residual: from there on single precision does
constexpr double kSingleExcess = 1.05;          // times the tolerance, of the residual that it really leaves

/// What is solved for, and where the search may begin; null: at nothing.
struct Load {
  const VecX* force = nullptr;
  const VecX* guess = nullptr;
};

constexpr int kProjectEvery = 20;  // iterations; rounding lets the null space grow slowly

template <Size kLanes>
using Lane = std::array<double, kLanes>;

/// The work on kLanes loads at once; entry i of lane l is at i kLanes + l. Vectors and matrix are of Scalar,
/// sums are doubles. In single precision loads are scaled to a greatest entry of 1.
template <Size kLanes, class Scalar>
class Solver {
 public:
  Solver(const BlockSystem& system, std::span<const Load> loads)
      : system_(system), rows_(system.rows->size()), count_(loads.size()), size_(3 * rows_ * kLanes) {
    for (std::vector<Scalar>* v : {&b_, &x_, &r_, &z_, &p_, &q_}) v->assign(size_, Scalar{0});
    unit_.fill(1.0);
    for (Size l = 0; l < count_; ++l) {
      const VecX& force = *loads[l].force;
      if (const double greatest = force.size() > 0 ? force.cwiseAbs().maxCoeff() : 0.0;
          is_single() && greatest > 0.0)
        unit_[l] = greatest;
      for (Size i = 0; i < 3 * rows_; ++i)
        b_[i * kLanes + l] = static_cast<Scalar>(force(static_cast<Eigen::Index>(i)) / unit_[l]);
    }
    hold(b_, 0, rows_);
    project(b_);
    r_ = b_;
    start_from(loads);
  }

  std::vector<GradientResult> run(const GradientSettings& settings) {
    std::vector<GradientResult> results(count_);
    const Lane<kLanes> load_squared = squares(b_);
    const auto [first_rho, first_squared] = precondition();
    Lane<kLanes> rho = first_rho, beta{};
    std::array<bool, kLanes> is_open{};
    const double enough = settings.tolerance * settings.tolerance;
    for (Size l = 0; l < count_; ++l) {
      results[l].is_converged = load_squared[l] == 0.0 || first_squared[l] <= enough * load_squared[l];
      is_open[l] = !results[l].is_converged && rho[l] > 0.0 && std::isfinite(rho[l]);
    }
    for (int iteration = 1; iteration <= settings.most_iterations; ++iteration) {
      core::stop_if_asked();
      if (std::none_of(is_open.begin(), is_open.end(), [](bool open) { return open; })) break;
      turn_direction(beta);
      const Lane<kLanes> curvature = multiply_direction();
      Lane<kLanes> step{};
      for (Size l = 0; l < kLanes; ++l) {
        if (!is_open[l]) continue;
        is_open[l] = curvature[l] > 0.0 && std::isfinite(curvature[l]);
        if (is_open[l]) step[l] = rho[l] / curvature[l];
      }
      advance(step);
      if (iteration % kProjectEvery == 0) project(r_);
      const auto [next_rho, squared] = precondition();
      for (Size l = 0; l < kLanes; ++l) {
        beta[l] = 0.0;
        if (!is_open[l]) continue;
        results[l].iterations = iteration;
        results[l].is_converged = squared[l] <= enough * load_squared[l];
        is_open[l] = !results[l].is_converged && next_rho[l] > 0.0 && std::isfinite(next_rho[l]);
        if (is_open[l]) beta[l] = next_rho[l] / rho[l];
        rho[l] = next_rho[l];
      }
    }
    finish(results);
    return results;
  }

 private:
  static constexpr bool is_single() { return std::is_same_v<Scalar, float>; }

  const Scalar* entries() const {
    if constexpr (is_single())
      return system_.single->data();
    else
      return system_.rows->entries.data();
  }

  /// Sum over all rows of what `add(begin, end, sums)` gives for a chunk, chunk after chunk.
  template <Size kSums, class Add>
  std::array<Lane<kLanes>, kSums> sum_chunks(const Add& add) {
    std::vector<std::array<Lane<kLanes>, kSums>> partial((rows_ + kRowGrain - 1) / kRowGrain);
    core::parallel_chunks(rows_, kRowGrain, [&](Size begin, Size end) {
      std::array<Lane<kLanes>, kSums> sums{};
      add(begin, end, sums);
      partial[begin / kRowGrain] = sums;
    });
    std::array<Lane<kLanes>, kSums> whole{};
    for (const auto& sums : partial)
      for (Size s = 0; s < kSums; ++s)
        for (Size l = 0; l < kLanes; ++l) whole[s][l] += sums[s][l];
    return whole;
  }

  Lane<kLanes> squares(const std::vector<Scalar>& v) {
    return sum_chunks<1>([&](Size begin, Size end, std::array<Lane<kLanes>, 1>& sums) {
      for (Size i = 3 * begin; i < 3 * end; ++i)
        for (Size l = 0; l < kLanes; ++l) sums[0][l] += double{v[i * kLanes + l]} * v[i * kLanes + l];
    })[0];
  }

  /// From the guesses: each that is nearer than nothing is.
  void start_from(std::span<const Load> loads) {
    if (std::none_of(loads.begin(), loads.end(), [](const Load& load) { return load.guess != nullptr; }))
      return;
    for (Size l = 0; l < count_; ++l) {
      if (!loads[l].guess) continue;
      for (Size i = 0; i < 3 * rows_; ++i)
        x_[i * kLanes + l] = static_cast<Scalar>((*loads[l].guess)(static_cast<Eigen::Index>(i)) / unit_[l]);
    }
    hold(x_, 0, rows_);
    core::parallel_chunks(rows_, kRowGrain, [&](Size begin, Size end) {
      multiply(x_, q_, begin, end);
      for (Size i = 3 * kLanes * begin; i < 3 * kLanes * end; ++i) r_[i] = b_[i] - q_[i];
    });
    project(r_);
    const Lane<kLanes> before = squares(b_), after = squares(r_);
    for (Size l = 0; l < kLanes; ++l) {
      if (after[l] < before[l]) continue;
      for (Size i = l; i < size_; i += kLanes) {
        x_[i] = Scalar{0};
        r_[i] = b_[i];
      }
    }
  }

  /// Takes out of rows [begin, end) what holds do not allow.
  void hold(std::vector<Scalar>& v, Size begin, Size end) const {
    for (Size row = begin; row < end; ++row) {
      if (system_.hold_of[row] < 0) continue;
      const Mat3& allowed = system_.holds[at(system_.hold_of[row])].allowed;
      for (Size l = 0; l < kLanes; ++l) {
        Scalar* const u = &v[3 * row * kLanes + l];
        const Vec3 held = allowed * Vec3(u[0], u[kLanes], u[2 * kLanes]);
        for (Size a = 0; a < 3; ++a) u[a * kLanes] = static_cast<Scalar>(held(static_cast<Eigen::Index>(a)));
      }
    }
  }

  void project(std::vector<Scalar>& v) const {
    if (!system_.project) return;
    VecX lane(static_cast<Eigen::Index>(3 * rows_));
    for (Size l = 0; l < count_; ++l) {
      for (Size i = 0; i < 3 * rows_; ++i) lane(static_cast<Eigen::Index>(i)) = v[i * kLanes + l];
      system_.project(lane);
      for (Size i = 0; i < 3 * rows_; ++i)
        v[i * kLanes + l] = static_cast<Scalar>(lane(static_cast<Eigen::Index>(i)));
    }
  }

  /// z = inverse r, and what the clusters answer; returns r . z and r . r.
  std::array<Lane<kLanes>, 2> precondition() {
    const CoarseModes* const coarse = system_.coarse_factor ? system_.coarse : nullptr;
    std::vector<double> amounts;
    if (coarse) amounts = coarse->answer(*system_.coarse_factor, r_, kLanes);
    return sum_chunks<2>([&](Size begin, Size end, std::array<Lane<kLanes>, 2>& sums) {
      for (Size row = begin; row < end; ++row) {
        Scalar inverse[9];
        for (Size i = 0; i < 9; ++i) inverse[i] = static_cast<Scalar>(system_.inverse[9 * row + i]);
        const Scalar* const r = &r_[3 * row * kLanes];
        Scalar* const z = &z_[3 * row * kLanes];
        for (Size a = 0; a < 3; ++a)
          for (Size l = 0; l < kLanes; ++l)
            z[a * kLanes + l] = (inverse[3 * a] * r[l] + inverse[3 * a + 1] * r[kLanes + l]) +
                                inverse[3 * a + 2] * r[2 * kLanes + l];
        if (coarse) coarse->template add<kLanes>(amounts, row, z);
        for (Size i = 0; i < 3; ++i)
          for (Size l = 0; l < kLanes; ++l) {
            sums[0][l] += double{r[i * kLanes + l]} * z[i * kLanes + l];
            sums[1][l] += double{r[i * kLanes + l]} * r[i * kLanes + l];
          }
      }
    });
  }

  /// p = z + beta p.
  void turn_direction(const Lane<kLanes>& beta) {
    const std::array<Scalar, kLanes> factor = narrow(beta);
    core::parallel_chunks(rows_, kRowGrain, [&](Size begin, Size end) {
      for (Size i = 3 * begin; i < 3 * end; ++i)
        for (Size l = 0; l < kLanes; ++l)
          p_[i * kLanes + l] = z_[i * kLanes + l] + factor[l] * p_[i * kLanes + l];
    });
  }

  void multiply(const std::vector<Scalar>& x, std::vector<Scalar>& product, Size begin, Size end) const {
    multiply_rows<kLanes>(*system_.rows, entries(), begin, end, x.data(), product.data());
    if (!system_.inertia.empty())
      for (Size row = begin; row < end; ++row) {
        const auto inertia = static_cast<Scalar>(system_.inertia[row]);
        for (Size i = 3 * row * kLanes; i < 3 * (row + 1) * kLanes; ++i) product[i] += inertia * x[i];
      }
    hold(product, begin, end);
  }

  /// q = A p; returns p . q.
  Lane<kLanes> multiply_direction() {
    return sum_chunks<1>([this](Size begin, Size end, std::array<Lane<kLanes>, 1>& sums) {
      multiply(p_, q_, begin, end);
      for (Size i = 3 * begin; i < 3 * end; ++i)
        for (Size l = 0; l < kLanes; ++l) sums[0][l] += double{p_[i * kLanes + l]} * q_[i * kLanes + l];
    })[0];
  }

  /// x += step p, r -= step q.
  void advance(const Lane<kLanes>& step) {
    const std::array<Scalar, kLanes> factor = narrow(step);
    core::parallel_chunks(rows_, kRowGrain, [&](Size begin, Size end) {
      for (Size i = 3 * begin; i < 3 * end; ++i)
        for (Size l = 0; l < kLanes; ++l) {
          x_[i * kLanes + l] += factor[l] * p_[i * kLanes + l];
          r_[i * kLanes + l] -= factor[l] * q_[i * kLanes + l];
        }
    });
  }

  static std::array<Scalar, kLanes> narrow(const Lane<kLanes>& values) {
    std::array<Scalar, kLanes> out{};
    for (Size l = 0; l < kLanes; ++l) out[l] = static_cast<Scalar>(values[l]);
    return out;
  }

  /// The answers and, with all digits of the matrix, what they leave.
  void finish(std::vector<GradientResult>& results) {
    if constexpr (is_single()) {
      Solver<kLanes, double> check(system_, count_);
      for (Size i = 0; i < size_; ++i) {
        check.b_[i] = b_[i] * unit_[i % kLanes];
        check.x_[i] = x_[i] * unit_[i % kLanes];
      }
      check.finish(results);
    } else {
      const Lane<kLanes> load_squared = squares(b_);
      const Lane<kLanes> squared =
          sum_chunks<1>([this](Size begin, Size end, std::array<Lane<kLanes>, 1>& sums) {
            multiply(x_, q_, begin, end);
            for (Size i = 3 * begin; i < 3 * end; ++i)
              for (Size l = 0; l < kLanes; ++l) {
                const double left = b_[i * kLanes + l] - q_[i * kLanes + l];
                sums[0][l] += left * left;
              }
          })[0];
      for (Size l = 0; l < count_; ++l) {
        GradientResult& result = results[l];
        const auto copy = [&](const std::vector<double>& from, VecX& to) {
          to.resize(static_cast<Eigen::Index>(3 * rows_));
          for (Size i = 0; i < 3 * rows_; ++i) to(static_cast<Eigen::Index>(i)) = from[i * kLanes + l];
        };
        copy(x_, result.x);
        copy(q_, result.image);
        if (load_squared[l] > 0.0) result.residual = core::sqrt(squared[l] / load_squared[l]);
      }
    }
  }

  template <Size, class>
  friend class Solver;
  Solver(const BlockSystem& system, Size count)
      : system_(system), rows_(system.rows->size()), count_(count), size_(3 * rows_ * kLanes) {
    for (std::vector<Scalar>* v : {&b_, &x_, &q_}) v->assign(size_, Scalar{0});
    unit_.fill(1.0);
  }

  const BlockSystem& system_;
  Size rows_, count_, size_;
  Lane<kLanes> unit_{};  // of each load
  std::vector<Scalar> b_, x_, r_, z_, p_, q_;
};

template <class Scalar>
std::vector<GradientResult> solve_some(const BlockSystem& system, std::span<const Load> loads,
                                       const GradientSettings& settings) {
  constexpr Size kMost = 4;
  std::vector<GradientResult> results(loads.size());
  core::parallel_chunks(loads.size(), kMost, [&](Size first, Size last) {
    const auto some = loads.subspan(first, last - first);
    // In single precision four lanes are one register, and cost less than two.
    constexpr Size kFew = std::is_same_v<Scalar, float> ? kMost : 2;
    std::vector<GradientResult> own = some.size() == 1 ? Solver<1, Scalar>(system, some).run(settings)
                                      : some.size() <= kFew
                                          ? Solver<kFew, Scalar>(system, some).run(settings)
                                          : Solver<kMost, Scalar>(system, some).run(settings);
    std::move(own.begin(), own.end(), results.begin() + static_cast<std::ptrdiff_t>(first));
  });
  return results;
}

}  // namespace

void invert_diagonal(BlockSystem& system) {
  const BlockRows& rows = *system.rows;
  system.inverse.assign(9 * rows.size(), 0.0);
  core::parallel_for(rows.size(), kRowGrain, [&](Size row) {
    if (rows.first[row] == rows.first[row + 1]) return;
    Mat3 block;
    for (int i = 0; i < 9; ++i) block(i / 3, i % 3) = rows.entries[9 * at(rows.first[row]) + at(i)];
    if (!system.inertia.empty()) block.diagonal().array() += system.inertia[row];
    const double scale = block.trace() / 3.0;
    if (!(scale > 0.0)) return;
    block /= scale;
    Mat3 allowed = Mat3::Identity();
    if (system.hold_of[row] >= 0) allowed = system.holds[at(system.hold_of[row])].allowed;
    // Identity on what is not allowed makes it invertible; the projections take that out again.
    Mat3 filled = allowed * block * allowed + (Mat3::Identity() - allowed);
    if (!(filled.determinant() > 1e-12)) filled = filled.diagonal().asDiagonal();
    const Mat3 inverse = allowed * filled.inverse() * allowed / scale;
    for (int i = 0; i < 9; ++i) system.inverse[9 * row + at(i)] = inverse(i / 3, i % 3);
  });
}

std::vector<GradientResult> solve_by_gradients(const BlockSystem& system, std::span<const VecX> loads,
                                               const GradientSettings& settings,
                                               std::span<const VecX> guesses) {
  std::vector<Load> all;
  for (Size l = 0; l < loads.size(); ++l)
    all.push_back({&loads[l], l < guesses.size() && guesses[l].size() > 0 ? &guesses[l] : nullptr});
  if (!system.single || settings.tolerance < kLeastSingleTolerance)
    return solve_some<double>(system, all, settings);
  std::vector<GradientResult> results = solve_some<float>(system, all, settings);
  std::vector<Load> again;
  std::vector<Size> which;
  for (Size l = 0; l < all.size(); ++l)
    if (!results[l].is_converged || !(results[l].residual <= kSingleExcess * settings.tolerance)) {
      again.push_back(all[l]);
      which.push_back(l);
    }
  std::vector<GradientResult> better = solve_some<double>(system, again, settings);
  for (Size i = 0; i < which.size(); ++i) results[which[i]] = std::move(better[i]);
  return results;
}

}  // namespace shatterbox::stress
