#include "sandbox/report/obj_frames.h"

#include <iterator>

#include <fmt/format.h>

#include "engine/body/polyhedron.h"
#include "engine/geometry/generators.h"
#include "sandbox/report/text_file.h"

namespace shatterbox::sandbox::report {

namespace {

/// As a comment, what of a body its surface does not tell.
void append_motion(const body::Body& body, std::string& text) {
  const Vec3 &x = body.pose.translation, &v = body.velocity, &w = body.angular_velocity;
  fmt::format_to(std::back_inserter(text),
                 "# mass {:.17g} kg, centre {:.17g} {:.17g} {:.17g} m, velocity {:.17g} {:.17g} {:.17g} m/s, "
                 "angular velocity {:.17g} {:.17g} {:.17g} rad/s\n",
                 body.shape->mass, x.x(), x.y(), x.z(), v.x(), v.y(), v.z(), w.x(), w.y(), w.z());
}

}  // namespace

std::string make_obj(std::span<const body::Body> bodies, double time) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "# shatterbox, {:.17g} s; metres, y up\n", time);
  std::size_t first = 1;
  for (const body::Body& body : bodies) {
    if (body.shape->kind == body::ShapeKind::plane) continue;
    const geometry::TriangleMesh mesh = body.shape->kind == body::ShapeKind::sphere
                                            ? geometry::make_capsule_surface(body.shape->radius, 0.0)
                                            : body::find_polyhedron(*body.shape);
    std::string name = body.name;
    for (char& c : name) {
      if (c == ' ') c = '_';
    }
    fmt::format_to(out, "o {}#{}\n", name, body.id);
    if (body.is_dynamic()) append_motion(body, text);
    for (const Vec3& p : mesh.positions) {
      const Vec3 world_point = body.pose.apply(p);
      fmt::format_to(out, "v {:.17g} {:.17g} {:.17g}\n", world_point.x(), world_point.y(), world_point.z());
    }
    for (const geometry::Triangle& t : mesh.triangles) {
      fmt::format_to(out, "f {} {} {}\n", first + static_cast<std::size_t>(t[0]),
                     first + static_cast<std::size_t>(t[1]), first + static_cast<std::size_t>(t[2]));
    }
    first += mesh.positions.size();
  }
  return text;
}

std::string write_obj_frame(const std::string& folder, int number, std::span<const body::Body> bodies,
                            double time) {
  return write_text(fmt::format("{}/frame_{:06}.obj", folder, number), make_obj(bodies, time));
}

}  // namespace shatterbox::sandbox::report
