// Points scattered through all of space from a seed: which are in one cube of a grid does not depend on who
// asks, so they are the same for every mesh.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "engine/core/random.h"
#include "engine/core/vec.h"

namespace shatterbox::fracture {

class SpacePoints {
 public:
  static constexpr double kPointsPerCube = 4.0;  // mean number; which there are is drawn by Poisson's law

  SpacePoints(double cube, std::uint64_t seed)
      : cube_(cube), seed_(seed), limit_(core::exp(-kPointsPerCube)) {}

  /// Calls visit(place, generator of more numbers for that point) for all in the cubes that a box touches.
  template <class Visit>
  void visit_box(const Vec3& low, const Vec3& high, const Visit& visit) const {
    std::array<std::int64_t, 3> first{}, last{}, cube{};
    for (int axis = 0; axis < 3; ++axis) {
      first[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(low(axis) / cube_));
      last[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(high(axis) / cube_));
    }
    for (cube[0] = first[0]; cube[0] <= last[0]; ++cube[0])
      for (cube[1] = first[1]; cube[1] <= last[1]; ++cube[1])
        for (cube[2] = first[2]; cube[2] <= last[2]; ++cube[2]) visit_cube(cube, visit);
  }

 private:
  template <class Visit>
  void visit_cube(const std::array<std::int64_t, 3>& number, const Visit& visit) const {
    std::uint64_t key = 0x736f6c6964ULL;
    for (const std::int64_t n : number)
      key = core::mix(key ^ (static_cast<std::uint64_t>(n) * 0x9e3779b97f4a7c15ULL));
    core::Random random(seed_, key);
    // Poisson: uniforms are multiplied until their product falls below exp(-mean).
    int count = 0;
    for (double product = random.uniform(); product > limit_; product *= random.uniform()) ++count;
    for (int i = 0; i < count; ++i) {
      Vec3 place;
      for (int axis = 0; axis < 3; ++axis)
        place(axis) =
            (static_cast<double>(number[static_cast<std::size_t>(axis)]) + random.uniform()) * cube_;
      visit(place, core::Random(random.bits(), 2));
    }
  }

  double cube_;  // m
  std::uint64_t seed_;
  double limit_;
};

}  // namespace shatterbox::fracture
