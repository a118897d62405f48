#include "engine/stress/shell_system.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <span>

#include "engine/core/elementary.h"
#include "engine/core/parallel.h"
#include "engine/core/random.h"
#include "engine/stress/elimination_order.h"
#include "engine/stress/front_factor.h"
#include "engine/stress/front_tiles.h"
#include "engine/stress/rigid_modes.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;

Size at(int i) {
  return static_cast<Size>(i);
}

constexpr int kIterations = 40;        // of the refinement; 1 to 3 do for a body without mechanisms
constexpr double kShiftRetry = 100.0;  // a factor that fails is made again with a shift so much larger

/// Places of one cell's unknowns and the share of its element's stiffness.
struct SystemCell {
  int element = 0;
  double fraction = 1.0;
  std::array<int, kElementDofs> dofs{};
};

constexpr Size kMostLanes = 4;

/// product += element's matrix times x, one vector.
void add_product(const double* entry, const SystemCell& cell, const double* x, double* product) {
  std::array<double, kElementDofs> u;
  std::array<double, kElementDofs> f{};
  for (Size i = 0; i < kElementDofs; ++i) u[i] = x[cell.dofs[i]];
  for (Size column = 0; column < kElementDofs; ++column) {
    double sum = *entry++ * u[column];
    for (Size row = column + 1; row < kElementDofs; ++row, ++entry) {
      f[row] += *entry * u[column];
      sum += *entry * u[row];
    }
    f[column] += sum;
  }
  for (Size i = 0; i < kElementDofs; ++i) product[cell.dofs[i]] += cell.fraction * f[i];
}

/// The same for four vectors side by side.
void add_products(const double* entry, const SystemCell& cell, const double* x, double* product) {
  using tiles::Pair;
  Pair u[kElementDofs][2];
  Pair f[kElementDofs][2] = {};
  for (Size i = 0; i < kElementDofs; ++i) {
    const double* const from = x + kMostLanes * at(cell.dofs[i]);
    u[i][0] = *reinterpret_cast<const Pair*>(from);
    u[i][1] = *reinterpret_cast<const Pair*>(from + 2);
  }
  for (Size column = 0; column < kElementDofs; ++column) {
    const Pair diagonal = {*entry, *entry};
    ++entry;
    const Pair u0 = u[column][0], u1 = u[column][1];
    Pair sum0 = diagonal * u0, sum1 = diagonal * u1;
    for (Size row = column + 1; row < kElementDofs; ++row, ++entry) {
      const Pair e = {*entry, *entry};
      f[row][0] += e * u0;
      f[row][1] += e * u1;
      sum0 += e * u[row][0];
      sum1 += e * u[row][1];
    }
    f[column][0] += sum0;
    f[column][1] += sum1;
  }
  const Pair fraction = {cell.fraction, cell.fraction};
  for (Size i = 0; i < kElementDofs; ++i) {
    double* const to = product + kMostLanes * at(cell.dofs[i]);
    *reinterpret_cast<Pair*>(to) += fraction * f[i][0];
    *reinterpret_cast<Pair*>(to + 2) += fraction * f[i][1];
  }
}

struct Refinement {
  VecX x, image;  // image: K x
  VecX residual, direction;
  double rho = 0.0, load_norm = 0.0;
  bool is_done = false;
};

}  // namespace

/// Everything in units of the shell (ShellStiffness), vectors in the order of the mesh's degrees of freedom.
struct ShellSystem::State {
  std::shared_ptr<const ShellStiffness> stiffness;
  double screening = 0.0;          // 1/s
  double screening_squared = 0.0;  // in units of the shell
  std::vector<SystemCell> cells;
  VecX mass;
  std::vector<int> place;  // of each degree of freedom in the factor, -1 if clamped or in no cell
  RigidModes rigid;
  FrontTree tree;
  std::optional<FrontFactor> factor;
  VecX shift;  // factored in place of screening_squared: never too small to be seen beside the stiffness
  int vertex_dofs = 0;
  mutable std::once_flag has_period;
  mutable double period = 0.0;

  void build_cells(const geometry::ShellMesh& mesh);
  void build_mass(const geometry::ShellMesh& mesh);
  void build_rigid_modes(const geometry::ShellMesh& mesh, const ShellSupport& support);
  void build_tree(const geometry::ShellMesh& mesh, const ShellSupport& support);
  bool build_factor();

  double seconds() const;  // unit of time: length / speed of sound
  bool is_balanced() const { return screening_squared == 0.0; }
  std::vector<VecX> multiply_stiffness(const std::vector<const VecX*>& all) const;
  void restrict_to_active(VecX& x) const;
  std::vector<VecX> precondition(const std::vector<const VecX*>& loads) const;
  void refine(std::span<Refinement> all, double tolerance) const;
  double compute_period() const;
};

void ShellSystem::State::build_cells(const geometry::ShellMesh& mesh) {
  cells.reserve(mesh.cells.size());
  for (const geometry::ShellCell& cell : mesh.cells)
    cells.push_back({cell.element, stiffness_fraction(*mesh.elements, cell), cell_dofs(mesh, cell)});
  vertex_dofs = vertex_dof(static_cast<int>(mesh.vertex_source.size()));
}

void ShellSystem::State::build_mass(const geometry::ShellMesh& mesh) {
  const double length = stiffness->length;
  const double unit = stiffness->properties.density * stiffness->properties.thickness * length * length;
  mass = lumped_mass(*stiffness, mesh) / unit;
  for (Eigen::Index i = vertex_dofs; i < mass.size(); ++i) mass(i) /= length * length;
  if (!stiffness->properties.has_bending) mass.tail(mass.size() - vertex_dofs).setZero();
}

void ShellSystem::State::build_rigid_modes(const geometry::ShellMesh& mesh, const ShellSupport& support) {
  const auto& source = mesh.elements->mesh.positions;
  std::vector<Vec3> positions(mesh.vertex_source.size());
  for (Size v = 0; v < positions.size(); ++v)
    positions[v] = source[at(mesh.vertex_source[v])] / stiffness->length;
  std::vector<Vec3> directions;
  if (stiffness->properties.has_bending)
    for (const int edge : mesh.edge_source) {
      const auto& ends = mesh.elements->topology.edges[at(edge)];
      directions.push_back((source[at(ends[1])] - source[at(ends[0])]).normalized());
    }
  std::vector<char> is_clamped(at(mesh.degree_of_freedom_count()), 0);
  for (const int vertex : support.vertices)
    for (int axis = 0; axis < 3; ++axis) is_clamped[at(vertex_dof(vertex) + axis)] = 1;
  for (const int edge : support.edges) is_clamped[at(edge_dof(mesh, edge))] = 1;
  rigid = RigidModes(mesh, positions, directions, mass, is_clamped);
}

void ShellSystem::State::build_tree(const geometry::ShellMesh& mesh, const ShellSupport& support) {
  const bool has_bending = stiffness->properties.has_bending;
  const Size vertices = mesh.vertex_source.size();
  std::vector<char> is_left_out(vertices + mesh.edge_source.size(), 0);
  for (const int vertex : support.vertices) is_left_out[at(vertex)] = 1;
  for (const int edge : support.edges) is_left_out[vertices + at(edge)] = 1;
  NodeGraph graph;
  graph.node_size.assign(is_left_out.size(), 1);
  std::fill_n(graph.node_size.begin(), vertices, 3);
  graph.elements.resize(mesh.cells.size());
  for (Size c = 0; c < mesh.cells.size(); ++c)
    for (Size i = 0; i < 3; ++i) {
      const int vertex = mesh.cells[c].vertices[i];
      const int edge = static_cast<int>(vertices) + mesh.cells[c].edges[i];
      graph.elements[c][i] = is_left_out[at(vertex)] != 0 ? -1 : vertex;
      graph.elements[c][3 + i] = !has_bending || is_left_out[at(edge)] != 0 ? -1 : edge;
    }
  tree = build_front_tree(graph, order_nodes(mesh, stiffness->vertex_rank, has_bending));
  place.assign(at(mesh.degree_of_freedom_count()), -1);
  for (Size node = 0; node < is_left_out.size(); ++node) {
    if (tree.node_place[node] < 0) continue;
    const Size size = node < vertices ? 3 : 1;
    const Size dof = node < vertices ? 3 * node : 2 * vertices + node;
    for (Size i = 0; i < size; ++i) place[dof + i] = tree.node_place[node] + static_cast<int>(i);
  }
}

bool ShellSystem::State::build_factor() {
  // A shift that lifts the rigid motions just above rounding; about 1e-6 of the square of the first
  // frequency, by the one of a plate of the part's size. The refinement takes it out again.
  const double thickness = stiffness->relative_thickness;
  std::vector<double> part_shift(at(rigid.part_count()));
  for (Size part = 0; part < part_shift.size(); ++part) {
    const double size_squared = rigid.part_size()[part] * rigid.part_size()[part];
    const double plate = 1.5e-5 * thickness * thickness / (size_squared * size_squared);
    part_shift[part] = std::max(plate, 1e-9 / rigid.part_mass()[part]);
  }
  const auto element = [this](int e) {
    const SystemCell& cell = cells[at(e)];
    return ElementEntries{stiffness->matrices[at(cell.element)].stiffness.data(), cell.fraction};
  };
  double factor_of_shift = 1.0;
  for (int attempt = 0; attempt < 4; ++attempt, factor_of_shift *= kShiftRetry) {
    shift = VecX::Zero(mass.size());
    std::vector<double> diagonal(at(tree.unknowns), 0.0);
    for (Size dof = 0; dof < place.size(); ++dof) {
      if (place[dof] < 0) continue;
      const Eigen::Index i = static_cast<Eigen::Index>(dof);
      shift(i) = std::max(screening_squared, factor_of_shift * part_shift[at(rigid.part_of_dof()[dof])]);
      diagonal[at(place[dof])] = shift(i) * mass(i);
    }
    factor = FrontFactor::make(tree, diagonal, element);
    if (factor) return true;
  }
  return false;
}

double ShellSystem::State::seconds() const {
  return stiffness->length * core::sqrt(stiffness->properties.density / stiffness->properties.youngs_modulus);
}

/// K times each vector; lanes never mix and sum in one order, so company changes no bits.
std::vector<VecX> ShellSystem::State::multiply_stiffness(const std::vector<const VecX*>& all) const {
  std::vector<VecX> results(all.size());
  for (Size first = 0; first < all.size(); first += kMostLanes) {
    const Size count = std::min(kMostLanes, all.size() - first);
    const Size lanes = count == 1 ? 1 : kMostLanes;
    const Size size = static_cast<Size>(mass.size());
    std::vector<double> x(size * lanes, 0.0), product(size * lanes, 0.0);
    for (Size l = 0; l < count; ++l)
      for (Size i = 0; i < size; ++i) x[lanes * i + l] = (*all[first + l])(static_cast<Eigen::Index>(i));
    for (const SystemCell& cell : cells) {
      const double* const entries = stiffness->matrices[at(cell.element)].stiffness.data();
      if (lanes == 1)
        add_product(entries, cell, x.data(), product.data());
      else
        add_products(entries, cell, x.data(), product.data());
    }
    for (Size l = 0; l < count; ++l) {
      VecX& result = results[first + l];
      result.resize(mass.size());
      for (Size i = 0; i < size; ++i) result(static_cast<Eigen::Index>(i)) = product[lanes * i + l];
      restrict_to_active(result);
    }
  }
  return results;
}

void ShellSystem::State::restrict_to_active(VecX& x) const {
  for (Size dof = 0; dof < place.size(); ++dof)
    if (place[dof] < 0) x(static_cast<Eigen::Index>(dof)) = 0.0;
}

std::vector<VecX> ShellSystem::State::precondition(const std::vector<const VecX*>& loads) const {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(tree.unknowns, static_cast<Eigen::Index>(loads.size()));
  for (Size l = 0; l < loads.size(); ++l)
    for (Size dof = 0; dof < place.size(); ++dof)
      if (place[dof] >= 0)
        columns(place[dof], static_cast<Eigen::Index>(l)) = (*loads[l])(static_cast<Eigen::Index>(dof));
  factor->solve(tree, columns);
  std::vector<VecX> result(loads.size());
  for (Size l = 0; l < loads.size(); ++l) {
    result[l] = VecX::Zero(mass.size());
    for (Size dof = 0; dof < place.size(); ++dof)
      if (place[dof] >= 0)
        result[l](static_cast<Eigen::Index>(dof)) = columns(place[dof], static_cast<Eigen::Index>(l));
    if (is_balanced()) rigid.remove_motion(result[l]);
  }
  return result;
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
    const std::vector<VecX> images = multiply_stiffness(directions);
    for (Size i = 0; i < open.size(); ++i) {
      Refinement& one = *open[i];
      if (one.is_done) continue;
      const VecX product = images[i] + screening_squared * mass.cwiseProduct(one.direction);
      const double curvature = one.direction.dot(product);
      one.is_done = !(curvature > 1e-30 * one.rho);
      if (one.is_done) continue;
      const double step = one.rho / curvature;
      one.x += step * one.direction;
      one.image += step * images[i];
      one.residual -= step * product;
      if (is_balanced()) rigid.balance(one.residual);
      one.is_done = one.residual.norm() <= tolerance * one.load_norm;
    }
  }
}

double ShellSystem::State::compute_period() const {
  constexpr int kVectors = 4;
  core::Random random(1, 0);
  std::vector<VecX> basis(kVectors, VecX::Zero(mass.size()));
  for (VecX& x : basis) {
    for (Eigen::Index i = 0; i < vertex_dofs; ++i) x(i) = random.uniform(-1.0, 1.0);
    restrict_to_active(x);
  }
  double frequency_squared = 0.0;
  for (int iteration = 0; iteration < 30; ++iteration) {
    std::vector<VecX> loads;
    std::vector<const VecX*> pointers;
    for (const VecX& x : basis) loads.push_back(mass.cwiseProduct(x));
    for (const VecX& load : loads) pointers.push_back(&load);
    basis = precondition(pointers);
    for (VecX& x : basis) {
      const double norm = core::sqrt(x.dot(mass.cwiseProduct(x)));
      if (!(norm > 0.0)) return 0.0;
      x /= norm;
    }
    Eigen::Matrix4d stiff, heavy;
    for (Size j = 0; j < kVectors; ++j) pointers[j] = &basis[j];
    const std::vector<VecX> products = multiply_stiffness(pointers);
    for (Size j = 0; j < kVectors; ++j) {
      const VecX& product = products[j];
      const VecX momentum = mass.cwiseProduct(basis[j]);
      for (Size i = 0; i < kVectors; ++i) {
        stiff(static_cast<int>(i), static_cast<int>(j)) = basis[i].dot(product);
        heavy(static_cast<int>(i), static_cast<int>(j)) = basis[i].dot(momentum);
      }
    }
    // The first step of a small body may leave fewer than four independent vectors.
    heavy.diagonal() *= 1.0 + 1e-12;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix4d> ritz(stiff, heavy);
    const double previous = frequency_squared;
    frequency_squared = ritz.eigenvalues()(0);
    std::vector<VecX> turned(kVectors, VecX::Zero(mass.size()));
    for (Size j = 0; j < kVectors; ++j)
      for (Size i = 0; i < kVectors; ++i)
        turned[j] += ritz.eigenvectors()(static_cast<int>(i), static_cast<int>(j)) * basis[i];
    basis = std::move(turned);
    if (iteration > 2 && std::abs(frequency_squared - previous) < 5e-3 * std::abs(frequency_squared)) break;
  }
  // A mechanism has no period; the shift's own frequency stands for "very long".
  double least = shift.maxCoeff();
  for (Size dof = 0; dof < place.size(); ++dof)
    if (place[dof] >= 0) least = std::min(least, shift(static_cast<Eigen::Index>(dof)));
  return 2.0 * core::kPi / core::sqrt(std::max(frequency_squared, 1e-3 * least)) * seconds();
}

ShellSystem::ShellSystem(std::unique_ptr<State> state) : state_(std::move(state)) {}
ShellSystem::~ShellSystem() = default;

core::Result<std::shared_ptr<const ShellSystem>> ShellSystem::make(
    std::shared_ptr<const ShellStiffness> stiffness, const geometry::ShellMesh& mesh, double screening,
    const ShellSupport& support) {
  if (mesh.cells.empty()) return core::Error{"a shell without cells has no stress"};
  auto state = std::make_unique<State>();
  state->stiffness = std::move(stiffness);
  state->screening = screening;
  const double relative = screening * state->seconds();
  state->screening_squared = relative * relative;
  state->build_cells(mesh);
  state->build_mass(mesh);
  state->build_rigid_modes(mesh, support);
  state->build_tree(mesh, support);
  if (state->tree.unknowns == 0) return core::Error{"the support clamps the whole shell"};
  if (!state->build_factor())
    return core::Error{"no Cholesky factor: the shell has triangles without area, or extremely thin ones"};
  return std::shared_ptr<const ShellSystem>(new ShellSystem(std::move(state)));
}

std::vector<ShellSolution> ShellSystem::solve(const std::vector<VecX>& loads, double tolerance) const {
  const State& state = *state_;
  const double length = state.stiffness->length;
  const double force = state.stiffness->force_unit();
  std::vector<ShellSolution> solutions(loads.size());
  core::parallel_chunks(loads.size(), kMostLanes, [&](Size begin, Size end) {
    std::vector<Refinement> work(end - begin);
    for (Size l = 0; l < work.size(); ++l) {
      Refinement& one = work[l];
      one.residual = loads[begin + l] / force;
      one.residual.tail(one.residual.size() - state.vertex_dofs) /= length;
      state.restrict_to_active(one.residual);
      one.load_norm = one.residual.norm();
      if (state.is_balanced()) state.rigid.balance(one.residual);
      one.x = one.image = VecX::Zero(one.residual.size());
      one.is_done = !(one.residual.norm() > 1e-14 * one.load_norm);  // nothing, or a rigid acceleration
    }
    state.refine(work, tolerance);
    for (Size l = 0; l < work.size(); ++l) {
      Refinement& one = work[l];
      if (state.is_balanced()) state.rigid.remove_motion(one.x);
      ShellSolution& solution = solutions[begin + l];
      solution.residual = one.load_norm > 0.0 ? one.residual.norm() / one.load_norm : 0.0;
      solution.elastic_compliance = one.x.dot(one.image) * force * length;
      one.x.head(state.vertex_dofs) *= length;
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
  std::call_once(state_->has_period, [this] { state_->period = state_->compute_period(); });
  return state_->period;
}

double ShellSystem::screening() const {
  return state_->screening;
}
int ShellSystem::dof_count() const {
  return static_cast<int>(state_->mass.size());
}
int ShellSystem::part_count() const {
  return state_->rigid.part_count();
}
int ShellSystem::rigid_mode_count() const {
  return state_->rigid.mode_count();
}
const ShellStiffness& ShellSystem::stiffness() const {
  return *state_->stiffness;
}
double ShellSystem::factor_entries() const {
  return state_->tree.entries;
}

double ShellSystem::factor_megaflops() const {
  double work = 0.0;
  for (const Front& front : state_->tree.fronts)
    if (front.parent < 0) work += front.work;
  return 2e-6 * work;
}

}  // namespace shatterbox::stress
