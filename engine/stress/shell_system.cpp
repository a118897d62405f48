#include "engine/stress/shell_system.h"

#include <algorithm>

#include "engine/core/bytes.h"
#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/stress/shell_system_state.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

constexpr int kIterations = 40;        // of the refinement; 1 to 3 do for a body without mechanisms
constexpr double kSplitShift = 1e6;    // of s^2 over a part's shift: below, about, the first frequency
constexpr int kMostPeriodSteps = 30;   // of the subspace iteration
constexpr int kRoughPeriodSteps = 2;   // of one that may decide that the period is below a limit:
constexpr double kRoughChange = 2.0;   // if the last step changed the frequency's square by no more than this
constexpr double kRoughMargin = 1.5;   // and the period found is so much shorter
constexpr double kShiftRetry = 100.0;  // a factor that fails is made again with a shift so much larger

}  // namespace

bool ShellSystem::State::build_factor() {
  const RigidModes& rigid = structure->rigid;
  const std::vector<int>& place = structure->place;
  const VecX& mass = structure->mass;
  // A shift that lifts the rigid motions just above rounding; about 1e-6 of the square of the first
  // frequency, by the one of a plate of the part's size. The refinement takes it out again.
  const double thickness = structure->stiffness->relative_thickness;
  std::vector<double> part_shift(at(rigid.part_count()));
  for (Size part = 0; part < part_shift.size(); ++part) {
    const double size_squared = rigid.part_size()[part] * rigid.part_size()[part];
    const double plate = 1.5e-5 * thickness * thickness / (size_squared * size_squared);
    part_shift[part] = std::max(plate, 1e-9 / rigid.part_mass()[part]);
  }
  is_split.resize(part_shift.size());
  for (Size part = 0; part < part_shift.size(); ++part)
    is_split[part] = screening_squared < kSplitShift * part_shift[part];
  const auto element = [this](int e) {
    const SystemCell& cell = structure->cells[at(e)];
    return ElementEntries{structure->stiffness->matrices[at(cell.element)].stiffness.data(), cell.fraction};
  };
  double factor_of_shift = 1.0;
  for (int attempt = 0; attempt < 4; ++attempt, factor_of_shift *= kShiftRetry) {
    shift = VecX::Zero(mass.size());
    diagonal.assign(at(structure->tree.unknowns), 0.0);
    for (Size dof = 0; dof < place.size(); ++dof) {
      if (place[dof] < 0) continue;
      const Eigen::Index i = static_cast<Eigen::Index>(dof);
      shift(i) = std::max(screening_squared, factor_of_shift * part_shift[at(rigid.part_of_dof()[dof])]);
      diagonal[at(place[dof])] = shift(i) * mass(i);
    }
    factor = FrontFactor::make(structure->tree, diagonal, element);
    if (factor) return true;
  }
  return false;
}

/// The factor's answer to up to kMost loads.
std::vector<VecX> ShellSystem::State::precondition(const std::vector<const VecX*>& loads) const {
  SolveLanes lanes(structure->tree, loads.size());
  for (Size l = 0; l < loads.size(); ++l) put_lane(*loads[l], l, lanes);
  solve_forward(structure->tree, *factor, lanes);
  solve_backward(structure->tree, *factor, lanes);
  std::vector<VecX> result(loads.size());
  const std::vector<int>& place = structure->place;
  for (Size l = 0; l < loads.size(); ++l) {
    result[l] = VecX::Zero(structure->mass.size());
    for (Size dof = 0; dof < place.size(); ++dof)
      if (place[dof] >= 0)
        result[l](static_cast<Eigen::Index>(dof)) = lanes.values[at(lanes.lanes * place[dof]) + l];
    if (is_balanced()) structure->rigid.remove_motion(result[l]);
  }
  return result;
}

void ShellSystem::State::put_lane(const VecX& load, Size lane, SolveLanes& lanes) const {
  const std::vector<int>& place = structure->place;
  for (Size dof = 0; dof < place.size(); ++dof)
    if (place[dof] >= 0)
      lanes.values[at(lanes.lanes * place[dof]) + lane] = load(static_cast<Eigen::Index>(dof));
}

/// A load in units of the shell, on active unknowns only.
VecX ShellSystem::State::scaled(const VecX& load) const {
  VecX b = load / structure->stiffness->force_unit();
  b.tail(b.size() - structure->vertex_dofs) /= structure->stiffness->length;
  structure->restrict_to_active(b);
  return b;
}

/// Conjugate gradients with the factor as preconditioner: iterative refinement that also copes with the few
/// soft modes that the factor's shift disturbs. Each load goes its own way; only the solves are done
/// together.
void ShellSystem::State::refine(std::span<Refinement> all, double tolerance) const {
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    std::vector<const VecX*> residuals;
    std::vector<Refinement*> open;
    for (Refinement& one : all)
      if (!one.is_done) {
        residuals.push_back(&one.residual);
        open.push_back(&one);
      }
    if (open.empty()) return;
    const std::vector<VecX> corrections = precondition(residuals);
    std::vector<const VecX*> directions;
    for (Size i = 0; i < open.size(); ++i) {
      Refinement& one = *open[i];
      const double rho = one.residual.dot(corrections[i]);
      one.is_done = !(rho > 0.0);
      if (iteration == 0)
        one.direction = corrections[i];
      else
        one.direction = corrections[i] + (rho / one.rho) * one.direction;
      one.rho = rho;
      directions.push_back(&one.direction);
    }
    const std::vector<VecX> images = structure->multiply_stiffness(directions);
    for (Size i = 0; i < open.size(); ++i) {
      Refinement& one = *open[i];
      if (one.is_done) continue;
      const VecX product = images[i] + screening_squared * structure->mass.cwiseProduct(one.direction);
      const double curvature = one.direction.dot(product);
      one.is_done = !(curvature > 1e-30 * one.rho);
      if (one.is_done) continue;
      const double step = one.rho / curvature;
      one.x += step * one.direction;
      one.image += step * images[i];
      one.residual -= step * product;
      if (is_balanced()) structure->rigid.balance(one.residual);
      one.is_done = one.residual.norm() <= tolerance * one.load_norm;
    }
  }
}

FrequencyEstimate ShellSystem::State::estimate_frequency(int steps) const {
  return first_frequency(
      *structure, [this](const std::vector<const VecX*>& loads) { return precondition(loads); }, steps);
}

double ShellSystem::State::period_of(double frequency_squared) const {
  // A mechanism has no period; the shift's own frequency stands for "very long".
  double least = shift.maxCoeff();
  for (Size dof = 0; dof < structure->place.size(); ++dof)
    if (structure->place[dof] >= 0) least = std::min(least, shift(static_cast<Eigen::Index>(dof)));
  return 2.0 * core::kPi / core::sqrt(std::max(frequency_squared, 1e-3 * least)) * structure->seconds();
}

ShellSystem::ShellSystem(std::unique_ptr<State> state) : state_(std::move(state)) {}
ShellSystem::~ShellSystem() = default;

core::Result<std::shared_ptr<const ShellSystem>> ShellSystem::make(
    std::shared_ptr<const ShellStructure> structure, double screening) {
  if (structure->cells.empty()) return core::Error{"a shell without cells has no stress"};
  if (structure->tree.unknowns == 0) return core::Error{"the support clamps the whole shell"};
  auto state = std::make_unique<State>();
  state->structure = std::move(structure);
  state->screening = screening;
  const double relative = screening * state->structure->seconds();
  state->screening_squared = relative * relative;
  if (!state->build_factor())
    return core::Error{"no Cholesky factor: the shell has triangles without area, or extremely thin ones"};
  return std::shared_ptr<const ShellSystem>(new ShellSystem(std::move(state)));
}

core::Result<std::shared_ptr<const ShellSystem>> ShellSystem::make(
    std::shared_ptr<const ShellStiffness> stiffness, const geometry::ShellMesh& mesh, double screening,
    const ShellSupport& support) {
  return make(ShellStructure::make(std::move(stiffness), mesh, support), screening);
}

std::vector<ShellSolution> ShellSystem::solve(const std::vector<VecX>& loads, double tolerance) const {
  const State& state = *state_;
  const ShellStructure& structure = *state.structure;
  const double length = structure.stiffness->length;
  const double force = structure.stiffness->force_unit();
  std::vector<ShellSolution> solutions(loads.size());
  core::parallel_chunks(loads.size(), kMostLanes, [&](Size begin, Size end) {
    std::vector<State::Refinement> work(end - begin);
    for (Size l = 0; l < work.size(); ++l) {
      State::Refinement& one = work[l];
      one.residual = state.scaled(loads[begin + l]);
      one.load_norm = one.residual.norm();
      if (state.is_balanced()) structure.rigid.balance(one.residual);
      one.x = one.image = VecX::Zero(one.residual.size());
      one.is_done = !(one.residual.norm() > 1e-14 * one.load_norm);  // nothing, or a rigid acceleration
    }
    state.refine(work, tolerance);
    for (Size l = 0; l < work.size(); ++l) {
      State::Refinement& one = work[l];
      if (state.is_balanced()) structure.rigid.remove_motion(one.x);
      ShellSolution& solution = solutions[begin + l];
      solution.residual = one.load_norm > 0.0 ? one.residual.norm() / one.load_norm : 0.0;
      solution.elastic_compliance = one.x.dot(one.image) * force * length;
      one.x.head(structure.vertex_dofs) *= length;
      solution.displacement = std::move(one.x);
      solution.compliance = loads[begin + l].dot(solution.displacement);
    }
  });
  return solutions;
}

ShellSolution ShellSystem::solve(const VecX& load, double tolerance) const {
  return solve(std::vector<VecX>{load}, tolerance).front();
}

double ShellSystem::first_period() const {
  std::call_once(state_->has_period, [this] {
    state_->period = state_->period_of(state_->estimate_frequency(kMostPeriodSteps).squared);
  });
  return state_->period;
}

double ShellSystem::trial_period(const ShellSolution& solution) const {
  const ShellStructure& structure = *state_->structure;
  const double length = structure.stiffness->length;
  VecX x = solution.displacement;
  x.head(structure.vertex_dofs) /= length;
  structure.rigid.remove_motion(x);
  const double inertia = (structure.mass.array() * x.array().square()).sum();
  const double elastic = solution.elastic_compliance / (structure.stiffness->force_unit() * length);
  return 2.0 * core::kPi * core::sqrt(inertia / std::max(elastic, 1e-300)) * structure.seconds();
}

bool ShellSystem::is_first_period_above(double limit) const {
  std::call_once(state_->has_rough_frequency,
                 [this] { state_->rough_frequency = state_->estimate_frequency(kRoughPeriodSteps); });
  const FrequencyEstimate& rough = state_->rough_frequency;
  const double rough_period = state_->period_of(rough.squared);
  if (rough_period > limit) return true;  // estimates only grow
  if (rough.previous < kRoughChange * rough.squared && kRoughMargin * rough_period < limit) return false;
  return first_period() > limit;
}

double ShellSystem::screening() const {
  return state_->screening;
}
int ShellSystem::dof_count() const {
  return static_cast<int>(state_->structure->mass.size());
}
int ShellSystem::part_count() const {
  return state_->structure->rigid.part_count();
}
int ShellSystem::rigid_mode_count() const {
  return state_->structure->rigid.mode_count();
}
const ShellStiffness& ShellSystem::stiffness() const {
  return *state_->structure->stiffness;
}
double ShellSystem::factor_entries() const {
  return state_->structure->tree.entries;
}
double ShellSystem::bytes() const {
  return state_->factor->bytes() + core::bytes_in(state_->diagonal, state_->shift);
}

}  // namespace shatterbox::stress
