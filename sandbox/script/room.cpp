#include "sandbox/script/room.h"

#include <algorithm>
#include <cmath>

#include "engine/geometry/closest_points.h"
#include "engine/geometry/crossings.h"

namespace shatterbox::sandbox::script {

namespace {

using body::ShapeKind;
using geometry::TriangleMesh;

/// A form in world space: the surface of a shell or a box, the ball of a sphere, or a half space.
struct Placed {
  ShapeKind kind = ShapeKind::shell;
  TriangleMesh surface;  // shells and boxes, m
  Pose pose;             // of the form's own frame
  Vec3 half_extent = Vec3::Zero();
  double radius = 0.0;                             // of the sphere, m
  Vec3 least = Vec3::Zero(), most = Vec3::Zero();  // bounds; planes have none
};

TriangleMesh box_mesh(const Vec3& half_extent) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.positions.push_back(half_extent.cwiseProduct(
        Vec3(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

void place(Placed& form) {
  const Vec3 reach = Vec3::Constant(form.radius);
  form.least = form.pose.translation - reach;
  form.most = form.pose.translation + reach;
  for (Vec3& p : form.surface.positions) {
    p = form.pose.apply(p);
    form.least = form.least.cwiseMin(p);
    form.most = form.most.cwiseMax(p);
  }
}

Placed placed(const world::BodyDescription& description) {
  Placed form;
  form.pose = description.pose;
  if (const auto* shell = std::get_if<world::ShellDescription>(&description.form)) {
    form.surface = shell->mesh;
  } else if (const auto* box = std::get_if<world::BoxDescription>(&description.form)) {
    form.kind = ShapeKind::box;
    form.half_extent = box->half_extent;
    form.surface = box_mesh(box->half_extent);
  } else if (const auto* sphere = std::get_if<world::SphereDescription>(&description.form)) {
    form.kind = ShapeKind::sphere;
    form.radius = sphere->radius;
  } else {
    form.kind = ShapeKind::plane;
  }
  place(form);
  return form;
}

Placed placed(const body::Body& body) {
  Placed form;
  form.kind = body.shape->kind;
  form.pose = body.pose;
  form.half_extent = body.shape->half_extent;
  if (form.kind == ShapeKind::sphere) form.radius = body.shape->radius;
  form.surface = form.kind == ShapeKind::box ? box_mesh(form.half_extent) : body.shape->surface;
  place(form);
  return form;
}

bool is_in_half_space(const Placed& form, const Placed& plane) {
  if (form.kind == ShapeKind::plane) return false;
  const auto is_below = [&](const Vec3& p) { return plane.pose.apply_inverse(p).y() < form.radius; };
  if (form.kind == ShapeKind::sphere) return is_below(form.pose.translation);
  return std::any_of(form.surface.positions.begin(), form.surface.positions.end(), is_below);
}

bool meets_sphere(const Placed& form, const Placed& sphere) {
  const Vec3& centre = sphere.pose.translation;
  if (form.kind == ShapeKind::sphere)
    return (form.pose.translation - centre).norm() < form.radius + sphere.radius;
  if (form.kind == ShapeKind::box)
    return geometry::closest_on_box(form.pose.apply_inverse(centre), form.half_extent).signed_distance <
           sphere.radius;
  const auto corner = [&](int v) -> const Vec3& {
    return form.surface.positions[static_cast<std::size_t>(v)];
  };
  return std::any_of(
      form.surface.triangles.begin(), form.surface.triangles.end(), [&](const geometry::Triangle& t) {
        return geometry::closest_on_triangle(centre, corner(t[0]), corner(t[1]), corner(t[2])).distance <
               sphere.radius;
      });
}

/// A corner or the centre of `form` inside `box`.
bool is_in_box(const Placed& form, const Placed& box) {
  if (box.kind != ShapeKind::box) return false;
  const auto is_inside = [&](const Vec3& p) {
    return (box.pose.apply_inverse(p).cwiseAbs().array() < box.half_extent.array()).all();
  };
  return (form.kind == ShapeKind::box && is_inside(form.pose.translation)) ||
         std::any_of(form.surface.positions.begin(), form.surface.positions.end(), is_inside);
}

bool cross(const Placed& a, const Placed& b) {
  if (b.kind == ShapeKind::plane) return is_in_half_space(a, b);
  if (a.kind == ShapeKind::plane) return is_in_half_space(b, a);
  if ((a.least.array() > b.most.array()).any() || (b.least.array() > a.most.array()).any()) return false;
  if (b.kind == ShapeKind::sphere) return meets_sphere(a, b);
  if (a.kind == ShapeKind::sphere) return meets_sphere(b, a);
  return is_in_box(a, b) || is_in_box(b, a) || geometry::count_crossing_pairs({a.surface, b.surface}) > 0;
}

/// A ball about everything of a body but planes, against the new form's bounds: cheap, before its triangles
/// are placed.
bool is_far(const body::Body& body, const Placed& form) {
  if (body.shape->kind == ShapeKind::plane || form.kind == ShapeKind::plane) return false;
  const Vec3 nearest = body.pose.translation.cwiseMax(form.least).cwiseMin(form.most);
  return (nearest - body.pose.translation).norm() > body.shape->bounding_radius;
}

}  // namespace

std::string find_obstacle(const world::World& world, const world::BodyDescription& description) {
  const Placed form = placed(description);
  for (const body::Body& body : world.bodies()) {
    if (description.group >= 0 && body.group == description.group) continue;
    if (is_far(body, form)) continue;
    if (cross(form, placed(body))) return body.name;
  }
  return {};
}

}  // namespace shatterbox::sandbox::script
