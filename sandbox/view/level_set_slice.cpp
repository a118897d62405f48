#include "sandbox/view/level_set_slice.h"

#include <algorithm>
#include <cmath>

#include "engine/core/index.h"
#include "sandbox/view/to_glm.h"

namespace shatterbox::sandbox::view {

namespace {

using core::at;

constexpr double kShownBeyond = 1.0;  // cells outside of the surface

class SliceMaker {
 public:
  SliceMaker(const body::Shape& shape, const geometry::LevelSet& set, const SliceSide& side)
      : shape_(shape),
        set_(set),
        axis_(at(side.axis)),
        sign_(side.leaves_out_above ? 1.0 : -1.0),
        layer_(set.count()[axis_] / 2) {
    const auto axis = static_cast<Eigen::Index>(axis_);
    level_ = set.spacing() * (set.low()[axis_] + layer_) - shape.material_from_body(axis);
  }

  void add_surface() {
    for (const geometry::Triangle& t : shape_.surface.triangles) {
      std::array<Corner, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) {
        corners[i].place = shape_.surface.positions[at(t[i])];
        corners[i].beyond = sign_ * (corners[i].place(static_cast<Eigen::Index>(axis_)) - level_);
      }
      add_what_is_within(corners);
    }
  }

  void add_plane() {
    const int columns = set_.count()[(axis_ + 1) % 3], rows = set_.count()[(axis_ + 2) % 3];
    for (int j = 0; j + 1 < rows; ++j)
      for (int i = 0; i + 1 < columns; ++i) {
        Corner low = node(i, j), high = node(i + 1, j + 1), right = node(i + 1, j), left = node(i, j + 1);
        if (sign_ < 0.0) std::swap(right, left);  // towards the eye
        add_what_is_within({low, right, high});
        add_what_is_within({low, high, left});
      }
  }

  Slice take(std::uint64_t id) {
    mesh_.id = id;
    mesh_.surface = render::Surface::shell;
    return {std::make_shared<const render::Mesh>(std::move(mesh_)),
            std::make_shared<const std::vector<float>>(std::move(distances_))};
  }

 private:
  struct Corner {
    Vec3 place = Vec3::Zero();  // m, body space
    double distance = 0.0;      // m, to the surface
    double beyond = 0.0;        // m: what is above 0 is left out
  };

  void add_what_is_within(const std::array<Corner, 3>& triangle) {
    std::vector<Corner> left;
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner &p = triangle[i], &q = triangle[(i + 1) % 3];
      if (p.beyond <= 0.0) left.push_back(p);
      if (p.beyond * q.beyond >= 0.0) continue;
      const double share = p.beyond / (p.beyond - q.beyond);
      left.push_back(
          {p.place + share * (q.place - p.place), p.distance + share * (q.distance - p.distance), 0.0});
    }
    if (left.size() < 3) return;
    const auto first = static_cast<unsigned>(mesh_.positions.size());
    for (const Corner& corner : left) {
      mesh_.positions.push_back(to_glm(corner.place));
      distances_.push_back(static_cast<float>(1e3 * corner.distance));
    }
    for (unsigned i = 2; i < left.size(); ++i) mesh_.triangles.emplace_back(first, first + i - 1, first + i);
  }

  Corner node(int i, int j) const {
    geometry::GridPlace place{};
    place[axis_] = layer_;
    place[(axis_ + 1) % 3] = i;
    place[(axis_ + 2) % 3] = j;
    Corner corner;
    for (std::size_t k = 0; k < 3; ++k)
      corner.place(static_cast<Eigen::Index>(k)) = set_.spacing() * (set_.low()[k] + place[k]);
    corner.place -= shape_.material_from_body;
    corner.distance = static_cast<double>(
        set_.values()[at(place[0] + set_.count()[0] * (place[1] + set_.count()[1] * place[2]))]);
    corner.beyond = corner.distance - kShownBeyond * set_.spacing();
    return corner;
  }

  const body::Shape& shape_;
  const geometry::LevelSet& set_;
  const std::size_t axis_;
  const double sign_;
  const int layer_;     // of nodes
  double level_ = 0.0;  // m, of the plane in body space
  render::Mesh mesh_;
  std::vector<float> distances_;
};

}  // namespace

SliceSide side_towards(const Vec3& eye) {
  SliceSide side;
  eye.cwiseAbs().maxCoeff(&side.axis);
  side.leaves_out_above = eye(side.axis) > 0.0;
  return side;
}

Slice make_slice(const body::Shape& shape, const geometry::LevelSet& set, const SliceSide& side,
                 std::uint64_t id) {
  SliceMaker maker(shape, set, side);
  maker.add_surface();
  maker.add_plane();
  return maker.take(id);
}

const geometry::LevelSet* SliceShelf::level_set(const body::Shape& shape,
                                                const geometry::LevelSetSpace& space) {
  if (!is_asked_) {
    auto made = geometry::LevelSet::make(shape.surface, shape.material_from_body, space);
    if (made.ok()) set_ = made.value();
    is_asked_ = true;
  }
  return set_.get();
}

const Slice& SliceShelf::slice(const body::Shape& shape, const SliceSide& side, std::uint64_t& next_id) {
  Slice& slice = slices_[at(2 * side.axis + (side.leaves_out_above ? 1 : 0))];
  if (!slice.mesh) slice = make_slice(shape, *set_, side, next_id++);
  return slice;
}

}  // namespace shatterbox::sandbox::view
