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

/// A load's pieces and their unit loads, in a row with those of the other loads.
struct Groups {
  std::vector<double> weights;
  int first = 0;
};

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

std::vector<ContactAnswer> press(const stress::ShellSystem& system, const geometry::ShellMesh& mesh,
                                 const std::vector<geometry::CellContact>& contacts, const VecX& mass,
                                 const std::vector<ContactPress>& loads) {
  std::vector<Groups> groups;
  std::vector<VecX> forces;
  for (const ContactPress& load : loads) {
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
    Groups own;
    own.first = static_cast<int>(forces.size());
    for (const int g : heaviest) {
      own.weights.push_back(weight[at(g)]);
      forces.push_back(stress::group_load(mesh, patch, group_of_share, g, load.direction));
    }
    groups.push_back(std::move(own));
  }
  const std::vector<stress::ShellSolution> solutions = system.solve(forces);

  std::vector<ContactAnswer> answers;
  const double screening_squared = system.screening() * system.screening();
  for (Size l = 0; l < loads.size(); ++l) {
    const Groups& own = groups[l];
    const auto n = static_cast<Eigen::Index>(own.weights.size());
    Eigen::MatrixXd flexibility(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        flexibility(i, j) = forces[at(own.first) + static_cast<Size>(i)].dot(
            solutions[at(own.first) + static_cast<Size>(j)].displacement);
    flexibility = (0.5 * (flexibility + flexibility.transpose())).eval();
    Eigen::MatrixXd pressed = flexibility;
    for (Eigen::Index i = 0; i < n; ++i)
      pressed(i, i) += loads[l].hertz_compliance / own.weights[static_cast<Size>(i)];
    std::vector<int> all(own.weights.size());
    std::iota(all.begin(), all.end(), 0);
    const Eigen::VectorXd shares = share_force(pressed, all);
    ContactAnswer answer;
    answer.displacement = VecX::Zero(mesh.degree_of_freedom_count());
    for (Eigen::Index i = 0; i < n; ++i) {
      const stress::ShellSolution& solution = solutions[at(own.first) + static_cast<Size>(i)];
      answer.residual = std::max(answer.residual, solution.residual);
      if (shares[i] == 0.0) continue;
      answer.displacement += shares[i] * solution.displacement;
      ++answer.groups;
    }
    answer.compliance = shares.dot(flexibility * shares);
    const double inertial = screening_squared * (mass.array() * answer.displacement.array().square()).sum();
    answer.elastic_compliance = std::max(0.0, answer.compliance - inertial);
    answers.push_back(std::move(answer));
  }
  return answers;
}

}  // namespace shatterbox::fracture
