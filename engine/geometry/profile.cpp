#include "engine/geometry/profile.h"

#include <algorithm>

#include "engine/core/elementary.h"

namespace shatterbox::geometry {
namespace {

constexpr int kSamples = 1024;
constexpr double kLeastRing = 8.0;    // edges of a ring at a corner of the profile
constexpr double kLeastRound = 10.0;  // edges about a circle of curvature between corners
constexpr double kLeastSlope = 1e-3;  // sine of a slope
constexpr int kPlaces = 16;           // of a segment where that is asked
constexpr double kGrading = 0.3;      // growth of the edge length per metre of distance

}  // namespace

Profile::Profile(const std::vector<ProfileSegment>& segments, double edge_length)
    : segments_(segments), edge_length_(edge_length) {
  double start = 0.0;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    std::vector<double> arc{0.0};
    for (int k = 1; k <= kSamples; ++k) {
      const double step = (at(i, k / double{kSamples}) - at(i, (k - 1) / double{kSamples})).norm();
      arc.push_back(arc.back() + step);
    }
    starts_.push_back(start);
    start += arc.back();
    arcs_.push_back(std::move(arc));
  }
  // A ring on the axis is a point and asks for nothing; at a corner any other wants kLeastRing edges, a short
  // segment one row; between corners a stem is as narrow as its rings, a disc is not.
  const auto narrow = [&](double s, double circle, double segment_length) {
    double size = std::min(edge_length, segment_length / kRowHeight);
    if (circle > 0.0) size = std::min(size, circle);
    narrows_.push_back({s, size});
  };
  const auto circle_of = [](double radius) { return 2.0 * core::kPi * radius; };
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    narrow(starts_[i], circle_of(segments_[i].from.x()) / kLeastRing, length(i));
    narrow(starts_[i] + length(i), circle_of(segments_[i].to.x()) / kLeastRing, length(i));
    for (int k = 1; k < kPlaces; ++k) {
      const double s = k * length(i) / kPlaces;
      const double radius = point(i, s).x() / std::max(std::abs(direction(i, s).y()), kLeastSlope);
      narrow(starts_[i] + s, circle_of(radius) / kLeastRound, length(i));
    }
  }
}

Vec2 Profile::at(std::size_t segment, double t) const {
  const ProfileSegment& s = segments_[segment];
  if (t <= 0.0) return s.from;
  if (t >= 1.0) return s.to;
  switch (s.kind) {
    case ProfileSegment::Kind::line:
      return s.from + t * (s.to - s.from);
    case ProfileSegment::Kind::parabola:
      return (1.0 - t) * (1.0 - t) * s.from + 2.0 * t * (1.0 - t) * s.centre + t * t * s.to;
    case ProfileSegment::Kind::arc:
      break;
  }
  const Vec2 a = s.from - s.centre;
  const Vec2 b = s.to - s.centre;
  const double angle = t * core::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  return s.centre + core::cos(angle) * a + core::sin(angle) * Vec2(-a.y(), a.x());
}

double Profile::parameter(std::size_t segment, double s) const {
  const std::vector<double>& arc = arcs_[segment];
  if (s <= 0.0) return 0.0;
  if (s >= arc.back()) return 1.0;
  const auto above = static_cast<std::size_t>(std::upper_bound(arc.begin(), arc.end(), s) - arc.begin());
  const double share = (s - arc[above - 1]) / (arc[above] - arc[above - 1]);
  return (static_cast<double>(above - 1) + share) / kSamples;
}

Vec2 Profile::point(std::size_t segment, double s) const {
  return at(segment, parameter(segment, s));
}

Vec2 Profile::direction(std::size_t segment, double s) const {
  const double t = parameter(segment, s);
  const Vec2 d =
      at(segment, std::min(1.0, t + 0.5 / kSamples)) - at(segment, std::max(0.0, t - 0.5 / kSamples));
  return d / d.norm();
}

double Profile::size(std::size_t segment, double s) const {
  double size = edge_length_;
  for (const Narrow& n : narrows_)
    size = std::min(size, n.size + kGrading * std::abs(starts_[segment] + s - n.s));
  return size;
}

}  // namespace shatterbox::geometry
