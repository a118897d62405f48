// How grain seeds are chosen from darts: one after the other, each not too near to those before it.
#pragma once

#include <vector>

#include "engine/core/vec.h"
#include "engine/fracture/point_cubes.h"

namespace shatterbox::fracture {

inline constexpr double kDartsPerSeed = 8.0;        // thrown for every seed that is wanted
inline constexpr double kLeastSeedSpacing = 0.7;    // share of the spacing
inline constexpr double kSeedWeightScatter = 0.15;  // about one

class SeedSpacing {
 public:
  /// `least`: m, after squeezing (see grain_squeeze).
  SeedSpacing(double least, const Mat3& squeeze) : least_(least), squeeze_(squeeze), cubes_(least) {}

  /// True if no place that was taken is nearer than the least spacing; then this one is taken.
  bool take(const Vec3& place) {
    const Vec3 x = squeeze_ * place;
    bool is_free = true;
    cubes_.visit_about(cubes_.cube_of(x), [&](const std::vector<int>& numbers) {
      for (const int n : numbers)
        is_free = is_free && (taken_[static_cast<std::size_t>(n)] - x).squaredNorm() >= least_ * least_;
      return is_free;
    });
    if (!is_free) return false;
    cubes_.add(x, static_cast<int>(taken_.size()));
    taken_.push_back(x);
    return true;
  }

 private:
  double least_;
  Mat3 squeeze_;
  PointCubes cubes_;
  std::vector<Vec3> taken_;  // squeezed
};

}  // namespace shatterbox::fracture
