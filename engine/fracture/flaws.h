// Weak points of a shell's surface, and what strength they leave: the Weibull law as points in material
// space. They come from the seed and the surface, not from its triangles: a finer mesh of the same surface
// has the same flaws.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/shell_mesh.h"
#include "engine/material/material.h"

namespace shatterbox::fracture {

/// A point of the mid-surface that fails at `strength` or above.
struct Flaw {
  int element = 0;
  Vec2 barycentric = Vec2::Zero();  // weights of the element's corners 1 and 2
  double strength = 0.0;            // Pa
};

/// Flaws by element; shared by all pieces of one parent.
struct FlawField {
  std::vector<Flaw> flaws;            // ascending by element, then by strength
  std::vector<int> first_of_element;  // |T| + 1
  double greatest_strength = 0.0;     // Pa: no flaw is stronger; sound material counts as this strong

  std::span<const Flaw> of_element(int element) const {
    const auto begin = static_cast<std::size_t>(first_of_element[static_cast<std::size_t>(element)]);
    const auto end = static_cast<std::size_t>(first_of_element[static_cast<std::size_t>(element) + 1]);
    return {flaws.data() + begin, end - begin};
  }
};

/// Points on a surface, uniform by area, that depend on the surface and not on its triangles.
struct SurfacePoint {
  int element = 0;
  Vec2 barycentric = Vec2::Zero();
  std::uint64_t key =
      0;  // of the point: the same under refinement; for more random numbers that belong to it
};

/// A Poisson process of `density` points a square metre on the surface. Three families of lines, one along
/// each axis and fixed in space by the seed, pierce it; a hit counts with probability 1 / (|n_x| + |n_y| +
/// |n_z|), which makes the expected number a constant density whatever way the surface faces. Ascending by
/// element, then by key.
std::vector<SurfacePoint> scatter_on_surface(const geometry::ShellElements& elements, double density,
                                             std::uint64_t seed);

/// Flaws with (s / strength)^m / flaw_area of them below strength s in a square metre, m = weibull_modulus,
/// up to 3 strength for m = 5 (243 flaws to a flaw_area for every m); fewer on bodies where that is more than
/// 200 000.
FlawField draw_flaws(const geometry::ShellElements& elements, const material::Material& material,
                     std::uint64_t seed);

}  // namespace shatterbox::fracture
