// Splitting a cut solid loses nothing, and merges what nothing could resolve.
#include "engine/fracture/split_solid.h"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

#include "engine/core/disjoint_sets.h"
#include "engine/geometry/edge_topology.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/solid_surface.h"
#include "engine/geometry/tetrahedralise.h"
#include "engine/geometry/vertex_fans.h"
#include "engine/geometry/weld.h"
#include "tests/engine/geometry/solids.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;
using namespace shatterbox::geometry;
using fracture::split_solid;

namespace {

/// What is wrong with a piece's surface; empty if it is closed, a manifold, and encloses the piece's volume.
std::string fault_of(const SolidSurface& surface, const SolidComplex& piece) {
  const TriangleMesh& mesh = surface.mesh;
  const EdgeTopology topology = build_edge_topology(mesh.triangles);
  std::vector<int> balance(topology.edges.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      if (a == b) return "a triangle has a corner twice";
      balance[static_cast<std::size_t>(topology.triangle_edges[t][k])] += a < b ? 1 : -1;
    }
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    if (topology.triangle_count(static_cast<int>(e)) != 2)
      return "an edge has " + std::to_string(topology.triangle_count(static_cast<int>(e))) + " triangles";
    if (balance[e] != 0) return "triangles disagree about the outside";
  }
  TriangleMesh copy = mesh;
  std::vector<int> source = surface.vertex_sources;
  if (split_vertex_fans(copy, source).count > 0) return "a vertex has several fans";
  const long euler = static_cast<long>(mesh.positions.size()) - static_cast<long>(topology.edges.size()) +
                     static_cast<long>(mesh.triangles.size());
  if (euler % 2 != 0) return "odd Euler characteristic";
  const double error = enclosed_volume(mesh) - total_volume(piece);
  if (std::abs(error) > 1e-12) return "volume off by " + std::to_string(error * 1e12) + " 1e-12";
  return "";
}

SolidComplex make_cube_in_eight() {
  SolidComplex complex = make_solid_complex(test::make_cube_elements(3, 0.2));
  SolidCutter cutter(complex);
  for (int k = 0; k < 3; ++k) {
    SolidCut cut = test::plane_cut(complex, Vec3::Unit(k), 0.6, k);
    keep_off_nodes(complex, 0.05, cut);
    cutter.cut(cut);
  }
  return complex;
}

}  // namespace

TEST_CASE("split solid: a cube in eight") {
  const SolidComplex complex = make_cube_in_eight();
  const auto split = split_solid(complex);
  REQUIRE(split.pieces.size() == 8);
  double sum = 0.0, last = 1.0;
  for (const auto& piece : split.pieces) {
    CHECK(are_cells_closed(piece.complex));
    CHECK(piece.mesh.cells.size() == piece.complex.cells.size());
    CHECK(total_volume(piece.complex) <= last);
    last = total_volume(piece.complex);
    sum += last;
    const SolidSurface surface = extract_surface(piece.complex);
    CHECK(fault_of(surface, piece.complex).empty());
    for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t)
      CHECK(surface.is_crack_face[t] == (surface.triangle_sources[t] < 0));
  }
  CHECK(sum == Approx(1.0).epsilon(1e-13));
  CHECK(total_volume(split.pieces[0].complex) == Approx(0.216).epsilon(0.05));
  CHECK(total_volume(split.pieces[7].complex) == Approx(0.064).epsilon(0.1));
}

TEST_CASE("split solid: after a clash only what was joined is made again") {
  const SolidComplex complex = make_cube_in_eight();
  fracture::SolidSplitter in_turn(complex), at_once(complex);
  const auto first = in_turn.split();
  for (const auto& piece : first.pieces) CHECK(piece.before == -1);
  for (fracture::SolidSplitter* splitter : {&in_turn, &at_once}) REQUIRE(splitter->join({{3, 1}, {5, -1}}));
  const auto second = in_turn.split(), fresh = at_once.split();
  REQUIRE(second.pieces.size() == fresh.pieces.size());
  CHECK(second.merged_count == fresh.merged_count);
  CHECK(second.merged_volume == fresh.merged_volume);
  std::size_t kept = 0;
  for (std::size_t p = 0; p < fresh.pieces.size(); ++p) {
    const int before = second.pieces[p].before;
    kept += before >= 0 ? 1 : 0;
    const auto& piece = before >= 0 ? first.pieces[static_cast<std::size_t>(before)] : second.pieces[p];
    CHECK(fresh.pieces[p].before == -1);
    REQUIRE(piece.complex.cells.size() == fresh.pieces[p].complex.cells.size());
    CHECK(total_volume(piece.complex) == total_volume(fresh.pieces[p].complex));
    CHECK(piece.complex.vertices.size() == fresh.pieces[p].complex.vertices.size());
    CHECK(piece.mesh.vertex_source == fresh.pieces[p].mesh.vertex_source);
    for (std::size_t c = 0; c < piece.mesh.cells.size(); ++c) {
      CHECK(piece.mesh.cells[c].element == fresh.pieces[p].mesh.cells[c].element);
      CHECK(piece.mesh.cells[c].vertices == fresh.pieces[p].mesh.cells[c].vertices);
    }
  }
  CHECK(kept > 3);
  CHECK(kept < fresh.pieces.size());
  for (const auto& piece : in_turn.split().pieces) CHECK(piece.before >= 0);
}

TEST_CASE("split solid: a plate too thin joins what it has most in common with") {
  SolidComplex complex = make_solid_complex(test::make_cube_elements(3));
  SolidCutter cutter(complex, 1e-3);
  cutter.cut(test::plane_cut(complex, Vec3::UnitX(), 0.50, 0));
  cutter.cut(test::plane_cut(complex, Vec3::UnitX(), 0.52, 1));
  CHECK(split_solid(complex, 0.019).pieces.size() == 3);
  const auto split = split_solid(complex, 0.021);
  CHECK(split.pieces.size() == 2);
  CHECK(split.merged_count == 1);
  CHECK(split.merged_volume == Approx(0.02));
}

TEST_CASE("split solid: pieces that cannot be beside each other are joined where a crack is between them") {
  SolidComplex complex = make_solid_complex(test::make_cube_elements(3));
  SolidCutter cutter(complex, 1e-3);
  cutter.cut(test::plane_cut(complex, Vec3::UnitX(), 0.5, 0));
  cutter.cut(test::plane_cut(complex, Vec3::UnitX(), 0.8, 1));
  const auto volumes_after = [&](const std::vector<fracture::PieceClash>& clashes) {
    fracture::SolidSplitter splitter(complex);
    CHECK(splitter.join(clashes));
    const fracture::SolidSplit split = splitter.split();
    CHECK(split.merged_count == 1);
    std::vector<double> volumes;
    for (const auto& piece : split.pieces) {
      const SolidSurface surface = extract_surface(piece.complex);
      CHECK(fault_of(surface, piece.complex).empty());
      volumes.push_back(total_volume(piece.complex));
    }
    return volumes;
  };
  const auto are = [](const std::vector<double>& volumes, double larger, double smaller) {
    return volumes.size() == 2 && std::abs(volumes[0] - larger) < 1e-9 &&
           std::abs(volumes[1] - smaller) < 1e-9;
  };
  // Of 0.5, 0.3 and 0.2, side by side.
  CHECK(are(volumes_after({{0, 1}}), 0.8, 0.2));
  CHECK(are(volumes_after({{2, 1}}), 0.5, 0.5));
  CHECK(are(volumes_after({{0, 2}}), 0.5, 0.5));  // no crack between them: the smaller one and its neighbour
  CHECK(are(volumes_after({{0, -1}}), 0.8, 0.2));
  CHECK(are(volumes_after({{2, -1}}), 0.5, 0.5));

  fracture::SolidSplitter splitter(complex);
  CHECK_FALSE(splitter.join({}));
  CHECK(splitter.join({{0, 1}, {1, 2}}));
  CHECK(splitter.split().pieces.size() == 1);
  CHECK_FALSE(splitter.join({{0, -1}}));  // there is nobody left
}

TEST_CASE("split solid: a boundary that holds keeps one piece, whose cells share their nodes") {
  SolidComplex complex = make_solid_complex(test::make_cube_elements(2));
  SolidCutter cutter(complex);
  SolidCut cut = test::plane_cut(complex, Vec3(1, 2, 3), 2.7);
  cut.kind = FacetKind::grain;
  cutter.cut(cut);
  const auto split = split_solid(complex);
  REQUIRE(split.pieces.size() == 1);
  CHECK(split.pieces[0].mesh.cells.size() > 48);
  CHECK(split.pieces[0].mesh.vertex_source.size() == 27);
}

namespace {

/// A cube, cut up to a dozen times in any way, and split; returns the number of cuts.
int try_random_cuts(int trial) {
  core::Random random(11, static_cast<std::uint64_t>(trial));
  const int n = 1 + trial % 2;
  SolidComplex complex =
      make_solid_complex(test::make_cube_elements(n, 0.3, static_cast<std::uint64_t>(trial)));
  SolidCutter cutter(complex, trial % 3 == 0 ? SolidCutter::kLeastSnap : SolidCutter::kUsualSnap);
  SolidCut last = test::plane_cut(complex, Vec3::UnitX(), 0.4);
  const int count = 1 + static_cast<int>(random.index(n == 1 ? 12 : 6));
  for (int i = 0; i < count; ++i) {
    SolidCut cut = test::random_cut(complex, random, i, &last);
    if (random.index(3) == 0) keep_off_nodes(complex, 0.05, cut);
    cutter.cut(cut);
  }
  const auto split = split_solid(complex, trial % 5 == 0 ? 0.05 : 0.0);
  double sum = 0.0;
  bool is_closed = true;
  std::string fault;
  std::vector<MassProperties> masses;
  for (const auto& piece : split.pieces) {
    is_closed = is_closed && are_cells_closed(piece.complex);
    sum += total_volume(piece.complex);
    if (fault.empty()) fault = fault_of(extract_surface(piece.complex), piece.complex);
    masses.push_back(solid_mass_properties(piece.complex, 1000.0));
  }
  const MassProperties all = combined(masses);
  INFO("trial " << trial << ": " << fault);
  CHECK(is_closed);
  CHECK(fault.empty());
  CHECK(std::abs(sum - 1.0) < 1e-12);
  CHECK(std::abs(all.mass / 1000.0 - 1.0) < 1e-12);
  CHECK((all.centre - Vec3::Constant(0.5)).norm() < 1e-12);
  CHECK((all.inertia - 1000.0 / 6.0 * Mat3::Identity()).norm() < 1e-12 * 1000.0);
  return count;
}

}  // namespace

TEST_CASE("split solid: 1e4 random cuts") {
  int cuts = 0;
  for (int trial = 0; cuts < test::how_many(10'000, 2000); ++trial) cuts += try_random_cuts(trial);
}

TEST_CASE("split solid: 1e6 random cuts", "[.][long]") {
  int cuts = 0;
  for (int trial = 0; cuts < 1'000'000; ++trial) cuts += try_random_cuts(trial);
}

namespace {

SolidComplex make_complex(const TriangleMesh& surface, double element_size) {
  TetrahedraOptions options;
  options.element_size = element_size;
  const EmbeddedSolid solid = tetrahedralise(surface, options).value();
  SolidComplex complex = build_solid_complex(solid.elements, solid.embedded.material);
  settle(complex);
  return complex;
}

/// Our own figure, 1 m high, its material divided among coarse tetrahedra; what is inside x < 0.6 is most of
/// it, as of the cube.
SolidComplex make_figure_complex() {
  Meshing meshing;
  meshing.edge_length = 0.05;
  TriangleMesh surface = make_figure(1.0, meshing).value();
  for (Vec3& p : surface.positions) p.x() += 0.4;
  return make_complex(surface, 0.08);
}

/// The greatest Euler characteristic of a connected part of a surface, and whether each is even: 2 of what is
/// a sphere, 0 of a torus.
std::pair<long, bool> euler_of_parts(const TriangleMesh& mesh) {
  const EdgeTopology topology = build_edge_topology(mesh.triangles);
  core::DisjointSets parts(mesh.positions.size());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 1; k < 3; ++k) parts.unite(t[0], t[k]);
  std::vector<long> euler(mesh.positions.size(), 0);
  const auto of = [&](int vertex) -> long& { return euler[static_cast<std::size_t>(parts.find(vertex))]; };
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) ++of(static_cast<int>(v));
  for (const auto& edge : topology.edges) --of(edge[0]);
  for (const Triangle& t : mesh.triangles) ++of(t[0]);
  bool is_even = true;
  for (const long e : euler) is_even = is_even && e % 2 == 0;
  return {*std::max_element(euler.begin(), euler.end()), is_even};
}

/// As try_random_cuts, of the figure; adds the pieces it came to. Returns the number of cuts.
int try_figure_cuts(const SolidComplex& whole, int trial, std::size_t& pieces) {
  core::Random random(12, static_cast<std::uint64_t>(trial));
  const double volume = total_volume(whole);
  SolidComplex complex = whole;
  SolidCutter cutter(complex, trial % 3 == 0 ? SolidCutter::kLeastSnap : SolidCutter::kUsualSnap);
  SolidCut last = test::plane_cut(complex, Vec3::UnitX(), 0.4);
  const int count = 1 + static_cast<int>(random.index(4));
  for (int i = 0; i < count; ++i) {
    SolidCut cut = test::random_cut(complex, random, i, &last);
    if (random.index(3) == 0) keep_off_nodes(complex, 0.05, cut);
    cutter.cut(cut);
  }
  const auto split = split_solid(complex);
  pieces += split.pieces.size();
  double sum = 0.0, least = volume;
  bool is_closed = true, is_even = true;
  long euler = 2;
  std::string fault;
  std::vector<MassProperties> masses;
  for (const auto& piece : split.pieces) {
    is_closed = is_closed && are_cells_closed(piece.complex);
    sum += total_volume(piece.complex);
    least = std::min(least, total_volume(piece.complex));
    const SolidSurface surface = extract_surface(piece.complex);
    if (fault.empty()) fault = fault_of(surface, piece.complex);
    const auto [greatest, even] = euler_of_parts(surface.mesh);
    euler = std::max(euler, greatest);
    is_even = is_even && even;
    masses.push_back(solid_mass_properties(piece.complex, 1000.0));
  }
  const MassProperties all = combined(masses), before = solid_mass_properties(whole, 1000.0);
  INFO("trial " << trial << ": " << split.pieces.size() << " pieces of " << count << " cuts: " << fault);
  CHECK(is_closed);
  CHECK(fault.empty());
  CHECK(is_even);
  CHECK(euler == 2);
  CHECK(least > 0.0);
  CHECK(std::abs(sum / volume - 1.0) < 1e-10);
  CHECK(std::abs(all.mass / before.mass - 1.0) < 1e-10);
  CHECK((all.centre - before.centre).norm() < 1e-10);
  CHECK((all.inertia - before.inertia).norm() < 1e-10 * before.inertia.norm());
  return count;
}

constexpr const char* kBunny = "/usr/share/glmark2/models/bunny.obj";  // of Debian's glmark2-data

/// The bunny of scenes/bunny.toml in coarser elements; its file has vertices and triangles alone.
SolidComplex make_bunny_complex() {
  TriangleMesh surface;
  std::ifstream file(kBunny);
  std::string word;
  while (file >> word) {
    if (word == "v") {
      Vec3& p = surface.positions.emplace_back();
      file >> p.x() >> p.y() >> p.z();
    } else if (word == "f") {
      Triangle& t = surface.triangles.emplace_back();
      file >> t[0] >> t[1] >> t[2];
      for (int& v : t) --v;
    }
  }
  weld_equal_positions(surface);
  return make_complex(surface, 0.12);
}

void cut_solid(const SolidComplex& whole, int most) {
  REQUIRE(fault_of(extract_surface(whole), whole).empty());
  std::size_t pieces = 0;
  int cuts = 0, trials = 0;
  for (; cuts < most; ++trials) cuts += try_figure_cuts(whole, trials, pieces);
  CHECK(pieces > 2 * static_cast<std::size_t>(trials));
}

}  // namespace

TEST_CASE("split solid: 1e2 random cuts of a figure") {
  cut_solid(make_figure_complex(), static_cast<int>(test::how_many(100, 5)));
}

TEST_CASE("split solid: 1e3 random cuts of a figure", "[.][long]") {
  cut_solid(make_figure_complex(), 1000);
}

TEST_CASE("split solid: 1e2 random cuts of the bunny") {
  if (!std::filesystem::exists(kBunny)) {
    WARN("there is no bunny: apt install glmark2-data");
    return;
  }
  if (test::kIsSanitized) return;  // as of the figure, and 70 000 triangles
  cut_solid(make_bunny_complex(), 100);
}

TEST_CASE("split solid: 1e3 random cuts of the bunny", "[.][long]") {
  REQUIRE(std::filesystem::exists(kBunny));
  cut_solid(make_bunny_complex(), 1000);
}

TEST_CASE("split solid: a rim that comes to a vertex again and a triangle that is divided twice") {
  const SolidComplex whole = make_figure_complex();
  std::size_t pieces = 0;
  for (const int trial : {79, 166, 370}) try_figure_cuts(whole, trial, pieces);
  CHECK(pieces == 19 + 65 + 31);
}
