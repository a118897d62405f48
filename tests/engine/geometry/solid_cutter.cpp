// Cutting a solid: whatever is cut, cells stay closed and their volumes sum to what they were.
#include "engine/geometry/solid_cutter.h"

#include <catch2/catch.hpp>

#include "engine/geometry/solid_contacts.h"
#include "tests/engine/geometry/solids.h"

using namespace shatterbox;
using namespace shatterbox::geometry;

namespace {

int count_facets(const SolidComplex& complex, FacetKind kind) {
  int count = 0;
  for (const SolidFacet& facet : complex.facets) count += facet.parts[0] < 0 && facet.kind == kind;
  return count;
}

double crack_area(const SolidComplex& complex) {
  double area = 0.0;
  for (const SolidFacet& facet : complex.facets)
    if (facet.parts[0] < 0 && facet.kind == FacetKind::crack)
      area += facet_area_vector(complex, facet).norm();
  return area;
}

/// Material in the centroid's weights: the first moment of the whole, m4.
Vec3 first_moment(const SolidComplex& complex) {
  Vec3 sum = Vec3::Zero();
  for (const SolidPart& cell : complex.cells) {
    const Tetrahedron& nodes = complex.elements->mesh.tetrahedra[static_cast<std::size_t>(cell.element)];
    const auto x = [&](std::size_t i) {
      return complex.elements->mesh.positions[static_cast<std::size_t>(nodes[i])];
    };
    Vec3 centroid = x(0);
    for (int k = 0; k < 3; ++k) centroid += cell.centroid[k] * (x(static_cast<std::size_t>(k) + 1) - x(0));
    sum += cell.volume * centroid;
  }
  return sum;
}

/// One large element whose material is those unit cubes (x, y, z), of 3 x 3 x 3, that `holds` tells.
template <class Holds>
SolidComplex make_block(const Holds& holds) {
  auto elements = std::make_shared<SolidElements>();
  elements->mesh.positions = {{-1, -1, -1}, {20, -1, -1}, {-1, 20, -1}, {-1, -1, 20}};
  elements->mesh.tetrahedra = {{0, 1, 2, 3}};
  elements->topology = build_tet_topology(elements->mesh.tetrahedra);
  SolidMaterial material;
  material.cell_elements = {0};
  const auto is_full = [&](int x, int y, int z) {
    return x >= 0 && y >= 0 && z >= 0 && x <= 2 && y <= 2 && z <= 2 && holds(x, y, z);
  };
  for (int v = 0; v < 64; ++v) {
    SolidVertex vertex;
    vertex.position = Vec3(v & 3, (v >> 2) & 3, v >> 4);
    vertex.nodes = {0, 1, 2, 3};
    const Vec3 w = (vertex.position + Vec3::Ones()) / 21.0;
    vertex.weights = {1.0 - w.sum(), w.x(), w.y(), w.z()};
    material.vertices.push_back(vertex);
  }
  const auto number = [](const Eigen::Vector3i& p) { return p.x() + 4 * p.y() + 16 * p.z(); };
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      for (int z = 0; z < 3; ++z)
        for (int k = 0; k < 6 && is_full(x, y, z); ++k) {
          const int axis = k / 2, up = k % 2;
          Eigen::Vector3i next(x, y, z);
          next[axis] += up ? 1 : -1;
          if (is_full(next.x(), next.y(), next.z())) continue;
          Eigen::Vector3i a(x, y, z);
          a[axis] += up;
          Eigen::Vector3i b = a, c = a, d = a;
          b[(axis + 1) % 3] += 1;
          c[(axis + 1) % 3] += 1;
          c[(axis + 2) % 3] += 1;
          d[(axis + 2) % 3] += 1;
          const std::array<Eigen::Vector3i, 4> loop = up ? std::array{a, b, c, d} : std::array{a, d, c, b};
          FacetLoop facet;
          facet.first_corner = static_cast<int>(material.corners.size());
          facet.corner_count = 4;
          facet.cells = {0, -1};
          facet.kind = FacetKind::outer;
          for (const auto& p : loop) material.corners.push_back(number(p));
          material.facets.push_back(facet);
        }
  return build_solid_complex(elements, material);
}

}  // namespace

TEST_CASE("solid cutter: a tetrahedron loses a corner") {
  auto elements = std::make_shared<SolidElements>();
  elements->mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  elements->mesh.tetrahedra = {{0, 1, 2, 3}};
  elements->topology = build_tet_topology(elements->mesh.tetrahedra);
  SolidComplex complex = make_solid_complex(elements);
  SolidCutter cutter(complex);
  cutter.cut(test::plane_cut(complex, Vec3::UnitX(), 0.75));
  settle(complex);
  REQUIRE(complex.cells.size() == 2);
  CHECK(are_cells_closed(complex));
  const int corner = cutter.side_of(0) > 0 ? 0 : 1;
  CHECK(complex.cells[static_cast<std::size_t>(corner)].volume == Approx(1.0 / 6.0 / 64.0));
  CHECK(total_volume(complex) == Approx(1.0 / 6.0).epsilon(1e-14));
  CHECK((first_moment(complex) - Vec3::Constant(1.0 / 24.0)).norm() < 1e-16);
  CHECK(complex.cells[static_cast<std::size_t>(corner)].centroid[0] == Approx(0.75 + 0.25 / 4.0));
  CHECK(crack_area(complex) == Approx(0.5 / 16.0));
  CHECK(cutter.cells_of(0) == std::vector<int>{0, 1});
}

TEST_CASE("solid cutter: a plane through a cube leaves the plane's area and both volumes") {
  for (const double place : {0.1, 0.25, 0.5, 0.53}) {
    SolidComplex complex = make_solid_complex(test::make_cube_elements(4, 0.2));
    SolidCutter cutter(complex, 1e-6);
    cutter.cut(test::plane_cut(complex, Vec3(1, 2, 2) / 3.0, place * 5.0 / 3.0));
    settle(complex);
    CHECK(are_cells_closed(complex));
    double below = 0.0;
    for (std::size_t c = 0; c < complex.cells.size(); ++c)
      if (cutter.side_of(static_cast<int>(c)) < 0) below += complex.cells[c].volume;
    // The part of the cube below n . x = d: sum over corners of (-1)^k max(d - n . corner, 0)^3 / (6 n1 n2
    // n3).
    const double d = place * 5.0 / 3.0;
    double exact = 0.0, area = 0.0;
    for (int i = 0; i < 8; ++i) {
      const double rest = d - ((i & 1) * 1.0 + ((i >> 1) & 1) * 2.0 + ((i >> 2) & 1) * 2.0) / 3.0;
      const double sign = ((i & 1) + ((i >> 1) & 1) + ((i >> 2) & 1)) % 2 == 0 ? 1.0 : -1.0;
      if (rest > 0.0) exact += sign * rest * rest * rest / (6.0 * 4.0 / 27.0);
      if (rest > 0.0) area += sign * rest * rest / (2.0 * 4.0 / 27.0);
    }
    CHECK(below == Approx(exact).epsilon(1e-5));
    CHECK(crack_area(complex) == Approx(area).epsilon(1e-4));
    CHECK(total_volume(complex) == Approx(1.0).epsilon(1e-13));
  }
}

TEST_CASE("solid cutter: along element faces, through nodes and edges, nothing is cut but opened") {
  SolidComplex complex = make_solid_complex(test::make_cube_elements(2));
  SolidCutter cutter(complex);
  cutter.cut(test::plane_cut(complex, Vec3::UnitX(), 0.5));
  CHECK(complex.cells.size() == 48);
  CHECK(crack_area(complex) == Approx(1.0));
  cutter.cut(test::plane_cut(complex, Vec3(1, -1, 0), 0.0));  // along the diagonals of the elements
  CHECK(complex.cells.size() == 48);
  CHECK(crack_area(complex) == Approx(1.0 + std::sqrt(2.0)));
  settle(complex);
  CHECK(are_cells_closed(complex));
  const SolidMesh mesh = make_solid_mesh(complex, find_solid_contacts(complex));
  // In four prisms, two of 2 x 3 x 3 nodes less one corner edge and two of half as many columns.
  CHECK(mesh.vertex_source.size() == 3 * (5 + 5 + 3 + 3));
}

TEST_CASE("solid cutter: the same cut again, or hardly beside it, changes nothing") {
  SolidComplex complex = make_solid_complex(test::make_cube_elements(3, 0.2));
  SolidCutter cutter(complex);
  const Vec3 normal = Vec3(1, 2, 3).normalized();
  cutter.cut(test::plane_cut(complex, normal, 0.7));
  const std::size_t cells = complex.cells.size();
  const int facets = count_facets(complex, FacetKind::crack);
  for (const double offset : {0.7, 0.7 + 1e-15, 0.7 - 1e-9, 0.7 + 1e-5}) {
    cutter.cut(test::plane_cut(complex, normal, offset, 1));
    CHECK(complex.cells.size() == cells);
    CHECK(count_facets(complex, FacetKind::crack) == facets);
  }
}

TEST_CASE("solid cutter: a crack that ends inside is closed at its tip, one that ends at a crack parts") {
  SolidComplex complex = make_solid_complex(test::make_cube_elements(4));
  SolidCutter cutter(complex);
  SolidCut cut = test::plane_cut(complex, Vec3::UnitX(), 0.55);
  // Active where the elements lie below z = 0.5: a slit.
  std::erase_if(cut.cells, [&](int c) {
    for (const int node : complex.elements->mesh.tetrahedra[static_cast<std::size_t>(c)])
      if (complex.elements->mesh.positions[static_cast<std::size_t>(node)].z() > 0.51) return true;
    return false;
  });
  cutter.cut(cut);
  settle(complex);
  CHECK(are_cells_closed(complex));
  CHECK(crack_area(complex) == Approx(0.5));
  SolidMesh mesh = make_solid_mesh(complex, find_solid_contacts(complex));
  // Every node beside the slit has a copy, those on its front (z = 0.5) do not.
  CHECK(mesh.vertex_source.size() == 125 + 2 * 5 * 2);

  // Another plane on one side of it only: the cells of the slit's positive side.
  SolidCut second = test::plane_cut(complex, Vec3::UnitY(), 0.45);
  std::erase_if(second.cells, [&](int c) { return cutter.side_of(c) <= 0; });
  const double whole = crack_area(complex);
  cutter.cut(second);
  settle(complex);
  CHECK(are_cells_closed(complex));
  CHECK(crack_area(complex) == Approx(whole + 0.5 * 0.45));
  CHECK(total_volume(complex) == Approx(1.0).epsilon(1e-13));
}

TEST_CASE("solid cutter: ten planes through one tetrahedron") {
  core::Random random(5);
  auto elements = std::make_shared<SolidElements>();
  elements->mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  elements->mesh.tetrahedra = {{0, 1, 2, 3}};
  elements->topology = build_tet_topology(elements->mesh.tetrahedra);
  for (int trial = 0; trial < 20; ++trial) {
    SolidComplex complex = make_solid_complex(elements);
    SolidCutter cutter(complex);
    for (int i = 0; i < 10; ++i) {
      const Vec3 normal = Vec3(random.normal(), random.normal(), random.normal()).normalized();
      cutter.cut(
          test::plane_cut(complex, normal, normal.dot(Vec3::Constant(0.2)) + 0.05 * random.normal(), i));
    }
    settle(complex);
    CHECK(complex.cells.size() > 30);
    CHECK(are_cells_closed(complex));
    CHECK(total_volume(complex) == Approx(1.0 / 6.0).epsilon(1e-13));
    const SolidMesh mesh = make_solid_mesh(complex, find_solid_contacts(complex));
    CHECK(mesh.vertex_source.size() == 4 * complex.cells.size());
  }
}

TEST_CASE("solid cutter: cells are not convex, caps have several loops and holes") {
  // 3 x 3 x 3 cubes less a pit of one in the middle of each of two opposite sides: planes across a pit cut a
  // ring, planes along both cut a frame or an H.
  const SolidComplex whole = make_block([](int x, int y, int z) { return !(x == 1 && y == 1 && z != 1); });
  REQUIRE(are_cells_closed(whole));
  CHECK(whole.cells[0].volume == Approx(25.0));

  struct Case {
    Vec3 normal;
    double offset, area;
    std::size_t cells;
  };
  const std::vector<Case> cases{
      {Vec3::UnitZ(), 0.5, 8.0, 2},        // a ring: a hole in the cap
      {Vec3::UnitZ(), 1.5, 9.0, 2},        // through the floor between the pits
      {Vec3::UnitX(), 1.5, 7.0, 2},        // an H
      {Vec3::UnitX(), 1.0, 7.0 + 0.0, 2},  // flush with a side of both pits
      {Vec3::UnitZ(), 1.0, 8.0, 2},        // flush with a floor: steps on both sides
  };
  for (const Case& c : cases) {
    SolidComplex complex = whole;
    SolidCutter cutter(complex, 1e-6);
    cutter.cut(test::plane_cut(complex, c.normal, c.offset));
    settle(complex);
    CHECK(complex.cells.size() == c.cells);
    CHECK(are_cells_closed(complex));
    CHECK(total_volume(complex) == Approx(25.0).epsilon(1e-13));
    CHECK(crack_area(complex) == Approx(c.area));
    const int first = cutter.side_of(0) < 0 ? 0 : 1;
    if (c.normal == Vec3::UnitZ()) {
      const double volume = c.offset <= 1.0 ? 8.0 * c.offset : 8.0 + 9.0 * (c.offset - 1.0);
      CHECK(complex.cells[static_cast<std::size_t>(first)].volume == Approx(volume));
    }
  }
  // Across a corner of a pit: two cuts, and everything cut again at random.
  core::Random random(7);
  for (int trial = 0; trial < 200; ++trial) {
    SolidComplex complex = whole;
    SolidCutter cutter(complex);
    for (int i = 0; i < 4; ++i) {
      const Vec3 normal = Vec3(random.normal(), random.normal(), random.normal()).normalized();
      cutter.cut(test::plane_cut(complex, normal, normal.dot(Vec3::Constant(1.5)) + random.normal(), i));
    }
    settle(complex);
    CHECK(are_cells_closed(complex));
    CHECK(total_volume(complex) == Approx(25.0).epsilon(1e-12));
  }
}

TEST_CASE("solid cutter: a cavity stays with the part about it") {
  const SolidComplex whole = make_block([](int x, int y, int z) { return !(x == 1 && y == 1 && z == 1); });
  REQUIRE(whole.cells[0].volume == Approx(26.0));
  for (const double offset : {0.5, 1.0, 1.5, 2.0, 2.5}) {
    SolidComplex complex = whole;
    SolidCutter cutter(complex, 1e-6);
    cutter.cut(test::plane_cut(complex, Vec3::UnitY(), offset));
    settle(complex);
    CHECK(are_cells_closed(complex));
    REQUIRE(complex.cells.size() == 2);
    const int below = cutter.side_of(0) < 0 ? 0 : 1;
    CHECK(complex.cells[static_cast<std::size_t>(below)].volume ==
          Approx(9.0 * offset - std::clamp(offset - 1.0, 0.0, 1.0)));
  }
}
