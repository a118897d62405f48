// Numbered points by cubes of space: who is near a place.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "engine/core/vec.h"

namespace shatterbox::fracture {

class PointCubes {
 public:
  using Cube = std::array<int, 3>;

  explicit PointCubes(double size) : size_(size) {}

  void add(const Vec3& x, int number) { cubes_[cube_of(x)].push_back(number); }

  Cube cube_of(const Vec3& x) const { return {floor_of(x.x()), floor_of(x.y()), floor_of(x.z())}; }

  /// Calls visit(numbers) for what is in the cube and those about it, which are all within its size of any
  /// point in it; ends when it returns false.
  template <class Visit>
  void visit_about(const Cube& middle, const Visit& visit) const {
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k) {
          const auto found = cubes_.find({middle[0] + i, middle[1] + j, middle[2] + k});
          if (found != cubes_.end() && !visit(found->second)) return;
        }
  }

 private:
  int floor_of(double x) const { return static_cast<int>(std::floor(x / size_)); }

  double size_;  // m
  std::map<Cube, std::vector<int>> cubes_;
};

}  // namespace shatterbox::fracture
