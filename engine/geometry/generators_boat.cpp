// The hull of an open boat from stations along its length and lines along its sides.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "engine/core/elementary.h"
#include "engine/geometry/generator_faults.h"
#include "engine/geometry/generators.h"

namespace shatterbox::geometry {
namespace {

constexpr double kFineEnds = 0.6;  // share of the slender part in the plan; 0: a lens, 1: cusps at the ends
constexpr double kHollow = 0.6;    // how far sections go over to a V towards the ends
constexpr double kRocker = 0.12;   // rise of the keel towards the ends, share of the depth

std::optional<std::string> find_boat_fault(const BoatSizes& sizes) {
  if (auto fault = find_size_fault("a boat's length", sizes.length)) return fault;
  if (auto fault = find_size_fault("a boat's beam", sizes.beam)) return fault;
  if (auto fault = find_size_fault("a boat's depth", sizes.depth)) return fault;
  if (sizes.beam > sizes.length) return "a boat's beam must not be greater than its length";
  if (!(std::isfinite(sizes.sheer) && sizes.sheer >= 0.0 && sizes.sheer <= sizes.length))
    return "a boat's sheer must be from 0 m to its length";
  return std::nullopt;
}

/// The hull's point at station s in [-1, 1], from stern to bow, and v in [0, 1], from the keel to the gunwale
/// of starboard.
Vec3 hull_point(const BoatSizes& sizes, double s, double v) {
  const double inner = 1.0 - s * s;
  const double half_beam = 0.5 * sizes.beam * inner * (1.0 - kFineEnds + kFineEnds * inner);
  const double keel = kRocker * sizes.depth * s * s * s * s;
  const double gunwale = sizes.depth + sizes.sheer * s * s;
  // Sections: an ellipse amidships, more and more a V towards the ends.
  const double sharp = kHollow * s * s + (1.0 - kHollow) * s * s * s * s;
  const double breadth = (1.0 - sharp) * core::sin(0.5 * core::kPi * v) + sharp * v;
  const double height = (1.0 - sharp) * (1.0 - core::cos(0.5 * core::kPi * v)) + sharp * v;
  // The stems lean out: the lower, the shorter the hull.
  const double rake = 0.16 * (1.0 - height) * (1.0 - height) * s * s;
  return {0.5 * sizes.length * s * (1.0 - rake), keel + (gunwale - keel) * height, half_beam * breadth};
}

}  // namespace

core::Result<TriangleMesh> make_boat(const BoatSizes& sizes, const Meshing& meshing) {
  if (const auto fault = find_boat_fault(sizes)) return core::Error{*fault};
  if (const auto fault = find_fault(meshing, sizes.length)) return core::Error{*fault};
  const double girth = 0.5 * sizes.beam + 0.7 * sizes.depth;  // of one side, roughly
  const auto parts_of = [&](double length, int least) {
    return std::max(least, static_cast<int>(length / meshing.edge_length + 0.5));
  };
  const int stations = parts_of(sizes.length, 4);
  const int strakes = parts_of(girth, 2);
  if (4.0 * stations * strakes > kMostTriangles) {
    return core::Error{"an edge length this short would make more than " + std::to_string(kMostTriangles) +
                       " triangles; make it larger"};
  }

  TriangleMesh mesh;
  // At the two ends both sides meet in a stem: one column of vertices there, 2 strakes + 1 elsewhere.
  std::vector<int> first;
  for (int i = 0; i <= stations; ++i) {
    first.push_back(static_cast<int>(mesh.positions.size()));
    const double s = 2.0 * i / stations - 1.0;
    const bool is_stem = i == 0 || i == stations;
    for (int j = is_stem ? 0 : -strakes; j <= strakes; ++j) {
      Vec3 p = hull_point(sizes, s, static_cast<double>(std::abs(j)) / strakes);
      if (is_stem) p.z() = 0.0;
      if (j < 0) p.z() = -p.z();
      mesh.positions.push_back(p);
    }
  }
  const auto vertex = [&](int i, int j) {
    const bool is_stem = i == 0 || i == stations;
    return first[static_cast<std::size_t>(i)] + (is_stem ? std::abs(j) : j + strakes);
  };
  for (int i = 0; i < stations; ++i)
    for (int j = -strakes; j < strakes; ++j) {
      const int a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
      // Each quad is cut along its shorter diagonal; where both are equal, mirrored about both planes.
      const auto way = [&](int p, int q) {
        return (mesh.positions[static_cast<std::size_t>(p)] - mesh.positions[static_cast<std::size_t>(q)])
            .norm();
      };
      const double difference = way(a, c) - way(b, d);
      const bool is_port_bow_like = (2 * i + 1 < stations) == (j < 0);
      const bool takes_ac = std::abs(difference) > 1e-9 * sizes.length ? difference < 0.0 : is_port_bow_like;
      // Faces look outside: down and away from the middle.
      if (takes_ac) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
      }
    }
  return mesh;
}

}  // namespace shatterbox::geometry
