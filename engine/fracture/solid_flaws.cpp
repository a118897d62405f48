#include "engine/fracture/solid_flaws.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/core/random.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kPointsPerCube = 4.0;     // mean number
constexpr double kFlawsPerVolume = 243.0;  // 3^5, as in a shell's area
constexpr double kMostSolidFlaws = 2e5;    // of one body

/// The points of one cube of a grid that fills space, the same whoever asks.
class SpacePoints {
 public:
  SpacePoints(double cube, std::uint64_t seed)
      : cube_(cube), seed_(seed), limit_(core::exp(-kPointsPerCube)) {}

  /// Calls visit(place, generator of more numbers for that point).
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
        place(axis) = (static_cast<double>(number[at(axis)]) + random.uniform()) * cube_;
      visit(place, core::Random(random.bits(), 2));
    }
  }

  double cube() const { return cube_; }

 private:
  double cube_;
  std::uint64_t seed_;
  double limit_;
};

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
  const SpacePoints points(core::pow(kPointsPerCube * flaw_volume / per_volume, 1.0 / 3.0), seed);

  std::vector<std::vector<SolidFlaw>> found(mesh.tetrahedra.size());
  core::parallel_for(mesh.tetrahedra.size(), 512, [&](Size t) {
    const geometry::Tetrahedron& tetrahedron = mesh.tetrahedra[t];
    Vec3 low = mesh.positions[at(tetrahedron[0])], high = low;
    for (const int v : tetrahedron) {
      low = low.cwiseMin(mesh.positions[at(v)]);
      high = high.cwiseMax(mesh.positions[at(v)]);
    }
    std::array<std::int64_t, 3> first{}, last{}, cube{};
    for (int axis = 0; axis < 3; ++axis) {
      first[at(axis)] = static_cast<std::int64_t>(std::floor(low(axis) / points.cube()));
      last[at(axis)] = static_cast<std::int64_t>(std::floor(high(axis) / points.cube()));
    }
    for (cube[0] = first[0]; cube[0] <= last[0]; ++cube[0])
      for (cube[1] = first[1]; cube[1] <= last[1]; ++cube[1])
        for (cube[2] = first[2]; cube[2] <= last[2]; ++cube[2])
          points.visit_cube(cube, [&](const Vec3& place, core::Random random) {
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
