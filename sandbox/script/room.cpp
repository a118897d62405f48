#include "sandbox/script/room.h"

#include <algorithm>
#include <cmath>

#include "engine/body/polyhedron.h"
#include "engine/core/elementary.h"
#include "engine/geometry/closest_points.h"
#include "engine/geometry/common_inside.h"
#include "engine/geometry/crossings.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/winding_number.h"

namespace shatterbox::sandbox::script {

namespace {

using body::ShapeKind;
using geometry::TriangleMesh;

/// A form in world space: the surface of a shell, a solid, a box or a capsule, the ball of a sphere, or a
/// half space.
struct Placed {
  ShapeKind kind = ShapeKind::shell;
  TriangleMesh surface;  // of all but planes and spheres, m
  Pose pose;             // of the form's own frame
  Vec3 half_extent = Vec3::Zero();
  double radius = 0.0;                             // of the sphere, m
  Vec3 least = Vec3::Zero(), most = Vec3::Zero();  // bounds; planes have none
};

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
  } else if (const auto* solid = std::get_if<world::SolidDescription>(&description.form)) {
    form.kind = ShapeKind::solid;
    form.surface = solid->mesh;
  } else if (const auto* box = std::get_if<world::BoxDescription>(&description.form)) {
    form.kind = ShapeKind::box;
    form.half_extent = box->half_extent;
    form.surface = geometry::make_box_surface(box->half_extent);
  } else if (const auto* sphere = std::get_if<world::SphereDescription>(&description.form)) {
    form.kind = ShapeKind::sphere;
    form.radius = sphere->radius;
  } else if (const auto* capsule = std::get_if<world::CapsuleDescription>(&description.form)) {
    form.kind = ShapeKind::capsule;
    form.surface = geometry::make_capsule_surface(capsule->radius, 0.5 * capsule->length - capsule->radius);
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
  form.surface = body::find_polyhedron(*body.shape);
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

/// One whose surface does not cross the solid's lies wholly in it.
bool is_in_solid(const Placed& form, const Placed& solid) {
  const bool has_inside = solid.kind == ShapeKind::solid || solid.kind == ShapeKind::capsule;
  if (!has_inside || form.kind == ShapeKind::plane) return false;
  const Vec3& point = form.kind == ShapeKind::sphere ? form.pose.translation : form.surface.positions.front();
  return geometry::WindingNumber(solid.surface).about(point) > 0.5;
}

/// Blocks that are pushed into each other with their sides in one plane: nothing of them crosses.
bool have_common_inside(const Placed& a, const Placed& b) {
  constexpr double kTouching = 1e-9;  // of their size
  return body::is_closed(a.kind) && body::is_closed(b.kind) &&
         geometry::have_common_inside(a.surface, b.surface, kTouching * (a.most - a.least).norm());
}

bool cross(const Placed& a, const Placed& b) {
  if (b.kind == ShapeKind::plane) return is_in_half_space(a, b);
  if (a.kind == ShapeKind::plane) return is_in_half_space(b, a);
  if ((a.least.array() > b.most.array()).any() || (b.least.array() > a.most.array()).any()) return false;
  if (is_in_solid(a, b) || is_in_solid(b, a)) return true;
  if (b.kind == ShapeKind::sphere) return meets_sphere(a, b);
  if (a.kind == ShapeKind::sphere) return meets_sphere(b, a);
  return is_in_box(a, b) || is_in_box(b, a) || geometry::count_crossing_pairs({a.surface, b.surface}) > 0 ||
         have_common_inside(a, b);
}

/// A ball about everything of a body but planes, against the new form's bounds: cheap, before its triangles
/// are placed.
bool is_far(const body::Body& body, const Placed& form) {
  if (body.shape->kind == ShapeKind::plane || form.kind == ShapeKind::plane) return false;
  const Vec3 nearest = body.pose.translation.cwiseMax(form.least).cwiseMin(form.most);
  return (nearest - body.pose.translation).norm() > body.shape->bounding_radius;
}

/// A little smaller, about the middle of its bounds; planes stay.
Placed shrunk(Placed form) {
  constexpr double kShrunk = 0.98;
  const Vec3 middle = form.kind == ShapeKind::sphere || form.kind == ShapeKind::box
                          ? form.pose.translation
                          : Vec3(0.5 * (form.least + form.most));
  form.half_extent *= kShrunk;
  form.radius *= kShrunk;
  for (Vec3& p : form.surface.positions) p = middle + kShrunk * (p - middle);
  form.least = middle + kShrunk * (form.least - middle);
  form.most = middle + kShrunk * (form.most - middle);
  return form;
}

}  // namespace

bool lie_in_each_other(const body::Body& a, const body::Body& b) {
  const Placed form = placed(a), other = placed(b);
  // What touches only does so until one of them is shrunk; what is nested closely does not until then.
  const auto has_hollows = [](const Placed& f) {
    return f.kind == ShapeKind::shell || f.kind == ShapeKind::solid;
  };
  if ((has_hollows(form) || has_hollows(other)) && !cross(form, other)) return false;
  return cross(shrunk(form), other) && cross(form, shrunk(other));
}

bool holds(const body::Body& body, const Vec3& point) {
  const Placed form = placed(body);
  const Vec3 own = form.pose.apply_inverse(point);
  switch (form.kind) {
    case ShapeKind::plane:
      return own.y() < 0.0;
    case ShapeKind::box:
      return (own.cwiseAbs().array() < form.half_extent.array()).all();
    case ShapeKind::sphere:
      return own.norm() < form.radius;
    default:
      return (point.array() > form.least.array()).all() && (point.array() < form.most.array()).all() &&
             std::abs(geometry::WindingNumber(form.surface).about(point)) > 0.5;
  }
}

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
