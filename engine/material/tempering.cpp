#include "engine/material/tempering.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "engine/core/elementary.h"

namespace shatterbox::material {
namespace {

struct Release {
  double diameter;  // in thicknesses
  double width;     // of it that has set its energy free: share * diameter
};

// The width does not grow beyond the last diameter: more of a wider disc keeps its energy.
constexpr std::array<Release, 13> kReleases{{{0.0, 0.0},
                                             {0.2, 0.1998},
                                             {0.4, 0.3968},
                                             {0.5, 0.4913},
                                             {0.6, 0.5804},
                                             {0.7, 0.6617},
                                             {0.8, 0.7331},
                                             {0.9, 0.7924},
                                             {1.0, 0.8415},
                                             {1.2, 0.9064},
                                             {1.5, 0.9471},
                                             {1.7, 0.9542},
                                             {2.0, 0.9560}}};

/// On the straight line between two rows; `x` within them.
double between(double x, double x0, double x1, double y0, double y1) {
  return y0 + (y1 - y0) * (x - x0) / (x1 - x0);
}

}  // namespace

double borne_tension(const Material& material) {
  return failure_stress(material) + material.surface_compression;
}

double stored_energy(const Material& material, double thickness) {
  const double stress = material.surface_compression;
  return (1.0 - material.poisson) * stress * stress * thickness / (5.0 * material.young);
}

double released_share(double diameter) {
  if (!(diameter > 0.0)) return 1.0;
  for (std::size_t i = 1; i < kReleases.size(); ++i)
    if (diameter <= kReleases[i].diameter)
      return between(diameter, kReleases[i - 1].diameter, kReleases[i].diameter, kReleases[i - 1].width,
                     kReleases[i].width) /
             diameter;
  return kReleases.back().width / diameter;
}

double die_area(const Material& material, double thickness) {
  const double stored = stored_energy(material, thickness);
  if (!(stored > 0.0)) return 0.0;
  // A die d wide: stored * share(d / t) * A = branching * t * crack * sqrt(A), A = pi d^2 / 4.
  const double width =
      2.0 / core::sqrt(core::kPi) * kCrackToDie * kBranchingEnergy * material.fracture_energy / stored;
  for (std::size_t i = 1; i < kReleases.size(); ++i) {
    if (width > kReleases[i].width) continue;
    const double diameter = thickness * between(width, kReleases[i - 1].width, kReleases[i].width,
                                                kReleases[i - 1].diameter, kReleases[i].diameter);
    return 0.25 * core::kPi * diameter * diameter;
  }
  return 0.0;
}

}  // namespace shatterbox::material
