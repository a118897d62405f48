// The shape of a dent: what a first-order displacement bends, it also stretches; the shape does not.
#include "engine/fracture/dent_shape.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "engine/core/index.h"
#include "engine/fracture/solid_model.h"
#include "engine/geometry/box_tets.h"
#include "engine/geometry/solid_deform.h"

using namespace shatterbox;
using namespace shatterbox::fracture;

namespace {

std::shared_ptr<const SolidModel> make_bar(const Vec3& half_extent, double element_size) {
  auto elements = std::make_shared<geometry::SolidElements>();
  elements->mesh = geometry::make_box_tets(half_extent, element_size).value();
  elements->topology = geometry::build_tet_topology(elements->mesh.tetrahedra);
  auto complex = std::make_shared<geometry::SolidComplex>(geometry::make_solid_complex(elements));
  settle(*complex);
  return make_solid_model(complex, stress::make_solid_stiffness(elements, {210e9, 0.3, 7850.0}), {});
}

template <class Field>
VecX displacement_of(const SolidModel& model, const Field& field) {
  VecX displacement(model.mesh.degree_of_freedom_count());
  for (std::size_t v = 0; v < model.mesh.vertex_source.size(); ++v)
    displacement.segment<3>(static_cast<Eigen::Index>(3 * v)) =
        field(model.mesh.elements->mesh.positions[core::at(model.mesh.vertex_source[v])]);
  return displacement;
}

double volume_after(const SolidModel& model, const VecX& displacement) {
  std::vector<Vec3> moves(model.mesh.elements->mesh.positions.size());
  for (std::size_t v = 0; v < model.mesh.vertex_source.size(); ++v)
    moves[core::at(model.mesh.vertex_source[v])] = displacement.segment<3>(static_cast<Eigen::Index>(3 * v));
  return geometry::volume_share(*model.complex, moves);
}

/// Where the vertex at a place is after a displacement.
Vec3 place_after(const SolidModel& model, const VecX& displacement, const Vec3& place) {
  for (std::size_t v = 0; v < model.mesh.vertex_source.size(); ++v)
    if ((model.mesh.elements->mesh.positions[core::at(model.mesh.vertex_source[v])] - place).norm() < 1e-9)
      return place + displacement.segment<3>(static_cast<Eigen::Index>(3 * v));
  FAIL("no vertex there");
  return place;
}

}  // namespace

TEST_CASE("dent shape: a bar that is bent by two radians is an arc of its length and its volume") {
  constexpr double kBend = 2.0, kLength = 1.0;  // 1/m, m
  const auto model = make_bar(Vec3(0.5 * kLength, 0.05, 0.05), 0.05);
  REQUIRE(model->system);
  const VecX linear = displacement_of(
      *model, [](const Vec3& x) { return Vec3(-kBend * x.x() * x.z(), 0.0, 0.5 * kBend * x.x() * x.x()); });
  CHECK(volume_after(*model, linear) > 1.15);
  const VecX shape = turn_dent_shape(*model, linear);
  CHECK(volume_after(*model, shape) == Approx(1.0).margin(0.01));
  const Vec3 corner(0.5 * kLength, 0.05, 0.05);
  const auto end = [&](double side) {
    const Vec3 low = corner.cwiseProduct(Vec3(side, -1.0, -1.0)),
               high = corner.cwiseProduct(Vec3(side, 1.0, 1.0));
    return Vec3(0.5 * (place_after(*model, shape, low) + place_after(*model, shape, high)));
  };
  const double chord = 2.0 / kBend * std::sin(0.5 * kBend * kLength);
  CHECK((end(1.0) - end(-1.0)).norm() == Approx(chord).epsilon(0.02));
}

TEST_CASE("dent shape: strains that turn nothing leave what they ask for") {
  const auto model = make_bar(Vec3(0.2, 0.1, 0.05), 0.05);
  REQUIRE(model->system);
  const VecX linear =
      displacement_of(*model, [](const Vec3& x) { return Vec3(0.1 * x.x(), -0.05 * x.y(), -0.05 * x.z()); });
  CHECK((turn_dent_shape(*model, linear) - linear).cwiseAbs().maxCoeff() < 1e-9);
}
