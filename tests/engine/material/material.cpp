#include "engine/material/material.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

namespace shatterbox::material {

TEST_CASE("presets are sound, sorted, sourced and found by name") {
  REQUIRE(presets().size() >= 6);
  for (std::size_t i = 0; i < presets().size(); ++i) {
    const Preset& preset = presets()[i];
    INFO(preset.material.name);
    CHECK(find_fault(preset.material).value_or("") == "");
    CHECK(preset.source.size() > 40);
    if (i > 0) CHECK(presets()[i - 1].material.name < preset.material.name);
    REQUIRE(find_preset(preset.material.name));
    CHECK(find_preset(preset.material.name)->density == preset.material.density);
  }
  CHECK_FALSE(find_preset("unobtainium"));
  for (const char* name : {"aluminium", "brick", "ceramic", "concrete", "eggshell", "glass", "ice", "plaster",
                           "porcelain", "steel", "terracotta"})
    CHECK(find_preset(name));
}

TEST_CASE("each preset says where its density stiffness and strength come from, by works that are listed") {
  std::ifstream file(SHATTERBOX_SOURCE_DIR "/engine/references.md");
  const std::string listed((std::istreambuf_iterator<char>(file)), {});
  REQUIRE_FALSE(listed.empty());
  const auto speaks_of = [](const std::string& text, std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(),
                       [&](const char* word) { return text.find(word) != std::string::npos; });
  };
  for (const Preset& preset : presets()) {
    INFO(preset.material.name << ": " << preset.source);
    const std::string source(preset.source);
    // What is as another is has that one's.
    if (!speaks_of(source, {"as glass", "As glass"})) {
      CHECK(speaks_of(source, {"density"}));
      CHECK(speaks_of(source, {" E ", " E,", "E of", ": E "}));
      CHECK(speaks_of(source, {"strength"}));
      CHECK(speaks_of(source, {"K_Ic", "fracture energy"}));
      CHECK(speaks_of(source, {"GPa", "MPa", "J/m2"}));
    }
    for (std::size_t at = source.find('['); at != std::string::npos; at = source.find('[', at + 1)) {
      const std::string key = source.substr(at, source.find(']', at) - at + 1);
      CHECK(listed.find("| " + key + " |") != std::string::npos);
    }
  }
}

TEST_CASE("the fracture energy of brittle presets is that of a known toughness") {
  // Plane strain: K_Ic = sqrt(E G_c / (1 - nu^2)), MPa sqrt(m).
  const auto toughness = [](const char* name) {
    const Material m = *find_preset(name);
    return std::sqrt(m.young * m.fracture_energy / (1.0 - m.poisson * m.poisson)) * 1e-6;
  };
  CHECK(toughness("glass") == Approx(0.75).epsilon(0.05));
  CHECK(toughness("porcelain") == Approx(1.3).epsilon(0.05));
  CHECK(toughness("ceramic") == Approx(1.25).epsilon(0.05));
  CHECK(toughness("aluminium") == Approx(29.0).epsilon(0.05));
  CHECK(toughness("brick") == Approx(0.8).epsilon(0.05));
  CHECK(toughness("ice") == Approx(0.1).epsilon(0.05));
  CHECK(toughness("plaster") == Approx(0.15).epsilon(0.05));
  CHECK(toughness("terracotta") == Approx(0.6).epsilon(0.05));
}

TEST_CASE("every value outside its range is told with the range") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  struct Wrong {
    double Material::*value;
    const char* name;
    double wrong;
  };
  for (const Wrong& w :
       {Wrong{&Material::density, "density", 0.0}, Wrong{&Material::density, "density", nan},
        Wrong{&Material::young, "young", -1.0}, Wrong{&Material::young, "young", infinite},
        Wrong{&Material::poisson, "poisson", 0.5}, Wrong{&Material::poisson, "poisson", -0.1},
        Wrong{&Material::strength, "strength", 0.0},
        Wrong{&Material::fracture_energy, "fracture_energy", 0.0},
        Wrong{&Material::weibull_modulus, "weibull_modulus", 0.5},
        Wrong{&Material::flaw_area, "flaw_area", 0.0}, Wrong{&Material::crack_spacing, "crack_spacing", -1.0},
        Wrong{&Material::grain_size, "grain_size", -1.0},
        Wrong{&Material::grain_strength, "grain_strength", 1.5}, Wrong{&Material::friction, "friction", -0.1},
        Wrong{&Material::rolling_friction, "rolling_friction", nan},
        Wrong{&Material::restitution, "restitution", 1.01}, Wrong{&Material::thickness, "thickness", 0.0}}) {
    Material material;
    CHECK_FALSE(find_fault(material));
    material.*w.value = w.wrong;
    const auto fault = find_fault(material);
    REQUIRE(fault);
    INFO(*fault);
    CHECK(fault->find(w.name) == 0);
    CHECK(fault->find("must be") != std::string::npos);
  }
}

}  // namespace shatterbox::material
