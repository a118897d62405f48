#include "sandbox/report/obj_frames.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "engine/core/elementary.h"
#include "engine/geometry/generators.h"

namespace shatterbox::sandbox::report {

geometry::TriangleMesh sphere_surface(double radius) {
  constexpr int kRings = 16, kSectors = 32;
  geometry::TriangleMesh mesh;
  mesh.positions.emplace_back(0.0, radius, 0.0);
  for (int ring = 1; ring < kRings; ++ring) {
    const double polar = core::kPi * ring / kRings;
    for (int sector = 0; sector < kSectors; ++sector) {
      const double turn = 2.0 * core::kPi * sector / kSectors;
      mesh.positions.emplace_back(radius * core::sin(polar) * core::cos(turn), radius * core::cos(polar),
                                  -radius * core::sin(polar) * core::sin(turn));
    }
  }
  mesh.positions.emplace_back(0.0, -radius, 0.0);
  const int last = static_cast<int>(mesh.positions.size()) - 1;
  const auto at = [](int ring, int sector) { return 1 + (ring - 1) * kSectors + sector % kSectors; };
  for (int sector = 0; sector < kSectors; ++sector) {
    mesh.triangles.push_back({0, at(1, sector), at(1, sector + 1)});
    for (int ring = 1; ring + 1 < kRings; ++ring) {
      mesh.triangles.push_back({at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1)});
      mesh.triangles.push_back({at(ring, sector), at(ring + 1, sector + 1), at(ring, sector + 1)});
    }
    mesh.triangles.push_back({at(kRings - 1, sector), last, at(kRings - 1, sector + 1)});
  }
  return mesh;
}

std::string make_obj(std::span<const body::Body> bodies, double time) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "# shatterbox, {:.17g} s; metres, y up\n", time);
  std::size_t first = 1;
  for (const body::Body& body : bodies) {
    geometry::TriangleMesh made;
    const geometry::TriangleMesh* mesh = &made;
    switch (body.shape->kind) {
      case body::ShapeKind::plane:
        continue;
      case body::ShapeKind::box:
        made = geometry::make_box_surface(body.shape->half_extent);
        break;
      case body::ShapeKind::sphere:
        made = sphere_surface(body.shape->radius);
        break;
      case body::ShapeKind::capsule:
        made = geometry::make_capsule_surface(body.shape->radius, body.shape->half_length);
        break;
      case body::ShapeKind::shell:
      case body::ShapeKind::solid:
        mesh = &body.shape->surface;
        break;
    }
    std::string name = body.name;
    for (char& c : name) {
      if (c == ' ') c = '_';
    }
    fmt::format_to(out, "o {}#{}\n", name, body.id);
    for (const Vec3& p : mesh->positions) {
      const Vec3 world_point = body.pose.apply(p);
      fmt::format_to(out, "v {:.17g} {:.17g} {:.17g}\n", world_point.x(), world_point.y(), world_point.z());
    }
    for (const geometry::Triangle& t : mesh->triangles) {
      fmt::format_to(out, "f {} {} {}\n", first + static_cast<std::size_t>(t[0]),
                     first + static_cast<std::size_t>(t[1]), first + static_cast<std::size_t>(t[2]));
    }
    first += mesh->positions.size();
  }
  return text;
}

std::string write_obj_frame(const std::string& folder, int number, std::span<const body::Body> bodies,
                            double time) {
  const std::string path = fmt::format("{}/frame_{:06}.obj", folder, number);
  errno = 0;
  std::ofstream stream(path, std::ios::binary);
  stream << make_obj(bodies, time);
  stream.close();
  if (!stream) return fmt::format("{} cannot be written: {}", path, std::strerror(errno));
  return {};
}

}  // namespace shatterbox::sandbox::report
