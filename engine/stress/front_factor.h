// Numeric part of the multifrontal Cholesky factorisation: dense fronts in tiles of four rows, every sum in a
// fixed order whatever the address of the data or the number of threads, so that the same matrix gives the
// same bits.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "engine/core/bytes.h"
#include "engine/core/vec.h"
#include "engine/stress/front_tree.h"

namespace shatterbox::stress {

/// The lower triangle of an element's matrix, column after column, and a factor. Unknowns: node after node,
/// as many of each as the graph's `element_unknowns` (of a shell's element 12).
struct ElementEntries {
  const double* lower = nullptr;
  double factor = 1.0;
};

class FrontFactor {
 public:
  /// Factors sum of elements + diag(diagonal). `diagonal`: one entry an unknown, in order of elimination.
  /// `element(e)` gives the entries of element e and may be called from several threads. None if a pivot is
  /// not positive.
  static std::optional<FrontFactor> make(const FrontTree& tree, const std::vector<double>& diagonal,
                                         const std::function<ElementEntries(int element)>& element);

  /// A front's panel: strips of four rows, pivot rows then rows below (front_tiles.h); the diagonal is
  /// inverted.
  const double* panel(std::size_t front) const { return panels_[front]; }

  double bytes() const { return static_cast<double>(sizeof(double) * size_) + core::bytes_in(panels_); }

 private:
  std::size_t size_ = 0;                           // doubles in all panels
  std::vector<double*> panels_;                    // begin of each front's, in blocks_
  std::vector<std::unique_ptr<double[]>> blocks_;  // some panels each
};

}  // namespace shatterbox::stress
