#include "engine/geometry/mesh_diagnosis.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "engine/core/elementary.h"
#include "engine/core/random.h"
#include "engine/geometry/edge_topology.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/mass_properties.h"

namespace shatterbox::geometry {
namespace {

TriangleMesh make_tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

/// The only finding of a mesh must be this one.
MeshFinding only_finding(const TriangleMesh& mesh, MeshFault fault, Severity severity) {
  const MeshDiagnosis diagnosis = diagnose(mesh);
  for (const MeshFinding& finding : diagnosis.findings) INFO(finding.sentence);
  REQUIRE(diagnosis.findings.size() == 1);
  const MeshFinding finding = diagnosis.findings.front();
  INFO(finding.sentence);
  CHECK(finding.fault == fault);
  CHECK(finding.severity == severity);
  CHECK(finding.sentence.size() > 30);
  CHECK(diagnosis.refused() == (severity == Severity::refused));
  if (severity != Severity::refused) CHECK(diagnose(mend(mesh).mesh).find(fault) == nullptr);
  return finding;
}

TriangleMesh scaled(TriangleMesh mesh, double scale) {
  for (Vec3& p : mesh.positions) p *= scale;
  return mesh;
}

}  // namespace

TEST_CASE("a sound mesh comes back as it was") {
  for (const TriangleMesh& mesh : {make_tetrahedron(), make_bowl({}, {0.01, 0.3, 1}).value()}) {
    const MendedMesh mended = mend(mesh);
    CHECK(mended.diagnosis.findings.empty());
    CHECK(mended.diagnosis.part_count == 1);
    CHECK(mended.mesh.positions == mesh.positions);
    CHECK(mended.mesh.triangles == mesh.triangles);
    CHECK(mended.triangle_source.back() == static_cast<int>(mesh.triangles.size()) - 1);
    CHECK(mended.vertex_source.back() == static_cast<int>(mesh.positions.size()) - 1);
  }
  CHECK(diagnose(make_tetrahedron()).is_closed);
  CHECK_FALSE(diagnose(make_bowl({}, {0.01, 0.3, 1}).value()).is_closed);
}

TEST_CASE("empty meshes, numbers that are none and wrong indices are refused with their place") {
  only_finding({}, MeshFault::empty, Severity::refused);
  only_finding({{{0, 0, 0}}, {}}, MeshFault::empty, Severity::refused);
  for (const double wrong :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity(), 1e100}) {
    TriangleMesh mesh = make_tetrahedron();
    mesh.positions[2].y() = wrong;
    const MeshFinding finding = only_finding(mesh, MeshFault::not_finite, Severity::refused);
    CHECK(finding.vertex == 2);
    CHECK(finding.sentence.find("vertex 3") != std::string::npos);
    CHECK(mend(mesh).mesh.triangles.empty());
  }
  for (const int wrong : {-1, 4, std::numeric_limits<int>::max()}) {
    TriangleMesh mesh = make_tetrahedron();
    mesh.triangles[1][2] = wrong;
    CHECK(only_finding(mesh, MeshFault::index_out_of_range, Severity::refused).triangle == 1);
  }
}

TEST_CASE("unwelded triangles are welded") {
  const TriangleMesh whole = make_sphere(0.3, {0.1, 0.3, 1}).value();
  TriangleMesh soup;
  for (const Triangle& t : whole.triangles) {
    const int first = static_cast<int>(soup.positions.size());
    for (const int v : t) soup.positions.push_back(whole.positions[static_cast<std::size_t>(v)]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  const MeshFinding finding = only_finding(soup, MeshFault::duplicate_vertices, Severity::mended);
  CHECK(finding.count == static_cast<int>(soup.positions.size() - whole.positions.size()));
  const MendedMesh mended = mend(soup);
  CHECK(mended.mesh.positions.size() == whole.positions.size());
  CHECK(mended.diagnosis.is_closed);
  CHECK(enclosed_volume(mended.mesh) == Approx(enclosed_volume(whole)).epsilon(1e-14));
}

TEST_CASE("vertices that nobody uses are dropped, with their number") {
  TriangleMesh mesh = make_tetrahedron();
  mesh.positions.emplace_back(7, 8, 9);
  const MeshFinding finding = only_finding(mesh, MeshFault::unused_vertices, Severity::mended);
  CHECK(finding.vertex == 4);
  CHECK(finding.place == Vec3(7, 8, 9));
  CHECK(mend(mesh).mesh.positions.size() == 4);
}

TEST_CASE("triangles without area go without opening a slit") {
  SECTION("a repeated corner") {
    TriangleMesh mesh = make_tetrahedron();
    mesh.triangles.push_back({1, 1, 2});
    CHECK(only_finding(mesh, MeshFault::degenerate_triangles, Severity::mended).triangle == 4);
  }
  for (const double scale : {1.0, 1e-30, 1e30}) {
    INFO(scale);
    // The square's lower edge has a vertex in the middle that only a flat triangle uses on one side.
    TriangleMesh mesh = scaled({{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0, 0}, {1, -1, 0}},
                                {{0, 1, 2}, {0, 3, 1}, {0, 4, 3}, {3, 4, 1}}},
                               scale);
    const MeshFinding finding = only_finding(mesh, MeshFault::degenerate_triangles, Severity::mended);
    CHECK(finding.count == 1);
    CHECK(finding.triangle == 1);
    const MendedMesh mended = mend(mesh);
    CHECK(mended.mesh.triangles.size() == 4);
    CHECK(surface_area(mended.mesh) / (scale * scale) == Approx(3.0).epsilon(1e-14));
    const EdgeTopology topology = build_edge_topology(mended.mesh.triangles);
    int border = 0;
    for (int e = 0; e < static_cast<int>(topology.edges.size()); ++e)
      border += topology.is_boundary(e) ? 1 : 0;
    CHECK(border == 4);  // two of the upper, two of the lower triangle: no slit between them
  }
  SECTION("two corners almost at one place") {
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1e-14, 0}, {0, 1, 0}, {0, -1, 0}},
                            {{0, 1, 2}, {0, 2, 3}, {0, 4, 1}}};
    only_finding(mesh, MeshFault::degenerate_triangles, Severity::mended);
    const MendedMesh mended = mend(mesh);
    CHECK(mended.mesh.triangles.size() == 2);
    CHECK(mended.mesh.positions.size() == 4);
    CHECK(mended.diagnosis.part_count == 1);
  }
  SECTION("nothing else") {
    const TriangleMesh line{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
    CHECK(diagnose(line).find(MeshFault::empty) != nullptr);
    CHECK(diagnose(line).refused());
  }
}

TEST_CASE("triangles there twice are dropped, whichever way they are wound") {
  TriangleMesh mesh = make_tetrahedron();
  mesh.triangles.push_back({2, 1, 0});
  mesh.triangles.push_back({1, 2, 0});
  const MeshFinding finding = only_finding(mesh, MeshFault::duplicate_triangles, Severity::mended);
  CHECK(finding.count == 2);
  CHECK(finding.triangle == 4);
}

TEST_CASE("an edge of three triangles is refused with its place") {
  TriangleMesh mesh = make_tetrahedron();
  mesh.positions.emplace_back(1, 1, -3);
  mesh.triangles.push_back({1, 2, 4});
  const MeshFinding finding = only_finding(mesh, MeshFault::non_manifold_edges, Severity::refused);
  CHECK(finding.place == Vec3(0.5, 0.5, 0));
  CHECK(finding.sentence.find("vertex 2 to vertex 3") != std::string::npos);
}

TEST_CASE("cones that meet in a point come apart there") {
  // Two fans of one vertex, joined elsewhere by a bridge so that the mesh is one part.
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}, {0, 3, 0}},
                    {{0, 1, 2}, {0, 3, 4}, {1, 5, 2}, {3, 5, 4}}};
  const MendedMesh mended = mend(mesh);
  REQUIRE(mended.diagnosis.find(MeshFault::non_manifold_vertices));
  CHECK(mended.diagnosis.find(MeshFault::non_manifold_vertices)->count ==
        2);                           // the middle and the bridge's top
  CHECK(mended.diagnosis.refused());  // and then it is two parts
  MendOptions options;
  options.allow_loose_parts = true;
  const MendedMesh allowed = mend(mesh, options);
  CHECK(allowed.diagnosis.part_count == 2);
  CHECK(allowed.mesh.positions.size() == 8);
  CHECK(allowed.vertex_source[6] == 0);
  CHECK(mend(allowed.mesh, options).mesh.triangles == allowed.mesh.triangles);
}

TEST_CASE("triangles wound against their neighbours are turned, a sphere inside out as well") {
  const TriangleMesh whole = make_sphere(1.0, {0.2, 0.3, 1}).value();
  TriangleMesh mixed = whole;
  core::Random random(5);
  int turned = 0;
  for (Triangle& t : mixed.triangles)
    if (random.uniform() < 0.3) {
      std::swap(t[0], t[1]);
      ++turned;
    }
  CHECK(only_finding(mixed, MeshFault::mixed_winding, Severity::mended).count == turned);
  CHECK(enclosed_volume(mend(mixed).mesh) == Approx(enclosed_volume(whole)).epsilon(1e-13));
  TriangleMesh inside_out = whole;
  for (Triangle& t : inside_out.triangles) std::swap(t[0], t[1]);
  only_finding(inside_out, MeshFault::mixed_winding, Severity::mended);
  CHECK(enclosed_volume(mend(inside_out).mesh) > 0.0);
}

TEST_CASE("of several closed parts those that are inside out are turned, and hollows are not") {
  const TriangleMesh whole = make_sphere(1.0, {0.2, 0.3, 1}).value();
  MendOptions options;
  options.allow_loose_parts = true;
  const auto with = [&](double scale, const Vec3& shift, bool is_turned) {
    TriangleMesh both = whole;
    const int first = static_cast<int>(both.positions.size());
    for (const Vec3& p : whole.positions) both.positions.push_back(scale * p + shift);
    for (const Triangle& t : whole.triangles)
      both.triangles.push_back({t[0] + first, t[is_turned ? 2 : 1] + first, t[is_turned ? 1 : 2] + first});
    return both;
  };
  const double volume = enclosed_volume(whole);
  // Half in the other one, and beside it.
  for (const double away : {0.9, 3.0}) {
    const MendedMesh mended = mend(with(0.5, Vec3(away, 0, 0), true), options);
    const MeshFinding* finding = mended.diagnosis.find(MeshFault::mixed_winding);
    REQUIRE(finding != nullptr);
    CHECK(finding->count == 1);
    CHECK(finding->triangle == static_cast<int>(whole.triangles.size()));
    CHECK(finding->sentence.find("1 closed part is inside out") != std::string::npos);
    CHECK(enclosed_volume(mended.mesh) == Approx(1.125 * volume).epsilon(1e-12));
    CHECK(mend(mended.mesh, options).mesh.triangles == mended.mesh.triangles);
  }
  const MendedMesh hollow = mend(with(0.5, Vec3(0.2, 0, 0), true), options);
  CHECK(hollow.diagnosis.find(MeshFault::mixed_winding) == nullptr);
  CHECK(enclosed_volume(hollow.mesh) == Approx(0.875 * volume).epsilon(1e-12));
}

TEST_CASE("a Moebius strip is refused, a ring of two turns is not") {
  for (const int half_turns : {1, 2}) {
    TriangleMesh strip;
    const int n = 24;
    for (int i = 0; i < n; ++i) {
      const double u = 2.0 * core::kPi * i / n;
      const double twist = 0.5 * half_turns * u;
      for (const double w : {-0.2, 0.2}) {
        const double r = 1.0 + w * core::cos(twist);
        strip.positions.emplace_back(r * core::cos(u), w * core::sin(twist), r * core::sin(u));
      }
    }
    for (int i = 0; i < n; ++i) {
      const bool swaps = i + 1 == n && half_turns == 1;
      const int a = 2 * i;
      const int c = 2 * ((i + 1) % n) + (swaps ? 1 : 0);
      const int d = 2 * ((i + 1) % n) + (swaps ? 0 : 1);
      strip.triangles.push_back({a, c, a + 1});
      strip.triangles.push_back({a + 1, c, d});
    }
    if (half_turns == 1)
      only_finding(strip, MeshFault::not_orientable, Severity::refused);
    else
      CHECK(diagnose(strip).findings.empty());
  }
}

TEST_CASE("loose parts are refused unless allowed") {
  TriangleMesh mesh = make_tetrahedron();
  for (const Vec3& p : make_tetrahedron().positions) mesh.positions.push_back(p + Vec3(5, 0, 0));
  for (const Triangle& t : make_tetrahedron().triangles)
    mesh.triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
  const MeshFinding finding = only_finding(mesh, MeshFault::loose_parts, Severity::refused);
  CHECK(finding.count == 2);
  CHECK(finding.triangle == 4);
  MendOptions options;
  options.allow_loose_parts = true;
  const MendedMesh allowed = mend(mesh, options);
  CHECK_FALSE(allowed.diagnosis.refused());
  CHECK(allowed.diagnosis.find(MeshFault::loose_parts)->severity == Severity::noted);
  CHECK(allowed.mesh.triangles.size() == 8);
}

TEST_CASE("very thin triangles are kept and noted, at any scale") {
  for (const double scale : {1e-9, 1.0, 1e9}) {
    const TriangleMesh mesh =
        scaled({{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-5, 0}, {0.5, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}, scale);
    const MeshDiagnosis diagnosis = diagnose(mesh);
    REQUIRE(diagnosis.findings.size() == 1);
    CHECK(diagnosis.findings[0].fault == MeshFault::slivers);
    CHECK(diagnosis.findings[0].triangle == 0);
    CHECK(diagnosis.sentences(Severity::noted).find("1 triangle is very thin") == 0);
  }
}

TEST_CASE("random soups are mended or refused, and what is mended is sound and stays so") {
  MendOptions options;
  options.allow_loose_parts = true;
  int sound = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    core::Random random(seed, 3);
    TriangleMesh mesh;
    const std::uint64_t vertices = 4 + random.index(12);
    // Places on a tiny lattice: equal, collinear and coplanar vertices in plenty.
    for (std::uint64_t v = 0; v < vertices; ++v) {
      const double x = static_cast<double>(random.index(3));
      const double y = static_cast<double>(random.index(3));
      mesh.positions.emplace_back(x, y, static_cast<double>(random.index(2)));
    }
    const std::uint64_t triangles = 1 + random.index(10);
    for (std::uint64_t t = 0; t < triangles; ++t) {
      Triangle corners{};
      for (int& v : corners) v = static_cast<int>(random.index(vertices));
      mesh.triangles.push_back(corners);
    }
    const MendedMesh mended = mend(mesh, options);
    if (mended.diagnosis.refused()) {
      CHECK(mended.mesh.triangles.empty());
      continue;
    }
    ++sound;
    REQUIRE(mended.triangle_source.size() == mended.mesh.triangles.size());
    REQUIRE(mended.vertex_source.size() == mended.mesh.positions.size());
    const MendedMesh again = mend(mended.mesh, options);
    INFO(seed << ": " << again.diagnosis.sentences(Severity::mended)
              << again.diagnosis.sentences(Severity::refused));
    REQUIRE_FALSE(again.diagnosis.refused());
    REQUIRE(again.diagnosis.find(MeshFault::degenerate_triangles) == nullptr);
    REQUIRE(again.diagnosis.find(MeshFault::mixed_winding) == nullptr);
    REQUIRE(again.diagnosis.find(MeshFault::unused_vertices) == nullptr);
  }
  CHECK(sound > 300);
}

}  // namespace shatterbox::geometry
