// The law of holes through what yields, and the plug that is cut: whatever the elements, it has room.
#include "engine/fracture/solid_hole.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "engine/fracture/perforation_law.h"
#include "engine/fracture/striker_way.h"
#include "engine/geometry/box_tets.h"
#include "tests/engine/geometry/solids.h"

using namespace shatterbox;
using namespace shatterbox::fracture;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kFlow = 360e6;  // Pa, of steel

PlateHit disc_hit(double thickness, double diameter, double flatness) {
  return {thickness, kPi / 4 * diameter * diameter, kPi * diameter, flatness};
}

/// A plate of that thickness in z, the middle of its face z = 0 at the origin.
geometry::SolidComplex make_plate(double thickness, double element_size) {
  auto elements = std::make_shared<geometry::SolidElements>();
  elements->mesh = geometry::make_box_tets(Vec3(0.2, 0.15, 0.5 * thickness), element_size).value();
  for (Vec3& p : elements->mesh.positions) p.z() += 0.5 * thickness;
  elements->topology = geometry::build_tet_topology(elements->mesh.tetrahedra);
  geometry::SolidComplex complex = geometry::make_solid_complex(elements);
  settle(complex);
  return complex;
}

/// The same of six tetrahedra alone, far larger than any striker.
geometry::SolidComplex make_coarse_plate(double thickness) {
  auto elements = std::make_shared<geometry::SolidElements>(*test::make_cube_elements(1));
  for (Vec3& p : elements->mesh.positions) p = Vec3(0.4 * p.x() - 0.2, 0.3 * p.y() - 0.15, thickness * p.z());
  geometry::SolidComplex complex = geometry::make_solid_complex(elements);
  settle(complex);
  return complex;
}

/// A ball of 3 cm radius on its way along a direction through the origin, or a stamp of that section.
Striker make_striker(const Vec3& direction, double speed, std::vector<Vec2> core = {Vec2::Zero()},
                     double radius = 0.03) {
  Striker striker;
  striker.direction = direction.normalized();
  striker.first = striker.direction.cross(Vec3::UnitY()).normalized();
  striker.second = striker.direction.cross(striker.first);
  striker.speed = speed;
  striker.mass = 0.89;
  striker.core = std::move(core);
  striker.radius = radius;
  return striker;
}

double distance_from_core(const Vec2& point, const std::vector<Vec2>& core) {
  double nearest = 1e300;
  bool is_inside = core.size() > 2;
  for (std::size_t i = 0; i < core.size(); ++i) {
    const Vec2 a = core[i], side = core[(i + 1) % core.size()] - a;
    const double t =
        side.squaredNorm() > 0.0 ? std::clamp((point - a).dot(side) / side.squaredNorm(), 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (point - a - t * side).norm());
    if (side.x() * (point - a).y() - side.y() * (point - a).x() < 0.0) is_inside = false;
  }
  return is_inside ? -nearest : nearest;
}

/// Least room between the wall and the striker's section, m; looked for along all edges of the wall.
double least_room(const SolidHole& hole, int tag) {
  double room = 1e300;
  const geometry::SolidComplex& complex = *hole.complex;
  for (const geometry::SolidFacet& facet : complex.facets) {
    if (facet.parts[0] >= 0 || facet.kind != geometry::FacetKind::crack || facet.tag != tag) continue;
    for (int k = 0; k < facet.side_count; ++k) {
      const int side = complex.sides_of(facet)[k];
      const Vec3 &a = complex.position(complex.side_begin(side)),
                 &b = complex.position(complex.side_end(side));
      for (int i = 0; i <= 8; ++i) {
        const Vec3 arm = a + i / 8.0 * (b - a) - hole.striker.centre;
        const Vec2 across(hole.striker.first.dot(arm), hole.striker.second.dot(arm));
        room = std::min(room, distance_from_core(across, hole.striker.core) - hole.striker.radius);
      }
    }
  }
  return room;
}

}  // namespace

TEST_CASE("perforation law: the work is [RD10]'s for round strikers and a plug's shear for flat ones") {
  const double d = 0.06, area = kPi / 4 * d * d;
  for (const double h : {0.002, 0.02, 0.05}) {
    const double resistance = h / d < 1.0 / 3 ? 2.0 / 3 + 4 * h / d : 2.0;
    CHECK(perforation_work(disc_hit(h, d, 0.0), kFlow) == Approx(resistance * kFlow * area * h));
    CHECK(perforation_work(disc_hit(h, d, 1.0), kFlow) == Approx(kPi * d * h * h * kFlow / std::sqrt(3.0)));
  }
  CHECK(perforation_work(disc_hit(0.12, d, 0.0), kFlow) ==
        Approx((2.0 + 0.8 * std::log(2.0)) * kFlow * area * 0.12));
  // Plugging ends at Woodward's sqrt(3) / 2 diameters: beyond it flat strikers spread the material too.
  CHECK(perforation_work(disc_hit(0.86 * d, d, 1.0), kFlow) <
        perforation_work(disc_hit(0.86 * d, d, 0.0), kFlow));
  CHECK(perforation_work(disc_hit(0.87 * d, d, 1.0), kFlow) ==
        perforation_work(disc_hit(0.87 * d, d, 0.0), kFlow));
  CHECK(perforation_work(disc_hit(0.0, d, 0.0), kFlow) == 0.0);
}

TEST_CASE(
    "perforation law: more for thicker plates and blunter is never more without a jump and no unit of "
    "length") {
  for (const double flatness : {0.0, 0.4, 1.0}) {
    double last = 0.0;
    for (double h = 0.0005; h < 0.3; h *= 1.02) {
      const double work = perforation_work(disc_hit(h, 0.06, flatness), kFlow);
      CHECK(work > last);
      if (last > 0.0) CHECK(work < 1.06 * last);
      CHECK(work <= perforation_work(disc_hit(h, 0.06, 0.0), kFlow));
      last = work;
      const double twin = perforation_work(disc_hit(h / 1024, 0.06 / 1024, flatness), kFlow);
      CHECK(twin * 1024.0 * 1024.0 * 1024.0 == Approx(work).epsilon(1e-12));
    }
  }
}

TEST_CASE(
    "perforation law: a plate that is there in part takes as much of the work and a wall only where it "
    "stands") {
  const double d = 0.06, area = kPi / 4 * d * d;
  for (const double flatness : {0.0, 0.4, 1.0}) {
    const double whole = perforation_work(disc_hit(0.02, d, flatness), kFlow);
    const std::vector<ThicknessShare> half{{0.0, 0.5}, {0.02, 0.25}, {0.02, 0.25}};
    CHECK(perforation_work(UnevenPlateHit{area, kPi * d, flatness, half, half}, kFlow) ==
          Approx(0.5 * whole));
    // Two plates beside each other.
    const double other = perforation_work(disc_hit(0.01, d, flatness), kFlow);
    const std::vector<ThicknessShare> both{{0.02, 0.3}, {0.01, 0.7}};
    CHECK(perforation_work(UnevenPlateHit{area, kPi * d, flatness, both, both}, kFlow) ==
          Approx(0.3 * whole + 0.7 * other));
  }
}

TEST_CASE("perforation law: residual speeds are Recht and Ipson's and close the energy") {
  const double work = 40e3, mass = 0.9, plug = 0.45;
  const double limit = ballistic_limit(work, mass, plug);
  CHECK(0.5 * mass * limit * limit == Approx(work * 1.5));
  CHECK(residual_speed(work, mass, plug, 0.999 * limit) == 0.0);
  CHECK(residual_speed(work, mass, plug, limit * 1.0001) < 0.02 * limit);
  for (const double speed : {1.1 * limit, 2.0 * limit, 5.0 * limit}) {
    const double left = residual_speed(work, mass, plug, speed);
    CHECK(left == Approx(mass / (mass + plug) * std::sqrt(speed * speed - limit * limit)));
    const double carried = 0.5 * mass * speed * speed * plug / (mass + plug);
    CHECK(0.5 * mass * speed * speed - carried - 0.5 * (mass + plug) * left * left == Approx(work));
  }
  // The strength is what a torn metal flows at; what does not yield is not perforated.
  CHECK(flow_stress(*material::find_preset("steel")) == 360e6);
  CHECK(flow_stress(*material::find_preset("concrete")) == 0.0);
}

TEST_CASE("perforation: a ball's plug leaves room everywhere whatever the elements") {
  const material::Material steel = *material::find_preset("steel");
  for (const double size : {0.01, 0.02, 0.05, 0.3}) {
    const geometry::SolidComplex plate = size > 0.2 ? make_coarse_plate(0.02) : make_plate(0.02, size);
    const auto hole = find_perforation(plate, steel, make_striker(Vec3::UnitZ(), 500.0), 1e-4, 7);
    CAPTURE(size);
    REQUIRE(hole);
    CHECK(hole->part_count == 2);
    CHECK(hole->is_through());
    CHECK(hole->thickness == Approx(0.02).epsilon(2e-3));
    CHECK(hole->work == Approx(perforation_work(disc_hit(hole->thickness, 0.06, 0.0), steel.strength)));
    CHECK(are_cells_closed(*hole->complex));
    CHECK(total_volume(*hole->complex) == Approx(0.4 * 0.3 * 0.02).epsilon(1e-10));
    CHECK(hole->plug_mass == Approx(7850.0 * hole->plug_volume));
    CHECK(least_room(*hole, 7) > 0.02 * 0.06 - 1e-4);
    CHECK(least_room(*hole, 7) < 0.02 * 0.06 + 1e-4);
    // A prism of 24 sides that widens by a tenth of its length.
    CHECK(hole->wall_area == Approx(2 * kPi * 0.0322 * 0.02).epsilon(0.02));
  }
}

TEST_CASE("perforation: at a slant the way is longer and beyond sixty degrees there is none") {
  const material::Material steel = *material::find_preset("steel");
  const geometry::SolidComplex plate = make_plate(0.02, 0.02);
  const double degree = kPi / 180.0;
  double last = 0.0;
  for (const double angle : {0.0, 30.0, 45.0}) {
    const Vec3 direction(std::sin(angle * degree), 0.0, std::cos(angle * degree));
    const auto hole = find_perforation(plate, steel, make_striker(direction, 600.0), 1e-4, 0);
    REQUIRE(hole);
    CHECK(hole->part_count == 2);
    CHECK(hole->thickness == Approx(0.02 / std::cos(angle * degree)).epsilon(2e-3));
    CHECK(hole->needed > last);
    CHECK(least_room(*hole, 0) > 0.001);
    last = hole->needed;
  }
  const Vec3 grazing(std::sin(65 * degree), 0.0, std::cos(65 * degree));
  REQUIRE(find_perforation(plate, steel, make_striker(grazing, 600.0), 1e-4, 0));
  CHECK_FALSE(find_perforation(plate, steel, make_striker(grazing, 600.0), 1e-4, 0)->is_near());
}

TEST_CASE("perforation: a way that is half open beside an edge costs half of the work") {
  const material::Material steel = *material::find_preset("steel");
  const geometry::SolidComplex plate = make_plate(0.02, 0.02);
  const std::vector<Vec2> square = {{-0.03, -0.03}, {0.03, -0.03}, {0.03, 0.03}, {-0.03, 0.03}};
  for (const bool is_flat : {true, false}) {
    Striker striker = make_striker(Vec3::UnitZ(), 900.0);
    if (is_flat) striker = make_striker(Vec3::UnitZ(), 900.0, square, 0.0);
    striker.flatness = is_flat ? 1.0 : 0.0;
    const auto whole = find_perforation(plate, steel, striker, 1e-4, 0);
    striker.centre = Vec3(0.2, 0.0, -0.03);
    striker.place = Vec3(0.19, 0.0, 0.0);
    const auto half = find_perforation(plate, steel, striker, 1e-4, 0);
    REQUIRE((whole && half && half->is_near()));
    // Of a square's wall one side stands, and half of two.
    CHECK(half->thickness == Approx(0.01).epsilon(0.02));
    CHECK(half->work == Approx(0.5 * whole->work).epsilon(0.02));
    CHECK(half->part_count == 2);
  }
}

namespace {

/// What is left when the plug is gone.
geometry::SolidComplex take_plug_out(const SolidHole& hole) {
  const geometry::SolidComplex& cut = *hole.complex;
  std::vector<int> kept;
  for (std::size_t c = 0; c < cut.cells.size(); ++c) {
    const Vec3 middle = cell_centre(cut, cut.cells[c]);
    const bool is_in =
        std::all_of(hole.sides.begin(), hole.sides.end(),
                    [&](const geometry::PunchSide& side) { return side.normal.dot(middle) <= side.offset; });
    if (!is_in) kept.push_back(static_cast<int>(c));
  }
  return geometry::PieceExtractor(cut).extract(kept);
}

}  // namespace

TEST_CASE(
    "perforation: who comes at the rim of a hole goes through the faces and not through the hole's wall") {
  const material::Material steel = *material::find_preset("steel");
  const geometry::SolidComplex plate = make_plate(0.02, 0.02);
  const auto first = find_perforation(plate, steel, make_striker(Vec3::UnitZ(), 900.0), 1e-4, 1);
  REQUIRE((first && first->is_through()));
  const geometry::SolidComplex holed = take_plug_out(*first);
  // Sides of the second way lie on planes that the first one was cut along.
  double last = 0.0;
  for (const double aside : {0.01, 0.02, 0.03, 0.045}) {
    Striker striker = make_striker(Vec3::UnitZ(), 900.0);
    striker.centre = Vec3(aside, 0.0, -0.03);
    striker.place = Vec3(0.0322, 0.0, 0.001);
    const auto second = find_perforation(holed, steel, striker, 1e-4, 2);
    CAPTURE(aside);
    REQUIRE((second && second->is_near()));
    CHECK(second->is_through());
    CHECK(second->part_count == 2);
    CHECK(second->work > last);
    CHECK(second->work < first->work);
    last = second->work;
  }
  // Who has the way open but for a hair meets nothing that could break.
  Striker brushing = make_striker(Vec3::UnitZ(), 900.0);
  brushing.centre = Vec3(0.0014, 0.0, -0.03);
  brushing.place = Vec3(0.0322, 0.0, 0.001);
  REQUIRE(find_perforation(holed, steel, brushing, 1e-3, 2));
  CHECK_FALSE(find_perforation(holed, steel, brushing, 1e-3, 2)->is_near());
  // At sixty-five degrees he slides off, there as elsewhere.
  Striker grazing = make_striker(Vec3(std::sin(65 * kPi / 180), 0.0, std::cos(65 * kPi / 180)), 900.0);
  grazing.centre = Vec3(0.02, 0.0, 0.0);
  grazing.place = Vec3(0.0322, 0.0, 0.0);
  REQUIRE(find_perforation(holed, steel, grazing, 1e-4, 2));
  CHECK_FALSE(find_perforation(holed, steel, grazing, 1e-4, 2)->is_near());
}

TEST_CASE("perforation: around the limit the energy decides and nobody asks where it is far") {
  const material::Material steel = *material::find_preset("steel");
  const geometry::SolidComplex plate = make_plate(0.02, 0.02);
  const auto at = [&](double speed) {
    return find_perforation(plate, steel, make_striker(Vec3::UnitZ(), speed), 1e-4, 0);
  };
  const auto known = at(300.0);
  REQUIRE(known);
  const double limit = ballistic_limit(known->work, 0.89, known->plug_mass);
  CHECK(limit > 300.0);
  CHECK_FALSE(at(0.999 * limit)->is_through());
  CHECK(at(1.001 * limit)->is_through());
  CHECK(at(1.001 * limit)->needed == Approx(known->needed));
  REQUIRE(at(50.0));
  CHECK_FALSE(at(50.0)->is_near());
  const geometry::SolidComplex block = make_plate(0.3, 0.05);
  CHECK_FALSE(find_perforation(block, steel, make_striker(Vec3::UnitZ(), 300.0), 1e-4, 0)->is_through());
  // A free plate gives way: of the same speed less is there.
  Striker striker = make_striker(Vec3::UnitZ(), 400.0);
  striker.struck_inverse_mass = 1.0 / 0.89;
  CHECK(find_perforation(plate, steel, striker, 1e-4, 0)->there == Approx(0.5 * at(400.0)->there));
}

TEST_CASE("perforation: square and long stamps cut what they are and what covers all parts nothing") {
  const material::Material steel = *material::find_preset("steel");
  const geometry::SolidComplex plate = make_plate(0.02, 0.02);
  const std::vector<Vec2> square = {{-0.03, -0.02}, {0.03, -0.02}, {0.03, 0.02}, {-0.03, 0.02}};
  Striker striker = make_striker(Vec3::UnitZ(), 500.0, square, 0.0);
  striker.flatness = 1.0;
  const auto hole = find_perforation(plate, steel, striker, 1e-4, 3);
  REQUIRE(hole);
  CHECK(hole->sides.size() == 4);
  CHECK(hole->thickness == Approx(0.02).epsilon(1e-3));
  CHECK(hole->work == Approx(0.2 * 0.02 * 0.02 * 360e6 / std::sqrt(3.0)).epsilon(2e-3));
  CHECK(least_room(*hole, 3) > 0.001);
  const std::vector<Vec2> segment = {{-0.04, 0.0}, {0.04, 0.0}};
  const auto slot =
      find_perforation(plate, steel, make_striker(Vec3::UnitZ(), 600.0, segment, 0.015), 1e-4, 0);
  REQUIRE(slot);
  CHECK(slot->thickness == Approx(0.02).epsilon(2e-3));
  CHECK(least_room(*slot, 0) > 0.001);
  const std::vector<Vec2> all = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  CHECK_FALSE(find_perforation(plate, steel, make_striker(Vec3::UnitZ(), 5000.0, all, 0.0), 1e-4, 0));
}

TEST_CASE("perforation: a side in two parts that hardly turn is one side") {
  const geometry::SolidComplex plate = make_plate(0.02, 0.02);
  const material::Material steel = *material::find_preset("steel");
  const double half = 0.03;
  const std::vector<Vec2> square{{-half, -half}, {half, -half}, {half, half}, {-half, half}};
  const auto plain =
      find_perforation(plate, steel, make_striker(Vec3::UnitZ(), 900.0, square, 0.0), 1e-4, 100);
  REQUIRE((plain && plain->is_near()));
  for (const double out : {0.0, 1e-19, 1e-12}) {
    std::vector<Vec2> broken = square;
    broken.insert(broken.begin() + 1, Vec2(0.2 * half, -half - out));
    const auto hole =
        find_perforation(plate, steel, make_striker(Vec3::UnitZ(), 900.0, broken, 0.0), 1e-4, 100);
    REQUIRE((hole && hole->is_near()));
    CHECK(hole->thickness == Approx(plain->thickness).epsilon(1e-6));
    CHECK(hole->needed == Approx(plain->needed).epsilon(1e-6));
  }
}

TEST_CASE("convex hulls go round once counter-clockwise") {
  const std::vector<Vec2> hull =
      convex_hull({{0, 0}, {1, 0}, {0.5, 0.5}, {1, 1}, {0, 1}, {0.5, 0.0}, {1, 0.3}, {0, 0}});
  CHECK(hull == std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  CHECK(convex_hull({{1, 0}, {0, 0}, {0.5, 0}}).size() == 2);
  Striker square;
  square.core = hull;
  square.radius = 0.5;
  CHECK(section_of(square).area == Approx(1.0 + 2.0 + kPi / 4));
  CHECK(section_of(square).perimeter == Approx(4.0 + kPi));
}

TEST_CASE("a stamp whose side lies in the side of a plate has nothing of it in its way") {
  const geometry::SolidComplex plate = make_plate(0.02, 0.05);
  std::vector<int> cells;
  for (std::size_t c = 0; c < plate.cells.size(); ++c) cells.push_back(static_cast<int>(c));
  constexpr double half = 0.03;
  Striker striker =
      make_striker(Vec3::UnitZ(), 100.0, {{-half, -half}, {half, -half}, {half, half}, {-half, half}}, 0.0);
  for (const double across : {0.0, 0.15, 0.15 + half})  // the second: half of the side is beyond a corner
    for (int digits = -63; digits <= 63; digits += 3) {
      striker.centre = Vec3((0.2 + half) * (1.0 + 1e-16 * digits), across, 0.0);
      INFO(across << ", " << digits);
      const WayMaterial way = find_way_material(plate, cells, striker, 0.02 * section_of(striker).diameter);
      CHECK(std::abs(way.thickness) < 1e-12);
      double sum = 0.0, least = 0.0;
      for (const ThicknessShare& share : way.section) {
        sum += share.share;
        least = std::min(least, share.share);
      }
      CHECK(sum < 1e-9);
      CHECK(least == 0.0);
    }
}
