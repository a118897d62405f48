#include "engine/material/material.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "engine/core/elementary.h"

namespace shatterbox::material {
namespace {

// Elastic constants, densities and fracture toughnesses are handbook values. Of the rest: `fracture_energy`
// is (1 - nu^2) K_Ic^2 / E unless said; `friction` and `restitution` are mid-range for dry, clean pairs;
// `flaw_area`, `crack_spacing` and the grains were chosen by eye on whole breaks, within what the strengths'
// known scatter allows.
std::vector<Preset> make_presets() {
  Material aluminium;
  aluminium.name = "aluminium";
  aluminium.density = 2700.0;
  aluminium.young = 70e9;
  aluminium.poisson = 0.33;
  aluminium.strength = 290e6;
  aluminium.fracture_energy = 1.1e4;
  aluminium.yield = 250e6;
  aluminium.elongation = 0.08;
  aluminium.weibull_modulus = 40.0;
  aluminium.flaw_area = 1e-2;
  aluminium.friction = 0.4;
  aluminium.restitution = 0.5;
  aluminium.thickness = 2e-3;

  Material brick;
  brick.name = "brick";
  brick.density = 1900.0;
  brick.young = 12e9;
  brick.poisson = 0.2;
  brick.strength = 4e6;
  brick.fracture_energy = 50.0;
  brick.weibull_modulus = 8.0;
  brick.flaw_area = 1e-2;
  brick.friction = 0.7;
  brick.restitution = 0.2;
  brick.thickness = 20e-3;

  Material ceramic;
  ceramic.name = "ceramic";
  ceramic.density = 2400.0;
  ceramic.young = 60e9;
  ceramic.poisson = 0.2;
  ceramic.strength = 45e6;
  ceramic.fracture_energy = 25.0;
  ceramic.weibull_modulus = 10.0;
  ceramic.flaw_area = 1e-3;
  ceramic.crack_spacing = 1.5;  // by eye: pots break into few large pieces
  ceramic.friction = 0.5;
  ceramic.restitution = 0.35;
  ceramic.thickness = 4e-3;

  Material concrete;
  concrete.name = "concrete";
  concrete.density = 2400.0;
  concrete.young = 33e9;
  concrete.poisson = 0.2;
  concrete.strength = 2.9e6;
  concrete.fracture_energy = 140.0;
  concrete.weibull_modulus = 12.0;
  concrete.flaw_area = 1e-2;
  concrete.friction = 0.7;
  concrete.restitution = 0.2;
  concrete.thickness = 50e-3;

  Material eggshell;
  eggshell.name = "eggshell";
  eggshell.density = 2240.0;
  eggshell.young = 30e9;
  eggshell.poisson = 0.3;
  eggshell.strength = 20e6;
  eggshell.fracture_energy = 10.0;
  eggshell.weibull_modulus = 5.0;
  eggshell.flaw_area = 1e-4;
  eggshell.grain_size = 4e-3;
  eggshell.grain_strength = 0.7;
  eggshell.friction = 0.5;
  eggshell.restitution = 0.3;
  eggshell.thickness = 0.35e-3;

  Material glass;
  glass.name = "glass";
  glass.density = 2500.0;
  glass.young = 70e9;
  glass.poisson = 0.22;
  glass.strength = 50e6;
  glass.fracture_energy = 8.0;
  glass.weibull_modulus = 5.0;
  glass.flaw_area = 1e-2;
  glass.friction = 0.4;
  glass.restitution = 0.5;
  glass.thickness = 4e-3;

  Material ice;
  ice.name = "ice";
  ice.density = 917.0;
  ice.young = 9.3e9;
  ice.poisson = 0.33;
  ice.strength = 1.2e6;
  ice.fracture_energy = 1.0;
  ice.weibull_modulus = 5.0;
  ice.flaw_area = 1e-2;
  ice.friction = 0.05;
  ice.restitution = 0.3;
  ice.thickness = 10e-3;

  Material ornament_glass = glass;
  ornament_glass.name = "ornament_glass";
  ornament_glass.flaw_area = 1e-3;
  ornament_glass.crack_spacing = 0.4;
  ornament_glass.thickness = 0.5e-3;

  Material plaster;
  plaster.name = "plaster";
  plaster.density = 1150.0;
  plaster.young = 4.5e9;
  plaster.poisson = 0.2;
  plaster.strength = 2.5e6;
  plaster.fracture_energy = 5.0;
  plaster.weibull_modulus = 8.0;
  plaster.flaw_area = 1e-3;
  plaster.friction = 0.6;
  plaster.restitution = 0.2;
  plaster.thickness = 5e-3;

  Material porcelain;
  porcelain.name = "porcelain";
  porcelain.density = 2400.0;
  porcelain.young = 70e9;
  porcelain.poisson = 0.2;
  porcelain.strength = 70e6;
  porcelain.fracture_energy = 23.0;
  porcelain.weibull_modulus = 12.0;
  porcelain.flaw_area = 1e-3;
  porcelain.friction = 0.4;
  porcelain.restitution = 0.45;
  porcelain.thickness = 3e-3;

  Material steel;
  steel.name = "steel";
  steel.density = 7850.0;
  steel.young = 210e9;
  steel.poisson = 0.3;
  steel.strength = 360e6;
  steel.fracture_energy = 2e5;
  steel.yield = 235e6;
  steel.elongation = 0.26;
  steel.weibull_modulus = 40.0;
  steel.flaw_area = 1e-2;
  steel.friction = 0.4;
  steel.restitution = 0.6;
  steel.thickness = 2e-3;

  Material tempered_glass = glass;
  tempered_glass.name = "tempered_glass";
  tempered_glass.surface_compression = 100e6;
  tempered_glass.thickness = 6e-3;

  Material terracotta;
  terracotta.name = "terracotta";
  terracotta.density = 1900.0;
  terracotta.young = 20e9;
  terracotta.poisson = 0.2;
  terracotta.strength = 12e6;
  terracotta.fracture_energy = 17.0;
  terracotta.weibull_modulus = 10.0;
  terracotta.flaw_area = 1e-3;
  terracotta.crack_spacing = 1.5;
  terracotta.friction = 0.6;
  terracotta.restitution = 0.25;
  terracotta.thickness = 6e-3;

  return {
      {aluminium,
       "Aluminium alloy EN AW-6082 T6: density, E, nu, tensile strength 290 MPa, proof strength 250 MPa and "
       "elongation 8 % by [EN1999] (extruded, up to 5 mm); K_Ic near 29 MPa sqrt(m)"},
      {brick,
       "Fired clay brick: density 1600 to 2000 kg/m3, bending strength 3 to 6 MPa, E 5 to 20 GPa as commonly "
       "reported for clay bricks, here mid-range; K_Ic near 0.8 MPa sqrt(m); Weibull modulus and flaw_area "
       "estimated"},
      {ceramic,
       "Glazed stoneware: density, E, nu and bending strength mid-range of tableware stoneware [ASM4], K_Ic "
       "near "
       "1.25 MPa sqrt(m) as of porcelain-like bodies; Weibull modulus 10 usual for traditional ceramics; "
       "flaw_area, "
       "crack_spacing estimated"},
      {concrete,
       "Concrete C30/37: density usual for normal weight, E 33 GPa, mean tensile strength 2.9 MPa, nu 0.2 by "
       "[EN1992]; fracture energy 73 "
       "f_cm^0.18 "
       "J/m2, f_cm 38 MPa, by [MC2010]; Weibull modulus and flaw_area estimated"},
      {eggshell,
       "Hen's egg: all estimated within what is commonly reported for hens' eggs: density of calcite less "
       "its "
       "pores, thickness 0.3 to 0.4 mm, E of tens of GPa, strength 10 to 40 MPa; fracture energy, Weibull "
       "modulus "
       "and grains by eye"},
      {glass,
       "Soda-lime float glass: density, E, nu by [EN572] (rounded: nu 0.2 there, 0.22 measured); K_Ic 0.75 "
       "MPa "
       "sqrt(m) [Law93]; strength of the order of the 45 MPa characteristic value of [EN572], for short "
       "loads; "
       "Weibull modulus 5 for weathered glass; flaw_area, crack_spacing fitted by eye"},
      {ice,
       "Freshwater ice near -10 C: density, E 9.3 GPa, nu 0.33, tensile strength 0.7 to 3.1 MPa, K_Ic near "
       "0.1 MPa "
       "sqrt(m) by [Pet03]; Weibull modulus and flaw_area estimated"},
      {ornament_glass,
       "As glass, without grains; blown, 0.3 to 0.8 mm thick; flaw_area a tenth of a pane's and "
       "crack_spacing "
       "estimated by eye"},
      {plaster,
       "Cast gypsum plaster, dry: density, E of some GPa and tensile strength 2 to 3 MPa as commonly "
       "reported at a "
       "water to plaster ratio near 0.7; K_Ic near 0.15 MPa sqrt(m); Weibull modulus and flaw_area "
       "estimated"},
      {porcelain,
       "Hard glazed porcelain, unpressed: density, E, bending strength by [IEC672] group C 110/120 (at least "
       "2200 to "
       "2300 kg/m3, 60 GPa and 50 to 90 MPa); K_Ic near 1.3 MPa sqrt(m); flaw_area, crack_spacing estimated"},
      {steel,
       "Structural steel S235: density, E, nu, tensile strength 360 MPa and yield strength 235 MPa by "
       "[EN1993], "
       "elongation 26 % by [EN10025]; fracture energy of the order of what tearing of mild steel takes, 100 "
       "to 300 kJ/m2"},
      {tempered_glass,
       "Thermally toughened float glass: as glass; 100 MPa of compression at the faces: [C1048] asks for at "
       "least 69, the 120 MPa characteristic bending strength of [EN12150] over the 45 of annealed glass for "
       "75"},
      {terracotta,
       "Unglazed earthenware: density, E and bending strength 10 to 15 MPa as commonly reported for "
       "terracotta, K_Ic "
       "near 0.6 MPa sqrt(m); Weibull modulus as of other clay ceramics; flaw_area, crack_spacing as of "
       "ceramic"},
  };
}

constexpr double kLongestGrain = 100.0;  // times its width

struct Range {
  const char* name;
  double Material::*value;
  double least;
  double most;
  bool includes_least;
  const char* unit;
};

constexpr Range kRanges[] = {
    {"density", &Material::density, 0.0, 1e6, false, " kg/m3"},
    {"young", &Material::young, 0.0, 1e15, false, " Pa"},
    {"poisson", &Material::poisson, 0.0, 0.4999, true, ""},
    {"strength", &Material::strength, 0.0, 1e15, false, " Pa"},
    {"fracture_energy", &Material::fracture_energy, 0.0, 1e12, false, " J/m2"},
    {"yield", &Material::yield, 0.0, 1e15, true, " Pa"},
    {"elongation", &Material::elongation, 0.0, 10.0, false, ""},
    {"plasticity", &Material::plasticity, 0.0, 100.0, true, ""},
    {"surface_compression", &Material::surface_compression, 0.0, 1e12, true, " Pa"},
    {"weibull_modulus", &Material::weibull_modulus, 1.0, 1000.0, true, ""},
    {"flaw_area", &Material::flaw_area, 0.0, 1e12, false, " m2"},
    {"crack_spacing", &Material::crack_spacing, 0.0, 10.0, true, ""},
    {"grain_size", &Material::grain_size, 0.0, 1e9, true, " m"},
    {"grain_strength", &Material::grain_strength, 0.0, 1.0, false, ""},
    {"friction", &Material::friction, 0.0, 100.0, true, ""},
    {"rolling_friction", &Material::rolling_friction, 0.0, 1e9, true, " m"},
    {"restitution", &Material::restitution, 0.0, 1.0, true, ""},
    {"thickness", &Material::thickness, 0.0, 1e9, false, " m"},
};

}  // namespace

const std::vector<Preset>& presets() {
  static const std::vector<Preset> list = make_presets();
  return list;
}

std::optional<Material> find_preset(std::string_view name) {
  for (const Preset& preset : presets())
    if (preset.material.name == name) return preset.material;
  return std::nullopt;
}

double shear_modulus(const Material& material) {
  return 0.5 * material.young / (1.0 + material.poisson);
}

double failure_stress(const Material& material) {
  if (!(material.yield > 0.0)) return material.strength;
  const double excess = 6.0 * shear_modulus(material) * material.elongation / material.yield;
  return std::max(material.strength, material.yield * core::sqrt(1.0 + excess));
}

std::optional<std::string> find_fault(const Material& material) {
  for (const Range& range : kRanges) {
    const double value = material.*range.value;
    // Finite first: comparing a NaN traps.
    const bool is_above =
        std::isfinite(value) && (range.includes_least ? value >= range.least : value > range.least);
    if (is_above && value <= range.most) continue;
    std::ostringstream text;
    text << range.name << " of material \"" << material.name << "\" must be "
         << (range.includes_least ? "from " : "greater than ") << range.least
         << (range.includes_least ? " to " : " and at most ") << range.most << range.unit << " (it is "
         << value << ")";
    return text.str();
  }
  const double length = material.grain_direction.norm();
  if (std::isfinite(length) && (length == 0.0 || (length >= 1.0 - 1e-12 && length <= kLongestGrain)))
    return std::nullopt;
  std::ostringstream text;
  text << "grain_direction of material \"" << material.name << "\" must be zero or from 1 to "
       << kLongestGrain << " long, as many times as grains are longer along it than across (it is " << length
       << " long)";
  return text.str();
}

}  // namespace shatterbox::material
