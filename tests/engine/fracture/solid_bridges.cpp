// What hangs by less than the elements can tell parts under more than the strength, and only that.
#include "engine/fracture/solid_bridges.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/geometry/solid_contacts.h"
#include "tests/engine/geometry/solids.h"

using namespace shatterbox;
using namespace shatterbox::fracture;
using geometry::SolidComplex;

namespace {

/// A unit cube of 5 x 5 x 5 cubes of six elements, cut across its middle but for one cube.
SolidComplex bridged_cube() {
  const auto elements = test::make_cube_elements(5);
  SolidComplex complex = geometry::make_solid_complex(elements);
  geometry::SolidCut cut = test::plane_cut(complex, Vec3::UnitX(), 0.48);
  std::erase_if(cut.cells, [&](int cell) {
    const Vec3 centre = cell_centre(complex, complex.cells[static_cast<std::size_t>(cell)]);
    return std::abs(centre.y() - 0.5) < 0.1 && std::abs(centre.z() - 0.5) < 0.1;
  });
  geometry::SolidCutter(complex).cut(cut);
  settle(complex);
  return complex;
}

double part(SolidComplex& complex, const std::vector<double>& tensions, double most_area = 1.0) {
  const auto contacts = geometry::find_solid_contacts(complex);
  return part_bridges(complex, {&contacts, &tensions, 1e6, 0.1, most_area, 7});
}

}  // namespace

TEST_CASE("solid bridges: one that is overloaded parts, along faces of its elements") {
  SolidComplex complex = bridged_cube();
  REQUIRE(count_parts(complex) == 1);
  const double volume = total_volume(complex);
  std::vector<double> tensions(complex.cells.size(), 0.0);
  for (std::size_t c = 0; c < tensions.size(); ++c) {
    const double away = std::abs(cell_centre(complex, complex.cells[c]).x() - 0.48);
    if (away < 0.2) tensions[c] = 2e6 - 4e6 * away;
  }
  CHECK(part(complex, tensions, 0.03) == 0.0);
  REQUIRE(count_parts(complex) == 1);
  const double area = part(complex, tensions);
  CHECK(area > 0.2 * 0.2);
  CHECK(area < 5.0 * 0.2 * 0.2);  // its sides open too, as far as they go past the cut
  CHECK(count_parts(complex) == 2);
  CHECK(total_volume(complex) == volume);
  CHECK(part(complex, tensions) == 0.0);
}

TEST_CASE("solid bridges: what bears its load, is no bridge, or would come off as a crumb stays") {
  SolidComplex complex = bridged_cube();
  CHECK(part(complex, std::vector<double>(complex.cells.size(), 0.9e6)) == 0.0);
  std::vector<double> at_the_end(complex.cells.size(), 0.0), few = at_the_end;
  for (std::size_t c = 0; c < few.size(); ++c) {
    const Vec3 centre = cell_centre(complex, complex.cells[c]);
    if (centre.x() > 0.9) at_the_end[c] = 5e6;  // far from the crack
    if (std::abs(centre.x() - 0.48) < 0.2 && centre.y() < 0.5) few[c] = 5e6;
  }
  CHECK(part(complex, at_the_end) == 0.0);
  CHECK(part(complex, few) == 0.0);
  CHECK(count_parts(complex) == 1);
  SolidComplex sound = geometry::make_solid_complex(test::make_cube_elements(5));
  CHECK(part(sound, std::vector<double>(sound.cells.size(), 5e6)) == 0.0);
}
