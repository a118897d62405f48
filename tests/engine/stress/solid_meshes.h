// Small solids with closed-form answers for the tests of stress.
#pragma once

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/random.h"
#include "engine/geometry/box_tets.h"
#include "engine/geometry/solid_mesh.h"
#include "engine/stress/solid_load.h"
#include "engine/stress/solid_stress.h"
#include "engine/stress/solid_system.h"

namespace shatterbox::stress::testing {

using Solids = std::shared_ptr<const geometry::SolidElements>;

inline Solids make_solids(geometry::TetMesh mesh) {
  auto elements = std::make_shared<geometry::SolidElements>();
  elements->mesh = std::move(mesh);
  elements->topology = geometry::build_tet_topology(elements->mesh.tetrahedra);
  return elements;
}

inline Solids lattice_box(const Vec3& half_extent, double element_size) {
  auto mesh = geometry::make_box_tets(half_extent, element_size);
  REQUIRE(mesh.ok());
  return make_solids(std::move(mesh.value()));
}

using Map = std::function<Vec3(const Vec3&)>;

/// Cells of the unit cube, each in Kuhn's six tetrahedra whose diagonals alternate from cell to cell, carried
/// by `map` (of right-handed Jacobian); inner vertices are first moved by up to `jitter` of a cell.
inline geometry::TetMesh mapped_grid(const std::array<int, 3>& cells, const Map& map, double jitter = 0.0) {
  geometry::TetMesh mesh;
  core::Random random(11, 0);
  const auto& [nx, ny, nz] = cells;
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) {
        Vec3 place(i, j, k);
        const bool is_inside = i > 0 && j > 0 && k > 0 && i < nx && j < ny && k < nz;
        for (int axis = 0; axis < 3; ++axis) {
          const double shift = random.uniform(-jitter, jitter);
          if (is_inside) place(axis) += shift;
        }
        mesh.positions.push_back(map(place.cwiseQuotient(Vec3(nx, ny, nz))));
      }
  const auto vertex = [&](int i, int j, int k) { return (k * (ny + 1) + j) * (nx + 1) + i; };
  constexpr std::array<std::array<int, 3>, 6> kOrders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        // From the corner (a, b, c) of the cell to the opposite one, so that neighbours are mirror images.
        const std::array<int, 3> start{i % 2, j % 2, k % 2};
        const bool is_mirrored = (i + j + k) % 2 != 0;
        for (std::size_t o = 0; o < 6; ++o) {
          std::array<int, 3> at_corner = start;
          geometry::Tetrahedron t{};
          for (std::size_t step = 0; step < 4; ++step) {
            t[step] = vertex(i + at_corner[0], j + at_corner[1], k + at_corner[2]);
            if (step < 3) {
              int& side = at_corner[core::at(kOrders[o][step])];
              side = 1 - side;
            }
          }
          if ((o >= 3) != is_mirrored) std::swap(t[2], t[3]);
          mesh.tetrahedra.push_back(t);
        }
      }
  return mesh;
}

inline Solids mapped(const std::array<int, 3>& cells, const Map& map, double jitter = 0.0) {
  return make_solids(mapped_grid(cells, map, jitter));
}

/// Contacts of an uncut mesh: all faces inside.
inline std::vector<geometry::SolidContact> whole_contacts(const geometry::SolidMesh& mesh) {
  std::vector<geometry::SolidContact> contacts;
  for (const auto& [a, b] : mesh.elements->topology.face_tetrahedra)
    if (b >= 0) contacts.push_back({a, b, 1.0});
  return contacts;
}

/// Volume and first moment of the part of a tetrahedron where `value` (linear, at its corners) is positive.
inline std::pair<double, Vec3> clip_tetrahedron(const std::array<Vec3, 4>& p,
                                                const std::array<double, 4>& value) {
  std::vector<int> in, out;
  for (int i = 0; i < 4; ++i) (value[core::at(i)] > 0.0 ? in : out).push_back(i);
  const auto whole = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const double volume = std::abs((b - a).cross(c - a).dot(d - a)) / 6.0;
    return std::pair<double, Vec3>(volume, volume / 4.0 * (a + b + c + d));
  };
  const auto all = whole(p[0], p[1], p[2], p[3]);
  const auto crossing = [&](int i, int j) -> Vec3 {
    const double vi = value[core::at(i)], vj = value[core::at(j)];
    return p[core::at(i)] + vi / (vi - vj) * (p[core::at(j)] - p[core::at(i)]);
  };
  if (in.empty()) return {0.0, Vec3::Zero()};
  if (out.empty()) return all;
  const auto tip = [&](int apex, const std::vector<int>& others) {
    return whole(p[core::at(apex)], crossing(apex, others[0]), crossing(apex, others[1]),
                 crossing(apex, others[2]));
  };
  if (in.size() == 1) return tip(in[0], out);
  if (out.size() == 1) {
    const auto rest = tip(out[0], in);
    return {all.first - rest.first, all.second - rest.second};
  }
  // A wedge: three tetrahedra.
  const Vec3 a = p[core::at(in[0])], b = p[core::at(in[1])];
  const Vec3 ac = crossing(in[0], out[0]), ad = crossing(in[0], out[1]), bc = crossing(in[1], out[0]),
             bd = crossing(in[1], out[1]);
  std::pair<double, Vec3> sum(0.0, Vec3::Zero());
  for (const auto& [volume, moment] : {whole(a, ac, ad, bd), whole(a, ac, bc, bd), whole(a, b, bc, bd)}) {
    sum.first += volume;
    sum.second += moment;
  }
  return sum;
}

/// An uncut mesh cut right through by the plane normal . x = offset, which passes no vertex: virtual nodes on
/// both sides. Contacts: all but those across it.
struct CutSolid {
  geometry::SolidMesh mesh;
  std::vector<geometry::SolidContact> contacts;
};
inline CutSolid cut_by_plane(const geometry::SolidMesh& whole, const Vec3& normal, double offset) {
  const geometry::TetMesh& tets = whole.elements->mesh;
  CutSolid cut;
  cut.mesh.elements = whole.elements;
  std::vector<std::array<int, 2>> cells(tets.tetrahedra.size(), {-1, -1});
  std::map<std::pair<int, int>, int> copies;
  for (int side = 0; side < 2; ++side)
    for (std::size_t t = 0; t < tets.tetrahedra.size(); ++t) {
      std::array<Vec3, 4> p;
      std::array<double, 4> value{};
      for (std::size_t i = 0; i < 4; ++i) {
        p[i] = tets.positions[core::at(tets.tetrahedra[t][i])];
        value[i] = (side == 0 ? 1.0 : -1.0) * (normal.dot(p[i]) - offset);
      }
      const auto [volume, moment] = clip_tetrahedron(p, value);
      if (!(volume > 0.0)) continue;
      geometry::SolidCell cell;
      cell.element = static_cast<int>(t);
      cell.volume = volume;
      Mat3 edges;
      for (int i = 0; i < 3; ++i) edges.col(i) = p[core::at(i + 1)] - p[0];
      cell.centroid = edges.inverse() * (moment / volume - p[0]);
      for (std::size_t i = 0; i < 4; ++i) {
        const auto [found, is_new] = copies.try_emplace({side, tets.tetrahedra[t][i]},
                                                        static_cast<int>(cut.mesh.vertex_source.size()));
        if (is_new) cut.mesh.vertex_source.push_back(tets.tetrahedra[t][i]);
        cell.vertices[i] = found->second;
      }
      cells[t][core::at(side)] = static_cast<int>(cut.mesh.cells.size());
      cut.mesh.cells.push_back(cell);
    }
  for (const auto& [a, b] : whole.elements->topology.face_tetrahedra)
    for (std::size_t side = 0; side < 2 && b >= 0; ++side)
      if (cells[core::at(a)][side] >= 0 && cells[core::at(b)][side] >= 0)
        cut.contacts.push_back({cells[core::at(a)][side], cells[core::at(b)][side], 1.0});
  return cut;
}

inline SolidProperties solid_properties(double poisson_ratio = 0.3) {
  SolidProperties properties;
  properties.youngs_modulus = 2e9;
  properties.poisson_ratio = poisson_ratio;
  properties.density = 1200.0;
  return properties;
}

inline std::shared_ptr<const SolidSystem> make_solid_system(
    const std::shared_ptr<const SolidStiffness>& stiffness, const geometry::SolidMesh& mesh,
    const SolidSystemOptions& options = {}) {
  auto system = SolidSystem::make(stiffness, mesh, options);
  REQUIRE(system.ok());
  return system.value();
}

/// Clamps the axes that `axes_of(position)` names (bits 1, 2, 4) of every vertex of an uncut mesh.
inline SolidSupport clamp_where(const geometry::SolidMesh& mesh,
                                const std::function<int(const Vec3&)>& axes_of) {
  SolidSupport support;
  for (std::size_t v = 0; v < mesh.vertex_source.size(); ++v) {
    const int axes = axes_of(mesh.elements->mesh.positions[core::at(mesh.vertex_source[v])]);
    for (int axis = 0; axis < 3; ++axis)
      if ((axes >> axis & 1) != 0) support.dofs.push_back(3 * static_cast<int>(v) + axis);
  }
  return support;
}

/// Surface traction (Pa, of a face's centre and outward unit normal) over the border of an uncut mesh, at
/// three points a face.
inline VecX traction_load(const geometry::SolidMesh& mesh,
                          const std::function<Vec3(const Vec3& place, const Vec3& normal)>& traction) {
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  const geometry::SolidElements& elements = *mesh.elements;
  for (std::size_t t = 0; t < elements.mesh.tetrahedra.size(); ++t)
    for (std::size_t f = 0; f < 4; ++f) {
      const int face = elements.topology.tetrahedron_faces[t][f];
      if (elements.topology.face_tetrahedra[core::at(face)][1] >= 0) continue;
      std::array<int, 3> v{};
      std::array<Vec3, 3> p;
      for (std::size_t i = 0; i < 3; ++i) {
        v[i] = elements.mesh.tetrahedra[t][core::at(geometry::kTetrahedronFaces[f][i])];
        p[i] = elements.mesh.positions[core::at(v[i])];
      }
      const Vec3 twice = (p[1] - p[0]).cross(p[2] - p[0]);
      const double area = 0.5 * twice.norm();
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const Vec3 force = area / 3.0 * traction(0.5 * (p[i] + p[j]), twice.normalized());
        load.segment<3>(3 * v[i]) += 0.5 * force;
        load.segment<3>(3 * v[j]) += 0.5 * force;
      }
    }
  return load;
}

/// |a - b| / |b| over all cells, volumes as weights.
inline double stress_difference(const geometry::SolidMesh& mesh, const std::vector<SolidStress>& a,
                                const std::vector<SolidStress>& b) {
  double difference = 0.0, size = 0.0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    const double d = stress_norm(a[c] - b[c]), s = stress_norm(b[c]);
    difference += mesh.cells[c].volume * d * d;
    size += mesh.cells[c].volume * s * s;
  }
  return core::sqrt(difference / size);
}

inline SolidSolveSettings fine(double tolerance = 1e-11) {
  SolidSolveSettings settings;
  settings.tolerance = tolerance;
  settings.most_iterations = 20000;
  return settings;
}

}  // namespace shatterbox::stress::testing
