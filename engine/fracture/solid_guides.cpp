#include "engine/fracture/solid_guides.h"

#include <algorithm>

#include "engine/core/index.h"
#include "engine/core/parallel.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

}  // namespace

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
