// What is crushed about hits on solids: cells that fill the core, whatever the elements and the cracks.
#include "engine/fracture/solid_core.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/fracture/decide_solid.h"
#include "engine/fracture/split_solid.h"
#include "engine/geometry/box_tets.h"
#include "engine/geometry/solid_contacts.h"
#include "engine/geometry/solid_cutter.h"
#include "tests/engine/geometry/solids.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;
using namespace shatterbox::fracture;
using core::at;

namespace {

/// A block about the origin, its upper face at y = half.y().
std::shared_ptr<const geometry::SolidComplex> make_block(const Vec3& half, double element_size) {
  auto elements = std::make_shared<geometry::SolidElements>();
  elements->mesh = geometry::make_box_tets(half, element_size).value();
  elements->topology = geometry::build_tet_topology(elements->mesh.tetrahedra);
  auto complex = std::make_shared<geometry::SolidComplex>(geometry::make_solid_complex(elements));
  settle(*complex);
  return complex;
}

const Vec3 kHalf(0.2, 0.1, 0.15);

SolidCoreSetup core_at(const Vec3& centre, double radius, double least_size) {
  SolidCoreSetup setup;
  setup.cores.push_back({centre, radius});
  setup.least_size = least_size;
  setup.seed = 7;
  setup.id = 3;
  return setup;
}

double crack_area(const geometry::SolidComplex& complex, int tag) {
  double area = 0.0;
  for (const geometry::SolidFacet& facet : complex.facets)
    if (facet.parts[0] < 0 && facet.kind == geometry::FacetKind::crack && facet.tag == tag)
      area += facet_area_vector(complex, facet).norm();
  return area;
}

}  // namespace

TEST_CASE("solid core: the crumbs fill the core, and nothing is lost") {
  const auto block = make_block(kHalf, 0.04);
  geometry::SolidComplex complex = *block;
  const Vec3 centre(0.03, kHalf.y(), -0.02);
  const CrushedSolid crushed = crush(complex, core_at(centre, 0.08, 0.03));
  CHECK(are_cells_closed(complex));
  CHECK(total_volume(complex) == Approx(8.0 * kHalf.prod()).epsilon(1e-12));
  CHECK(crack_area(complex, 3) == Approx(crushed.area).epsilon(1e-12));
  const SolidSplit split = split_solid(complex, 1e-4);  // what snapping leaves is no crumb
  REQUIRE(static_cast<int>(split.pieces.size()) == crushed.cells + 1);
  CHECK(crushed.cells > 8);
  CHECK(crushed.cells < 40);
  double volume = 0.0;
  for (std::size_t p = 1; p < split.pieces.size(); ++p) {
    const geometry::SolidComplex& piece = split.pieces[p].complex;
    const double own = total_volume(piece);
    volume += own;
    CHECK(own > 1e-2 * 0.03 * 0.03 * 0.03);  // no splinter: seeds keep apart
    for (const geometry::SolidPart& cell : piece.cells)
      CHECK((cell_centre(piece, cell) - centre).norm() < 0.13);
  }
  // Cells whose seeds lie in half a ball fill about that.
  CHECK(volume == Approx(2.0 / 3.0 * core::kPi * 0.08 * 0.08 * 0.08).epsilon(0.3));
}

TEST_CASE("solid core: the same cells whatever the elements, also when these are larger") {
  const Vec3 centre(0.03, kHalf.y(), -0.02);
  int cells = 0;
  double area = 0.0;
  for (const double size : {0.1, 0.04, 0.02}) {
    geometry::SolidComplex complex = *make_block(kHalf, size);
    const CrushedSolid crushed = crush(complex, core_at(centre, 0.08, 0.02));
    if (cells == 0) {
      cells = crushed.cells;
      area = crushed.area;
    }
    CHECK(crushed.cells == cells);
    CHECK(crushed.area == Approx(area).epsilon(1e-4));  // cuts snap to nodes
  }
}

TEST_CASE("solid core: what a crack has parted is divided by itself") {
  geometry::SolidComplex complex = *make_block(kHalf, 0.04);
  geometry::SolidCutter cutter(complex);
  const Vec3 normal = Vec3(1.0, 0.2, 0.1).normalized();
  cutter.cut(test::plane_cut(complex, normal, 0.02, 1));
  settle(complex);
  REQUIRE(count_parts(complex) == 2);
  const double cut = crack_area(complex, 1);
  const CrushedSolid crushed = crush(complex, core_at(Vec3(0.03, kHalf.y(), -0.02), 0.08, 0.03));
  CHECK(are_cells_closed(complex));
  CHECK(crack_area(complex, 1) == Approx(cut).epsilon(1e-9));
  CHECK(crack_area(complex, 3) == Approx(crushed.area).epsilon(1e-12));
  const SolidSplit split = split_solid(complex, 1e-4);
  CHECK(static_cast<int>(split.pieces.size()) >= crushed.cells + 2);
  for (const SolidPiece& piece : split.pieces) {
    bool is_before = false, is_behind = false;
    for (const geometry::SolidPart& cell : piece.complex.cells)
      (normal.dot(cell_centre(piece.complex, cell)) < 0.02 ? is_before : is_behind) = true;
    CHECK(is_before != is_behind);
  }
}

TEST_CASE("solid core: a blow that several points bear makes no more crumbs than that of one") {
  const auto block = make_block(kHalf, 0.04);
  const Vec3 left(-0.13, kHalf.y(), 0.0), right(0.13, kHalf.y(), 0.0);
  const auto crushed_at = [&](const std::vector<SolidCore>& cores) {
    geometry::SolidComplex complex = *block;
    SolidCoreSetup setup = core_at(left, 0.05, 0.02);
    setup.cores = cores;
    const CrushedSolid crushed = crush(complex, setup);
    CHECK(total_volume(complex) == Approx(8.0 * kHalf.prod()).epsilon(1e-12));
    return crushed.cells;
  };
  const int one = crushed_at({{left, 0.05}});
  CHECK(one > 15);
  const double half = 0.05 * core::sqrt(0.5);  // presses with half the force
  const int two = crushed_at({{left, half}, {right, half}});
  CHECK(two > one / 2);
  CHECK(two <= 1.2 * one);
  CHECK(crushed_at({{left, half}, {left + Vec3(0.02, 0.0, 0.0), half}}) <= 1.2 * one);
  CHECK(crushed_at({{left, 0.05}, {left, 0.05}}) < one);
  CHECK(crushed_at({{left, 0.1}, {left, 0.02}}) < 80);
}

TEST_CASE("solid core: beyond the energy nothing is cut") {
  geometry::SolidComplex complex = *make_block(kHalf, 0.04);
  const std::size_t cells = complex.cells.size();
  SolidCoreSetup setup = core_at(Vec3(0.0, kHalf.y(), 0.0), 0.08, 0.03);
  setup.most_area = 1e-3;
  const CrushedSolid crushed = crush(complex, setup);
  CHECK(crushed.is_out_of_energy);
  CHECK(crushed.area == 0.0);
  CHECK(complex.cells.size() == cells);
  setup.cores.clear();
  CHECK(crush(complex, setup).cells == 0);
}

TEST_CASE("solid core: a disc of its radius presses with eight times the tensile strength") {
  const double radius = crushed_disc_radius(3e4, 2.5e6);
  CHECK(3e4 / (core::kPi * radius * radius) == Approx(8.0 * 2.5e6));
}

namespace {

SolidDecision strike(const char* material, double speed, double spacing = 4.0, const Vec3& half = kHalf,
                     double scale = 1.0) {
  SolidSubject subject;
  subject.complex = make_block(scale * half, scale * (test::kIsSanitized ? 0.032 : 0.025));
  subject.material = *material::find_preset(material);
  ImpactLoad load;
  load.point_material = scale * Vec3(0.03, half.y(), -0.02);
  load.direction = -Vec3::UnitY();
  load.effective_mass = 1.0 * scale * scale * scale;
  load.closing_speed = speed;
  load.impulse = 1.3 * load.effective_mass * speed;
  load.other_inverse_mass = 1.0 / load.effective_mass;
  load.hertz_compliance = 1e-9 / scale;
  Impact impact;
  impact.loads.push_back(load);
  FractureSettings settings;
  settings.core_spacing = spacing;
  return decide_solid(subject, impact, settings);
}

}  // namespace

TEST_CASE("solid core: a hard hit crushes, a soft one cracks, and what is crushed is paid for") {
  const SolidDecision hard = strike("plaster", 15.0);
  REQUIRE(hard.verdict.outcome == Outcome::broke);
  CHECK(hard.core_cells > 5);
  CHECK(hard.fracture_energy ==
        Approx(material::find_preset("plaster")->fracture_energy * hard.new_area).epsilon(1e-9));
  CHECK(hard.fracture_energy <= hard.elastic_energy);
  const SolidDecision without = strike("plaster", 15.0, 0.0);
  CHECK(without.core_cells == 0);
  CHECK(hard.part_count > without.part_count);
  CHECK(hard.cracks == without.cracks + 1);
  const SolidDecision soft = strike("plaster", 2.0, 4.0, Vec3(0.4, 0.02, 0.05));
  REQUIRE(soft.verdict.outcome == Outcome::broke);
  CHECK(soft.core_cells == 0);
  CHECK(strike("steel", 100.0).core_cells == 0);
}

TEST_CASE("solid core: a twin of 1024 times the size has the same") {
  const SolidDecision one = strike("plaster", 15.0), large = strike("plaster", 15.0, 4.0, kHalf, 1024.0);
  REQUIRE(one.core_cells > 0);
  CHECK(large.verdict.force == Approx(1024.0 * 1024.0 * one.verdict.force).epsilon(1e-6));
  geometry::SolidComplex small = *make_block(kHalf, 0.04), twin = *make_block(1024.0 * kHalf, 1024.0 * 0.04);
  const CrushedSolid a = crush(small, core_at(Vec3(0.03, kHalf.y(), -0.02), 0.08, 0.03));
  const CrushedSolid b =
      crush(twin, core_at(1024.0 * Vec3(0.03, kHalf.y(), -0.02), 1024.0 * 0.08, 1024.0 * 0.03));
  CHECK(a.cells == b.cells);
  CHECK(b.area == Approx(1024.0 * 1024.0 * a.area).epsilon(1e-9));
}
