// Mass, centre and inertia, exactly: area integrals over triangles for infinitely thin shells, the divergence
// theorem for solids inside closed surfaces [Mir96], closed forms for boxes and spheres.
#pragma once

#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

struct MassProperties {
  double mass = 0.0;            // kg
  Vec3 centre = Vec3::Zero();   // centre of mass, m
  Mat3 inertia = Mat3::Zero();  // about the centre of mass, axes of the mesh, kg m2
};

/// Adds up mass, first and second moments about a point near the mass (near, so that little cancels when the
/// inertia is moved to the centre). For shells that are cut: one triangle of material after the other.
class MassSum {
 public:
  explicit MassSum(const Vec3& reference = Vec3::Zero()) : reference_(reference) {}

  /// An infinitely thin triangle a, b, c of `area_density` kg/m2 (density x thickness); its winding does not
  /// matter.
  void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c, double area_density);

  /// The tetrahedron of the reference point and the triangle, of `density` kg/m3; negative where the triangle
  /// turns its back to the reference point: the sum over a closed surface is the solid inside.
  void add_tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, double density);

  /// The sum; without mass all is zero but the centre, which is the reference point.
  MassProperties properties() const;

 private:
  Vec3 reference_;
  double mass_ = 0.0;
  Vec3 first_ = Vec3::Zero();   // integral of x dm, x from the reference point
  Mat3 second_ = Mat3::Zero();  // integral of x x^T dm
};

/// Area of a mesh, m2.
double surface_area(const TriangleMesh& mesh);

/// Volume inside a closed surface wound counter-clockwise seen from outside, m3; negative if it is inside
/// out.
double enclosed_volume(const TriangleMesh& mesh);

/// An infinitely thin shell of `thickness` m and `density` kg/m3 on the mid-surface `mesh`, open or closed.
MassProperties shell_mass_properties(const TriangleMesh& mesh, double thickness, double density);

/// The solid inside the closed surface `mesh` (counter-clockwise seen from outside) of `density` kg/m3.
MassProperties solid_mass_properties(const TriangleMesh& mesh, double density);

/// A solid box about the origin, a solid sphere about the origin, and a solid capsule about the y axis, whose
/// round ends have their middles at -half_length and half_length.
MassProperties box_mass_properties(const Vec3& half_extent, double density);
MassProperties sphere_mass_properties(double radius, double density);
MassProperties capsule_mass_properties(double radius, double half_length, double density);

/// The same mass after the rigid motion `pose`.
MassProperties transformed(const MassProperties& properties, const Pose& pose);

/// Several masses as one rigid body. Without mass all is zero.
MassProperties combined(const std::vector<MassProperties>& parts);

/// Inertia about `point` of a mass whose inertia about its own centre is known (parallel axes).
Mat3 inertia_about(const MassProperties& properties, const Vec3& point);

}  // namespace shatterbox::geometry
