// Compliances without displacements: load . (K + s^2 M)^-1 load is |L^-1 load|^2, half a solve.
#include <algorithm>
#include <array>

#include "engine/core/parallel.h"
#include "engine/stress/front_tiles.h"
#include "engine/stress/shell_system_state.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;

}  // namespace

double ShellSystem::State::rigid_compliance(const RigidModes::Amounts& a,
                                            const RigidModes::Amounts& b) const {
  if (is_balanced()) return 0.0;
  double sum = 0.0;
  for (Size part = 0; part < a.size(); ++part) sum += a[part].dot(b[part]);
  return sum / screening_squared;
}

/// L^-1 of the loads [first, first + 4), each relieved of the rigid motions that are split off.
ShellSystem::State::Half ShellSystem::State::solve_half(const std::vector<VecX>& loads, Size first) const {
  Half half{SolveLanes(structure->tree, kMostLanes), {}};
  const Size count = std::min(kMostLanes, loads.size() - first);
  for (Size l = 0; l < count; ++l) {
    VecX b = scaled(loads[first + l]);
    RigidModes::Amounts amounts = structure->rigid.resultants(b);
    for (Size part = 0; part < amounts.size(); ++part)
      if (is_split[part] == 0) amounts[part].setZero();
    structure->rigid.subtract(b, amounts);
    put_lane(b, l, half.y);
    half.rigid.push_back(std::move(amounts));
  }
  solve_forward(structure->tree, *factor, half.y);
  return half;
}

Eigen::MatrixXd ShellSystem::compliance_matrix(const std::vector<VecX>& loads,
                                               const std::vector<int>& groups) const {
  const State& state = *state_;
  const Size blocks = (loads.size() + kMostLanes - 1) / kMostLanes;
  std::vector<std::optional<State::Half>> halves(blocks);
  core::parallel_for(blocks, 1, [&](Size b) { halves[b] = state.solve_half(loads, kMostLanes * b); });
  const auto n = static_cast<Eigen::Index>(loads.size());
  Eigen::MatrixXd compliance = Eigen::MatrixXd::Zero(n, n);
  core::parallel_for(blocks, 1, [&](Size b) {
    for (Size a = 0; a <= b; ++a) {
      const auto is_wanted = [&](Size i, Size j) {
        return i < loads.size() && j < loads.size() && groups[i] == groups[j];
      };
      bool is_any = false;
      for (Size k = 0; k < kMostLanes * kMostLanes; ++k)
        is_any = is_any || is_wanted(kMostLanes * b + k / kMostLanes, kMostLanes * a + k % kMostLanes);
      if (!is_any) continue;
      const tiles::Tile products = tiles::multiply(halves[b]->y.values.data(), halves[a]->y.values.data(),
                                                   state.structure->tree.unknowns);
      for (Size k = 0; k < kMostLanes * kMostLanes; ++k) {
        const Size row = k / kMostLanes, column = k % kMostLanes;
        const Size i = kMostLanes * b + row, j = kMostLanes * a + column;
        if (!is_wanted(i, j) || j > i) continue;
        double sum = row < 2 ? products.low[column][row] : products.high[column][row - 2];
        sum += state.rigid_compliance(halves[b]->rigid[row], halves[a]->rigid[column]);
        compliance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = sum;
      }
    }
  });
  compliance.triangularView<Eigen::StrictlyUpper>() = compliance.transpose();
  return compliance * (state.structure->stiffness->force_unit() * state.structure->stiffness->length);
}

std::vector<LoadCompliance> ShellSystem::compliances(const std::vector<VecX>& loads) const {
  const State& state = *state_;
  const double unit = state.structure->stiffness->force_unit() * state.structure->stiffness->length;
  std::vector<LoadCompliance> result(loads.size());
  core::parallel_chunks(loads.size(), kMostLanes, [&](Size begin, Size end) {
    State::Half half = state.solve_half(loads, begin);
    SolveLanes& x = half.y;
    std::array<double, kMostLanes> total{}, inertial{};
    for (Size i = 0; i < x.values.size(); ++i) total[i % kMostLanes] += x.values[i] * x.values[i];
    solve_backward(state.structure->tree, *state.factor, x);
    for (Size i = 0; i < x.values.size(); ++i)
      inertial[i % kMostLanes] += state.diagonal[i / kMostLanes] * x.values[i] * x.values[i];
    for (Size l = 0; begin + l < end; ++l) {
      result[begin + l].elastic = unit * std::max(0.0, total[l] - inertial[l]);
      result[begin + l].total = unit * (total[l] + state.rigid_compliance(half.rigid[l], half.rigid[l]));
    }
  });
  return result;
}

}  // namespace shatterbox::stress
