// A cracked solid on elements of its own: the same material, whose sides of a crack can part.
#include "engine/geometry/solid_copies.h"

#include <catch2/catch.hpp>

#include <set>

#include "engine/core/index.h"
#include "engine/geometry/crack_lips.h"
#include "engine/geometry/solid_contacts.h"
#include "engine/geometry/solid_deform.h"
#include "engine/geometry/solid_surface.h"
#include "tests/engine/geometry/solids.h"

using namespace shatterbox;
using namespace shatterbox::geometry;
using core::at;

namespace {

SolidMesh mesh_of(const SolidComplex& complex) {
  return make_solid_mesh(complex, find_solid_contacts(complex));
}

/// The unit cube, cut across x from y = 0 until less than `depth`.
SolidComplex make_slit_cube(double depth) {
  SolidComplex cube = make_solid_complex(test::make_cube_elements(10));
  SolidCutter cutter(cube);
  SolidCut cut = test::plane_cut(cube, Vec3::UnitX(), 0.4, 7);
  std::erase_if(cut.cells, [&](int c) {
    const auto& nodes = cube.elements->mesh.tetrahedra[at(cube.cells[at(c)].element)];
    return std::any_of(nodes.begin(), nodes.end(),
                       [&](int v) { return cube.elements->mesh.positions[at(v)].y() > depth + 1e-9; });
  });
  cutter.cut(cut);
  settle(cube);
  return cube;
}

double area_of_kind(const SolidComplex& complex, FacetKind kind) {
  double area = 0.0;
  for (const SolidFacet& facet : complex.facets)
    if (facet.parts[0] < 0 && facet.kind == kind) area += facet_area_vector(complex, facet).norm();
  return area;
}

/// Both sides of the slit turn about its end; below zero into each other.
std::vector<Vec3> turned_sides(const CopiedSolid& copied, double angle) {
  const TetMesh& mesh = copied.complex.elements->mesh;
  std::vector<double> side(mesh.positions.size(), 0.0);
  for (const SolidPart& cell : copied.complex.cells) {
    const double sign = cell_centre(copied.complex, cell).x() > 0.4 ? 1.0 : -1.0;
    for (const int v : mesh.tetrahedra[at(cell.element)])
      if (side[at(v)] == 0.0) side[at(v)] = sign;
  }
  std::vector<Vec3> moves(mesh.positions.size(), Vec3::Zero());
  for (std::size_t v = 0; v < moves.size(); ++v)
    moves[v].x() = angle * side[v] * std::max(0.0, 0.5 - mesh.positions[v].y());
  return moves;
}

/// m: how far the sides have come apart at y = 0, the least; below zero where they are in each other.
double narrowest_mouth(const CopiedSolid& copied, const SolidComplex& moved) {
  double least = 1e300;
  for (const auto& lip : copied.lips) {
    const SolidFacet &behind = moved.facets[at(lip[0])], &in_front = moved.facets[at(lip[1])];
    const double towards_front = facet_area_vector(moved, behind).x() > 0.0 ? 1.0 : -1.0;
    for (int i = 0; i < behind.side_count; ++i) {
      const Vec3& from = moved.position(moved.side_begin(moved.sides_of(behind)[i]));
      const Vec3& to = moved.position(moved.side_begin(moved.sides_of(in_front)[i]));
      if (std::abs(from.y()) < 1e-9) least = std::min(least, towards_front * (to - from).x());
    }
  }
  return least;
}

}  // namespace

TEST_CASE("solid copies: what is uncut is what it was") {
  const SolidComplex cube = make_solid_complex(test::make_cube_elements(3));
  const CopiedSolid copied = copy_elements(cube, mesh_of(cube));
  CHECK(copied.complex.cells.size() == cube.cells.size());
  CHECK(copied.element_sources.size() == cube.elements->mesh.tetrahedra.size());
  CHECK(copied.vertex_sources.size() == cube.elements->mesh.positions.size());
  CHECK(are_cells_closed(copied.complex));
  CHECK(total_volume(copied.complex) == Approx(1.0).epsilon(1e-12));
  CHECK(find_border_facets(copied.complex).size() == find_border_facets(cube).size());
}

TEST_CASE("solid copies: both sides of a slit are border, and its end holds") {
  const SolidComplex cube = make_slit_cube(0.5);
  const SolidMesh mesh = mesh_of(cube);
  const CopiedSolid copied = copy_elements(cube, mesh);
  const SolidComplex& complex = copied.complex;
  REQUIRE(complex.cells.size() == cube.cells.size());
  CHECK(are_cells_closed(complex));
  CHECK(count_parts(complex) == 1);
  CHECK(total_volume(complex) == Approx(1.0).epsilon(1e-12));
  CHECK(area_of_kind(cube, FacetKind::crack) == Approx(0.5).epsilon(1e-9));
  CHECK(area_of_kind(complex, FacetKind::crack) == Approx(1.0).epsilon(1e-9));
  for (const SolidFacet& facet : complex.facets)
    if (facet.kind == FacetKind::crack) CHECK((facet.cells[0] < 0) != (facet.cells[1] < 0));
  // As many copies as the stress has, and each cell in one of its own element.
  CHECK(mesh_of(complex).vertex_source.size() == mesh.vertex_source.size());
  for (std::size_t c = 0; c < complex.cells.size(); ++c) {
    CHECK(copied.element_sources[at(complex.cells[c].element)] == cube.cells[c].element);
    CHECK(complex.cells[c].volume == Approx(cube.cells[c].volume).margin(1e-15));
  }
  CHECK(std::set<int>(copied.element_sources.begin(), copied.element_sources.end()).size() ==
        cube.elements->mesh.tetrahedra.size());
  const SolidSurface surface = extract_surface(complex);
  CHECK(enclosed_volume(surface.mesh) == Approx(1.0).epsilon(1e-9));
}

TEST_CASE("solid copies: what is pulled apart gapes, and its material stays what it was") {
  const SolidComplex cube = make_slit_cube(0.5);
  const CopiedSolid copied = copy_elements(cube, mesh_of(cube));
  std::vector<Vec3> moves = turned_sides(copied, 0.1);
  const std::vector<Vec3> before = moves;
  part_lips(copied, moves);
  CHECK(moves == before);
  REQUIRE(least_volume_share(copied.complex, moves) > 0.3);
  const DeformedSolid open = deform(copied.complex, moves, 1e-4);
  CHECK(are_cells_closed(open.complex));
  CHECK(narrowest_mouth(copied, open.complex) == Approx(0.1).epsilon(1e-6));
  const SolidSurface surface = extract_surface(open.complex);
  CHECK(enclosed_volume(surface.mesh) == Approx(total_volume(open.complex)).epsilon(1e-9));
}

TEST_CASE(
    "solid copies: sides that are pressed into each other do not pass, and what is far off hardly moves") {
  const SolidComplex cube = make_slit_cube(0.5);
  const CopiedSolid copied = copy_elements(cube, mesh_of(cube));
  std::vector<Vec3> moves = turned_sides(copied, -0.1);
  CHECK(narrowest_mouth(copied, deform(copied.complex, moves, 1e-4).complex) == Approx(-0.1).epsilon(1e-6));
  const std::vector<Vec3> before = moves;
  part_lips(copied, moves);
  const double mouth = narrowest_mouth(copied, deform(copied.complex, moves, 1e-4).complex);
  CHECK(mouth > 0.0);
  CHECK(mouth < 0.01);
  double farthest = 0.0;
  for (std::size_t v = 0; v < moves.size(); ++v) farthest = std::max(farthest, (moves[v] - before[v]).norm());
  CHECK(farthest > 0.04);  // half of how deep they were in each other, about
  CHECK(farthest < 0.07);
  for (std::size_t v = 0; v < moves.size(); ++v)
    if (copied.complex.elements->mesh.positions[v].x() > 0.9)
      CHECK((moves[v] - before[v]).norm() < 0.5 * farthest);
}
