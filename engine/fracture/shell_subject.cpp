#include "engine/fracture/shell_subject.h"

#include <algorithm>

#include "engine/core/index.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kStraight = 1e-3;  // of its length: how wide a support may be and still be a line

/// Whether what is held of a body's own mesh lies on one straight line: a hinge that nothing keeps from
/// turning.
bool is_held_on_a_line(const geometry::ShellMesh& mesh, const std::vector<char>& is_vertex_held) {
  const geometry::ShellElements& elements = *mesh.elements;
  const std::vector<char> none(elements.topology.edges.size(), 0);
  std::vector<Vec3> held;
  for (const int v : stress::find_support(mesh, is_vertex_held, none).vertices)
    held.push_back(elements.mesh.positions[at(mesh.vertex_source[at(v)])]);
  Vec3 span = Vec3::Zero();
  for (const Vec3& p : held)
    if ((p - held.front()).squaredNorm() > span.squaredNorm()) span = p - held.front();
  const double width = kStraight * span.squaredNorm();
  return std::all_of(held.begin(), held.end(),
                     [&](const Vec3& p) { return (p - held.front()).cross(span).norm() <= width; });
}

}  // namespace

stress::ShellProperties properties_of(const ShellSubject& subject) {
  stress::ShellProperties p;
  p.youngs_modulus = subject.material.young;
  p.poisson_ratio = subject.material.poisson;
  p.density = subject.material.density;
  p.thickness = subject.thickness;
  return p;
}

stress::ShellSupport support_of(const ShellSubject& subject, const geometry::ShellMesh& mesh) {
  if (subject.clamped_vertices.empty()) return {};
  const geometry::ShellElements& elements = *mesh.elements;
  std::vector<char> vertices(elements.mesh.positions.size(), 0);
  for (const int v : subject.clamped_vertices) vertices[at(v)] = 1;
  std::vector<char> edges(elements.topology.edges.size(), 0);
  if (is_held_on_a_line(*subject.mesh, vertices)) {
    for (Size e = 0; e < edges.size(); ++e) {
      const auto& ends = elements.topology.edges[e];
      edges[e] = vertices[at(ends[0])] && vertices[at(ends[1])];
    }
  } else {
    for (Size t = 0; t < elements.mesh.triangles.size(); ++t) {
      const geometry::Triangle& triangle = elements.mesh.triangles[t];
      if (std::all_of(triangle.begin(), triangle.end(), [&](int v) { return vertices[at(v)] != 0; }))
        for (const int e : elements.topology.triangle_edges[t]) edges[at(e)] = 1;
    }
  }
  return stress::find_support(mesh, vertices, edges);
}

}  // namespace shatterbox::fracture
