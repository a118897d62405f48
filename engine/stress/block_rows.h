// A symmetric sparse matrix of 3 x 3 blocks, a row a vertex, all of its blocks stored: the stiffness of a
// solid, made from its cells, and products with it of one or four vectors side by side.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/stress/solid_stiffness.h"

namespace shatterbox::stress {

struct BlockRows {
  std::vector<int> first;       // |V| + 1: where each row's blocks begin; the first one is on the diagonal
  std::vector<int> column;      // |blocks|
  std::vector<double> entries;  // |blocks| x 9, row after row

  std::size_t size() const { return first.size() - 1; }
};

inline constexpr std::size_t kRowGrain = 512;  // rows to a task; fixed, so that sums have one order

/// K of the mesh in units of the solid (|virtual vertices| rows; empty for vertices in no cell). Blocks (i,
/// j) and (j, i) are each other's transpose to the bit.
BlockRows assemble_stiffness(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh);

/// product = rows [begin, end) times x; `entries` are those of the rows, maybe in single precision. Vectors
/// of lanes: entry 3 v + axis of lane l is at (3 v + axis) kLanes + l.
template <std::size_t kLanes, class Scalar>
void multiply_rows(const BlockRows& rows, const Scalar* entries, std::size_t begin, std::size_t end,
                   const Scalar* x, Scalar* product) {
  for (std::size_t row = begin; row < end; ++row) {
    Scalar sum[3][kLanes] = {};
    const auto last = static_cast<std::size_t>(rows.first[row + 1]);
    for (auto block = static_cast<std::size_t>(rows.first[row]); block < last; ++block) {
      const Scalar* const e = entries + 9 * block;
      const Scalar* const u = x + 3 * kLanes * static_cast<std::size_t>(rows.column[block]);
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t l = 0; l < kLanes; ++l)
          sum[a][l] += (e[3 * a] * u[l] + e[3 * a + 1] * u[kLanes + l]) + e[3 * a + 2] * u[2 * kLanes + l];
    }
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t l = 0; l < kLanes; ++l) product[(3 * row + a) * kLanes + l] = sum[a][l];
  }
}

}  // namespace shatterbox::stress
