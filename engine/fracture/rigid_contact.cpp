#include "engine/fracture/rigid_contact.h"

#include <algorithm>
#include <numeric>

#include <Eigen/Cholesky>

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
Size at(int i) {
  return static_cast<Size>(i);
}

constexpr int kMostGroups = 24;        // pieces that share one load; the lightest beyond that carry nothing
constexpr double kLeastWeight = 0.01;  // nor do those with less than this share of the patch

/// Shares p of the total force under which all pieces sink equally, none of them pulled; they sum to 1.
Eigen::VectorXd share_force(const Eigen::MatrixXd& flexibility, std::vector<int> active) {
  const auto total = flexibility.rows();
  for (;;) {
    const auto n = static_cast<Eigen::Index>(active.size());
    Eigen::MatrixXd matrix(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        matrix(i, j) = flexibility(active[static_cast<Size>(i)], active[static_cast<Size>(j)]);
    const Eigen::VectorXd solved = matrix.ldlt().solve(Eigen::VectorXd::Ones(n));
    std::vector<int> kept;
    for (Eigen::Index i = 0; i < n; ++i)
      if (solved[i] > 0.0) kept.push_back(active[static_cast<Size>(i)]);
    if (kept.size() == active.size() || kept.empty()) {
      Eigen::VectorXd shares = Eigen::VectorXd::Zero(total);
      const double sum = kept.empty() ? 0.0 : solved.sum();
      for (Eigen::Index i = 0; i < n; ++i)
        shares[active[static_cast<Size>(i)]] = sum > 0.0 ? solved[i] / sum : 1.0 / static_cast<double>(n);
      return shares;
    }
    active = kept;
  }
}

}  // namespace

PressGroups find_press_groups(const geometry::ShellMesh& mesh,
                              const std::vector<geometry::CellContact>& contacts, const ContactPress& load) {
  const stress::LoadPatch patch = stress::find_load_patch(mesh, load.point, load.radius);
  const std::vector<int> group_of_share = stress::group_patch(patch, contacts);
  const int count =
      group_of_share.empty() ? 0 : *std::max_element(group_of_share.begin(), group_of_share.end()) + 1;
  std::vector<int> heaviest(at(count));
  std::iota(heaviest.begin(), heaviest.end(), 0);
  std::vector<double> weight(at(count));
  for (int g = 0; g < count; ++g) weight[at(g)] = stress::group_weight(patch, group_of_share, g);
  std::sort(heaviest.begin(), heaviest.end(), [&](int a, int b) {
    return weight[at(a)] != weight[at(b)] ? weight[at(a)] > weight[at(b)] : a < b;
  });
  if (count > kMostGroups) heaviest.resize(kMostGroups);
  while (heaviest.size() > 1 && weight[at(heaviest.back())] < kLeastWeight) heaviest.pop_back();
  std::sort(heaviest.begin(), heaviest.end());
  PressGroups groups;
  groups.hertz_compliance = load.hertz_compliance;
  for (const int g : heaviest) {
    groups.weights.push_back(weight[at(g)]);
    groups.forces.push_back(stress::group_load(mesh, patch, group_of_share, g, load.direction));
  }
  return groups;
}

namespace {

/// One load's answer from those of its pieces: `solutions` are |pieces| long.
ContactAnswer combine(const PressGroups& load, const stress::ShellSolution* solutions, const VecX& mass,
                      double screening_squared) {
  const auto n = static_cast<Eigen::Index>(load.weights.size());
  Eigen::MatrixXd flexibility(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      flexibility(i, j) = load.forces[static_cast<Size>(i)].dot(solutions[j].displacement);
  flexibility = (0.5 * (flexibility + flexibility.transpose())).eval();
  Eigen::MatrixXd pressed = flexibility;
  for (Eigen::Index i = 0; i < n; ++i)
    pressed(i, i) += load.hertz_compliance / load.weights[static_cast<Size>(i)];
  std::vector<int> all(load.weights.size());
  std::iota(all.begin(), all.end(), 0);
  const Eigen::VectorXd shares = share_force(pressed, all);
  ContactAnswer answer;
  answer.displacement = VecX::Zero(mass.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    answer.residual = std::max(answer.residual, solutions[i].residual);
    if (shares[i] == 0.0) continue;
    answer.displacement += shares[i] * solutions[i].displacement;
    ++answer.groups;
  }
  answer.compliance = shares.dot(flexibility * shares);
  const double inertial = screening_squared * (mass.array() * answer.displacement.array().square()).sum();
  answer.elastic_compliance = std::max(0.0, answer.compliance - inertial);
  return answer;
}

}  // namespace

std::vector<ContactAnswer> press(const stress::ShellSystem& system, const VecX& mass,
                                 const std::vector<PressGroups>& loads) {
  std::vector<VecX> forces;
  for (const PressGroups& load : loads) forces.insert(forces.end(), load.forces.begin(), load.forces.end());
  const std::vector<stress::ShellSolution> solutions = system.solve(forces, kVerdictResidual);
  const double screening_squared = system.screening() * system.screening();
  std::vector<ContactAnswer> answers;
  const stress::ShellSolution* next = solutions.data();
  for (const PressGroups& load : loads) {
    answers.push_back(combine(load, next, mass, screening_squared));
    next += load.forces.size();
  }
  return answers;
}

}  // namespace shatterbox::fracture
