// What a body is made of, in SI units, and presets by name, each with its source.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/vec.h"

namespace shatterbox::material {

struct Material {
  std::string name = "glass";
  double density = 2500.0;       // kg/m3
  double young = 70e9;           // Young's modulus, Pa
  double poisson = 0.22;         // Poisson's ratio, in [0, 0.5)
  double strength = 50e6;        // tensile strength (mean flaw), Pa
  double fracture_energy = 8.0;  // energy of new crack area, J/m2
  double yield = 0.0;            // von Mises stress at which it flows, Pa; 0: it breaks and does not yield
  double elongation = 0.2;       // of what yields: plastic strain at which it tears, dimensionless
  double plasticity = 1.0;       // of what yields: dents are so many times as deep as energy says
  double surface_compression = 0.0;  // of sheets: stored in their faces, Pa; 0: annealed
  double weibull_modulus = 5.0;      // scatter of the flaws' strengths, dimensionless: larger is more even
  double flaw_area = 1e-2;           // area that holds one flaw below the strength on average, m2
  double crack_spacing = 0.5;   // how far cracks keep apart, share of the shielded length; smaller is finer
  double grain_size = 0.0;      // mean distance of grain seeds, m; 0: no grains
  double grain_strength = 0.6;  // strength of grain boundaries, share of the material's
  // In the body's own axes; its length, at least 1, tells how many times longer than across grains are along
  // it. Zero: they are alike in all directions.
  Vec3 grain_direction = Vec3::Zero();
  double friction = 0.5;          // Coulomb, dimensionless
  double rolling_friction = 0.0;  // m: radius of the patch that it rolls, and spins, on
  double restitution = 0.3;       // Newton, in [0, 1]
  double thickness = 1e-3;        // of shells, m
};

/// One preset: the material and where its numbers come from.
struct Preset {
  Material material;
  std::string_view source;
};

/// All presets in alphabetical order.
const std::vector<Preset>& presets();

/// The preset of that name, or nothing.
std::optional<Material> find_preset(std::string_view name);

/// Shear modulus, Pa.
double shear_modulus(const Material& material);

/// The stress (Pa) of a linear solve at which the material fails: its strength; of what yields the stress
/// whose energy density is that of flow at the yield strength as far as the elongation (equivalent strain
/// energy, [MG81]).
double failure_stress(const Material& material);

/// A sentence that says what is wrong with a material (a value outside its range, with the range), or
/// nothing.
std::optional<std::string> find_fault(const Material& material);

}  // namespace shatterbox::material
