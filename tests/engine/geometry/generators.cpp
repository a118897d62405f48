#include "engine/geometry/generators.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <limits>
#include <set>
#include <vector>

#include "engine/core/elementary.h"
#include "engine/core/hash.h"
#include "engine/geometry/edge_topology.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/mesh_diagnosis.h"
#include "tests/support/sanitized.h"

namespace shatterbox::geometry {
namespace {

constexpr double kDegree = core::kPi / 180.0;

struct Edges {
  double mean = 0.0;
  double greatest = 0.0;
  int border = 0;
  int euler = 0;
};

Edges measure(const TriangleMesh& mesh) {
  const EdgeTopology topology = build_edge_topology(mesh.triangles);
  Edges edges;
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    const auto [a, b] = topology.edges[e];
    const double length =
        (mesh.positions[static_cast<std::size_t>(a)] - mesh.positions[static_cast<std::size_t>(b)]).norm();
    edges.mean += length / static_cast<double>(topology.edges.size());
    edges.greatest = std::max(edges.greatest, length);
    edges.border += topology.is_boundary(static_cast<int>(e)) ? 1 : 0;
  }
  edges.euler = static_cast<int>(mesh.positions.size()) - static_cast<int>(topology.edges.size()) +
                static_cast<int>(mesh.triangles.size());
  return edges;
}

std::uint64_t hash(const TriangleMesh& mesh) {
  core::Hash hash;
  for (const Vec3& p : mesh.positions) hash.add(p);
  for (const Triangle& t : mesh.triangles)
    for (const int v : t) hash.add(static_cast<std::uint64_t>(v));
  return hash.value();
}

}  // namespace

TEST_CASE("generated meshes are well-shaped, of the size asked for, and nothing is wrong with them") {
  OrnamentSizes capped;
  capped.has_cap = true;
  const WineGlassSizes large_glass{0.4, 0.08, 0.064, 0.07, 0.008, 0.17};
  // The finest meshes are the same loops run more often.
  const std::vector<double> lengths =
      test::kIsSanitized ? std::vector{0.009} : std::vector{0.012, 0.006, 0.003};
  const std::vector<std::uint64_t> seeds =
      test::kIsSanitized ? std::vector<std::uint64_t>{1} : std::vector<std::uint64_t>{1, 2};
  for (const double h : lengths)
    for (const double jitter : {0.0, 0.3, 0.5})
      for (const std::uint64_t seed : seeds) {
        const Meshing meshing{h, jitter, seed};
        struct Case {
          const char* name;
          TriangleMesh mesh;
          int euler;
          bool is_closed;
        };
        const Case cases[] = {{"sphere", make_sphere(0.05, meshing).value(), 2, true},
                              {"ornament", make_ornament({}, meshing).value().mesh, 1, false},
                              {"capped", make_ornament(capped, meshing).value().mesh, 2, true},
                              {"bowl", make_bowl({}, meshing).value(), 1, false},
                              {"wine glass", make_wine_glass(large_glass, meshing).value(), 0, false},
                              {"pane", make_pane(0.2, 0.15, meshing).value(), 1, false},
                              {"boat", make_boat({0.2, 0.08, 0.04, 0.02}, meshing).value(), 1, false}};
        for (const Case& c : cases) {
          INFO(c.name << " h " << h << " jitter " << jitter << " seed " << seed);
          const Edges edges = measure(c.mesh);
          CHECK(least_angle(c.mesh) > 20.0 * kDegree);
          CHECK(edges.mean < 1.1 * h);
          CHECK(edges.mean > 0.8 * h);
          CHECK(edges.greatest < 2.6 * h);
          CHECK(edges.euler == c.euler);
          CHECK((edges.border == 0) == c.is_closed);
          CHECK(diagnose(c.mesh).findings.empty());
          const double expected = surface_area(c.mesh) / (0.4330127 * h * h);
          // Where an edge is not much smaller than the neck, its own size decides.
          if (h < 0.01) CHECK(static_cast<double>(c.mesh.triangles.size()) == Approx(expected).epsilon(0.3));
        }
      }
}

TEST_CASE("a finer mesh is the same surface") {
  const OrnamentSizes sizes;
  const double base = core::sqrt(sizes.radius * sizes.radius - sizes.neck_radius * sizes.neck_radius);
  for (const double h : {0.01, 0.005}) {
    const PartedMesh ornament = make_ornament(sizes, {h, 0.3, 1}).value();
    double worst = 0.0;
    for (const Vec3& p : ornament.mesh.positions) {
      const double off_sphere = std::abs(p.norm() - sizes.radius);
      const double off_neck = std::abs(core::sqrt(p.x() * p.x() + p.z() * p.z()) - sizes.neck_radius);
      worst = std::max(worst, p.y() > base + 1e-12 ? off_neck : off_sphere);
      CHECK(p.y() <= base + sizes.neck_height + 1e-15);
    }
    CHECK(worst < 1e-14);
    for (std::size_t t = 0; t < ornament.parts.size(); ++t) {
      double y = 0.0;
      for (const int v : ornament.mesh.triangles[t])
        y += ornament.mesh.positions[static_cast<std::size_t>(v)].y() / 3.0;
      CHECK((ornament.parts[t] == Part::neck) == (y > base));
    }
  }
  // Area converges as h^2 to the sphere's zone and the neck.
  const double truth =
      2.0 * core::kPi * (sizes.radius * (sizes.radius + base) + sizes.neck_radius * sizes.neck_height);
  const double h = test::kIsSanitized ? 0.006 : 0.004;
  const double coarse = truth - surface_area(make_ornament(sizes, {h, 0.3, 1}).value().mesh);
  const double fine = truth - surface_area(make_ornament(sizes, {0.5 * h, 0.3, 1}).value().mesh);
  CHECK(coarse / truth < 6e-3 * (h / 0.004) * (h / 0.004));
  CHECK(coarse / fine == Approx(4.0).epsilon(0.2));
}

TEST_CASE("a boat is one sheet, the same on all four quarters, with stems in the middle plane") {
  const BoatSizes sizes;
  for (const double h : {0.2, 1.0 / 15.0, 0.02}) {
    const TriangleMesh boat = make_boat(sizes, {h, 0.3, 1}).value();
    std::set<std::array<double, 3>> places;
    for (const Vec3& p : boat.positions) places.insert({p.x(), p.y(), p.z()});
    CHECK(places.size() == boat.positions.size());
    Vec3 least = Vec3::Constant(1e9), most = -least;
    for (const Vec3& p : boat.positions) {
      CHECK(places.count({p.x(), p.y(), -p.z()}) == 1);
      least = least.cwiseMin(p);
      most = most.cwiseMax(p);
      if (std::abs(p.x()) > 0.4999 * sizes.length) CHECK(p.z() == 0.0);
    }
    CHECK((most - least).x() == Approx(sizes.length).epsilon(1e-12));
    CHECK((most - least).z() < sizes.beam * (1.0 + 1e-12));
    CHECK((most - least).y() == Approx(sizes.depth + sizes.sheer).epsilon(1e-3));  // no station amidships
    // Outside is down, and away from the middle plane.
    for (const Triangle& t : boat.triangles) {
      const Vec3& a = boat.positions[static_cast<std::size_t>(t[0])];
      const Vec3& b = boat.positions[static_cast<std::size_t>(t[1])];
      const Vec3& c = boat.positions[static_cast<std::size_t>(t[2])];
      const Vec3 inside(0.0, sizes.depth + sizes.sheer, 0.0);
      CHECK((b - a).cross(c - a).dot((a + b + c) / 3.0 - inside) > 0.0);
    }
  }
  CHECK(make_boat(sizes, {1.0 / 15.0, 0.3, 1}).value().triangles.size() == 300);
}

TEST_CASE("faces look outwards") {
  CHECK(enclosed_volume(make_sphere(1.0, {0.2, 0.3, 1}).value()) ==
        Approx(4.0 / 3.0 * core::kPi).epsilon(0.05));
  OrnamentSizes capped;
  capped.has_cap = true;
  CHECK(enclosed_volume(make_ornament(capped, {0.005, 0.3, 1}).value().mesh) >
        4.0 / 3.0 * core::kPi * 6.2e-5);
  CHECK(enclosed_volume(make_torus(1.0, 0.2, {0.05, 0.0, 1}).value()) > 0.0);
  const TriangleMesh pane = make_pane(1.0, 1.0, {0.1, 0.3, 1}).value();
  for (const Triangle& t : pane.triangles) {
    const Vec3& a = pane.positions[static_cast<std::size_t>(t[0])];
    const Vec3 normal = (pane.positions[static_cast<std::size_t>(t[1])] - a)
                            .cross(pane.positions[static_cast<std::size_t>(t[2])] - a);
    CHECK(normal.z() > 0.0);
  }
}

TEST_CASE("a pane's border is straight to the bit and its edges have no directions") {
  const TriangleMesh pane = make_pane(1.0, 0.7, {0.012, 0.3, 1}).value();
  const EdgeTopology topology = build_edge_topology(pane.triangles);
  std::array<int, 18> directions{};
  int inner = 0;
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    const Vec3& a = pane.positions[static_cast<std::size_t>(topology.edges[e][0])];
    const Vec3& b = pane.positions[static_cast<std::size_t>(topology.edges[e][1])];
    if (topology.is_boundary(static_cast<int>(e))) {
      const bool is_on_side =
          (std::abs(a.x()) == 0.5 && a.x() == b.x()) || (std::abs(a.y()) == 0.35 && a.y() == b.y());
      CHECK(is_on_side);
      continue;
    }
    const double angle = core::atan2(b.y() - a.y(), b.x() - a.x());
    ++directions[static_cast<std::size_t>((angle + core::kPi) / core::kPi * 18.0 * 0.9999) % 18];
    ++inner;
  }
  CHECK(surface_area(pane) == Approx(0.7).epsilon(1e-12));
  // A lattice has a third of its edges in each of three sectors of the 18.
  for (const int count : directions) CHECK(count == Approx(inner / 18.0).epsilon(0.25));
}

TEST_CASE("the same numbers give the same mesh to the bit, another seed another one") {
  const Meshing one{0.004, 0.3, 1};
  const Meshing two{0.004, 0.3, 2};
  // Pinned: g++ and clang++, -O1 to -O3.
  const std::uint64_t ornament = hash(make_ornament({}, one).value().mesh);
  const std::uint64_t sphere = hash(make_sphere(0.04, one).value());
  CHECK(ornament == 0x7d92beb1a0590464ULL);
  CHECK(sphere == 0xc7a033d21d266e9cULL);
  CHECK(hash(make_bowl({}, one).value()) == 0x49b56e5077c15c28ULL);
  CHECK(hash(make_wine_glass({}, one).value()) == 0x1051043f375818fbULL);
  CHECK(hash(make_pane(0.3, 0.2, one).value()) == 0xc7da8482011571a2ULL);
  CHECK(hash(make_boat({}, one).value()) == 0x89e1f2dab20bd6ffULL);
  CHECK(hash(make_ornament({}, one).value().mesh) == ornament);
  CHECK(hash(make_ornament({}, two).value().mesh) != ornament);
  CHECK(hash(make_sphere(0.04, two).value()) != sphere);
}

TEST_CASE("a wine glass has the sizes asked for, and is open at its rim and below its foot only") {
  WineGlassSizes sizes;
  sizes.height = 0.14;
  sizes.radius = 0.05;
  sizes.rim_radius = 0.045;
  const TriangleMesh glass = make_wine_glass(sizes, {0.003, 0.3, 1}).value();
  double widest = 0.0;
  for (const Vec3& p : glass.positions) {
    const double r = core::sqrt(p.x() * p.x() + p.z() * p.z());
    widest = std::max(widest, r);
    CHECK(p.y() >= 0.0);
    CHECK(p.y() <= sizes.height * (1.0 + 1e-12));
    CHECK(r > sizes.stem_radius * (1.0 - 1e-12));
    const bool is_stem = p.y() > 0.03 && p.y() < sizes.stem_length;
    if (is_stem) CHECK(r == Approx(sizes.stem_radius));
  }
  CHECK(widest == Approx(sizes.radius).epsilon(1e-3));
  const EdgeTopology topology = build_edge_topology(glass.triangles);
  double rim = 0.0, foot = 0.0;
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    if (!topology.is_boundary(static_cast<int>(e))) continue;
    const Vec3 &p = glass.positions[static_cast<std::size_t>(topology.edges[e][0])],
               &q = glass.positions[static_cast<std::size_t>(topology.edges[e][1])];
    const bool is_rim = p.y() > 0.5 * sizes.height;
    CHECK(p.y() == Approx(is_rim ? sizes.height : 0.0).margin(1e-12));
    (is_rim ? rim : foot) += (p - q).norm();
  }
  CHECK(rim == Approx(2.0 * core::kPi * sizes.rim_radius).epsilon(0.01));
  CHECK(foot == Approx(2.0 * core::kPi * sizes.foot_radius).epsilon(0.01));
}

TEST_CASE("the separate cap keeps its clearance and has a loop") {
  const OrnamentSizes sizes;
  const double clearance = 0.0005;
  const PartedMesh cap = make_ornament_cap(sizes, clearance, {0.003, 0.3, 1}).value();
  const double base = core::sqrt(sizes.radius * sizes.radius - sizes.neck_radius * sizes.neck_radius);
  const auto loops = std::count(cap.parts.begin(), cap.parts.end(), Part::loop);
  CHECK(loops > 100);
  CHECK(loops < static_cast<long>(cap.parts.size()));
  for (const Vec3& p : cap.mesh.positions) {
    const double r = core::sqrt(p.x() * p.x() + p.z() * p.z());
    const bool is_beside = r > sizes.neck_radius + 0.9 * clearance && p.y() > base;
    const bool is_above = p.y() > base + sizes.neck_height + 0.9 * clearance;
    CHECK((is_beside || is_above));
    CHECK(p.norm() > sizes.radius);
  }
  MendOptions options;
  options.allow_loose_parts = true;
  CHECK(diagnose(cap.mesh, options).part_count == 2);
  CHECK_FALSE(diagnose(cap.mesh, options).refused());
  CHECK(diagnose(cap.mesh).refused());
}

TEST_CASE("sizes from a grain of sand to a stadium give the same mesh") {
  for (const double scale : {1e-4, 1e3}) {
    const TriangleMesh mesh =
        make_bowl({0.08 * scale, 0.035 * scale, 0.006 * scale, 0.07 * scale}, {0.008 * scale, 0.3, 1})
            .value();
    const TriangleMesh usual = make_bowl({}, {0.008, 0.3, 1}).value();
    CHECK(mesh.triangles.size() == Approx(usual.triangles.size()).epsilon(0.02));
    CHECK(least_angle(mesh) > 20.0 * kDegree);
  }
}

TEST_CASE("sizes that make no sense are refused in a sentence") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(make_sphere(0.0, {}).ok());
  CHECK_FALSE(make_sphere(nan, {}).ok());
  CHECK_FALSE(make_sphere(1.0, {0.0, 0.3, 1}).ok());
  CHECK_FALSE(make_sphere(1.0, {nan, 0.3, 1}).ok());
  CHECK_FALSE(make_sphere(1.0, {1e-300, 0.3, 1}).ok());
  CHECK_FALSE(make_sphere(1.0, {0.1, 0.9, 1}).ok());
  CHECK_FALSE(make_sphere(1.0, {0.1, nan, 1}).ok());
  CHECK_FALSE(make_bowl({0.08, 0.035, nan, 0.07}, {}).ok());
  CHECK_FALSE(make_sphere(1.0, {0.0008, 0.3, 1}).ok());
  CHECK_FALSE(make_pane(1.0, -1.0, {}).ok());
  CHECK_FALSE(make_pane(10.0, 10.0, {0.001, 0.3, 1}).ok());
  CHECK_FALSE(make_bowl({0.08, 0.035, 0.06, 0.07}, {}).ok());
  CHECK_FALSE(make_torus(0.1, 0.2, {}).ok());
  WineGlassSizes glass;
  glass.stem_length = 0.25;
  CHECK(make_wine_glass(glass, {}).error() ==
        "a wine glass's height must be greater than stem_length, 0.25 m (it is 0.2 m)");
  glass = {};
  glass.stem_radius = 0.02;
  CHECK(make_wine_glass(glass, {}).error().find("foot_radius") != std::string::npos);
  VaseSizes vase;
  vase.wall = 0.05;
  vase.height = 0.3;
  CHECK(make_vase(vase, {}).error() == "a vase's height must be greater than ten walls, 0.5 m (it is 0.3 m)");
  CHECK_FALSE(make_boat({1.0, 2.0, 0.2, 0.1}, {}).ok());
  CHECK_FALSE(make_boat({1.0, 0.4, nan, 0.1}, {}).ok());
  CHECK_FALSE(make_boat({1.0, 0.4, 0.2, -0.1}, {}).ok());
  CHECK_FALSE(make_boat({}, {1e-4, 0.3, 1}).ok());
  CHECK_FALSE(make_surface_of_revolution({}, {}).ok());
  OrnamentSizes wide;
  wide.neck_radius = 0.05;
  const auto ornament = make_ornament(wide, {});
  REQUIRE_FALSE(ornament.ok());
  CHECK(ornament.error().find("neck_radius (0.05 m)") != std::string::npos);
}

TEST_CASE("a neck much shorter and narrower than an edge still gets whole triangles") {
  const PartedMesh mesh = make_ornament({0.04, 0.002, 0.0015, false}, {0.008, 0.3, 1}).value();
  CHECK(least_angle(mesh.mesh) > 20.0 * kDegree);
  CHECK(diagnose(mesh.mesh).findings.empty());
}

}  // namespace shatterbox::geometry

TEST_CASE("a long stem is round: its triangles keep to the circle that they go about") {
  const WineGlassSizes sizes;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    INFO("seed " << seed);
    const auto glass = make_wine_glass(sizes, {0.006, 0.5, seed});
    REQUIRE(glass);
    const TriangleMesh& mesh = glass.value();
    double nearest = 1e300;
    for (const Triangle& t : mesh.triangles) {
      Vec3 middle = Vec3::Zero();
      for (const int v : t) middle += mesh.positions[static_cast<std::size_t>(v)] / 3.0;
      if (middle.y() < 0.4 * sizes.stem_length || middle.y() > 0.9 * sizes.stem_length) continue;
      nearest = std::min(nearest, std::hypot(middle.x(), middle.z()));
    }
    CHECK(nearest > 0.8 * sizes.stem_radius);
  }
}
