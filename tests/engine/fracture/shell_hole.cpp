// Holes in sheets that yield: what they ask of a striker, and the plug, whatever the triangles.
#include "engine/fracture/shell_hole.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "engine/core/index.h"
#include "engine/fracture/perforation_law.h"
#include "tests/engine/fracture/steel_sheet.h"

using namespace shatterbox;
using namespace shatterbox::fracture;

namespace {

constexpr double kSheetThickness = 1.5e-3;  // m

/// A ball of 3 cm radius on its way along a direction through `place`, or a stamp of that section.
Striker make_striker(const Vec3& direction, double speed, const Vec3& place = Vec3::Zero(),
                     std::vector<Vec2> core = {Vec2::Zero()}, double radius = 0.03) {
  Striker striker;
  striker.direction = direction.normalized();
  striker.first = striker.direction.cross(Vec3::UnitY()).normalized();
  striker.second = striker.direction.cross(striker.first);
  striker.centre = striker.place = place;
  striker.speed = speed;
  striker.mass = 0.89;
  striker.core = std::move(core);
  striker.radius = radius;
  return striker;
}

double disc_work(double thickness) {
  const double area = core::kPi * 0.03 * 0.03;
  return perforation_work({thickness, area, 2.0 * core::kPi * 0.03, 0.0}, 360e6);
}

}  // namespace

TEST_CASE("shell hole: a sheet asks what the law says, and parts with a round plug, on any mesh") {
  for (const double edge : {0.01, 0.025, 0.06}) {
    const ShellSubject sheet = test::steel_sheet(test::make_pane(0.5, edge), kSheetThickness);
    CAPTURE(edge);
    for (const Vec3& place : {Vec3(0.0, 0.0, 0.0), Vec3(0.031, -0.047, 0.0)}) {
      const auto hole = find_perforation(sheet, make_striker(Vec3::UnitZ(), 90.0, place), 1e-4, 0);
      REQUIRE(hole);
      CHECK(hole->thickness == Approx(kSheetThickness).epsilon(1e-9));
      CHECK(hole->work == Approx(disc_work(kSheetThickness)).epsilon(1e-9));
      CHECK(hole->is_through());
      CHECK(hole->part_count == 2);
      // A polygon of 24 sides that is a tenth wider than the ball.
      const double area = hole->plug_volume / kSheetThickness;
      const double wanted = 24.0 * std::tan(core::kPi / 24.0) * 0.033 * 0.033;
      CHECK(area == Approx(wanted).epsilon(0.05));
      CHECK(hole->wall_area == Approx(2.0 * core::kPi * 0.033 * kSheetThickness).epsilon(0.03));
      CHECK(hole->plug_mass == Approx(7850.0 * hole->plug_volume));
      CHECK(geometry::total_area(*hole->mesh) == Approx(0.25).epsilon(1e-12));
      // The ball has room all about: no wall comes nearer to its line than its radius.
      double nearest = 1.0;
      for (const CrackSegment& segment : hole->segments)
        for (int i = 0; i <= 8; ++i) {
          const Vec3 x = segment.ends[0] + i / 8.0 * (segment.ends[1] - segment.ends[0]);
          nearest = std::min(nearest, (x - place).head<2>().norm());
        }
      CHECK(nearest > 0.03);
    }
  }
}

TEST_CASE("shell hole: slanted it is thicker, beyond sixty degrees he slides off") {
  const ShellSubject sheet = test::steel_sheet(test::make_pane(0.5, 0.025), kSheetThickness);
  const auto at = [&](double degrees) {
    const double angle = degrees * core::kPi / 180.0;
    return find_perforation(sheet, make_striker(Vec3(std::sin(angle), 0.0, std::cos(angle)), 120.0), 1e-4, 0);
  };
  REQUIRE(at(40.0));
  CHECK(at(40.0)->thickness == Approx(kSheetThickness / std::cos(40.0 * core::kPi / 180.0)).epsilon(1e-9));
  CHECK(at(40.0)->is_through());
  REQUIRE(at(65.0));
  CHECK_FALSE(at(65.0)->is_near());
}

TEST_CASE("shell hole: who has too little is far, or does not go through") {
  const ShellSubject sheet = test::steel_sheet(test::make_pane(0.5, 0.025), kSheetThickness);
  const auto at = [&](double speed) {
    return find_perforation(sheet, make_striker(Vec3::UnitZ(), speed), 1e-4, 0);
  };
  REQUIRE(at(90.0));
  const double limit = ballistic_limit(at(90.0)->work, 0.89, at(90.0)->plug_mass);
  CHECK(at(1.001 * limit)->is_through());
  CHECK_FALSE(at(0.999 * limit)->is_through());
  CHECK(at(0.999 * limit)->is_near());
  CHECK_FALSE(at(0.2 * limit)->is_near());
  ShellSubject glass = sheet;
  glass.material = *material::find_preset("glass");
  CHECK_FALSE(find_perforation(glass, make_striker(Vec3::UnitZ(), 90.0), 1e-4, 0));
}

TEST_CASE("shell hole: where a hole is already there is nothing to spread") {
  ShellSubject sheet = test::steel_sheet(test::make_pane(0.5, 0.02), kSheetThickness);
  const auto first = find_perforation(sheet, make_striker(Vec3::UnitZ(), 90.0), 1e-4, 0);
  REQUIRE((first && first->mesh));
  // Without the plug.
  geometry::ShellMesh holed = *first->mesh;
  std::erase_if(holed.cells, [&](const geometry::ShellCell& cell) {
    Vec2 middle = Vec2::Zero();
    for (int i = 0; i < cell.corner_count; ++i)
      middle += holed.corners[core::at(cell.first_corner + i)].barycentric / cell.corner_count;
    return position_in_element(*holed.elements, cell.element, middle).norm() < 0.033;
  });
  geometry::assign_degrees_of_freedom(holed, geometry::find_cell_contacts(holed));
  sheet.mesh = std::make_shared<const geometry::ShellMesh>(std::move(holed));
  sheet.systems = nullptr;
  prepare_subject(sheet);
  const auto beside = find_perforation(sheet, make_striker(Vec3::UnitZ(), 90.0, Vec3(0.15, 0, 0)), 1e-4, 1);
  const auto half = find_perforation(sheet, make_striker(Vec3::UnitZ(), 90.0, Vec3(0.04, 0, 0)), 1e-4, 1);
  REQUIRE((beside && half));
  CHECK(beside->work == Approx(first->work).epsilon(1e-9));
  CHECK(half->work < 0.75 * first->work);
  CHECK(half->work > 0.2 * first->work);
  CHECK(half->is_through());
}

TEST_CASE(
    "shell hole: of a closed ball he takes the wall that he meets and what is no more than the hole is let "
    "be") {
  const ShellSubject ball = test::steel_sheet(test::make_sphere(0.12, 0.015), kSheetThickness);
  const auto hole = find_perforation(ball, make_striker(-Vec3::UnitZ(), 90.0, Vec3(0, 0, 0.12)), 1e-4, 0);
  REQUIRE((hole && hole->mesh));
  CHECK(hole->part_count == 2);
  CHECK(hole->thickness > kSheetThickness);
  CHECK(hole->thickness < 1.1 * kSheetThickness);
  for (const CrackSegment& segment : hole->segments) CHECK(segment.ends[0].z() > 0.0);
  const ShellSubject small = test::steel_sheet(test::make_sphere(0.02, 0.004), kSheetThickness);
  const auto whole = find_perforation(small, make_striker(-Vec3::UnitZ(), 900.0, Vec3(0, 0, 0.02)), 1e-4, 0);
  CHECK((!whole || !whole->is_through()));
}

TEST_CASE("shell hole: a square stamp leaves a square hole") {
  const ShellSubject sheet = test::steel_sheet(test::make_pane(0.5, 0.02), kSheetThickness);
  const std::vector<Vec2> square = {{-0.03, -0.02}, {0.03, -0.02}, {0.03, 0.02}, {-0.03, 0.02}};
  Striker striker = make_striker(Vec3::UnitZ(), 90.0, Vec3::Zero(), square, 0.0);
  striker.flatness = 1.0;
  const auto hole = find_perforation(sheet, striker, 1e-4, 0);
  REQUIRE((hole && hole->mesh));
  CHECK(hole->sides.size() == 4);
  CHECK(hole->work == Approx(0.2 * kSheetThickness * kSheetThickness * 360e6 / std::sqrt(3.0)).epsilon(2e-3));
  const double clearance = 0.05 * section_of(striker).diameter;
  CHECK(hole->plug_volume / kSheetThickness ==
        Approx((0.06 + 2.0 * clearance) * (0.04 + 2.0 * clearance)).epsilon(0.05));
}

TEST_CASE("shell hole: under who was asked, and does not go through, no crack starts later in the event") {
  const ShellSubject sheet = test::steel_sheet(test::make_pane(0.5, 0.025), kSheetThickness);
  ImpactLoad load;
  load.direction = -Vec3::UnitZ();
  load.closing_speed = 200.0;
  load.effective_mass = 0.89;
  load.impulse = 1.6 * 0.89 * 200.0;
  load.other_inverse_mass = 1.0 / 0.89;
  load.hertz_compliance = 1e-8;
  load.hertz_radius = 5e-3;
  Impact impact;
  impact.loads = {load};
  const Decision torn = decide_shell(sheet, impact);
  CHECK(torn.verdict.outcome == Outcome::broke);  // nobody was asked
  CHECK_FALSE(torn.dent);
  impact.loads[0].was_asked = true;
  const Decision held = decide_shell(sheet, impact);
  CHECK(held.verdict.outcome == Outcome::held);
  CHECK(held.verdict.ratio > 1.0);
  CHECK(held.dent);
  impact.loads[0].was_asked = false;
  impact.loads[0].striker = std::make_shared<const Striker>(make_striker(-Vec3::UnitZ(), 200.0));
  const Decision gone_through = decide_shell(sheet, impact);
  REQUIRE((gone_through.perforation && gone_through.perforation->is_through()));
  CHECK(gone_through.verdict.outcome == Outcome::broke);
  CHECK(gone_through.cracks == 1);
  CHECK(gone_through.fracture_energy == gone_through.perforation->needed);
  CHECK(gone_through.dent);
}
