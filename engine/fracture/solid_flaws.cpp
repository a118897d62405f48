#include "engine/fracture/solid_flaws.h"

#include <algorithm>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/fracture/space_points.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kFlawsPerVolume = 243.0;  // 3^5, as in a shell's area
constexpr double kMostSolidFlaws = 2e5;    // of one body

/// Whether a point is in a tetrahedron; of a common face one of the two has it, by the sign of its normal.
bool holds(const geometry::TetMesh& mesh, const geometry::Tetrahedron& t, const Vec3& p) {
  for (const auto& face : geometry::kTetrahedronFaces) {
    std::array<int, 3> v{t[at(face[0])], t[at(face[1])], t[at(face[2])]};
    // In the order of the numbers, so that both tetrahedra of a face compute the same volume.
    const bool is_odd = (v[0] > v[1]) != ((v[1] > v[2]) != (v[0] > v[2]));
    std::sort(v.begin(), v.end());
    const Vec3& a = mesh.positions[at(v[0])];
    const double volume = (mesh.positions[at(v[1])] - a).cross(mesh.positions[at(v[2])] - a).dot(p - a);
    if (is_odd ? volume < 0.0 : volume >= 0.0) return false;
  }
  return true;
}

}  // namespace

SolidFlawField draw_solid_flaws(const geometry::SolidElements& elements, const material::Material& material,
                                std::uint64_t seed) {
  const geometry::TetMesh& mesh = elements.mesh;
  SolidFlawField field;
  field.first_of_element.assign(mesh.tetrahedra.size() + 1, 0);
  const double volume = geometry::total_volume(mesh);
  const double flaw_volume = material.flaw_area * core::sqrt(material.flaw_area);
  const double exponent = 1.0 / material.weibull_modulus;
  const double per_volume =
      std::min(kFlawsPerVolume, kMostSolidFlaws * flaw_volume / std::max(volume, 1e-300));
  const double strength = material::failure_stress(material);
  field.greatest_strength = strength * core::pow(per_volume, exponent);
  if (!(per_volume > 0.0) || !(volume > 0.0)) return field;
  const SpacePoints points(core::pow(SpacePoints::kPointsPerCube * flaw_volume / per_volume, 1.0 / 3.0),
                           seed);

  std::vector<std::vector<SolidFlaw>> found(mesh.tetrahedra.size());
  core::parallel_for(mesh.tetrahedra.size(), 512, [&](Size t) {
    const geometry::Tetrahedron& tetrahedron = mesh.tetrahedra[t];
    Vec3 low = mesh.positions[at(tetrahedron[0])], high = low;
    for (const int v : tetrahedron) {
      low = low.cwiseMin(mesh.positions[at(v)]);
      high = high.cwiseMax(mesh.positions[at(v)]);
    }
    points.visit_box(low, high, [&](const Vec3& place, core::Random random) {
      if ((place - low).minCoeff() < 0.0 || (high - place).minCoeff() < 0.0) return;
      if (!holds(mesh, tetrahedron, place)) return;
      const double level = (random.uniform() + 0x1.0p-54) * per_volume;
      found[t].push_back({static_cast<int>(t), place, strength * core::pow(level, exponent)});
    });
    std::stable_sort(found[t].begin(), found[t].end(),
                     [](const SolidFlaw& a, const SolidFlaw& b) { return a.strength < b.strength; });
  });
  for (Size t = 0; t < found.size(); ++t) {
    field.flaws.insert(field.flaws.end(), found[t].begin(), found[t].end());
    field.first_of_element[t + 1] = static_cast<int>(field.flaws.size());
  }
  return field;
}

}  // namespace shatterbox::fracture
