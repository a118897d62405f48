#include "engine/fracture/perforation.h"

#include <algorithm>

#include "engine/core/elementary.h"
#include "engine/fracture/perforation_law.h"
#include "engine/fracture/striker_way.h"
#include "engine/geometry/solid_contacts.h"

namespace shatterbox::fracture {
namespace {

using geometry::PunchSide;

constexpr double kPlugTaper = 0.1;        // by which it widens along the way: plugs are cones of some degrees
constexpr double kLeastSquareness = 0.5;  // cosine: beyond 60 degrees strikers ricochet
constexpr double kMostPlug = 0.5;         // of the body: a hole is in what is more than the hole
constexpr double kShareThatCounts = 0.1;  // of the energy that a hole takes, from which it is looked for

double kinetic_energy_of(const Striker& striker) {
  return 0.5 * striker.speed * striker.speed / (1.0 / striker.mass + striker.struck_inverse_mass);
}

}  // namespace

double Perforation::momentum_share() const {
  return 1.0 - core::sqrt(std::max(0.0, 1.0 - 1.0 / ratio()));
}

std::optional<Perforation> find_perforation(const geometry::SolidComplex& complex,
                                            const material::Material& material, const Striker& striker,
                                            double least_width, int tag) {
  const double flow = flow_stress(material);
  const StrikerSection section = section_of(striker);
  if (!(flow > 0.0) || !(section.area > 0.0) || !(striker.mass > 0.0) || !(striker.speed > 0.0) ||
      striker.core.empty())
    return std::nullopt;
  Perforation out;
  out.striker = striker;
  out.there = kinetic_energy_of(striker);
  // What is straight in his way tells how thick it is and where it begins; the plug is a cone from there.
  std::vector<int> cells = find_punch_cells(complex, sides_of_way(striker, 0.0, 0.0), striker.place);
  const WayMaterial way = find_way_material(complex, cells, striker);
  if (way.squareness < kLeastSquareness) return out;
  out.thickness = way.thickness;
  out.work = out.needed =
      perforation_work({section.area, section.perimeter, striker.flatness, way.section, way.rim}, flow);
  if (out.there < kShareThatCounts * out.needed) return out;
  const std::vector<geometry::PunchSide> sides = sides_of_way(striker, way.front, kPlugTaper);
  cells = find_punch_cells(complex, sides, striker.place);
  auto cut = std::make_shared<geometry::SolidComplex>(complex);
  const geometry::Punched punched = punch_out(*cut, sides, std::move(cells), tag);
  const int part_count = count_parts(*cut);
  if (part_count <= count_parts(complex)) return std::nullopt;
  if (!(punched.volume > least_width * punched.wall_area)) return out;
  if (punched.volume > kMostPlug * total_volume(complex)) return std::nullopt;
  out.complex = std::move(cut);
  out.sides = sides;
  out.part_count = part_count;
  out.plug_volume = punched.volume;
  out.wall_area = punched.wall_area;
  out.plug_mass = material.density * punched.volume;
  out.needed = perforation_energy(out.work, striker.mass, out.plug_mass);
  return out;
}

}  // namespace shatterbox::fracture
