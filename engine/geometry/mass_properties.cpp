#include "engine/geometry/mass_properties.h"

#include "engine/core/elementary.h"

namespace shatterbox::geometry {
namespace {

/// Inertia from second moments: tr(S) 1 - S.
Mat3 inertia_of(const Mat3& second) {
  return second.trace() * Mat3::Identity() - second;
}

/// The middle of the mesh's box: near enough to the mass for the sums to keep their digits.
Vec3 middle_of(const TriangleMesh& mesh) {
  if (mesh.positions.empty()) return Vec3::Zero();
  Vec3 low = mesh.positions.front();
  Vec3 high = low;
  for (const Vec3& p : mesh.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return 0.5 * (low + high);
}

template <class Visit>
void for_each_triangle(const TriangleMesh& mesh, const Visit& visit) {
  for (const Triangle& t : mesh.triangles)
    visit(mesh.positions[static_cast<std::size_t>(t[0])], mesh.positions[static_cast<std::size_t>(t[1])],
          mesh.positions[static_cast<std::size_t>(t[2])]);
}

}  // namespace

// With corners p_i of a simplex of dimension n and s their sum, the mean of x x^T over it is
// (s s^T + sum p_i p_i^T) / ((n + 1)(n + 2)): 12 for triangles, 20 for tetrahedra.
void MassSum::add_triangle(const Vec3& a, const Vec3& b, const Vec3& c, double area_density) {
  const Vec3 p = a - reference_;
  const Vec3 q = b - reference_;
  const Vec3 r = c - reference_;
  const double m = 0.5 * area_density * (b - a).cross(c - a).norm();
  const Vec3 s = p + q + r;
  mass_ += m;
  first_ += m / 3.0 * s;
  second_ += m / 12.0 * (s * s.transpose() + p * p.transpose() + q * q.transpose() + r * r.transpose());
}

void MassSum::add_tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, double density) {
  const Vec3 p = a - reference_;
  const Vec3 q = b - reference_;
  const Vec3 r = c - reference_;
  const double m = density / 6.0 * p.dot(q.cross(r));
  const Vec3 s = p + q + r;
  mass_ += m;
  first_ += m / 4.0 * s;
  second_ += m / 20.0 * (s * s.transpose() + p * p.transpose() + q * q.transpose() + r * r.transpose());
}

MassProperties MassSum::properties() const {
  MassProperties result;
  result.centre = reference_;
  if (mass_ == 0.0) return result;
  const Vec3 offset = first_ / mass_;
  result.mass = mass_;
  result.centre = reference_ + offset;
  result.inertia = inertia_of(second_ - mass_ * offset * offset.transpose());
  return result;
}

double surface_area(const TriangleMesh& mesh) {
  double area = 0.0;
  for_each_triangle(
      mesh, [&](const Vec3& a, const Vec3& b, const Vec3& c) { area += 0.5 * (b - a).cross(c - a).norm(); });
  return area;
}

double enclosed_volume(const TriangleMesh& mesh) {
  const Vec3 o = middle_of(mesh);
  double volume = 0.0;
  for_each_triangle(mesh, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    volume += (a - o).dot((b - o).cross(c - o)) / 6.0;
  });
  return volume;
}

MassProperties shell_mass_properties(const TriangleMesh& mesh, double thickness, double density) {
  MassSum sum(middle_of(mesh));
  for_each_triangle(mesh, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    sum.add_triangle(a, b, c, thickness * density);
  });
  return sum.properties();
}

MassProperties solid_mass_properties(const TriangleMesh& mesh, double density) {
  MassSum sum(middle_of(mesh));
  for_each_triangle(
      mesh, [&](const Vec3& a, const Vec3& b, const Vec3& c) { sum.add_tetrahedron(a, b, c, density); });
  return sum.properties();
}

MassProperties box_mass_properties(const Vec3& half_extent, double density) {
  MassProperties result;
  result.mass = 8.0 * density * half_extent.prod();
  const Vec3 second = result.mass / 3.0 * half_extent.cwiseProduct(half_extent);
  result.inertia = inertia_of(second.asDiagonal());
  return result;
}

MassProperties sphere_mass_properties(double radius, double density) {
  MassProperties result;
  result.mass = 4.0 / 3.0 * core::kPi * radius * radius * radius * density;
  result.inertia = 0.4 * result.mass * radius * radius * Mat3::Identity();
  return result;
}

MassProperties capsule_mass_properties(double radius, double half_length, double density) {
  const double square = radius * radius, height = 2.0 * half_length;
  const double cylinder = core::kPi * square * height * density;
  const double ball = 4.0 / 3.0 * core::kPi * square * radius * density;
  // Each half ball has its centre of mass 3/8 of the radius beyond its flat side.
  const double along = 0.5 * cylinder * square + 0.4 * ball * square;
  const double across = cylinder * (height * height / 12.0 + 0.25 * square) +
                        ball * (0.4 * square + half_length * half_length + 0.75 * radius * half_length);
  MassProperties result;
  result.mass = cylinder + ball;
  result.inertia = Vec3(across, along, across).asDiagonal();
  return result;
}

MassProperties transformed(const MassProperties& properties, const Pose& pose) {
  const Mat3 rotation = pose.rotation.toRotationMatrix();
  return {properties.mass, pose.apply(properties.centre),
          rotation * properties.inertia * rotation.transpose()};
}

MassProperties combined(const std::vector<MassProperties>& parts) {
  MassProperties result;
  Vec3 first = Vec3::Zero();
  for (const MassProperties& part : parts) {
    result.mass += part.mass;
    first += part.mass * part.centre;
  }
  if (result.mass == 0.0) return {};
  result.centre = first / result.mass;
  for (const MassProperties& part : parts) result.inertia += inertia_about(part, result.centre);
  return result;
}

Mat3 inertia_about(const MassProperties& properties, const Vec3& point) {
  const Vec3 offset = properties.centre - point;
  return properties.inertia + properties.mass * inertia_of(offset * offset.transpose());
}

}  // namespace shatterbox::geometry
