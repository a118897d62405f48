#include "engine/stress/block_gradients.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/core/stop.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

constexpr int kProjectEvery = 20;  // iterations; rounding lets the null space grow slowly

template <Size kLanes>
using Lane = std::array<double, kLanes>;

/// The work on kLanes loads at once; entry i of lane l is at i kLanes + l.
template <Size kLanes>
class Solver {
 public:
  Solver(const BlockSystem& system, std::span<const VecX> loads)
      : system_(system), rows_(system.rows->size()), count_(loads.size()), size_(3 * rows_ * kLanes) {
    for (std::vector<double>* v : {&b_, &x_, &r_, &z_, &p_, &q_}) v->assign(size_, 0.0);
    for (Size l = 0; l < count_; ++l)
      for (Size i = 0; i < 3 * rows_; ++i) b_[i * kLanes + l] = loads[l](static_cast<Eigen::Index>(i));
    hold(b_, 0, rows_);
    project(b_);
    r_ = b_;
  }

  std::vector<GradientResult> run(const GradientSettings& settings) {
    std::vector<GradientResult> results(count_);
    const auto [first_rho, load_squared] = precondition();
    Lane<kLanes> rho = first_rho, beta{};
    std::array<bool, kLanes> is_open{};
    for (Size l = 0; l < count_; ++l) {
      is_open[l] = rho[l] > 0.0 && std::isfinite(rho[l]);
      results[l].is_converged = load_squared[l] == 0.0;
    }
    const double enough = settings.tolerance * settings.tolerance;
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
    finish(results, load_squared);
    return results;
  }

 private:
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

  /// Takes out of rows [begin, end) what holds do not allow.
  void hold(std::vector<double>& v, Size begin, Size end) const {
    for (Size row = begin; row < end; ++row) {
      if (system_.hold_of[row] < 0) continue;
      const Mat3& allowed = system_.holds[at(system_.hold_of[row])].allowed;
      for (Size l = 0; l < kLanes; ++l) {
        double* const u = &v[3 * row * kLanes + l];
        const Vec3 held = allowed * Vec3(u[0], u[kLanes], u[2 * kLanes]);
        for (Size a = 0; a < 3; ++a) u[a * kLanes] = held(static_cast<Eigen::Index>(a));
      }
    }
  }

  void project(std::vector<double>& v) const {
    if (!system_.project) return;
    VecX lane(static_cast<Eigen::Index>(3 * rows_));
    for (Size l = 0; l < count_; ++l) {
      for (Size i = 0; i < 3 * rows_; ++i) lane(static_cast<Eigen::Index>(i)) = v[i * kLanes + l];
      system_.project(lane);
      for (Size i = 0; i < 3 * rows_; ++i) v[i * kLanes + l] = lane(static_cast<Eigen::Index>(i));
    }
  }

  /// z = inverse r, and what the clusters answer; returns r . z and r . r.
  std::array<Lane<kLanes>, 2> precondition() {
    const CoarseModes* const coarse = system_.coarse_factor ? system_.coarse : nullptr;
    std::vector<double> amounts;
    if (coarse) amounts = coarse->answer(*system_.coarse_factor, r_, kLanes);
    return sum_chunks<2>([&](Size begin, Size end, std::array<Lane<kLanes>, 2>& sums) {
      for (Size row = begin; row < end; ++row) {
        const double* const inverse = &system_.inverse[9 * row];
        const double* const r = &r_[3 * row * kLanes];
        double* const z = &z_[3 * row * kLanes];
        for (Size a = 0; a < 3; ++a)
          for (Size l = 0; l < kLanes; ++l)
            z[a * kLanes + l] = (inverse[3 * a] * r[l] + inverse[3 * a + 1] * r[kLanes + l]) +
                                inverse[3 * a + 2] * r[2 * kLanes + l];
        if (coarse) coarse->add<kLanes>(amounts, row, z);
        for (Size i = 0; i < 3; ++i)
          for (Size l = 0; l < kLanes; ++l) {
            sums[0][l] += r[i * kLanes + l] * z[i * kLanes + l];
            sums[1][l] += r[i * kLanes + l] * r[i * kLanes + l];
          }
      }
    });
  }

  /// p = z + beta p.
  void turn_direction(const Lane<kLanes>& beta) {
    core::parallel_chunks(rows_, kRowGrain, [&](Size begin, Size end) {
      for (Size i = 3 * begin; i < 3 * end; ++i)
        for (Size l = 0; l < kLanes; ++l)
          p_[i * kLanes + l] = z_[i * kLanes + l] + beta[l] * p_[i * kLanes + l];
    });
  }

  void multiply(const std::vector<double>& x, std::vector<double>& product, Size begin, Size end) const {
    multiply_rows<kLanes>(*system_.rows, begin, end, x.data(), product.data());
    if (!system_.inertia.empty())
      for (Size row = begin; row < end; ++row)
        for (Size i = 3 * row * kLanes; i < 3 * (row + 1) * kLanes; ++i)
          product[i] += system_.inertia[row] * x[i];
    hold(product, begin, end);
  }

  /// q = A p; returns p . q.
  Lane<kLanes> multiply_direction() {
    return sum_chunks<1>([this](Size begin, Size end, std::array<Lane<kLanes>, 1>& sums) {
      multiply(p_, q_, begin, end);
      for (Size i = 3 * begin; i < 3 * end; ++i)
        for (Size l = 0; l < kLanes; ++l) sums[0][l] += p_[i * kLanes + l] * q_[i * kLanes + l];
    })[0];
  }

  /// x += step p, r -= step q.
  void advance(const Lane<kLanes>& step) {
    core::parallel_chunks(rows_, kRowGrain, [&](Size begin, Size end) {
      for (Size i = 3 * begin; i < 3 * end; ++i)
        for (Size l = 0; l < kLanes; ++l) {
          x_[i * kLanes + l] += step[l] * p_[i * kLanes + l];
          r_[i * kLanes + l] -= step[l] * q_[i * kLanes + l];
        }
    });
  }

  void finish(std::vector<GradientResult>& results, const Lane<kLanes>& load_squared) {
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

  const BlockSystem& system_;
  Size rows_, count_, size_;
  std::vector<double> b_, x_, r_, z_, p_, q_;
};

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
                                               const GradientSettings& settings) {
  constexpr Size kMost = 4;
  std::vector<GradientResult> results;
  results.reserve(loads.size());
  for (Size first = 0; first < loads.size(); first += kMost) {
    const auto some = loads.subspan(first, std::min(kMost, loads.size() - first));
    std::vector<GradientResult> own = some.size() == 1   ? Solver<1>(system, some).run(settings)
                                      : some.size() == 2 ? Solver<2>(system, some).run(settings)
                                                         : Solver<kMost>(system, some).run(settings);
    std::move(own.begin(), own.end(), std::back_inserter(results));
  }
  return results;
}

}  // namespace shatterbox::stress
