#include "engine/fracture/rigid_contact.h"

#include <algorithm>
#include <numeric>

#include <Eigen/Cholesky>

#include "engine/core/index.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr Size kMostGroups = 24;       // pieces that share one load; the lightest beyond that carry nothing
constexpr double kLeastWeight = 0.01;  // nor do those with less than this share of the patch

/// Shares p of the total force under which all pieces sink equally, none of them pulled; they sum to 1.
Eigen::VectorXd share_among(const Eigen::MatrixXd& flexibility, std::vector<int> active) {
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

std::vector<int> heaviest_groups(const std::vector<double>& weight, Size most) {
  std::vector<int> heaviest(weight.size());
  std::iota(heaviest.begin(), heaviest.end(), 0);
  std::sort(heaviest.begin(), heaviest.end(), [&](int a, int b) {
    return weight[at(a)] != weight[at(b)] ? weight[at(a)] > weight[at(b)] : a < b;
  });
  if (heaviest.size() > most) heaviest.resize(most);
  while (heaviest.size() > 1 && weight[at(heaviest.back())] < kLeastWeight) heaviest.pop_back();
  std::sort(heaviest.begin(), heaviest.end());
  return heaviest;
}

Eigen::VectorXd share_force(const PressGroups& load, const Eigen::MatrixXd& flexibility) {
  Eigen::MatrixXd pressed = flexibility;
  for (Eigen::Index i = 0; i < pressed.rows(); ++i)
    pressed(i, i) += load.hertz_compliance / load.weights[static_cast<Size>(i)];
  std::vector<int> all(load.weights.size());
  std::iota(all.begin(), all.end(), 0);
  return share_among(pressed, std::move(all));
}

PressGroups find_press_groups(const geometry::ShellMesh& mesh,
                              const std::vector<geometry::CellContact>& contacts, const ContactPress& load) {
  const stress::LoadPatch patch = stress::find_load_patch(mesh, load.point, load.radius);
  const std::vector<int> group_of_share = stress::group_patch(patch, contacts);
  const int count =
      group_of_share.empty() ? 0 : *std::max_element(group_of_share.begin(), group_of_share.end()) + 1;
  std::vector<double> weight(at(count));
  for (int g = 0; g < count; ++g) weight[at(g)] = stress::group_weight(patch, group_of_share, g);
  PressGroups groups;
  groups.hertz_compliance = load.hertz_compliance;
  for (const int g : heaviest_groups(weight, kMostGroups)) {
    groups.weights.push_back(weight[at(g)]);
    groups.forces.push_back(stress::group_load(mesh, patch, group_of_share, g, load.direction));
  }
  return groups;
}

namespace {

/// One load's answer from the flexibility of its pieces (|pieces| x |pieces|).
ContactAnswer combine(const PressGroups& load, const Eigen::MatrixXd& flexibility) {
  const Eigen::VectorXd shares = share_force(load, flexibility);
  ContactAnswer answer;
  answer.load = VecX::Zero(load.forces.front().size());
  for (Eigen::Index i = 0; i < shares.size(); ++i)
    if (shares[i] != 0.0) answer.load += shares[i] * load.forces[static_cast<Size>(i)];
  answer.compliance = answer.elastic_compliance = shares.dot(flexibility * shares);
  return answer;
}

}  // namespace

std::vector<ContactAnswer> press(const stress::ShellSystem& system, const std::vector<PressGroups>& loads,
                                 bool wants_elastic) {
  const bool is_whole_wanted = wants_elastic && system.screening() > 0.0;
  std::vector<VecX> forces;
  std::vector<int> owners;
  for (Size l = 0; l < loads.size(); ++l) {
    if (is_whole_wanted && loads[l].forces.size() == 1) continue;
    forces.insert(forces.end(), loads[l].forces.begin(), loads[l].forces.end());
    owners.resize(forces.size(), static_cast<int>(l));
  }
  const Eigen::MatrixXd flexibility = system.compliance_matrix(forces, owners);
  std::vector<ContactAnswer> answers(loads.size());
  Eigen::Index next = 0;
  for (Size l = 0; l < loads.size(); ++l) {
    if (is_whole_wanted && loads[l].forces.size() == 1) {
      answers[l].load = loads[l].forces.front();
      continue;
    }
    const auto n = static_cast<Eigen::Index>(loads[l].forces.size());
    answers[l] = combine(loads[l], flexibility.block(next, next, n, n));
    next += n;
  }
  if (system.screening() == 0.0) return answers;
  for (ContactAnswer& answer : answers) answer.elastic_compliance = 0.0;
  if (!is_whole_wanted) return answers;
  std::vector<VecX> shared;
  for (const ContactAnswer& answer : answers) shared.push_back(answer.load);
  const std::vector<stress::LoadCompliance> compliances = system.compliances(shared);
  for (Size l = 0; l < loads.size(); ++l) {
    answers[l].compliance = compliances[l].total;
    answers[l].elastic_compliance = compliances[l].elastic;
  }
  return answers;
}

VecX share_load(const stress::ShellSystem& system, const PressGroups& load) {
  if (load.forces.size() == 1) return load.forces.front();
  return press(system, {load}, false).front().load;
}

}  // namespace shatterbox::fracture
