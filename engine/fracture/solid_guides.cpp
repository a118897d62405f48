#include "engine/fracture/solid_guides.h"

#include <algorithm>

#include "engine/core/hash.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/fracture/path_noise.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kSolidWaveLength = 0.14;  // of the cracks' noise, share of the body's size

}  // namespace

std::shared_ptr<const CrackTurns> KeptCrackTurns::of(
    const std::shared_ptr<const geometry::SolidElements>& elements, double size, double waviness,
    std::uint64_t seed) {
  {
    const std::lock_guard lock(mutex_);
    if (turns_ && elements_ == elements && size_ == size && waviness_ == waviness && seed_ == seed)
      return turns_;
  }
  const PathNoise a(kSolidWaveLength * size, waviness, seed);
  const PathNoise b(kSolidWaveLength * size, waviness, core::mix(seed + 1));
  const geometry::TetMesh& mesh = elements->mesh;
  auto turns = std::make_shared<CrackTurns>(mesh.tetrahedra.size());
  core::parallel_for(turns->size(), 512, [&](Size e) {
    Vec3 middle = Vec3::Zero();
    for (const int v : mesh.tetrahedra[e]) middle += 0.25 * mesh.positions[at(v)];
    (*turns)[e] = {a.at(middle), b.at(middle)};
  });
  // Not while they are made: a loop that waits may take up other work that asks for the same ones.
  const std::lock_guard lock(mutex_);
  elements_ = elements;
  size_ = size;
  waviness_ = waviness;
  seed_ = seed;
  turns_ = std::move(turns);
  return turns_;
}

SolidGuides::SolidGuides(const geometry::SolidComplex& complex, const SolidGuideSetup& setup)
    : setup_(setup), mesh_(complex.elements->mesh) {
  cells_.reserve(complex.cells.size());
  for (const geometry::SolidPart& cell : complex.cells) cells_.push_back({cell.element, cell.volume});
}

/// Across the first principal stress; where the two greatest are alike, or little pulls, the crack is not
/// told where to go.
Mat3 SolidGuides::conduction(int element, const stress::SolidStress& stress) const {
  const stress::PrincipalAxes axes = stress::principal_axes(stress);
  if (!(axes.values(0) > 0.0)) return Mat3::Identity();
  const Vec3 across = axes.directions.col(0);
  int least = 0;
  across.cwiseAbs().minCoeff(&least);
  const Vec3 u = across.cross(Vec3::Unit(least)).normalized();
  const auto& [first, second] = (*setup_.turns)[at(element)];
  const Vec3 wavy = across + first * u + second * across.cross(u);
  const double anisotropy = std::clamp((axes.values(0) - axes.values(1)) / axes.values(0), 0.0, 1.0);
  const double pull = std::min(1.0, axes.values(0) / setup_.strength);
  return guide_conduction(wavy.normalized(), pull * anisotropy);
}

const CrackGuide& SolidGuides::of(int piece) {
  if (const auto known = guides_.find(piece); known != guides_.end()) return known->second;
  std::vector<int> own;  // cells, by element
  for (Size c = 0; c < cells_.size(); ++c)
    if ((*setup_.pieces)[c] == piece) own.push_back(static_cast<int>(c));
  std::stable_sort(own.begin(), own.end(),
                   [&](int a, int b) { return cells_[at(a)].element < cells_[at(b)].element; });
  std::vector<GuideElement> elements;
  std::vector<stress::SolidStress> stresses;  // times volume
  for (const int c : own) {
    const Cell& cell = cells_[at(c)];
    if (elements.empty() || elements.back().element != cell.element) {
      elements.push_back({cell.element, 0.0, Mat3::Identity()});
      stresses.push_back(stress::SolidStress::Zero());
    }
    elements.back().volume += cell.volume;
    stresses.back() += cell.volume * (*setup_.stresses)[at(c)];
  }
  core::parallel_for(elements.size(), 1024, [&](Size e) {
    if (elements[e].volume > 0.0)
      elements[e].conduction = conduction(elements[e].element, stresses[e] / elements[e].volume);
  });
  return guides_.try_emplace(piece, mesh_, std::move(elements), *setup_.trees).first->second;
}

}  // namespace shatterbox::fracture
