#include "engine/geometry/generators.h"

#include <algorithm>
#include <cmath>

#include "engine/core/elementary.h"
#include "engine/geometry/generator_faults.h"
#include "engine/geometry/irregular.h"
#include "engine/geometry/profile.h"

namespace shatterbox::geometry {
namespace {

ProfileSegment line(const Vec2& from, const Vec2& to, Part part) {
  return {ProfileSegment::Kind::line, from, to, Vec2::Zero(), part};
}

std::optional<std::string> find_ornament_fault(const OrnamentSizes& sizes) {
  if (auto fault = find_size_fault("an ornament's radius", sizes.radius)) return fault;
  if (auto fault = find_size_fault("an ornament's neck_radius", sizes.neck_radius)) return fault;
  if (auto fault = find_size_fault("an ornament's neck_height", sizes.neck_height)) return fault;
  if (sizes.neck_radius > 0.9 * sizes.radius)
    return "an ornament's neck_radius (" + metres(sizes.neck_radius) +
           ") must be less than 0.9 of its radius (" + metres(sizes.radius) + ")";
  return std::nullopt;
}

/// Height at which the neck leaves the sphere.
double neck_base(const OrnamentSizes& sizes) {
  return core::sqrt((sizes.radius - sizes.neck_radius) * (sizes.radius + sizes.neck_radius));
}

/// A cap from (radius, low) up, with a rounded shoulder, and in to the axis at the height `top`.
void add_cap(std::vector<ProfileSegment>& profile, double radius, double low, double top) {
  const double shoulder = std::min(0.3 * radius, 0.5 * (top - low));
  const Vec2 below(radius, top - shoulder);
  const Vec2 inside(radius - shoulder, top);
  profile.push_back(line({radius, low}, below, Part::cap));
  profile.push_back(
      {ProfileSegment::Kind::arc, below, inside, {radius - shoulder, top - shoulder}, Part::cap});
  profile.push_back(line(inside, {0.0, top}, Part::cap));
}

void append(PartedMesh& whole, const TriangleMesh& mesh, Part part) {
  const int first = static_cast<int>(whole.mesh.positions.size());
  whole.mesh.positions.insert(whole.mesh.positions.end(), mesh.positions.begin(), mesh.positions.end());
  for (const Triangle& t : mesh.triangles)
    whole.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  whole.parts.resize(whole.mesh.triangles.size(), part);
}

/// Rows of a rectangle: even rows have columns + 1 vertices, odd rows one more, shifted by half a column.
std::vector<double> row_places(int row, int columns, double width) {
  std::vector<double> places{-0.5 * width};
  const double shift = row % 2 == 0 ? 1.0 : 0.5;
  for (int i = 0; i + shift < columns; ++i) places.push_back(((i + shift) / columns - 0.5) * width);
  places.push_back(0.5 * width);
  return places;
}

}  // namespace

core::Result<PartedMesh> make_ornament(const OrnamentSizes& sizes, const Meshing& meshing) {
  if (const auto fault = find_ornament_fault(sizes)) return core::Error{*fault};
  const double base = neck_base(sizes);
  const double top = base + sizes.neck_height;
  const Vec2 shoulder(sizes.neck_radius, base);
  std::vector<ProfileSegment> profile{
      {ProfileSegment::Kind::arc, {0.0, -sizes.radius}, shoulder, Vec2::Zero(), Part::body},
      line(shoulder, {sizes.neck_radius, top}, Part::neck)};
  if (sizes.has_cap) add_cap(profile, sizes.neck_radius, top, top + 0.7 * sizes.neck_radius);
  return make_surface_of_revolution(profile, meshing);
}

core::Result<PartedMesh> make_ornament_cap(const OrnamentSizes& sizes, double clearance,
                                           const Meshing& meshing) {
  if (const auto fault = find_ornament_fault(sizes)) return core::Error{*fault};
  if (const auto fault = find_size_fault("the clearance of an ornament's cap", clearance))
    return core::Error{*fault};
  const double radius = sizes.neck_radius + clearance;
  const double base = neck_base(sizes);
  // The shoulder needs room: the cup's top is clear of the neck's rim by the shoulder's own height.
  const double top = base + sizes.neck_height + clearance + 0.3 * radius;
  std::vector<ProfileSegment> profile;
  add_cap(profile, radius, base + 0.2 * sizes.neck_height, top);
  core::Result<PartedMesh> cap = make_surface_of_revolution(profile, meshing);
  if (!cap) return cap;

  const double ring = 0.45 * radius;
  const double wire = 0.08 * radius;
  Meshing fine = meshing;
  fine.edge_length = std::min(meshing.edge_length, 0.8 * wire);
  core::Result<TriangleMesh> loop = make_torus(ring, wire, fine);
  if (!loop) return core::Error{loop.error()};
  // Upright, standing on the cup's top with a hair between them: the two never cross.
  for (Vec3& p : loop.value().positions) p = Vec3(p.x(), p.z() + top + ring + 1.01 * wire, -p.y());
  append(cap.value(), loop.value(), Part::loop);
  return cap;
}

core::Result<TriangleMesh> make_bowl(const BowlSizes& sizes, const Meshing& meshing) {
  if (const auto fault = find_size_fault("a bowl's rim_radius", sizes.rim_radius)) return core::Error{*fault};
  if (const auto fault = find_size_fault("a bowl's foot_radius", sizes.foot_radius))
    return core::Error{*fault};
  if (const auto fault = find_size_fault("a bowl's height", sizes.height)) return core::Error{*fault};
  if (!(std::isfinite(sizes.foot_height) && sizes.foot_height >= 0.0 &&
        sizes.foot_height < 0.5 * sizes.height))
    return core::Error{"a bowl's foot_height must be from 0 to half its height (it is " +
                       metres(sizes.foot_height) + ")"};
  const Vec2 foot(sizes.foot_radius, 0.0);
  const Vec2 rim(sizes.rim_radius, sizes.height);
  std::vector<ProfileSegment> profile;
  if (sizes.foot_height > 0.0) {
    const Vec2 inner(std::max(0.5 * sizes.foot_radius, sizes.foot_radius - sizes.foot_height),
                     sizes.foot_height);
    profile.push_back(line({0.0, sizes.foot_height}, inner, Part::body));
    profile.push_back(line(inner, foot, Part::body));
  } else {
    profile.push_back(line({0.0, 0.0}, foot, Part::body));
  }
  // The wall leaves the foot flat and stands nearly upright at the rim.
  const Vec2 control(foot.x() + 0.85 * (rim.x() - foot.x()), 0.15 * sizes.height);
  profile.push_back({ProfileSegment::Kind::parabola, foot, rim, control, Part::body});
  core::Result<PartedMesh> bowl = make_surface_of_revolution(profile, meshing);
  if (!bowl) return core::Error{bowl.error()};
  return std::move(bowl.value().mesh);
}

core::Result<TriangleMesh> make_pane(double width, double height, const Meshing& meshing) {
  if (const auto fault = find_size_fault("a pane's width", width)) return core::Error{*fault};
  if (const auto fault = find_size_fault("a pane's height", height)) return core::Error{*fault};
  if (const auto fault = find_fault(meshing, std::max(width, height))) return core::Error{*fault};
  const double h = std::min({meshing.edge_length, width, height / kRowHeight});
  const double wanted_columns = std::floor(width / h + 0.5);
  const double wanted_rows = std::max(1.0, std::floor(height / (kRowHeight * h) + 0.5));
  if (2.0 * (wanted_columns + 1.0) * wanted_rows > kMostTriangles) return too_fine(meshing);
  const int columns = static_cast<int>(wanted_columns);
  const int rows = static_cast<int>(wanted_rows);

  TriangleMesh mesh;
  SurfaceWalk walk;
  std::vector<int> first;
  for (int row = 0; row <= rows; ++row) {
    first.push_back(static_cast<int>(mesh.positions.size()));
    const double y = row == rows ? 0.5 * height : (static_cast<double>(row) / rows - 0.5) * height;
    const std::vector<double> places = row_places(row, columns, width);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const bool is_side = i == 0 || i + 1 == places.size();
      mesh.positions.emplace_back(places[i], y, 0.0);
      walk.freedom.emplace_back(is_side ? 0.0 : 1.0, row == 0 || row == rows ? 0.0 : 1.0);
    }
  }
  first.push_back(static_cast<int>(mesh.positions.size()));
  const auto x = [&](int vertex) { return mesh.positions[static_cast<std::size_t>(vertex)].x(); };
  for (std::size_t row = 0; row < static_cast<std::size_t>(rows); ++row) {
    int low = first[row];
    int high = first[row + 1];
    while (low + 1 < first[row + 1] || high + 1 < first[row + 2]) {
      const bool goes_low =
          high + 1 == first[row + 2] || (low + 1 < first[row + 1] && x(low + 1) <= x(high + 1));
      mesh.triangles.push_back({low, goes_low ? low + 1 : high + 1, high});
      ++(goes_low ? low : high);
    }
  }
  walk.parameters = mesh.positions;
  walk.creases.assign(mesh.positions.size(), -1);
  walk.position = [](const Vec3& p) { return p; };
  walk.tangents = [](const Vec3&) { return Tangents(Tangents::Identity()); };
  walk.stepped = [](const Vec3& p, const Vec2& step) {
    return Vec3(p.x() + step.x(), p.y() + step.y(), 0.0);
  };
  make_irregular(mesh, walk, meshing.jitter, meshing.seed);
  return mesh;
}

core::Result<TriangleMesh> make_torus(double ring_radius, double wire_radius, const Meshing& meshing) {
  if (const auto fault = find_size_fault("a torus' wire_radius", wire_radius)) return core::Error{*fault};
  if (const auto fault = find_size_fault("a torus' ring_radius", ring_radius, wire_radius))
    return core::Error{*fault};
  if (const auto fault = find_fault(meshing, ring_radius + wire_radius)) return core::Error{*fault};
  const double around = std::max(6.0, std::floor(2.0 * core::kPi * wire_radius / meshing.edge_length + 0.5));
  const double along =
      std::max(8.0, std::floor(2.0 * core::kPi * ring_radius / (kRowHeight * meshing.edge_length) + 0.5));
  if (2.0 * around * along > kMostTriangles) return too_fine(meshing);
  const int m = static_cast<int>(around);
  const int n = static_cast<int>(along);
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double u = 2.0 * core::kPi * i / n;
      const double v = 2.0 * core::kPi * j / m;
      const double r = ring_radius + wire_radius * core::cos(v);
      mesh.positions.emplace_back(r * core::cos(u), wire_radius * core::sin(v), -r * core::sin(u));
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const int a = i * m + j;
      const int b = (i + 1) % n * m + j;
      const int c = (i + 1) % n * m + (j + 1) % m;
      const int d = i * m + (j + 1) % m;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

TriangleMesh make_capsule_surface(double radius, double half_length, int around) {
  const int rings = around / 4;                   // of each round end
  const int shared = half_length == 0.0 ? 1 : 0;  // a sphere's two ends have their last one in common
  const int count = 2 * rings - shared;
  TriangleMesh mesh;
  mesh.positions.emplace_back(0.0, half_length + radius, 0.0);
  const auto add_ring = [&](double polar, double middle) {
    for (int i = 0; i < around; ++i) {
      const double turn = 2.0 * core::kPi * i / around, ring = radius * core::sin(polar);
      mesh.positions.emplace_back(ring * core::cos(turn), middle + radius * core::cos(polar),
                                  -ring * core::sin(turn));
    }
  };
  for (int k = 1; k <= rings; ++k) add_ring(0.5 * core::kPi * k / rings, half_length);
  for (int k = rings + shared; k < 2 * rings; ++k) add_ring(0.5 * core::kPi * k / rings, -half_length);
  mesh.positions.emplace_back(0.0, -half_length - radius, 0.0);
  const int last = static_cast<int>(mesh.positions.size()) - 1;
  const auto corner = [around](int ring, int i) { return 1 + ring * around + i % around; };
  for (int i = 0; i < around; ++i) {
    mesh.triangles.push_back({0, corner(0, i), corner(0, i + 1)});
    for (int ring = 0; ring + 1 < count; ++ring) {
      mesh.triangles.push_back({corner(ring, i), corner(ring + 1, i), corner(ring + 1, i + 1)});
      mesh.triangles.push_back({corner(ring, i), corner(ring + 1, i + 1), corner(ring, i + 1)});
    }
    mesh.triangles.push_back({corner(count - 1, i), last, corner(count - 1, i + 1)});
  }
  return mesh;
}

TriangleMesh make_box_surface(const Vec3& half_extent) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
    mesh.positions.emplace_back(sign.cwiseProduct(half_extent));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

double least_angle(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 0.0;
  double sharpest = -1.0;
  for (const Triangle& t : mesh.triangles)
    sharpest = std::max(sharpest, sharpest_cosine(mesh.positions[static_cast<std::size_t>(t[0])],
                                                  mesh.positions[static_cast<std::size_t>(t[1])],
                                                  mesh.positions[static_cast<std::size_t>(t[2])]));
  return core::acos(sharpest);
}

}  // namespace shatterbox::geometry
