#include "engine/fracture/perforation.h"

#include <algorithm>

#include "engine/core/elementary.h"
#include "engine/fracture/perforation_law.h"

namespace shatterbox::fracture {
namespace {

constexpr double kLeastSquareness = 0.5;  // cosine: beyond 60 degrees strikers ricochet
constexpr double kShareThatCounts = 0.1;  // of the energy that a hole takes, from which it is looked for

double kinetic_energy_of(const Striker& striker) {
  return 0.5 * striker.speed * striker.speed / (1.0 / striker.mass + striker.struck_inverse_mass);
}

}  // namespace

double Perforation::momentum_share() const {
  return 1.0 - core::sqrt(std::max(0.0, 1.0 - 1.0 / ratio()));
}

std::optional<Perforation> begin_perforation(const material::Material& material, const Striker& striker) {
  if (!(flow_stress(material) > 0.0) || !(section_of(striker).area > 0.0) || !(striker.mass > 0.0) ||
      !(striker.speed > 0.0) || striker.core.empty())
    return std::nullopt;
  Perforation out;
  out.striker = striker;
  out.there = kinetic_energy_of(striker);
  return out;
}

bool ask_for_hole(const material::Material& material, const WayMaterial& way, Perforation& perforation) {
  if (way.squareness < kLeastSquareness) return false;
  const StrikerSection section = section_of(perforation.striker);
  perforation.thickness = way.thickness;
  perforation.work = perforation.needed =
      perforation_work({section.area, section.perimeter, perforation.striker.flatness, way.section, way.rim},
                       flow_stress(material));
  return perforation.there >= kShareThatCounts * perforation.needed;
}

void take_plug(double volume, double density, double wall_area, int part_count, Perforation& perforation) {
  perforation.is_cut = true;
  perforation.part_count = part_count;
  perforation.plug_volume = volume;
  perforation.wall_area = wall_area;
  perforation.plug_mass = density * volume;
  perforation.needed = perforation_energy(perforation.work, perforation.striker.mass, perforation.plug_mass);
}

}  // namespace shatterbox::fracture
