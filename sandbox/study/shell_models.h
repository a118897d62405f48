// Small shells whose stress is known in closed form: meshes, supports, loads. Shared with the tests of
// stress.
#pragma once

#include <memory>

#include "engine/stress/shell_system.h"

namespace shatterbox::sandbox::study::model {

using Elements = std::shared_ptr<const geometry::ShellElements>;

Elements make_elements(geometry::TriangleMesh mesh);

/// Plate [0, width] x [0, height] in the plane z = 0, normal +z, diagonals alternating; inner vertices are
/// moved by up to `jitter` of a cell.
geometry::TriangleMesh grid_mesh(int nx, int ny, double width, double height, double jitter = 0.0);
Elements grid(int nx, int ny, double width, double height, double jitter = 0.0);

/// Disc of radius 1 in z = 0: vertex 0 in the middle, ring k has 6 k vertices.
Elements disc(int rings);

/// Sphere: 20 * 4^level triangles; vertices 0 and 11 are poles of the first icosahedron.
Elements icosphere(int level, double radius = 1.0);

stress::ShellProperties properties_of(double thickness, double poisson_ratio = 0.3);
double bending_stiffness(const stress::ShellProperties& properties);  // N m

/// Throws where there is no factor.
std::shared_ptr<const stress::ShellSystem> make_system(
    const std::shared_ptr<const stress::ShellStiffness>& stiffness, const geometry::ShellMesh& mesh,
    double screening = 0.0, const stress::ShellSupport& support = {});

/// Border of the unit square: vertices, and edges if clamped.
stress::ShellSupport square_support(const geometry::ShellMesh& mesh, bool is_clamped);

/// `pressure` (Pa) along every cell's normal.
VecX pressure_load(const geometry::ShellMesh& mesh, double pressure);

}  // namespace shatterbox::sandbox::study::model
