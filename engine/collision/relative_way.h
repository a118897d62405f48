// Where the boxes of a body come to lie on its way, as seen by another that it may meet. What goes along with
// one of them, and turns with it, sees only what they do against each other: two that fly off together, or
// spin about each other, sweep hardly anything. README: "Which of them may".
#pragma once

#include <array>

#include "engine/collision/collider.h"
#include "engine/collision/tight_box.h"
#include "engine/core/vec.h"

namespace shatterbox::collision {

/// The way of a body in a step, or a part of it, on which all its vertices go straight and evenly: what was
/// at `centre` + e when the step began goes from `centre` + `from` + `turned_from` e to `centre` + `to` +
/// `turned_to` e.
struct BodyWay {
  Vec3 centre = Vec3::Zero();                   // world, m
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  // m
  Mat3 turned_from = Mat3::Identity(), turned_to = Mat3::Identity();
  // Of a body whose vertices go straight from one pose to another each length between them shrinks a little
  // on the way, to no less than this share: cos(angle / 2).
  double least_length = 1.0;

  /// Where a vertex is on it that was at `start`.
  Vec3 begin_of(const Vec3& start) const { return centre + from + turned_from * (start - centre); }
  Vec3 end_of(const Vec3& start) const { return centre + to + turned_to * (start - centre); }
};

/// Of a body whose boxes are known where the step began: where its vertices are at both ends of a way.
class SeenWay {
 public:
  SeenWay() = default;  // stays where it was
  SeenWay(const BodyWay& way, double reach);

  bool stays() const { return stays_; }

  /// A box about what goes straight from where it is when the way begins to where it is at its end.
  TightBox along(const TightBox& box) const {
    if (stays_) return box;
    TightBox there = to_.moved(box);
    there.include(is_there_ ? box : from_.moved(box));
    return there;
  }

  Vec3 begin_of(const Vec3& start) const { return is_there_ ? start : way_.begin_of(start); }
  Vec3 end_of(const Vec3& start) const { return stays_ ? start : way_.end_of(start); }

 private:
  // Moves a box as its middle goes, and widens it by what goes otherwise in it.
  struct Shift {
    BoxLanes centre = {}, way = {}, spare = {};
    std::array<BoxLanes, 3> columns = {}, sizes = {};  // of the strain, and their absolute values

    Shift() = default;
    Shift(const Vec3& centre, const Vec3& way, const Mat3& strain, double reach);
    TightBox moved(const TightBox& box) const {
      const BoxLanes middle = 0.5F * (box.low + box.high) - centre, half = 0.5F * (box.high - box.low);
      const BoxLanes gone = way + columns[0] * middle[0] + columns[1] * middle[1] + columns[2] * middle[2];
      const BoxLanes more = spare + sizes[0] * half[0] + sizes[1] * half[1] + sizes[2] * half[2];
      TightBox result;
      result.low = box.low + (gone - more);
      result.high = box.high + (gone + more);
      return result;
    }
  };

  bool stays_ = true, is_there_ = true;  // `is_there_`: at the way's beginning, where the step began
  BodyWay way_;
  Shift from_, to_;
};

/// Two bodies on their ways, seen by one who goes along with one of them, and turns with it where that makes
/// less of their ways; or by one who goes with a alone. A point seen so goes about straight: no more than
/// `bow` off. What is `d` apart in the world is seen no more than d / `least_length` apart.
struct RelativeWays {
  SeenWay a, b;
  double bow = 0.0;  // m
  double least_length = 1.0;

  RelativeWays() = default;  // both stay
  /// No vertex of theirs is further than these reaches (m) from the centre.
  RelativeWays(const BodyWay& way_a, double reach_a, const BodyWay& way_b, double reach_b);

  /// How far what is `margin` apart, of a body of this radius and another, may be seen, m.
  double seen_margin(double margin, double radii) const {
    return (margin + radii) / least_length - radii + bow;
  }
  /// How far what is seen this far apart, m, is at least.
  double apart_at_least(double seen, double radii) const {
    return (seen - bow + radii) * least_length - radii;
  }
};

}  // namespace shatterbox::collision
