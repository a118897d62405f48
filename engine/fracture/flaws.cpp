#include "engine/fracture/flaws.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/random.h"
#include "engine/core/stop.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kLinesPerSquare = 4.0;  // mean number of lines through one square of a family's grid
constexpr double kFlawsPerArea = 243.0;  // 3^5: up to three times the strength for m = 5
constexpr double kMostFlaws = 2e5;       // of one body

/// One family of parallel lines: they run along `axis` and pierce the grid of the other two.
struct LineFamily {
  int axis;
  double square;  // m, side of the grid's squares
  std::uint64_t seed;
};

/// A line: where it pierces the plane of its grid, and its number.
struct Line {
  Vec2 place;
  std::uint64_t key;
};

/// Poisson number with the mean kLinesPerSquare: multiply uniforms until their product falls below
/// exp(-mean).
int poisson(core::Random& random) {
  static const double limit = core::exp(-kLinesPerSquare);
  int count = 0;
  for (double product = random.uniform(); product > limit; product *= random.uniform()) ++count;
  return count;
}

void lines_of_square(const LineFamily& family, std::int64_t i, std::int64_t j, std::vector<Line>& lines) {
  lines.clear();
  const std::uint64_t square = core::mix(static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15ULL ^
                                         core::mix(static_cast<std::uint64_t>(j) + 0x632be59bd9b4e019ULL));
  core::Random random(family.seed, square ^ (static_cast<std::uint64_t>(family.axis) << 62));
  const int count = poisson(random);
  for (int n = 0; n < count; ++n) {
    const double x = random.uniform();
    const double y = random.uniform();
    const Vec2 place((static_cast<double>(i) + x) * family.square,
                     (static_cast<double>(j) + y) * family.square);
    lines.push_back({place, random.bits()});
  }
}

/// Adds the hits of one family on one triangle. A line through an edge counts for one side of it only
/// (half-open rule).
void pierce(const LineFamily& family, const geometry::ShellElements& elements, int element,
            std::vector<Line>& lines, std::vector<SurfacePoint>& points) {
  const geometry::Triangle& triangle = elements.mesh.triangles[at(element)];
  const int u = (family.axis + 1) % 3;
  const int v = (family.axis + 2) % 3;
  std::array<Vec2, 3> flat;
  for (Size i = 0; i < 3; ++i) {
    const Vec3& x = elements.mesh.positions[at(triangle[i])];
    flat[i] = {x[u], x[v]};
  }
  const Vec2 b = flat[1] - flat[0];
  const Vec2 c = flat[2] - flat[0];
  const double twice = b.x() * c.y() - b.y() * c.x();
  const Mat3 frame = facet_frame(elements, element);
  const Vec3 normal = frame.col(2);
  if (std::abs(normal[family.axis]) < 1e-12) return;  // seen edge on: never hit
  const double share = 1.0 / normal.cwiseAbs().sum();
  const Vec2 low = flat[0].cwiseMin(flat[1]).cwiseMin(flat[2]) / family.square;
  const Vec2 high = flat[0].cwiseMax(flat[1]).cwiseMax(flat[2]) / family.square;
  for (auto i = static_cast<std::int64_t>(std::floor(low.x()));
       i <= static_cast<std::int64_t>(std::floor(high.x())); ++i) {
    core::stop_if_asked();
    for (auto j = static_cast<std::int64_t>(std::floor(low.y()));
         j <= static_cast<std::int64_t>(std::floor(high.y())); ++j) {
      lines_of_square(family, i, j, lines);
      for (const Line& line : lines) {
        const Vec2 p = line.place - flat[0];
        const Vec2 barycentric((p.x() * c.y() - p.y() * c.x()) / twice,
                               (b.x() * p.y() - b.y() * p.x()) / twice);
        if (barycentric.x() < 0.0 || barycentric.y() < 0.0 || barycentric.sum() >= 1.0) continue;
        // The two sheets of a closed body that a line pierces are told apart by the way they face.
        const std::uint64_t key = core::mix(line.key + (normal[family.axis] > 0.0 ? 1 : 2));
        if (core::Random(key, 1).uniform() < share) points.push_back({element, barycentric, key});
      }
    }
  }
}

}  // namespace

std::vector<SurfacePoint> scatter_on_surface(const geometry::ShellElements& elements, double density,
                                             std::uint64_t seed) {
  std::vector<SurfacePoint> points;
  if (!(density > 0.0)) return points;
  const double square = core::sqrt(kLinesPerSquare / density);
  std::vector<Line> lines;
  for (Size t = 0; t < elements.mesh.triangles.size(); ++t) {
    const int element = static_cast<int>(t);
    const auto first = static_cast<std::ptrdiff_t>(points.size());
    if (!(element_area(elements, element) > 0.0)) continue;
    for (int axis = 0; axis < 3; ++axis) pierce({axis, square, seed}, elements, element, lines, points);
    std::sort(points.begin() + first, points.end(),
              [](const SurfacePoint& a, const SurfacePoint& b) { return a.key < b.key; });
  }
  return points;
}

FlawField draw_flaws(const geometry::ShellElements& elements, const material::Material& material,
                     std::uint64_t seed) {
  double area = 0.0;
  for (Size t = 0; t < elements.mesh.triangles.size(); ++t)
    area += element_area(elements, static_cast<int>(t));
  // The cap looks at the area rounded up to a power of two: a mesh a little finer must not get other flaws.
  double rounded = material.flaw_area;
  while (rounded < area) rounded *= 2.0;
  const double per_area = std::min(kFlawsPerArea, kMostFlaws * material.flaw_area / rounded);
  const double exponent = 1.0 / material.weibull_modulus;
  FlawField field;
  const double strength = material::failure_stress(material);
  field.greatest_strength = strength * core::pow(per_area, exponent);
  const std::vector<SurfacePoint> points = scatter_on_surface(elements, per_area / material.flaw_area, seed);
  field.flaws.reserve(points.size());
  for (const SurfacePoint& point : points) {
    core::Random random(point.key, 2);
    const double level =
        (random.uniform() + 0x1.0p-54) * per_area;  // flaws to a flaw_area that are weaker than this one
    field.flaws.push_back({point.element, point.barycentric, strength * core::pow(level, exponent)});
  }
  field.first_of_element.assign(elements.mesh.triangles.size() + 1, 0);
  for (const Flaw& flaw : field.flaws) ++field.first_of_element[at(flaw.element) + 1];
  for (Size t = 0; t < elements.mesh.triangles.size(); ++t) {
    field.first_of_element[t + 1] += field.first_of_element[t];
    std::sort(field.flaws.begin() + field.first_of_element[t],
              field.flaws.begin() + field.first_of_element[t + 1],
              [](const Flaw& a, const Flaw& b) { return a.strength < b.strength; });
  }
  return field;
}

}  // namespace shatterbox::fracture
