#include "engine/audit/passage.h"

#include <algorithm>
#include <cmath>

#include "engine/audit/exact_sign.h"

namespace shatterbox::audit {
namespace {

constexpr double kSplit = 0.4876;  // not a half: scenes are made of round numbers
constexpr int kMostParts = 2000;

enum class Overlap { outside, inside, unknown };

/// All is seen from the last vertex, which rounds each difference by no more than 2^-53 of itself.
class Search {
 public:
  Search(bool is_edge_edge, const FourPoints& start, const FourPoints& end) : is_edge_edge_(is_edge_edge) {
    FourPoints from_start, from_end;
    Vec3 size[4];
    for (std::size_t i = 0; i < 4; ++i) {
      from_start[i] = start[i] - start[3];
      from_end[i] = end[i] - end[3];
      size[i] = from_start[i].cwiseAbs().cwiseMax(from_end[i].cwiseAbs());
      reach_ = std::max(reach_, size[i].maxCoeff());
      motion_ = std::max(motion_, (from_end[i] - from_start[i]).norm());
    }
    reach_ *= 2.0;
    const auto across = [](const Vec3& a, const Vec3& b) {
      return Vec3(a.y() * b.z() + a.z() * b.y(), a.z() * b.x() + a.x() * b.z(),
                  a.x() * b.y() + a.y() * b.x());
    };
    volume_error_ = 40.0 * kUnit * size[0].dot(across(size[1], size[2]));
    start_ = from_start;
    end_ = from_end;
  }

  Passage run() { return look(0.0, start_, 1.0, end_, 0); }

 private:
  static double volume(const Vec3& a, const Vec3& b, const Vec3& c) { return a.dot(b.cross(c)); }

  FourPoints points_at(double time) const {
    FourPoints points;
    for (std::size_t i = 0; i < 4; ++i) points[i] = start_[i] + time * (end_[i] - start_[i]);
    return points;
  }

  /// The part of time from x_time, when the vertices are at x, to y_time.
  Passage look(double x_time, const FourPoints& x, double y_time, const FourPoints& y, int depth) {
    // The volume over this part of time in Bernstein's form: between its coefficients at all times.
    const std::array<double, 4> coefficients{
        volume(x[0], x[1], x[2]),
        (volume(y[0], x[1], x[2]) + volume(x[0], y[1], x[2]) + volume(x[0], x[1], y[2])) / 3.0,
        (volume(x[0], y[1], y[2]) + volume(y[0], x[1], y[2]) + volume(y[0], y[1], x[2])) / 3.0,
        volume(y[0], y[1], y[2])};
    const auto [least, greatest] = std::minmax_element(coefficients.begin(), coefficients.end());
    if (*least > volume_error_ || *greatest < -volume_error_) return Passage::none;
    const FourPoints middle = points_at(0.5 * (x_time + y_time));
    if (is_separated(x, y, middle)) return Passage::none;
    const bool is_noise = *greatest <= volume_error_ && *least >= -volume_error_;
    const bool changes = (coefficients[0] > volume_error_ && coefficients[3] < -volume_error_) ||
                         (coefficients[0] < -volume_error_ && coefficients[3] > volume_error_);
    const Overlap overlap = overlap_around(middle, 0.5 * (y_time - x_time) * motion_);
    if (overlap == Overlap::outside) return Passage::none;
    if (overlap == Overlap::inside && changes) return Passage::passed;
    if (is_noise || depth > 60 || ++parts_ > kMostParts) return Passage::unsettled;
    const double cut_time = x_time + kSplit * (y_time - x_time);
    const FourPoints cut = points_at(cut_time);
    const Passage first = look(x_time, x, cut_time, cut, depth + 1);
    if (first == Passage::passed) return first;
    const Passage second = look(cut_time, cut, y_time, y, depth + 1);
    return second == Passage::none ? first : second;
  }

  /// True if some direction, of those in which the features can be nearest at `middle`, separates them at
  /// both ends of the paths, and so all along.
  bool is_separated(const FourPoints& x, const FourPoints& y, const FourPoints& middle) const {
    const auto& m = middle;
    if (is_edge_edge_) {
      const Vec3 a = m[1] - m[0], b = m[3] - m[2];
      if (separates(a.cross(b), x, y)) return true;
      for (std::size_t i = 0; i < 2; ++i) {
        if (separates(square_to(m[i] - m[2], b), x, y) || separates(square_to(m[2 + i] - m[0], a), x, y))
          return true;
        for (std::size_t j = 2; j < 4; ++j)
          if (separates(m[i] - m[j], x, y)) return true;
      }
      return false;
    }
    if (separates((m[2] - m[1]).cross(m[3] - m[1]), x, y)) return true;
    for (std::size_t i = 1; i < 4; ++i) {
      const std::size_t j = i % 3 + 1;
      if (separates(square_to(m[0] - m[i], m[j] - m[i]), x, y) || separates(m[0] - m[i], x, y)) return true;
    }
    return false;
  }

  static Vec3 square_to(const Vec3& way, const Vec3& edge) {
    const double length_squared = edge.squaredNorm();
    return length_squared > 0.0 ? Vec3(way - edge * (edge.dot(way) / length_squared)) : way;
  }

  bool separates(const Vec3& direction, const FourPoints& x, const FourPoints& y) const {
    const std::size_t first = is_edge_edge_ ? 2 : 1;
    const double error = 16.0 * kUnit * reach_ * direction.cwiseAbs().sum();
    double side = 0.0;
    for (const FourPoints* points : {&x, &y}) {
      for (std::size_t i = 0; i < first; ++i) {
        for (std::size_t j = first; j < 4; ++j) {
          const double gap = direction.dot((*points)[i] - (*points)[j]);
          if (std::abs(gap) <= error || gap * side < 0.0) return false;
          side = gap;
        }
      }
    }
    return true;
  }

  /// Whether the features overlap, seen across their planes, for all positions within `shift` of these.
  Overlap overlap_around(const FourPoints& m, double shift) const {
    double size = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) size = std::max(size, (m[i] - m[j]).norm());
    const double grown = size + 2.0 * shift + 8.0 * kUnit * reach_;
    const double error = grown * grown * grown * grown - size * size * size * size +
                         64.0 * kUnit * grown * grown * grown * grown;
    const auto sign = [error](double value) { return value > error ? 1 : value < -error ? -1 : 0; };
    if (!is_edge_edge_) {
      const Vec3 normal = (m[2] - m[1]).cross(m[3] - m[1]);
      int sum = 0;
      for (std::size_t i = 1; i < 4; ++i) {
        const std::size_t j = i % 3 + 1;
        const int side = sign((m[j] - m[i]).cross(m[0] - m[i]).dot(normal));
        if (side < 0) return Overlap::outside;
        sum += side;
      }
      return sum == 3 ? Overlap::inside : Overlap::unknown;
    }
    const Vec3 a = m[1] - m[0], b = m[3] - m[2], normal = a.cross(b);
    const int over_a = sign(a.cross(m[2] - m[0]).dot(normal)) * sign(a.cross(m[3] - m[0]).dot(normal));
    const int over_b = sign(b.cross(m[0] - m[2]).dot(normal)) * sign(b.cross(m[1] - m[2]).dot(normal));
    if (over_a > 0 || over_b > 0) return Overlap::outside;
    return over_a < 0 && over_b < 0 ? Overlap::inside : Overlap::unknown;
  }

  bool is_edge_edge_;
  FourPoints start_, end_;
  double reach_ = 0.0;         // m: twice the greatest coordinate
  double motion_ = 0.0;        // m: of any vertex against the last one
  double volume_error_ = 0.0;  // m3
  int parts_ = 0;
};

}  // namespace

Passage vertex_through_triangle(const FourPoints& start, const FourPoints& end) {
  return Search(false, start, end).run();
}

Passage edge_through_edge(const FourPoints& start, const FourPoints& end) {
  return Search(true, start, end).run();
}

}  // namespace shatterbox::audit
