#include "engine/geometry/tetrahedralise.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "engine/core/elementary.h"
#include "engine/core/hash.h"
#include "engine/core/index.h"
#include "engine/core/random.h"
#include "engine/geometry/closest_points.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/orientation.h"
#include "engine/geometry/surface_distance.h"
#include "tests/engine/geometry/closed_surfaces.h"

using namespace shatterbox;
using namespace shatterbox::geometry;

namespace {

constexpr double kOneDegree = core::kPi / 180.0;

using core::at;

struct Shape {
  const char* name;
  TriangleMesh surface;
  double element_size;  // m
};

std::vector<Shape> shapes() {
  OrnamentSizes ornament;
  ornament.has_cap = true;
  return {{"sphere", make_sphere(0.1, fine(0.01)).value(), 0.025},
          {"coarse sphere", make_sphere(0.1, fine(0.08)).value(), 0.02},
          {"box", make_box_surface(Vec3(0.1, 0.07, 0.05)), 0.025},
          {"torus", make_torus(0.1, 0.03, fine(0.01)).value(), 0.015},
          {"ornament", make_ornament(ornament, fine(0.004)).value().mesh, 0.01},
          {"plate", make_box_surface(Vec3(0.1, 0.1, 0.002)), 0.02},
          {"star", make_star(), 0.02},
          {"hollow", make_hollow_ball(), 0.03}};
}

bool contains(const TetMesh& mesh, const Tetrahedron& t, const Vec3& p) {
  for (const auto& face : kTetrahedronFaces)
    if (orientation(mesh.positions[at(t[at(face[0])])], mesh.positions[at(t[at(face[1])])],
                    mesh.positions[at(t[at(face[2])])], p) > 0)
      return false;
  return true;
}

bool is_covered(const TetMesh& mesh, const Vec3& p) {
  return std::any_of(mesh.tetrahedra.begin(), mesh.tetrahedra.end(),
                     [&](const Tetrahedron& t) { return contains(mesh, t, p); });
}

std::uint64_t hash(const EmbeddedSolid& solid) {
  core::Hash hash;
  for (const Vec3& p : solid.elements->mesh.positions) hash.add(p);
  for (const SolidVertex& v : solid.embedded.material.vertices) hash.add(v.position);
  for (const int v : solid.embedded.material.corners) hash.add(static_cast<std::uint64_t>(v));
  return hash.value();
}

}  // namespace

TEST_CASE("tetrahedralise: well-shaped, and all of the inside is in it") {
  for (const bool warps : {false, true})
    for (const Shape& shape : shapes()) {
      INFO(shape.name << " warps " << warps);
      TetrahedraOptions options;
      options.element_size = shape.element_size;
      options.warps = warps;
      const core::Result<EmbeddedSolid> result = tetrahedralise(shape.surface, options);
      REQUIRE(result);
      const EmbeddedSolid& solid = result.value();
      const double volume = enclosed_volume(shape.surface);
      CHECK(solid.quality.least_dihedral >= (warps ? 25.0 : 59.99) * kOneDegree);
      CHECK(solid.quality.greatest_dihedral <= (warps ? 140.0 : 90.01) * kOneDegree);
      CHECK(solid.quality.median_least_dihedral > 44.0 * kOneDegree);
      CHECK(solid.quality.worst_aspect < 6.0);
      double sum = 0.0;
      for (const double v : solid.embedded.volumes) sum += v;
      CHECK(sum == Approx(volume).epsilon(1e-12));
      CHECK(solid.cover_ratio > 1.0);

      // Every element holds something, and the cells are closed.
      std::vector<double> volumes = embedded_volumes(*solid.elements, solid.embedded);
      CHECK(*std::min_element(volumes.begin(), volumes.end()) > 0.0);
      SolidComplex complex = build_solid_complex(solid.elements, solid.embedded.material);
      settle(complex);
      CHECK(are_cells_closed(complex));
      CHECK(total_volume(complex) == Approx(volume).epsilon(1e-12));
      for (const SolidVertex& vertex : solid.embedded.material.vertices) {
        Vec3 mean = Vec3::Zero();
        for (std::size_t k = 0; k < 4; ++k)
          if (vertex.nodes[k] >= 0)
            mean += vertex.weights[k] * solid.elements->mesh.positions[at(vertex.nodes[k])];
        CHECK((mean - vertex.position).norm() <= 1e-12 * shape.element_size);
      }
    }
}

TEST_CASE("tetrahedralise: graded, the tetrahedra fit together, are well-shaped and few") {
  struct Case {
    Shape shape;
    int grading;
    double share;  // of the ungraded ones, at most
  };
  const TriangleMesh ball = make_sphere(0.1, fine(0.01)).value();
  for (const Case& c :
       {Case{{"ball", ball, 0.01}, 2, 0.78}, Case{{"small ball", ball, 0.02}, 2, 1.0},
        Case{{"fine ball", ball, 0.006}, 4, 0.6},
        Case{{"box", make_box_surface(Vec3(0.1, 0.07, 0.05)), 0.008}, 8, 0.75},
        Case{{"star", make_star(), 0.008}, 4, 0.9}, Case{{"hollow", make_hollow_ball(), 0.01}, 2, 1.0}}) {
    INFO(c.shape.name << " " << c.grading);
    TetrahedraOptions options;
    options.element_size = c.shape.element_size;
    const EmbeddedSolid even = tetrahedralise(c.shape.surface, options).value();
    options.grading = c.grading;
    const EmbeddedSolid solid = tetrahedralise(c.shape.surface, options).value();
    CHECK(solid.quality.count <= c.share * even.quality.count);
    CHECK(solid.quality.least_dihedral >= 25.0 * kOneDegree);
    CHECK(solid.quality.greatest_dihedral <= 140.0 * kOneDegree);
    CHECK(solid.quality.median_least_dihedral > 44.0 * kOneDegree);
    // They fit: the border is closed, and encloses what their volumes add up to.
    const TetMesh& mesh = solid.elements->mesh;
    const TriangleMesh border = boundary_surface(mesh, solid.elements->topology);
    const EdgeTopology edges = build_edge_topology(border.triangles);
    int open = 0;
    for (int e = 0; e < static_cast<int>(edges.edges.size()); ++e) open += edges.triangle_count(e) % 2;
    CHECK(open == 0);
    CHECK(enclosed_volume(border) == Approx(total_volume(mesh)).epsilon(1e-10));
    CHECK(solid.quality.least_volume > 0.0);
    // Every facet between elements is one facet of both: what the surface encloses is all in closed cells.
    SolidComplex complex = build_solid_complex(solid.elements, solid.embedded.material);
    settle(complex);
    CHECK(are_cells_closed(complex));
    CHECK(total_volume(complex) == Approx(enclosed_volume(c.shape.surface)).epsilon(1e-10));
    // At the surface they are as small as asked for.
    const SurfaceDistance distance(c.shape.surface);
    double longest = 0.0;
    for (const auto& [v, w] : solid.elements->topology.edges) {
      const Vec3 &p = mesh.positions[at(v)], &q = mesh.positions[at(w)];
      if (distance.find(0.5 * (p + q), options.element_size).triangle >= 0)
        longest = std::max(longest, (p - q).norm());
    }
    CHECK(longest < 1.65 * options.element_size);  // one and both its ends moved
  }
}

TEST_CASE("tetrahedralise: a lattice that is graded has no angle below 45 degrees") {
  const TriangleMesh surface = make_sphere(0.1, fine(0.01)).value();
  TetrahedraOptions options;
  options.element_size = 0.006;
  options.grading = 4;
  options.warps = false;
  const EmbeddedSolid solid = tetrahedralise(surface, options).value();
  CHECK(solid.quality.least_dihedral > 44.99 * kOneDegree);
  CHECK(solid.quality.greatest_dihedral < 120.01 * kOneDegree);
}

TEST_CASE("tetrahedralise: points just inside the surface, its corners and edges are covered") {
  core::Random random(11, 12);
  for (const Shape& shape : shapes()) {
    INFO(shape.name);
    TetrahedraOptions options;
    options.element_size = shape.element_size;
    const EmbeddedSolid solid = tetrahedralise(shape.surface, options).value();
    for (int i = 0; i < 300; ++i) {
      const Triangle& t = shape.surface.triangles[random.index(shape.surface.triangles.size())];
      const Vec3 &a = shape.surface.positions[at(t[0])], &b = shape.surface.positions[at(t[1])],
                 &c = shape.surface.positions[at(t[2])];
      // In the triangle, on a side of it, or at a corner.
      double u = i % 3 == 2 ? 1.0 : random.uniform(), v = i % 3 == 0 ? random.uniform() : 0.0;
      if (u + v > 1.0 && i % 3 == 0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      const Vec3 normal = (b - a).cross(c - a).normalized();
      CHECK(is_covered(solid.elements->mesh, a + u * (b - a) + v * (c - a) - 1e-9 * normal));
    }
  }
}

TEST_CASE("tetrahedralise: moving vertices leaves hardly any element with a sliver of material") {
  const TriangleMesh surface = make_sphere(0.1, fine(0.006)).value();
  const auto count_slivers = [&](bool warps) {
    TetrahedraOptions options;
    options.element_size = 0.02;
    options.warps = warps;
    const EmbeddedSolid solid = tetrahedralise(surface, options).value();
    int count = 0;
    for (std::size_t c = 0; c < solid.embedded.volumes.size(); ++c)
      count += solid.embedded.volumes[c] <
               0.02 * tetrahedron_volume(solid.elements->mesh, solid.embedded.material.cell_elements[c]);
    return count;
  };
  CHECK(count_slivers(false) > 300);
  CHECK(count_slivers(true) < 20);
}

TEST_CASE("tetrahedralise: about as many as asked for") {
  for (const auto& [count, grading] : {std::pair{2000, 1}, {20000, 1}, {20000, 2}, {40000, 4}})
    for (const Shape& shape : {Shape{"sphere", make_sphere(0.1, fine(0.02)).value(), 0.0},
                               Shape{"box", make_box_surface(Vec3(0.1, 0.07, 0.05)), 0.0},
                               Shape{"torus", make_torus(0.1, 0.03, fine(0.02)).value(), 0.0}}) {
      INFO(shape.name << " " << count << " " << grading);
      TetrahedraOptions options;
      options.count = count;
      options.grading = grading;
      const EmbeddedSolid solid = tetrahedralise(shape.surface, options).value();
      // Where large cells can stand depends on the form.
      const double off = grading == 1 ? 0.15 : 0.3;
      CHECK(solid.quality.count > (1.0 - off) * count);
      CHECK(solid.quality.count < (1.0 + off) * count);
    }
}

TEST_CASE("tetrahedralise: the scale and the place change nothing but rounding, the same bits again") {
  const TriangleMesh surface = make_torus(0.1, 0.03, fine(0.02)).value();
  TetrahedraOptions options;
  options.element_size = 0.02;
  const EmbeddedSolid solid = tetrahedralise(surface, options).value();
  CHECK(hash(solid) == hash(tetrahedralise(surface, options).value()));
  CHECK(hash(solid) == 0x85175555e7e76741ULL);        // any compiler, any optimisation
  for (const double scale : {0x1.0p-12, 0x1.0p14}) {  // whole powers: no rounding
    TriangleMesh scaled = surface;
    for (Vec3& p : scaled.positions) p *= scale;
    TetrahedraOptions scaled_options;
    scaled_options.element_size = scale * 0.02;
    const EmbeddedSolid other = tetrahedralise(scaled, scaled_options).value();
    CHECK(other.elements->mesh.tetrahedra == solid.elements->mesh.tetrahedra);
    CHECK(other.embedded.material.corners == solid.embedded.material.corners);
    CHECK(other.elements->mesh.positions[7] == scale * solid.elements->mesh.positions[7]);
  }
}

TEST_CASE("tetrahedralise: nonsense is refused with a sentence") {
  TriangleMesh surface = make_box_surface(Vec3::Constant(0.1));
  TetrahedraOptions options;
  CHECK_FALSE(tetrahedralise(surface, options));
  options.element_size = 1e-5;
  CHECK(tetrahedralise(surface, options).error().find("make it larger") != std::string::npos);
  options.element_size = 0.05;
  CHECK(tetrahedralise(surface, options));
  for (const int grading : {-1, 0, 3, 16}) {
    options.grading = grading;
    CHECK(tetrahedralise(surface, options).error().find("1, 2, 4 or 8") != std::string::npos);
  }
  options.grading = 1;
  for (Triangle& t : surface.triangles) std::swap(t[1], t[2]);
  CHECK(tetrahedralise(surface, options).error().find("inside out") != std::string::npos);
  surface.triangles.pop_back();
  CHECK(tetrahedralise(surface, options).error().find("not closed") != std::string::npos);
}

TEST_CASE("surface distance: the nearest place is that of a search through all triangles") {
  const TriangleMesh surface = make_torus(0.1, 0.03, fine(0.01)).value();
  const SurfaceDistance distance(surface);
  core::Random random(1, 5);
  for (int i = 0; i < 200; ++i) {
    const double x = random.uniform(-0.2, 0.2);
    const double y = random.uniform(-0.1, 0.1);
    const double z = random.uniform(-0.2, 0.2);
    const Vec3 p(x, y, z);
    double least = 1e300;
    for (const Triangle& t : surface.triangles)
      least = std::min(least, closest_on_triangle(p, surface.positions[at(t[0])], surface.positions[at(t[1])],
                                                  surface.positions[at(t[2])])
                                  .distance);
    const NearestPlace nearest = distance.find(p, 1.0);
    REQUIRE(nearest.triangle >= 0);
    CHECK(nearest.distance == least);
    CHECK((nearest.place - p).norm() == Approx(least));
    CHECK((distance.find(p, 0.5 * nearest.distance).triangle < 0 || nearest.distance == 0.0));
  }
}
