// The guides of one generation of cracks in a solid (crack_guide.h): one a piece, made when its first crack
// asks, from the stresses and the material that its cells had when the generation began.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "engine/core/vec.h"
#include "engine/fracture/crack_guide.h"
#include "engine/geometry/solid_complex.h"
#include "engine/stress/solid_stress.h"

namespace shatterbox::fracture {

/// rad, by element: by how much cracks bend from the planes of the stress, about two axes.
using CrackTurns = std::vector<std::array<double, 2>>;

/// The turns of a body's elements, found when they are first asked for and kept for its pieces: sums of waves
/// are slow.
class KeptCrackTurns {
 public:
  /// Of noise of that `waviness` (rad) and of waves that are a share of `size` (m) long. Any thread.
  std::shared_ptr<const CrackTurns> of(const std::shared_ptr<const geometry::SolidElements>& elements,
                                       double size, double waviness, std::uint64_t seed);

 private:
  std::mutex mutex_;
  std::shared_ptr<const geometry::SolidElements> elements_;
  double size_ = 0.0, waviness_ = 0.0;
  std::uint64_t seed_ = 0;
  std::shared_ptr<const CrackTurns> turns_;
};

/// All that is pointed to must outlive the guides.
struct SolidGuideSetup {
  const std::vector<stress::SolidStress>* stresses = nullptr;  // |cells|, Pa
  const std::vector<int>* pieces = nullptr;                    // |cells|: that each is in
  const CrackTurns* turns = nullptr;                           // |elements|
  GuideTrees* trees = nullptr;                                 // of the elements' mesh
  double strength = 0.0;                                       // Pa: what a sure stress pulls with
};

class SolidGuides {
 public:
  /// Of the complex as it is now; the mesh of its elements must outlive the guides.
  SolidGuides(const geometry::SolidComplex& complex, const SolidGuideSetup& setup);

  const CrackGuide& of(int piece);

 private:
  struct Cell {
    int element = 0;
    double volume = 0.0;
  };
  Mat3 conduction(int element, const stress::SolidStress& stress) const;

  SolidGuideSetup setup_;
  const geometry::TetMesh& mesh_;
  std::vector<Cell> cells_;
  std::map<int, CrackGuide> guides_;  // by piece
};

}  // namespace shatterbox::fracture
