// A profile in the half plane (r >= 0, y), to be turned about the y axis: positions by arc length, and the
// local edge length that short segments and narrow rings ask for.
#pragma once

#include <vector>

#include "engine/geometry/generators.h"

namespace shatterbox::geometry {

inline constexpr double kRowHeight = 0.8660254037844386;  // of an equilateral triangle

class Profile {
 public:
  /// Segments must have a length; `edge_length` is the size wanted where nothing narrow is near.
  Profile(const std::vector<ProfileSegment>& segments, double edge_length);

  std::size_t segment_count() const { return segments_.size(); }
  double length(std::size_t segment) const { return arcs_[segment].back(); }

  /// The point (r, y) of a segment after `s` metres of it; ends are the segment's own ends to the bit.
  Vec2 point(std::size_t segment, double s) const;

  /// Unit direction there.
  Vec2 direction(std::size_t segment, double s) const;

  /// Local edge length, m.
  double size(std::size_t segment, double s) const;

 private:
  struct Narrow {
    double s;     // along the whole profile, m
    double size;  // m
  };

  Vec2 at(std::size_t segment, double t) const;
  double parameter(std::size_t segment, double s) const;

  std::vector<ProfileSegment> segments_;
  std::vector<std::vector<double>> arcs_;  // per segment: length up to each of kSamples + 1 equal steps of t
  std::vector<double> starts_;             // per segment: length of the profile before it
  std::vector<Narrow> narrows_;
  double edge_length_;
};

}  // namespace shatterbox::geometry
