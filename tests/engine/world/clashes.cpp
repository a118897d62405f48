// Pieces are not born in each other, nor in others that their whole did not cross.
#include "engine/world/clashes.h"

#include <catch2/catch.hpp>

#include "engine/geometry/generators.h"

using namespace shatterbox;
using fracture::PieceClash;

namespace {

/// A cube of a metre, turned, with its middle at `place` of the frame that is turned.
body::Body make_cube(body::BodyId id, const Vec3& place) {
  auto shape = std::make_shared<body::Shape>();
  shape->kind = body::ShapeKind::solid;
  shape->surface = geometry::make_box_surface(Vec3::Constant(0.5));
  shape->bounding_radius = std::sqrt(0.75);
  body::Body cube;
  cube.id = id;
  cube.shape = shape;
  cube.pose.rotation = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  cube.pose.translation = cube.pose.rotation * place;
  return cube;
}

std::vector<std::pair<int, int>> clashes_of(const body::Body& whole, const std::vector<body::Body>& born,
                                            std::vector<body::Body> bodies) {
  bodies.push_back(whole);
  std::vector<std::pair<int, int>> out;
  for (const PieceClash& clash : world::find_clashes(whole, born, bodies, {}))
    out.emplace_back(clash.a, clash.b);
  return out;
}

}  // namespace

TEST_CASE("pieces that are apart do not clash, and those that cross or touch do") {
  const body::Body whole = make_cube(1, Vec3::Zero());
  const body::Body left = make_cube(0, Vec3(-0.6, 0, 0)), right = make_cube(0, Vec3(0.6, 0, 0));
  const body::Body above = make_cube(0, Vec3(0.3, 0.7, 0.2));
  using Pairs = std::vector<std::pair<int, int>>;
  CHECK(clashes_of(whole, {left, right}, {}).empty());
  CHECK(clashes_of(whole, {left, right, above}, {}) == Pairs{{0, 2}, {1, 2}});
  // By faces, and by a corner that lies on a face.
  CHECK(clashes_of(whole, {left, make_cube(0, Vec3(0.4, 0, 0))}, {}) == Pairs{{0, 1}});
  CHECK(clashes_of(whole, {left, make_cube(0, Vec3(0.4 + 1e-8, 0, 0))}, {}).empty());
  body::Body tilted = right;
  tilted.pose.rotation = left.pose.rotation * Quat::FromTwoVectors(Vec3(1, 1, 1), Vec3(-1, 0, 0));
  const Vec3 corner = tilted.pose.rotation * Vec3::Constant(0.5);
  const Vec3 on_face = left.pose.apply(Vec3(0.5, 0.1, -0.2)), along = left.pose.rotation * Vec3(1, 0, 0);
  tilted.pose.translation = on_face - corner;
  CHECK(clashes_of(whole, {left, tilted}, {}) == Pairs{{0, 1}});
  tilted.pose.translation += 1e-8 * along;
  CHECK(clashes_of(whole, {left, tilted}, {}).empty());
}

TEST_CASE("colliders of pieces are made once, and are there for the next who asks") {
  const body::Body whole = make_cube(1, Vec3::Zero());
  const body::Body left = make_cube(0, Vec3(-0.6, 0, 0)), right = make_cube(0, Vec3(0.6, 0, 0));
  const dynamics::ContactState contact;
  world::find_clashes(whole, {left, right}, {whole}, contact);
  REQUIRE(contact.shelf->newborn.size() == 2);
  CHECK(contact.shelf->newborn[0].shape == left.shape);
  CHECK(contact.shelf->newborn[1].shape == right.shape);
  const auto collider = contact.shelf->newborn[1].collider;
  const body::Body beside = make_cube(2, Vec3(0.6, 1.7, 0));
  world::find_clashes(right, {left}, {right, beside}, contact);
  REQUIRE(contact.shelf->newborn.size() == 3);
  CHECK(contact.shelf->newborn[1].collider == collider);
  CHECK(contact.shelf->newborn[2].shape == beside.shape);
}

TEST_CASE("a piece clashes with a body that its whole did not cross") {
  const body::Body whole = make_cube(1, Vec3::Zero());
  const body::Body left = make_cube(0, Vec3(-0.6, 0, 0)), right = make_cube(0, Vec3(0.6, 0, 0));
  const body::Body neighbour = make_cube(7, Vec3(1.3, 0.1, 0.2)), crossed = make_cube(8, Vec3(0.9, 0.2, 0.1));
  using Pairs = std::vector<std::pair<int, int>>;
  CHECK(clashes_of(whole, {left, right}, {neighbour}) == Pairs{{1, -1}});
  CHECK(clashes_of(whole, {left, right}, {crossed}).empty());
  CHECK(clashes_of(whole, {left, right}, {make_cube(9, Vec3(5, 0, 0))}).empty());
}
