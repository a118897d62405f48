#include "sandbox/study/shell_models.h"

#include <array>
#include <map>
#include <stdexcept>
#include <vector>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/random.h"

namespace shatterbox::sandbox::study::model {

using namespace stress;

Elements make_elements(geometry::TriangleMesh mesh) {
  auto elements = std::make_shared<geometry::ShellElements>();
  elements->mesh = std::move(mesh);
  elements->topology = geometry::build_edge_topology(elements->mesh.triangles);
  return elements;
}

geometry::TriangleMesh grid_mesh(int nx, int ny, double width, double height, double jitter) {
  geometry::TriangleMesh mesh;
  core::Random random(7, 0);
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      const bool is_inside = i > 0 && j > 0 && i < nx && j < ny;
      const double dx = is_inside ? random.uniform(-jitter, jitter) : 0.0;
      const double dy = is_inside ? random.uniform(-jitter, jitter) : 0.0;
      mesh.positions.emplace_back((i + dx) * width / nx, (j + dy) * height / ny, 0.0);
    }
  const auto vertex = [nx](int i, int j) { return j * (nx + 1) + i; };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
      if ((i + j) % 2 == 0) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
      }
    }
  return mesh;
}
Elements grid(int nx, int ny, double width, double height, double jitter) {
  return make_elements(grid_mesh(nx, ny, width, height, jitter));
}

Elements disc(int rings) {
  geometry::TriangleMesh mesh;
  mesh.positions.emplace_back(0.0, 0.0, 0.0);
  const auto first = [](int ring) { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1); };
  for (int ring = 1; ring <= rings; ++ring)
    for (int i = 0; i < 6 * ring; ++i) {
      const double angle = 2.0 * core::kPi * i / (6.0 * ring);
      const double radius = static_cast<double>(ring) / rings;
      mesh.positions.emplace_back(radius * core::cos(angle), radius * core::sin(angle), 0.0);
    }
  for (int ring = 1; ring <= rings; ++ring)
    for (int sector = 0; sector < 6; ++sector)
      for (int i = 0; i < ring; ++i) {
        const auto outer = [&](int k) { return first(ring) + (sector * ring + k) % (6 * ring); };
        const auto inner = [&](int k) {
          return ring == 1 ? 0 : first(ring - 1) + (sector * (ring - 1) + k) % (6 * (ring - 1));
        };
        mesh.triangles.push_back({outer(i), outer(i + 1), inner(i)});
        if (i + 1 < ring) mesh.triangles.push_back({inner(i), outer(i + 1), inner(i + 1)});
      }
  return make_elements(std::move(mesh));
}

Elements icosphere(int level, double radius) {
  geometry::TriangleMesh mesh;
  mesh.positions.emplace_back(0.0, 0.0, 1.0);
  const double z = 1.0 / core::sqrt(5.0);
  const double r = 2.0 * z;
  for (int i = 0; i < 10; ++i) {
    const double angle = core::kPi * (2 * (i % 5) + (i < 5 ? 0 : 1)) / 5.0;
    mesh.positions.emplace_back(r * core::cos(angle), r * core::sin(angle), i < 5 ? z : -z);
  }
  mesh.positions.emplace_back(0.0, 0.0, -1.0);
  for (int i = 0; i < 5; ++i) {
    const int j = (i + 1) % 5;
    mesh.triangles.push_back({0, 1 + i, 1 + j});
    mesh.triangles.push_back({1 + i, 6 + i, 1 + j});
    mesh.triangles.push_back({1 + j, 6 + i, 6 + j});
    mesh.triangles.push_back({11, 6 + j, 6 + i});
  }
  for (int l = 0; l < level; ++l) {
    std::map<std::array<int, 2>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [found, is_new] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(mesh.positions.size()));
      if (is_new) {
        const Vec3 sum =
            mesh.positions[static_cast<std::size_t>(a)] + mesh.positions[static_cast<std::size_t>(b)];
        mesh.positions.push_back(sum.normalized());
      }
      return found->second;
    };
    std::vector<geometry::Triangle> finer;
    for (const auto& t : mesh.triangles) {
      const int a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      finer.push_back({t[0], a, c});
      finer.push_back({a, t[1], b});
      finer.push_back({c, b, t[2]});
      finer.push_back({a, b, c});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3& position : mesh.positions) position *= radius;
  return make_elements(std::move(mesh));
}

ShellProperties properties_of(double thickness, double poisson_ratio) {
  ShellProperties properties;
  properties.youngs_modulus = 2e9;
  properties.poisson_ratio = poisson_ratio;
  properties.density = 1200.0;
  properties.thickness = thickness;
  return properties;
}

double bending_stiffness(const ShellProperties& p) {
  return p.youngs_modulus * p.thickness * p.thickness * p.thickness /
         (12.0 * (1.0 - p.poisson_ratio * p.poisson_ratio));
}

std::shared_ptr<const ShellSystem> make_system(const std::shared_ptr<const ShellStiffness>& stiffness,
                                               const geometry::ShellMesh& mesh, double screening,
                                               const ShellSupport& support) {
  auto system = ShellSystem::make(stiffness, mesh, screening, support);
  if (!system.ok()) throw std::runtime_error(system.error());
  return system.value();
}

ShellSupport square_support(const geometry::ShellMesh& mesh, bool is_clamped) {
  const auto& elements = *mesh.elements;
  std::vector<char> vertices(elements.mesh.positions.size(), 0);
  std::vector<char> edges(elements.topology.edges.size(), 0);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!elements.topology.is_boundary(static_cast<int>(e))) continue;
    edges[e] = is_clamped ? 1 : 0;
    for (const int v : elements.topology.edges[e]) vertices[core::at(v)] = 1;
  }
  return find_support(mesh, vertices, edges);
}

VecX pressure_load(const geometry::ShellMesh& mesh, double pressure) {
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  for (const geometry::ShellCell& cell : mesh.cells) {
    const Vec3 normal = geometry::facet_frame(*mesh.elements, cell.element).col(2);
    for (const int v : cell.vertices) load.segment<3>(vertex_dof(v)) += pressure * cell.area / 3.0 * normal;
  }
  return load;
}

}  // namespace shatterbox::sandbox::study::model
