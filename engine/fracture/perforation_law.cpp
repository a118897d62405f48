#include "engine/fracture/perforation_law.h"

#include <algorithm>

#include "engine/core/elementary.h"

namespace shatterbox::fracture {
namespace {

/// Resisting stress over flow stress, by thickness over diameter [RD10].
double resistance(double slenderness) {
  if (slenderness < 1.0 / 3.0) return 2.0 / 3.0 + 4.0 * slenderness;
  if (slenderness <= 1.0) return 2.0;
  return 2.0 + 0.8 * core::log(slenderness);
}

}  // namespace

double flow_stress(const material::Material& material) {
  return material.yield > 0.0 ? std::max(material.yield, material.strength) : 0.0;
}

double perforation_work(const PlateHit& hit, double flow_stress) {
  const std::vector<ThicknessShare> all{{hit.thickness, 1.0}};
  return perforation_work({hit.area, hit.perimeter, hit.flatness, all, all}, flow_stress);
}

double perforation_work(const UnevenPlateHit& hit, double flow_stress) {
  if (!(hit.area > 0.0)) return 0.0;
  const double diameter = 2.0 * core::sqrt(hit.area / core::kPi);
  double spread = 0.0, sheared = 0.0;
  for (const auto& [thickness, share] : hit.section)
    if (thickness > 0.0)
      spread += share * resistance(thickness / diameter) * flow_stress * hit.area * thickness;
  for (const auto& [thickness, share] : hit.rim)
    sheared += share * flow_stress / core::sqrt(3.0) * hit.perimeter * thickness * thickness;
  return spread + hit.flatness * (std::min(spread, sheared) - spread);
}

double perforation_energy(double work, double mass, double plug_mass) {
  return work * (1.0 + plug_mass / mass);
}

double ballistic_limit(double work, double mass, double plug_mass) {
  return core::sqrt(2.0 * perforation_energy(work, mass, plug_mass) / mass);
}

double residual_speed(double work, double mass, double plug_mass, double speed) {
  const double left = speed * speed - 2.0 * perforation_energy(work, mass, plug_mass) / mass;
  return left > 0.0 ? mass / (mass + plug_mass) * core::sqrt(left) : 0.0;
}

}  // namespace shatterbox::fracture
