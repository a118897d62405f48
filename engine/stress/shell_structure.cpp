#include "engine/stress/shell_structure.h"

#include <algorithm>

#include "engine/core/bytes.h"
#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/stress/elimination_order.h"
#include "engine/stress/front_tiles.h"
#include "engine/stress/loaded_parts.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

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

}  // namespace

std::shared_ptr<const ShellStructure> ShellStructure::make(std::shared_ptr<const ShellStiffness> stiffness,
                                                           const geometry::ShellMesh& mesh,
                                                           const ShellSupport& support) {
  auto structure = std::make_shared<ShellStructure>();
  structure->stiffness = std::move(stiffness);
  structure->build_cells(mesh);
  structure->build_mass(mesh);
  core::parallel_for(2, 1, [&](Size part) {
    if (part == 0)
      structure->build_tree(mesh, support);
    else
      structure->build_rigid_modes(mesh, support);
  });
  return structure;
}

void ShellStructure::build_cells(const geometry::ShellMesh& mesh) {
  cells.reserve(mesh.cells.size());
  for (const geometry::ShellCell& cell : mesh.cells)
    cells.push_back({cell.element, stiffness_fraction(*mesh.elements, cell), cell_dofs(mesh, cell)});
  vertex_dofs = vertex_dof(static_cast<int>(mesh.vertex_source.size()));
}

void ShellStructure::build_mass(const geometry::ShellMesh& mesh) {
  const double length = stiffness->length;
  const double unit = stiffness->properties.density * stiffness->properties.thickness * length * length;
  mass = lumped_mass(*stiffness, mesh) / unit;
  for (Eigen::Index i = vertex_dofs; i < mass.size(); ++i) mass(i) /= length * length;
  if (!stiffness->properties.has_bending) mass.tail(mass.size() - vertex_dofs).setZero();
}

void ShellStructure::build_rigid_modes(const geometry::ShellMesh& mesh, const ShellSupport& support) {
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
  rigid = RigidModes(part_of_dofs(mesh), positions, directions, mass, is_clamped);
}

void ShellStructure::build_tree(const geometry::ShellMesh& mesh, const ShellSupport& support) {
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

double ShellStructure::seconds() const {
  return stiffness->length * core::sqrt(stiffness->properties.density / stiffness->properties.youngs_modulus);
}

std::vector<VecX> ShellStructure::multiply_stiffness(const std::vector<const VecX*>& all) const {
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

void ShellStructure::restrict_to_active(VecX& x) const {
  for (Size dof = 0; dof < place.size(); ++dof)
    if (place[dof] < 0) x(static_cast<Eigen::Index>(dof)) = 0.0;
}

double ShellStructure::bytes() const {
  return core::bytes_in(cells, mass, place) + rigid.bytes() + tree.bytes();
}

}  // namespace shatterbox::stress
