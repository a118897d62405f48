// What the tests of solves share: a material, loads, supports, differences.
#pragma once

#include <catch2/catch.hpp>

#include "engine/core/index.h"
#include "engine/stress/shell_load.h"
#include "engine/stress/shell_stress.h"
#include "engine/stress/shell_system.h"
#include "sandbox/study/shell_models.h"

namespace shatterbox::stress::testing {

using namespace sandbox::study::model;

inline Vec3 stress_norms(const std::vector<CellStress>& a, const std::vector<CellStress>& b) {
  double difference = 0.0, size = 0.0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    difference += (a[c].membrane - b[c].membrane).squaredNorm() + (a[c].bending - b[c].bending).squaredNorm();
    size += b[c].membrane.squaredNorm() + b[c].bending.squaredNorm();
  }
  return {core::sqrt(difference / size), core::sqrt(size), 0.0};
}

}  // namespace shatterbox::stress::testing
