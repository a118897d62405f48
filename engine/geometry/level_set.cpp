#include "engine/geometry/level_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/core/index.h"
#include "engine/geometry/bvh.h"

namespace shatterbox::geometry {
namespace {

using core::at;

constexpr int kPad = 3;  // cells about the surface: more than the patches reach, so that the rim is outside
constexpr float kUnknown = std::numeric_limits<float>::max();

// A grid while it is made; distances in cells.
class LevelSetGrid {
 public:
  LevelSetGrid(const GridPlace& low, const GridPlace& count)
      : low_(low),
        count_(count),
        step_{1, count[0], count[0] * count[1]},
        values_(at(step_[2] * count[2]), kUnknown),
        nearest_(values_.size(), -1),
        is_cut_(values_.size(), 0) {}

  void add(const TrianglePatch& patch, int triangle) {
    for (const auto& node : patch.nodes) {
      const std::size_t i = at(number(patch, node.from_low));
      if (node.distance >= values_[i]) continue;
      values_[i] = node.distance;
      nearest_[i] = triangle;
    }
    for (const auto& cut : patch.cuts) {
      const int node = number(patch, cut.from_low);
      is_cut_[at(node)] = static_cast<std::uint8_t>(is_cut_[at(node)] | (1U << cut.axis));
      if (cut.side_low != 0) votes_.push_back({node, cut.side_low});
      if (cut.side_high != 0) votes_.push_back({node + step_[cut.axis], cut.side_high});
    }
  }

  /// Regions that the surface leaves of the grid are in or out as the triangles at their borders say.
  void find_sides() {
    label_regions();
    std::vector<long> sum(at(regions_), 0);
    for (const Vote& vote : votes_) sum[at(region_[at(vote.node)])] += vote.side;
    sum[at(region_[0])] = std::numeric_limits<long>::max();  // the rim
    is_inside_.resize(values_.size());
    for (std::size_t i = 0; i < values_.size(); ++i) is_inside_[i] = sum[at(region_[i])] < 0 ? 1 : 0;
  }

  /// To nodes beyond the patches: a node's nearest triangle is mostly that of one of its neighbours. In the
  /// eight orders of the axes, so that news comes from everywhere.
  void sweep(const std::vector<GridCorners>& triangles) {
    const std::vector<char> is_known = known();
    for (unsigned order = 0; order < 8; ++order) {
      for (int k = 0; k < count_[2]; ++k)
        for (int j = 0; j < count_[1]; ++j)
          for (int i = 0; i < count_[0]; ++i) {
            const GridPlace place{ordered(i, 0, order), ordered(j, 1, order), ordered(k, 2, order)};
            const int node = place[0] + step_[1] * place[1] + step_[2] * place[2];
            if (is_known[at(node)] == 0) ask_neighbours(node, place, order, triangles);
          }
    }
  }

  std::vector<float> signed_values(double spacing) const {
    std::vector<float> result(values_.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
      const auto metres = static_cast<float>(spacing * static_cast<double>(values_[i]));
      result[i] = is_inside_[i] != 0 ? -metres : metres;
    }
    return result;
  }

 private:
  struct Vote {
    int node, side;
  };

  int number(const TrianglePatch& patch, const std::array<std::uint8_t, 3>& from_low) const {
    int result = 0;
    for (std::size_t i = 0; i < 3; ++i) result += step_[i] * (patch.low[i] + from_low[i] - low_[i]);
    return result;
  }

  // Nodes that are joined by edges which no triangle touches.
  void label_regions() {
    region_.assign(values_.size(), -1);
    std::vector<int> stack;
    for (std::size_t start = 0; start < values_.size(); ++start) {
      if (region_[start] >= 0) continue;
      region_[start] = regions_;
      stack.push_back(static_cast<int>(start));
      while (!stack.empty()) {
        const int node = stack.back();
        stack.pop_back();
        visit_neighbours(node, stack);
      }
      ++regions_;
    }
  }

  void visit_neighbours(int node, std::vector<int>& stack) {
    const GridPlace place = place_of(node);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const unsigned bit = 1U << axis;
      const int before = node - step_[axis], behind = node + step_[axis];
      if (place[axis] > 0 && (is_cut_[at(before)] & bit) == 0) take(before, node, stack);
      if (place[axis] + 1 < count_[axis] && (is_cut_[at(node)] & bit) == 0) take(behind, node, stack);
    }
  }

  void take(int node, int from, std::vector<int>& stack) {
    if (region_[at(node)] >= 0) return;
    region_[at(node)] = region_[at(from)];
    stack.push_back(node);
  }

  GridPlace place_of(int node) const {
    return {node % count_[0], node / step_[1] % count_[1], node / step_[2]};
  }

  std::vector<char> known() const {
    std::vector<char> is_known(values_.size());
    for (std::size_t i = 0; i < values_.size(); ++i) is_known[i] = values_[i] < kUnknown ? 1 : 0;
    return is_known;
  }

  int ordered(int i, std::size_t axis, unsigned order) const {
    return (order >> axis & 1U) != 0 ? count_[axis] - 1 - i : i;
  }

  void ask_neighbours(int node, const GridPlace& place, unsigned order,
                      const std::vector<GridCorners>& triangles) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int way = (order >> axis & 1U) != 0 ? 1 : -1;  // to where this order came from
      if (place[axis] + way < 0 || place[axis] + way >= count_[axis]) continue;
      const int triangle = nearest_[at(node + way * step_[axis])];
      if (triangle < 0 || triangle == nearest_[at(node)]) continue;
      const auto distance = static_cast<float>(distance_in_cells(
          triangles[at(triangle)], {place[0] + low_[0], place[1] + low_[1], place[2] + low_[2]}));
      if (distance >= values_[at(node)]) continue;
      values_[at(node)] = distance;
      nearest_[at(node)] = triangle;
    }
  }

  const GridPlace low_, count_, step_;
  std::vector<float> values_;
  std::vector<int> nearest_;          // triangle, -1: not known yet
  std::vector<std::uint8_t> is_cut_;  // bit i: the edge to the next node along axis i
  std::vector<Vote> votes_;
  std::vector<int> region_;
  int regions_ = 0;
  std::vector<char> is_inside_;
};

}  // namespace

LevelSetSpace make_level_set_space(double size) {
  LevelSetSpace space;
  space.spacing = size / kLevelSetCells;
  return space;
}

core::Result<std::shared_ptr<const LevelSet>> LevelSet::make(const TriangleMesh& surface,
                                                             const Vec3& material_from_body,
                                                             const LevelSetSpace& space) {
  const Box box = box_of(surface);
  if (surface.triangles.empty() || !(space.spacing > 0.0)) return core::Error{"there is no surface"};
  const Vec3 cells = (box.high - box.low) / space.spacing;
  if (cells.maxCoeff() < kLeastLevelSetCells)
    return core::Error{"the grid is too coarse for so small a piece"};
  if (cells.maxCoeff() > TrianglePatch::kMostCells)
    return core::Error{"the grid is too fine for so large a body"};

  std::vector<GridCorners> corners;
  corners.reserve(surface.triangles.size());
  for (const Triangle& t : surface.triangles)
    corners.push_back(snap_to_grid(
        {surface.positions[at(t[0])] + material_from_body, surface.positions[at(t[1])] + material_from_body,
         surface.positions[at(t[2])] + material_from_body},
        space.spacing));
  const PatchCache::Patches patches = space.patches->find(corners);

  std::shared_ptr<LevelSet> set(new LevelSet);
  set->spacing_ = space.spacing;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const double shift = material_from_body(axis);
    set->low_[i] = static_cast<int>(std::floor((box.low(axis) + shift) / space.spacing)) - kPad;
    const int high = static_cast<int>(std::ceil((box.high(axis) + shift) / space.spacing)) + kPad;
    set->count_[i] = high - set->low_[i] + 1;
  }
  LevelSetGrid grid(set->low_, set->count_);
  for (std::size_t t = 0; t < patches.size(); ++t) grid.add(*patches[t], static_cast<int>(t));
  grid.find_sides();
  grid.sweep(corners);
  set->values_ = grid.signed_values(space.spacing);
  return std::shared_ptr<const LevelSet>(std::move(set));
}

double LevelSet::distance(const Vec3& material) const {
  Vec3 place = material / spacing_, beyond = Vec3::Zero();
  GridPlace cell{};
  std::array<double, 3> share{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const double inside = std::clamp(place(axis) - low_[i], 0.0, static_cast<double>(count_[i] - 1));
    beyond(axis) = place(axis) - low_[i] - inside;
    cell[i] = std::min(static_cast<int>(inside), count_[i] - 2);
    share[i] = inside - cell[i];
  }
  double sum = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    int number = 0, step = 1;
    for (std::size_t i = 0; i < 3; ++i) {
      const int up = static_cast<int>(corner >> i & 1U);
      weight *= up != 0 ? share[i] : 1.0 - share[i];
      number += step * (cell[i] + up);
      step *= count_[i];
    }
    sum += weight * static_cast<double>(values_[at(number)]);
  }
  return sum + spacing_ * beyond.norm();
}

Vec3 LevelSet::gradient(const Vec3& material) const {
  const double half = 0.5 * spacing_;
  Vec3 slope;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    Vec3 step = Vec3::Zero();
    step(axis) = half;
    slope(axis) = (distance(material + step) - distance(material - step)) / spacing_;
  }
  return slope;
}

double LevelSet::bytes() const {
  return static_cast<double>(sizeof(LevelSet) + values_.size() * sizeof(float));
}

}  // namespace shatterbox::geometry
