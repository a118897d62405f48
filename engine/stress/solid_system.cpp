#include "engine/stress/solid_system.h"

#include <algorithm>
#include <mutex>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/stress/part_system.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

}  // namespace

struct SolidSystem::State {
  /// A connected part of the mesh by itself.
  struct Part {
    std::vector<int> vertices;  // of the whole mesh, ascending: which its own are
    geometry::SolidMesh mesh;
    SolidSystemOptions options;
    std::unique_ptr<const PartSystem> system;

    VecX gather(const VecX& whole) const {
      VecX own(static_cast<Eigen::Index>(3 * vertices.size()));
      for (Size v = 0; v < vertices.size(); ++v)
        own.segment<3>(static_cast<Eigen::Index>(3 * v)) = whole.segment<3>(3 * vertices[v]);
      return own;
    }
    void scatter(const VecX& own, VecX& whole) const {
      for (Size v = 0; v < vertices.size(); ++v)
        whole.segment<3>(3 * vertices[v]) = own.segment<3>(static_cast<Eigen::Index>(3 * v));
    }
  };

  std::shared_ptr<const SolidStiffness> stiffness;
  std::vector<int> part_of;  // |V|, -1 for vertices in no cell
  std::vector<Part> parts;
  mutable std::once_flag has_period;
  mutable double period = 0.0;

  void divide(const geometry::SolidMesh& mesh, const SolidSystemOptions& options);
  VecX zero() const { return VecX::Zero(static_cast<Eigen::Index>(3 * part_of.size())); }
  std::vector<std::vector<Size>> loads_of_parts(const std::vector<VecX>& loads) const;
  void add(const Part& part, const SolidSolution& own, SolidSolution& whole) const;
};

SolidSystem::SolidSystem(std::unique_ptr<State> state) : state_(std::move(state)) {}
SolidSystem::~SolidSystem() = default;

core::Result<std::shared_ptr<const SolidSystem>> SolidSystem::make(
    std::shared_ptr<const SolidStiffness> stiffness, const geometry::SolidMesh& mesh,
    const SolidSystemOptions& options) {
  if (mesh.cells.empty()) return core::Error{"a solid without cells has no stress"};
  for (const geometry::SolidCell& cell : mesh.cells)
    if (!(stiffness->solids[at(cell.element)].volume > 0.0))
      return core::Error{"an element of the solid has no volume"};
  auto state = std::make_unique<State>();
  const std::vector<int> part_of_dof = part_of_dofs(mesh);
  for (Size dof = 0; dof < part_of_dof.size(); dof += 3) state->part_of.push_back(part_of_dof[dof]);
  state->divide(mesh, options);
  core::parallel_for(state->parts.size(), 1, [&](Size p) {
    State::Part& part = state->parts[p];
    part.system = std::make_unique<PartSystem>(stiffness, part.mesh, part.options);
    part.mesh = {};
  });
  if (std::none_of(state->parts.begin(), state->parts.end(),
                   [](const State::Part& part) { return part.system->can_move(); }))
    return core::Error{"the support clamps the whole solid"};
  state->stiffness = std::move(stiffness);
  return std::shared_ptr<const SolidSystem>(new SolidSystem(std::move(state)));
}

/// The connected parts of a mesh with what of its support and anchors is theirs, by their first vertices.
void SolidSystem::State::divide(const geometry::SolidMesh& mesh, const SolidSystemOptions& options) {
  const int count = part_of.empty() ? 0 : *std::max_element(part_of.begin(), part_of.end()) + 1;
  parts = std::vector<Part>(at(count));
  std::vector<int> number(part_of.size(), -1);
  for (Size v = 0; v < part_of.size(); ++v) {
    if (part_of[v] < 0) continue;
    Part& part = parts[at(part_of[v])];
    number[v] = static_cast<int>(part.vertices.size());
    part.vertices.push_back(static_cast<int>(v));
    part.mesh.vertex_source.push_back(mesh.vertex_source[v]);
  }
  for (Part& part : parts) {
    part.mesh.elements = mesh.elements;
    part.options.null_space = options.null_space;
  }
  for (geometry::SolidCell cell : mesh.cells) {
    Part& part = parts[at(part_of[at(cell.vertices[0])])];
    for (int& vertex : cell.vertices) vertex = number[at(vertex)];
    part.mesh.cells.push_back(cell);
  }
  for (const int dof : options.support.dofs)
    if (const int v = dof / 3; part_of[at(v)] >= 0)
      parts[at(part_of[at(v)])].options.support.dofs.push_back(3 * number[at(v)] + dof % 3);
  for (const auto& [x1, x2, x3] : options.anchors)
    if (part_of[at(x1)] >= 0)
      parts[at(part_of[at(x1)])].options.anchors.push_back({number[at(x1)], number[at(x2)], number[at(x3)]});
}

/// Which loads are on each part.
std::vector<std::vector<Size>> SolidSystem::State::loads_of_parts(const std::vector<VecX>& loads) const {
  std::vector<std::vector<Size>> on(parts.size());
  for (Size l = 0; l < loads.size(); ++l)
    for (Size v = 0; v < part_of.size(); ++v) {
      if (part_of[v] < 0) continue;
      std::vector<Size>& own = on[at(part_of[v])];
      if ((own.empty() || own.back() != l) &&
          loads[l].segment<3>(static_cast<Eigen::Index>(3 * v)) != Vec3::Zero())
        own.push_back(l);
    }
  return on;
}

/// Adds what a load does to one part to what it does to all.
void SolidSystem::State::add(const Part& part, const SolidSolution& own, SolidSolution& whole) const {
  part.scatter(own.displacement, whole.displacement);
  if (own.rigid_displacement.size() > 0) {
    if (whole.rigid_displacement.size() == 0) whole.rigid_displacement = zero();
    part.scatter(own.rigid_displacement, whole.rigid_displacement);
  }
  whole.compliance += own.compliance;
  whole.elastic_compliance += own.elastic_compliance;
  whole.residual = std::max(whole.residual, own.residual);
  whole.iterations = std::max(whole.iterations, own.iterations);
  if (whole.fault.empty()) whole.fault = own.fault;
}

std::vector<SolidSolution> SolidSystem::solve(const std::vector<VecX>& loads,
                                              const SolidSolveSettings& settings,
                                              const std::vector<VecX>& guesses) const {
  const State& state = *state_;
  const std::vector<std::vector<Size>> loads_on = state.loads_of_parts(loads);
  std::vector<std::vector<SolidSolution>> own(state.parts.size());
  core::parallel_for(state.parts.size(), 1, [&](Size p) {
    if (loads_on[p].empty()) return;
    std::vector<VecX> own_loads, own_guesses;
    for (const Size l : loads_on[p]) {
      own_loads.push_back(state.parts[p].gather(loads[l]));
      const bool has_guess = l < guesses.size() && guesses[l].size() > 0;
      own_guesses.push_back(has_guess ? state.parts[p].gather(guesses[l]) : VecX());
    }
    own[p] = state.parts[p].system->solve(own_loads, settings, own_guesses);
  });
  std::vector<SolidSolution> solutions(loads.size());
  for (SolidSolution& solution : solutions) solution.displacement = state.zero();
  for (Size p = 0; p < own.size(); ++p)
    for (Size i = 0; i < own[p].size(); ++i) state.add(state.parts[p], own[p][i], solutions[loads_on[p][i]]);
  return solutions;
}

SolidSolution SolidSystem::solve(const VecX& load, const SolidSolveSettings& settings) const {
  return solve(std::vector<VecX>{load}, settings).front();
}

VecX SolidSystem::balance(const VecX& load) const {
  VecX balanced = state_->zero();
  for (const State::Part& part : state_->parts)
    part.scatter(part.system->balance(part.gather(load)), balanced);
  return balanced;
}

double SolidSystem::first_period() const {
  std::call_once(state_->has_period, [this] {
    for (const State::Part& part : state_->parts)
      state_->period = std::max(state_->period, part.system->first_period());
  });
  return state_->period;
}

double SolidSystem::trial_period(const SolidSolution& solution) const {
  const State& state = *state_;
  double vibrating = 0.0;
  for (const State::Part& part : state.parts)
    vibrating += part.system->vibrating_moment(part.gather(solution.displacement));
  const double elastic =
      solution.elastic_compliance / (state.stiffness->force_unit() * state.stiffness->length);
  if (!(elastic > 0.0)) return 0.0;
  return 2.0 * core::kPi * core::sqrt(vibrating / elastic) * state.parts.front().system->seconds();
}

int SolidSystem::dof_count() const {
  return 3 * static_cast<int>(state_->part_of.size());
}
int SolidSystem::part_count() const {
  return static_cast<int>(state_->parts.size());
}
const std::vector<int>& SolidSystem::part_of_vertex() const {
  return state_->part_of;
}
int SolidSystem::rigid_mode_count() const {
  int count = 0;
  for (const State::Part& part : state_->parts) count += part.system->rigid.mode_count();
  return count;
}
const SolidStiffness& SolidSystem::stiffness() const {
  return *state_->stiffness;
}
double SolidSystem::block_count() const {
  double count = 0.0;
  for (const State::Part& part : state_->parts) count += static_cast<double>(part.system->rows.column.size());
  return count;
}

Eigen::MatrixXd compliance_matrix(const std::vector<VecX>& loads,
                                  const std::vector<SolidSolution>& solutions) {
  const Size n = loads.size();
  Eigen::MatrixXd all(n, n);
  for (Size i = 0; i < n; ++i)
    for (Size j = 0; j < n; ++j) {
      const SolidSolution& solution = solutions[j];
      double& entry = all(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      entry = loads[i].dot(solution.displacement);
      if (solution.rigid_displacement.size() > 0) entry += loads[i].dot(solution.rigid_displacement);
    }
  return 0.5 * (all + all.transpose());
}

}  // namespace shatterbox::stress
