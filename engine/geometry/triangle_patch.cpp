#include "engine/geometry/triangle_patch.h"

#include <algorithm>
#include <cmath>

#include "engine/core/hash.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/geometry/closest_points.h"

namespace shatterbox::geometry {
namespace {

using core::at;
__extension__ using Wide = __int128;  // products of three differences of corners

constexpr int kFineBits = 20;
constexpr std::int64_t kFine = std::int64_t{1} << kFineBits;  // of a cell
constexpr double kCellOfFine = 1.0 / static_cast<double>(kFine);

using Corner = std::array<std::int64_t, 3>;

int sign(Wide value) {
  return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0);
}

// Twice the signed area of (a, b, p), seen along an axis.
Wide area(const Corner& a, const Corner& b, const Corner& p, std::size_t u, std::size_t v) {
  return Wide{b[u] - a[u]} * (p[v] - a[v]) - Wide{b[v] - a[v]} * (p[u] - a[u]);
}

int floor_cell(std::int64_t fine) {
  return static_cast<int>(fine >> kFineBits);
}
int ceil_cell(std::int64_t fine) {
  return static_cast<int>((fine + kFine - 1) >> kFineBits);
}

struct Extent {
  Corner low, high;
};

Extent extent_of(const GridCorners& corners) {
  Extent extent{corners[0], corners[0]};
  for (const Corner& corner : corners)
    for (std::size_t i = 0; i < 3; ++i) {
      extent.low[i] = std::min(extent.low[i], corner[i]);
      extent.high[i] = std::max(extent.high[i], corner[i]);
    }
  return extent;
}

// Looks along one axis: which of its grid lines meet the triangle, and between which nodes.
class CutSearch {
 public:
  CutSearch(const GridCorners& corners, std::size_t axis, TrianglePatch& patch)
      : corners_(corners),
        extent_(extent_of(corners)),
        axis_(axis),
        u_((axis + 1) % 3),
        v_((axis + 2) % 3),
        whole_(area(corners[0], corners[1], corners[2], u_, v_)),
        patch_(patch) {
    for (std::size_t i = 0; i < 3; ++i)
      normal_[i] = area(corners[0], corners[1], corners[2], (i + 1) % 3, (i + 2) % 3);
  }

  void run() {
    Corner p{};
    for (int i = ceil_cell(extent_.low[u_]); i <= floor_cell(extent_.high[u_]); ++i) {
      for (int j = ceil_cell(extent_.low[v_]); j <= floor_cell(extent_.high[v_]); ++j) {
        p[u_] = std::int64_t{i} * kFine;
        p[v_] = std::int64_t{j} * kFine;
        if (covers(p)) cut_line(p);
      }
    }
  }

 private:
  // Whether the line through p touches the triangle.
  bool covers(const Corner& p) const {
    bool is_left = true, is_right = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const Wide side = area(corners_[i], corners_[(i + 1) % 3], p, u_, v_);
      is_left = is_left && side >= 0;
      is_right = is_right && side <= 0;
    }
    return is_left || is_right;
  }

  int side_of(const Corner& node) const {
    Wide sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += normal_[i] * (node[i] - corners_[0][i]);
    return sign(sum);
  }

  void cut_line(Corner p) {
    const int first = floor_cell(extent_.low[axis_]), last = ceil_cell(extent_.high[axis_]);
    for (int k = std::min(first, last - 1); k < std::max(last, first + 1); ++k) {
      p[axis_] = std::int64_t{k} * kFine;
      const int low = whole_ == 0 ? 0 : side_of(p);
      Corner next = p;
      next[axis_] += kFine;
      const int high = whole_ == 0 ? 0 : side_of(next);
      if (low * high <= 0) add(p, low, high);
    }
  }

  void add(const Corner& node, int low, int high) {
    TrianglePatch::Cut cut{};
    for (std::size_t i = 0; i < 3; ++i)
      cut.from_low[i] = static_cast<std::uint8_t>(floor_cell(node[i]) - patch_.low[i]);
    cut.axis = static_cast<std::uint8_t>(axis_);
    cut.side_low = static_cast<std::int8_t>(low);
    cut.side_high = static_cast<std::int8_t>(high);
    patch_.cuts.push_back(cut);
  }

  const GridCorners& corners_;
  const Extent extent_;
  const std::size_t axis_, u_, v_;
  const Wide whole_;  // its area seen along the axis, twice; 0: it is seen from its edge
  std::array<Wide, 3> normal_{};
  TrianglePatch& patch_;
};

Vec3 in_cells(const Corner& corner, const GridPlace& from) {
  Vec3 place;
  for (std::size_t i = 0; i < 3; ++i)
    place(static_cast<int>(i)) = kCellOfFine * static_cast<double>(corner[i] - std::int64_t{from[i]} * kFine);
  return place;
}

void measure_nodes(const GridCorners& corners, const GridPlace& high, TrianglePatch& patch) {
  for (int z = 0; z <= high[2] - patch.low[2]; ++z)
    for (int y = 0; y <= high[1] - patch.low[1]; ++y)
      for (int x = 0; x <= high[0] - patch.low[0]; ++x) {
        const double distance =
            distance_in_cells(corners, {patch.low[0] + x, patch.low[1] + y, patch.low[2] + z});
        if (distance > TrianglePatch::kReach) continue;
        patch.nodes.push_back(
            {{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), static_cast<std::uint8_t>(z)},
             static_cast<float>(distance)});
      }
}

}  // namespace

double TrianglePatch::bytes() const {
  return static_cast<double>(sizeof(TrianglePatch) + nodes.size() * sizeof(Node) + cuts.size() * sizeof(Cut));
}

GridCorners snap_to_grid(const std::array<Vec3, 3>& corners, double spacing) {
  GridCorners snapped{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 3; ++i)
      snapped[k][i] = std::llround(corners[k](static_cast<int>(i)) / spacing * static_cast<double>(kFine));
  // The least corner first: a piece may count them from another one.
  std::rotate(snapped.begin(), std::min_element(snapped.begin(), snapped.end()), snapped.end());
  return snapped;
}

double distance_in_cells(const GridCorners& corners, const GridPlace& node) {
  return closest_on_triangle(Vec3::Zero(), in_cells(corners[0], node), in_cells(corners[1], node),
                             in_cells(corners[2], node))
      .distance;
}

TrianglePatch make_patch(const GridCorners& corners) {
  constexpr int kBeyond = static_cast<int>(TrianglePatch::kReach);
  TrianglePatch patch;
  const Extent extent = extent_of(corners);
  GridPlace high{};
  for (std::size_t i = 0; i < 3; ++i) {
    patch.low[i] = floor_cell(extent.low[i]) - kBeyond;
    high[i] = ceil_cell(extent.high[i]) + kBeyond;
  }
  measure_nodes(corners, high, patch);
  for (std::size_t axis = 0; axis < 3; ++axis) CutSearch(corners, axis, patch).run();
  patch.nodes.shrink_to_fit();
  patch.cuts.shrink_to_fit();
  return patch;
}

std::size_t PatchCache::KeyHash::operator()(const GridCorners& corners) const {
  core::Hash hash;
  for (const Corner& corner : corners)
    for (const std::int64_t value : corner) hash.add(static_cast<std::uint64_t>(value));
  return static_cast<std::size_t>(hash.value());
}

PatchCache::Patches PatchCache::find(std::span<const GridCorners> triangles) {
  Patches patches(triangles.size());
  std::vector<std::size_t> missing;
  {
    const std::lock_guard lock(mutex_);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto kept = kept_.find(triangles[t]);
      if (kept != kept_.end())
        patches[t] = kept->second;
      else
        missing.push_back(t);
    }
    figures_.found += static_cast<long>(triangles.size() - missing.size());
  }
  core::parallel_for(missing.size(), 64, [&](std::size_t k) {
    patches[missing[k]] = std::make_shared<const TrianglePatch>(make_patch(triangles[missing[k]]));
  });
  const std::lock_guard lock(mutex_);
  figures_.made += static_cast<long>(missing.size());
  for (const std::size_t t : missing)
    if (kept_.emplace(triangles[t], patches[t]).second) figures_.bytes += patches[t]->bytes();
  return patches;
}

PatchCache::Figures PatchCache::figures() const {
  const std::lock_guard lock(mutex_);
  return figures_;
}

}  // namespace shatterbox::geometry
