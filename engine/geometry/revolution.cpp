// Surfaces of revolution from rings of vertices, each with as many as its circumference wants, stitched and
// loosened.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/core/elementary.h"
#include "engine/core/random.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/irregular.h"
#include "engine/geometry/profile.h"

namespace shatterbox::geometry {
namespace {

constexpr int kQuadrature = 512;
constexpr int kLeastCount = 6;  // vertices of a ring: one round a point

struct Ring {
  std::size_t segment = 0;
  double s = 0.0;       // along the segment, m
  int count = 1;        // 1 on the axis
  double phase = 0.0;   // angle of the first vertex
  bool is_end = false;  // of a segment: its vertices stay on it
  int first_vertex = 0;

  double angle(int i) const { return phase + 2.0 * core::kPi * i / count; }
  int vertex(int i) const { return first_vertex + i % count; }
};

std::optional<std::string> find_profile_fault(const std::vector<ProfileSegment>& profile) {
  if (profile.empty()) return "a profile needs at least one segment";
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const ProfileSegment& s = profile[i];
    const std::string name = "segment " + std::to_string(i + 1) + " of the profile ";
    for (const double x : {s.from.x(), s.from.y(), s.to.x(), s.to.y(), s.centre.x(), s.centre.y()})
      if (!std::isfinite(x)) return name + "has a number that is none";
    if (s.from.x() < 0.0 || s.to.x() < 0.0) return name + "goes to the other side of the axis (r < 0)";
    if (s.from == s.to) return name + "has no length";
    if (i > 0 && s.from != profile[i - 1].to) return name + "does not begin where the one before it ends";
    if (i > 0 && s.from.x() == 0.0) return name + "begins on the axis; only the ends of the whole may";
  }
  return std::nullopt;
}

/// Where the rows of a segment end: equal shares of the integral of 1 / row height. Empty if they are too
/// many.
std::vector<double> find_row_ends(const Profile& profile, std::size_t segment) {
  const double length = profile.length(segment);
  std::vector<double> sum{0.0};
  for (int k = 0; k < kQuadrature; ++k) {
    const double s = (k + 0.5) / kQuadrature * length;
    sum.push_back(sum.back() + length / kQuadrature / (kRowHeight * profile.size(segment, s)));
  }
  const double rows = std::max(1.0, std::floor(sum.back() + 0.5));
  if (rows > kMostTriangles) return {};
  std::vector<double> ends;
  std::size_t k = 0;
  for (int row = 1; row < static_cast<int>(rows); ++row) {
    const double wanted = row / rows * sum.back();
    while (sum[k + 1] < wanted) ++k;
    const double share = (wanted - sum[k]) / (sum[k + 1] - sum[k]);
    ends.push_back((static_cast<double>(k) + share) / kQuadrature * length);
  }
  ends.push_back(length);
  return ends;
}

/// All rings from the profile's begin to its end; empty if there would be too many vertices.
std::vector<Ring> lay_rings(const Profile& profile, const Meshing& meshing) {
  core::Random random(meshing.seed, 0x12176);
  std::vector<Ring> rings;
  double vertices = 0.0;
  const auto add = [&](std::size_t segment, double s, bool is_end) {
    Ring ring;
    ring.segment = segment;
    ring.s = s;
    ring.is_end = is_end;
    ring.first_vertex = static_cast<int>(vertices);
    const double radius = profile.point(segment, s).x();
    if (radius > 0.0) {
      const double wanted = 2.0 * core::kPi * radius / profile.size(segment, s);
      if (vertices + wanted > 0.5 * kMostTriangles) return false;
      ring.count = std::max(kLeastCount, static_cast<int>(wanted + 0.5));
    }
    const double turn = meshing.jitter > 0.0 ? random.uniform() : 0.5 * static_cast<double>(rings.size() % 2);
    ring.phase = 2.0 * core::kPi * turn / ring.count;
    vertices += ring.count;
    rings.push_back(ring);
    return true;
  };
  if (!add(0, 0.0, true)) return {};
  for (std::size_t segment = 0; segment < profile.segment_count(); ++segment) {
    const std::vector<double> ends = find_row_ends(profile, segment);
    if (ends.empty()) return {};
    for (std::size_t i = 0; i < ends.size(); ++i)
      if (!add(segment, ends[i], i + 1 == ends.size())) return {};
  }
  return rings;
}

/// Triangles between two rings, `low` before `high` on the profile, seen from outside counter-clockwise.
void stitch(const Ring& low, const Ring& high, std::vector<Triangle>& triangles) {
  // The first vertex of `high` is the one nearest in angle to the first of `low`; then the ring whose next
  // vertex comes first goes on.
  const double offset = (low.angle(0) - high.angle(0)) / (2.0 * core::kPi) * high.count;
  const int shift = static_cast<int>(std::floor(offset + 0.5));
  const auto high_vertex = [&](int j) {
    return high.vertex(((j + shift) % high.count + high.count) % high.count);
  };
  const auto high_angle = [&](int j) { return high.angle(j + shift); };
  const int low_steps = low.count > 1 ? low.count : 0;
  const int high_steps = high.count > 1 ? high.count : 0;
  for (int i = 0, j = 0; i < low_steps || j < high_steps;) {
    const bool goes_low = j == high_steps || (i < low_steps && low.angle(i + 1) <= high_angle(j + 1));
    if (goes_low) {
      triangles.push_back({low.vertex(i), high_vertex(j), low.vertex(i + 1)});
      ++i;
    } else {
      triangles.push_back({low.vertex(i), high_vertex(j), high_vertex(j + 1)});
      ++j;
    }
  }
}

SurfaceWalk make_walk(const Profile& profile, const std::vector<Ring>& rings) {
  SurfaceWalk walk;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const Ring& ring = rings[r];
    for (int i = 0; i < ring.count; ++i) {
      walk.parameters.emplace_back(static_cast<double>(ring.segment), ring.s, ring.angle(i));
      walk.freedom.emplace_back(ring.is_end ? 0.0 : 1.0, ring.count > 1 ? 1.0 : 0.0);
      walk.creases.push_back(ring.is_end ? static_cast<int>(r) : -1);
    }
  }
  const auto segment_of = [](const Vec3& parameter) { return static_cast<std::size_t>(parameter.x()); };
  walk.position = [&profile, segment_of](const Vec3& q) {
    const Vec2 p = profile.point(segment_of(q), q.y());
    return Vec3(p.x() * core::cos(q.z()), p.y(), p.x() * core::sin(q.z()));
  };
  walk.tangents = [&profile, segment_of](const Vec3& q) {
    const Vec2 d = profile.direction(segment_of(q), q.y());
    const double c = core::cos(q.z());
    const double s = core::sin(q.z());
    Tangents tangents;
    tangents.col(0) = Vec3(d.x() * c, d.y(), d.x() * s);
    tangents.col(1) = Vec3(-s, 0.0, c);
    return tangents;
  };
  walk.stepped = [&profile, segment_of](const Vec3& q, const Vec2& step) {
    const std::size_t segment = segment_of(q);
    const double radius = profile.point(segment, q.y()).x();
    const double s = std::clamp(q.y() + step.x(), 0.0, profile.length(segment));
    return Vec3(q.x(), s, radius > 0.0 ? q.z() + step.y() / radius : q.z());
  };
  return walk;
}

}  // namespace

core::Result<PartedMesh> make_surface_of_revolution(const std::vector<ProfileSegment>& segments,
                                                    const Meshing& meshing) {
  if (const auto fault = find_profile_fault(segments)) return core::Error{*fault};
  double extent = 0.0;
  for (const ProfileSegment& s : segments) extent = std::max({extent, s.from.norm(), s.to.norm()});
  if (const auto fault = find_fault(meshing, extent)) return core::Error{*fault};

  const Profile profile(segments, meshing.edge_length);
  std::vector<Ring> rings = lay_rings(profile, meshing);
  // Too fine for anything: the same sentence as for an edge length that is too short for the extent.
  if (rings.empty()) return core::Error{*find_fault(meshing, std::numeric_limits<double>::max())};
  for (const Ring& ring : rings)
    if (!ring.is_end && profile.point(ring.segment, ring.s).x() <= 0.0)
      return core::Error{"segment " + std::to_string(ring.segment + 1) + " of the profile crosses the axis"};

  const bool is_round = segments.front().from == segments.back().to && segments.front().from.x() > 0.0;
  if (is_round) rings.pop_back();
  SurfaceWalk walk = make_walk(profile, rings);
  PartedMesh result;
  for (const Vec3& parameter : walk.parameters) result.mesh.positions.push_back(walk.position(parameter));
  for (std::size_t r = 1; r < rings.size(); ++r) {
    stitch(rings[r - 1], rings[r], result.mesh.triangles);
    result.parts.resize(result.mesh.triangles.size(), segments[rings[r].segment].part);
  }
  if (is_round) {
    stitch(rings.back(), rings.front(), result.mesh.triangles);
    result.parts.resize(result.mesh.triangles.size(), segments.back().part);
  }
  make_irregular(result.mesh, walk, meshing.jitter, meshing.seed);
  return result;
}

}  // namespace shatterbox::geometry
