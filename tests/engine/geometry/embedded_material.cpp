#include "engine/geometry/embedded_material.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numeric>

#include "engine/core/index.h"
#include "engine/core/random.h"
#include "engine/geometry/box_tets.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/mesh_diagnosis.h"
#include "tests/engine/geometry/closed_surfaces.h"

using namespace shatterbox;
using namespace shatterbox::geometry;

namespace {

using core::at;

std::shared_ptr<const SolidElements> make_elements(TetMesh mesh) {
  auto elements = std::make_shared<SolidElements>();
  elements->mesh = std::move(mesh);
  elements->topology = build_tet_topology(elements->mesh.tetrahedra);
  return elements;
}

Vec3 area_vector(const SolidMaterial& material, const FacetLoop& facet) {
  const auto corner = [&](int i) -> const Vec3& {
    return material.vertices[at(material.corners[at(facet.first_corner + i)])].position;
  };
  Vec3 sum = Vec3::Zero();
  for (int i = 2; i < facet.corner_count; ++i)
    sum += 0.5 * (corner(i - 1) - corner(0)).cross(corner(i) - corner(0));
  return sum;
}

/// The number of sides of cells that are not used as often in one direction as in the other.
int count_open_sides(const SolidMaterial& material) {
  std::map<std::array<int, 3>, int> counts;
  for (const FacetLoop& facet : material.facets)
    for (const int side : {0, 1}) {
      const int cell = facet.cells[at(side)];
      if (cell < 0) continue;
      for (int i = 0; i < facet.corner_count; ++i) {
        int a = material.corners[at(facet.first_corner + i)];
        int b = material.corners[at(facet.first_corner + (i + 1) % facet.corner_count)];
        if (side == 1) std::swap(a, b);
        counts[{cell, std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
      }
    }
  return static_cast<int>(
      std::count_if(counts.begin(), counts.end(), [](const auto& entry) { return entry.second != 0; }));
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// All that must hold of any embedding.
EmbeddedMaterial check(const std::shared_ptr<const SolidElements>& elements, const TriangleMesh& surface) {
  core::Result<EmbeddedMaterial> result = embed_surface(*elements, surface);
  REQUIRE(result);
  const EmbeddedMaterial& embedded = result.value();
  const SolidMaterial& material = embedded.material;
  const double size = elements->mesh.positions.empty() ? 0.0 : elements->mesh.positions[0].norm();

  CHECK(count_open_sides(material) == 0);
  // But for rounding of positions: that is of what is thin, too.
  const double rounding = 1e-15 * size * surface_area(surface);
  const auto enclosed = Approx(enclosed_volume(surface)).epsilon(1e-12).margin(rounding);
  CHECK(sum_of(embedded.volumes) == enclosed);
  CHECK(sum_of(embedded_volumes(*elements, embedded)) == enclosed);
  CHECK(std::is_sorted(material.cell_elements.begin(), material.cell_elements.end()));
  for (std::size_t c = 0; c < embedded.volumes.size(); ++c) {
    const double whole = tetrahedron_volume(elements->mesh, material.cell_elements[c]);
    CHECK(embedded.volumes[c] > 0.0);
    CHECK(embedded.volumes[c] <= (1.0 + 1e-12) * whole);
    if (embedded.is_whole[c]) CHECK(embedded.volumes[c] == whole);
  }

  // Each given triangle is covered, and faces outwards.
  std::vector<Vec3> areas(surface.triangles.size(), Vec3::Zero());
  Vec3 first_moment = Vec3::Zero();
  for (const FacetLoop& facet : material.facets) {
    if (facet.kind != FacetKind::outer) {
      CHECK((facet.cells[0] >= 0 && facet.cells[1] >= 0 && facet.cells[0] != facet.cells[1]));
      continue;
    }
    CHECK(facet.cells[1] == -1);
    areas[at(facet.tag)] += area_vector(material, facet);
  }
  for (std::size_t t = 0; t < areas.size(); ++t) {
    const Triangle& corners = surface.triangles[t];
    const Vec3& a = surface.positions[at(corners[0])];
    const Vec3 whole =
        0.5 * (surface.positions[at(corners[1])] - a).cross(surface.positions[at(corners[2])] - a);
    CHECK((areas[t] - whole).norm() <= 1e-12 * (whole.norm() + size * size));
  }

  // The centroid of all, and vertices as means of nodes.
  for (std::size_t c = 0; c < embedded.volumes.size(); ++c)
    first_moment += embedded.volumes[c] * embedded.centroids[c];
  const MassProperties mass = solid_mass_properties(surface, 1.0);
  CHECK((first_moment / mass.mass - mass.centre).norm() <= 1e-11 * size);
  for (const SolidVertex& vertex : material.vertices) {
    Vec3 mean = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k)
      if (vertex.nodes[k] >= 0) mean += vertex.weights[k] * elements->mesh.positions[at(vertex.nodes[k])];
    CHECK((mean - vertex.position).norm() <= 1e-12 * size);
  }

  SolidComplex complex = build_solid_complex(elements, material);
  settle(complex);
  CHECK(are_cells_closed(complex));
  CHECK(total_volume(complex) == enclosed);
  return std::move(result.value());
}

TriangleMesh moved(TriangleMesh surface, const Vec3& way) {
  for (Vec3& p : surface.positions) p += way;
  return surface;
}

TriangleMesh turned(TriangleMesh surface, const Vec3& axis, double angle) {
  const Mat3 rotation = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  for (Vec3& p : surface.positions) p = rotation * p;
  return surface;
}

/// Corners at multiples of an eighth.
std::shared_ptr<const SolidElements> eighths() {
  return make_elements(make_box_tets(Vec3::Constant(0.5), 0.125).value());
}

/// The middle of some element near the middle of all.
Vec3 inner_place(const SolidElements& elements) {
  Vec3 best = Vec3::Ones();
  for (const Tetrahedron& t : elements.mesh.tetrahedra) {
    Vec3 middle = Vec3::Zero();
    for (const int v : t) middle += 0.25 * elements.mesh.positions[at(v)];
    if (middle.norm() < best.norm()) best = middle;
  }
  return best;
}

}  // namespace

TEST_CASE("embedded material: a box in general position") {
  const auto elements = eighths();
  core::Random random(1, 1);
  for (int i = 0; i < 5; ++i) {
    const Vec3 axis(random.uniform(-1, 1), 1.0, 0.3);
    check(elements,
          moved(turned(make_box_surface(Vec3(0.27, 0.21, 0.13)), axis, 2.0 * i), {0.03, -0.04, 0.02}));
  }
}

TEST_CASE("embedded material: a box along the elements' faces, through their nodes, on their edges") {
  const auto elements = eighths();
  // Faces on planes of the lattice: of corners (multiples of 1/8), of middles (odd sixteenths), mixed.
  for (const Vec3& half : {Vec3(0.25, 0.25, 0.25), Vec3(0.1875, 0.1875, 0.1875), Vec3(0.25, 0.1875, 0.3),
                           Vec3(0.25, 0.125, 0.0625)})
    for (const Vec3& way :
         {Vec3(0, 0, 0), Vec3(0.125, 0, 0), Vec3(0.0625, 0.0625, 0.0625), Vec3(0.0625, 0, 0)}) {
      const EmbeddedMaterial embedded = check(elements, moved(make_box_surface(half), way));
      // What has no volume is nobody's cell.
      for (std::size_t c = 0; c < embedded.volumes.size(); ++c)
        CHECK(embedded.volumes[c] > 1e-6 * 0.125 * 0.125 * 0.125);
    }
}

TEST_CASE("embedded material: surfaces made of the elements' own faces") {
  // The border of all elements that have one vertex in common; of all inside a ball; turned over, none fits.
  const auto elements = eighths();
  for (const double radius : {0.13, 0.2, 0.3}) {
    TetMesh part{elements->mesh.positions, {}};
    for (const Tetrahedron& t : elements->mesh.tetrahedra) {
      Vec3 middle = Vec3::Zero();
      for (const int v : t) middle += 0.25 * elements->mesh.positions[at(v)];
      if (middle.norm() < radius) part.tetrahedra.push_back(t);
    }
    const TriangleMesh surface = boundary_surface(part, build_tet_topology(part.tetrahedra));
    const EmbeddedMaterial embedded = check(elements, surface);
    CHECK(embedded.volumes.size() == part.tetrahedra.size());
    for (std::size_t c = 0; c < embedded.volumes.size(); ++c)
      CHECK(embedded.volumes[c] ==
            Approx(tetrahedron_volume(elements->mesh, embedded.material.cell_elements[c])).epsilon(1e-12));
  }
}

TEST_CASE("embedded material: vertices on nodes, edges through nodes and along edges") {
  const auto elements = eighths();
  TriangleMesh octahedron;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) octahedron.positions.push_back(sign * 0.25 * Vec3::Unit(axis));
  octahedron.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                          {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (const Vec3& way :
       {Vec3(0, 0, 0), Vec3(0.125, 0.125, 0), Vec3(0.0625, 0.0625, 0.0625), Vec3(0.0625, 0, 0)})
    check(elements, moved(octahedron, way));
}

TEST_CASE("embedded material: sphere, torus, ornament, finer and coarser than the elements") {
  const auto elements = eighths();
  for (const double h : {0.3, 0.05, 0.02}) check(elements, make_sphere(0.4, fine(h)).value());
  check(elements, make_torus(0.3, 0.1, fine(0.04)).value());
  check(elements, turned(make_torus(0.3, 0.03, fine(0.02)).value(), {1.0, 2.0, 0.5}, 0.7));
  OrnamentSizes sizes;
  sizes.radius = 0.35;
  sizes.neck_radius = 0.08;
  sizes.neck_height = 0.06;
  sizes.has_cap = true;
  check(elements, make_ornament(sizes, fine(0.04)).value().mesh);
  // Everything inside one element.
  const EmbeddedMaterial small =
      check(elements, moved(make_sphere(0.005, fine(0.002)).value(), inner_place(*elements)));
  CHECK(small.volumes.size() == 1);
}

TEST_CASE("embedded material: plates thinner than an element, parallel sheets are cells of their own") {
  const auto elements = eighths();
  for (const double thickness : {0.03, 1e-3, 1e-6}) {
    check(elements, turned(make_box_surface(Vec3(0.3, 0.3, 0.5 * thickness)), {1.0, 0.4, 0.2}, 0.3));
    check(elements, make_box_surface(Vec3(0.3, 0.3, 0.5 * thickness)));
    check(elements, moved(make_box_surface(Vec3(0.25, 0.25, 0.5 * thickness)), {0.0, 0.0, 0.5 * thickness}));
  }
  TriangleMesh sheets = moved(make_box_surface(Vec3(0.3, 0.3, 0.005)), {0.0, 0.0, 0.026});
  const EmbeddedMaterial one = check(elements, sheets);
  append(sheets, moved(make_box_surface(Vec3(0.3, 0.3, 0.005)), {0.0, 0.0, 0.040}));
  const EmbeddedMaterial two = check(elements, sheets);
  const auto has_two_cells = [](const EmbeddedMaterial& embedded) {
    int count = 0;
    for (std::size_t c = 1; c < embedded.volumes.size(); ++c)
      count += embedded.material.cell_elements[c] == embedded.material.cell_elements[c - 1];
    return count;
  };
  CHECK(has_two_cells(one) == 0);
  CHECK(has_two_cells(two) > 100);
}

TEST_CASE("embedded material: a hollow belongs to the material around it") {
  const auto elements = eighths();
  TriangleMesh hollow = make_sphere(0.4, fine(0.05)).value();
  TriangleMesh inner = make_sphere(0.3, fine(0.03)).value();
  for (Triangle& t : inner.triangles) std::swap(t[1], t[2]);
  append(hollow, inner);
  check(elements, hollow);
  // A bubble in one element, far from its faces.
  TriangleMesh bubble = make_sphere(0.4, fine(0.05)).value();
  inner = moved(make_sphere(0.005, fine(0.004)).value(), inner_place(*elements));
  for (Triangle& t : inner.triangles) std::swap(t[1], t[2]);
  append(bubble, inner);
  const EmbeddedMaterial embedded = check(elements, bubble);
  const auto& owners = embedded.material.cell_elements;
  CHECK(std::adjacent_find(owners.begin(), owners.end()) == owners.end());  // one cell an element
}

TEST_CASE("embedded material: spikes, saws and needles") {
  const auto elements = eighths();
  core::Random random(5, 6);
  for (int run = 0; run < 4; ++run) {
    // A sphere whose vertices go in and out: through faces, along edges, many times through an element.
    TriangleMesh star = make_sphere(1.0, fine(0.25)).value();
    for (Vec3& p : star.positions) p *= random.uniform(0.05, 0.45);
    check(elements, star);
  }
}

TEST_CASE("embedded material: random polyhedra whose corners lie on nodes, edges and faces") {
  const auto elements = eighths();
  core::Random random(2, 1);
  int checked = 0;
  for (int run = 0; run < 20; ++run) {
    Meshing meshing = fine(random.uniform(0.3, 0.9));
    meshing.seed = static_cast<std::uint64_t>(run);
    TriangleMesh surface = make_sphere(1.0, meshing).value();
    const double depth = random.uniform(0.0, 0.5), steps = run % 3 == 0 ? 8.0 : run % 3 == 1 ? 16.0 : 32.0;
    for (Vec3& p : surface.positions) {
      p *= 0.4 * (1.0 - depth * random.uniform());
      for (int axis = 0; axis < 3; ++axis) p[axis] = std::floor(p[axis] * steps + 0.5) / steps;
    }
    const MendedMesh mended = mend_solid(surface);
    // Rounding to the lattice may make a surface cross or touch itself.
    if (mended.diagnosis.refused() || !embed_surface(*elements, mended.mesh)) continue;
    check(elements, mended.mesh);
    ++checked;
  }
  CHECK(checked > 15);
}

TEST_CASE("embedded material: what is not covered, open or crosses itself is refused with the place") {
  const auto elements = eighths();
  const auto says = [&](const TriangleMesh& surface, const char* words) {
    const core::Result<EmbeddedMaterial> result = embed_surface(*elements, surface);
    REQUIRE_FALSE(result);
    INFO(result.error());
    CHECK(result.error().find(words) != std::string::npos);
  };
  says(make_box_surface(Vec3::Constant(0.6)), "do not cover");
  says(make_box_surface(Vec3(0.6, 0.1, 0.1)), "do not cover");
  TriangleMesh open = make_box_surface(Vec3::Constant(0.2));
  open.triangles.pop_back();
  says(open, "not closed");
  TriangleMesh crossing = make_box_surface(Vec3::Constant(0.2));
  append(crossing, moved(make_box_surface(Vec3::Constant(0.2)), Vec3(0.11, 0.12, 0.13)));
  says(crossing, "crosses itself");
}

TEST_CASE("embedded material: the same bits again") {
  const auto elements = eighths();
  const TriangleMesh surface = make_torus(0.3, 0.1, fine(0.04)).value();
  const EmbeddedMaterial a = embed_surface(*elements, surface).value();
  const EmbeddedMaterial b = embed_surface(*elements, surface).value();
  CHECK(a.volumes == b.volumes);
  CHECK(a.material.corners == b.material.corners);
  CHECK(a.material.cell_elements == b.material.cell_elements);
}
