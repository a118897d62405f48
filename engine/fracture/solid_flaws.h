// Weak points of a solid's material, and what strength they leave: the Weibull law as a Poisson process in
// material space. They come from the seed and the place, not from the elements.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/solid_mesh.h"
#include "engine/material/material.h"

namespace shatterbox::fracture {

struct SolidFlaw {
  int element = 0;
  Vec3 place = Vec3::Zero();  // m, material space
  double strength = 0.0;      // Pa
};

/// Flaws by element; shared by all pieces of one parent.
struct SolidFlawField {
  std::vector<SolidFlaw> flaws;       // ascending by element, then by strength
  std::vector<int> first_of_element;  // |T| + 1
  double greatest_strength = 0.0;     // Pa: no flaw is stronger; sound material counts as this strong

  std::span<const SolidFlaw> of_element(int element) const {
    const auto begin = static_cast<std::size_t>(first_of_element[static_cast<std::size_t>(element)]);
    const auto end = static_cast<std::size_t>(first_of_element[static_cast<std::size_t>(element) + 1]);
    return {flaws.data() + begin, end - begin};
  }
};

/// Flaws with (s / strength)^m / flaw_volume of them below strength s in a cubic metre, m = weibull_modulus
/// and flaw_volume = flaw_area^(3/2), up to 3 strength for m = 5 (243 flaws to a flaw_volume for every m);
/// fewer on bodies where that is more than 200 000.
SolidFlawField draw_solid_flaws(const geometry::SolidElements& elements, const material::Material& material,
                                std::uint64_t seed);

}  // namespace shatterbox::fracture
