#include "sandbox/study/solid_models.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/random.h"
#include "engine/geometry/box_tets.h"

namespace shatterbox::sandbox::study::model {

using namespace stress;

Solids make_solids(geometry::TetMesh mesh) {
  auto elements = std::make_shared<geometry::SolidElements>();
  elements->mesh = std::move(mesh);
  elements->topology = geometry::build_tet_topology(elements->mesh.tetrahedra);
  return elements;
}

Solids lattice_box(const Vec3& half_extent, double element_size) {
  auto mesh = geometry::make_box_tets(half_extent, element_size);
  if (!mesh.ok()) throw std::runtime_error(mesh.error());
  return make_solids(std::move(mesh.value()));
}

geometry::TetMesh mapped_grid(const std::array<int, 3>& cells, const Map& map, double jitter) {
  geometry::TetMesh mesh;
  core::Random random(11, 0);
  const int nx = cells[0], ny = cells[1], nz = cells[2];
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

Solids mapped(const std::array<int, 3>& cells, const Map& map, double jitter) {
  return make_solids(mapped_grid(cells, map, jitter));
}

std::vector<geometry::SolidContact> whole_contacts(const geometry::SolidMesh& mesh) {
  std::vector<geometry::SolidContact> contacts;
  for (const auto& [a, b] : mesh.elements->topology.face_tetrahedra)
    if (b >= 0) contacts.push_back({a, b, 1.0});
  return contacts;
}

SolidProperties solid_properties(double poisson_ratio) {
  SolidProperties properties;
  properties.youngs_modulus = 2e9;
  properties.poisson_ratio = poisson_ratio;
  properties.density = 1200.0;
  return properties;
}

std::shared_ptr<const SolidSystem> make_solid_system(const std::shared_ptr<const SolidStiffness>& stiffness,
                                                     const geometry::SolidMesh& mesh,
                                                     const SolidSystemOptions& options) {
  auto system = SolidSystem::make(stiffness, mesh, options);
  if (!system.ok()) throw std::runtime_error(system.error());
  return system.value();
}

SolidSupport clamp_where(const geometry::SolidMesh& mesh, const std::function<int(const Vec3&)>& axes_of) {
  SolidSupport support;
  for (std::size_t v = 0; v < mesh.vertex_source.size(); ++v) {
    const int axes = axes_of(mesh.elements->mesh.positions[core::at(mesh.vertex_source[v])]);
    for (int axis = 0; axis < 3; ++axis)
      if ((axes >> axis & 1) != 0) support.dofs.push_back(3 * static_cast<int>(v) + axis);
  }
  return support;
}

VecX traction_load(const geometry::SolidMesh& mesh,
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

double stress_difference(const geometry::SolidMesh& mesh, const std::vector<SolidStress>& a,
                         const std::vector<SolidStress>& b) {
  double difference = 0.0, size = 0.0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    const double d = stress_norm(a[c] - b[c]), s = stress_norm(b[c]);
    difference += mesh.cells[c].volume * d * d;
    size += mesh.cells[c].volume * s * s;
  }
  return core::sqrt(difference / size);
}

SolidSolveSettings fine(double tolerance) {
  SolidSolveSettings settings;
  settings.tolerance = tolerance;
  settings.most_iterations = 20000;
  return settings;
}

Beam::Beam(double element_size, const SolidProperties& properties)
    : solids(lattice_box(Vec3(1.0, 0.1, 0.1), element_size)),
      mesh(make_solid_mesh(solids)),
      stiffness(make_solid_stiffness(solids, properties)),
      skin(make_border_skin(mesh)) {}

VecX Beam::hit(double x, const Vec3& force) const {
  return patch_load(mesh, find_load_patch(mesh, skin, Vec3(x, 0.0, 0.1), 0.05), force);
}

std::vector<SolidStress> Beam::stress_of(const SolidSolution& solution) const {
  return cell_stresses(*stiffness, mesh, solution.displacement);
}

}  // namespace shatterbox::sandbox::study::model
