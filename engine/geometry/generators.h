// Surfaces by their sizes: sphere, ornament, bowl, wine glass, pane, boat, vase, bottle, egg, lathe, and any
// surface of revolution. Triangles are near-equilateral, of one size, and without directions that cracks
// could follow; vertices lie on the exact surface, so that a finer mesh is the same shape. y is up. The same
// numbers give the same mesh to the bit.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/core/vec.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// How fine, and how irregular.
struct Meshing {
  double edge_length = 0.003;  // typical edge, m
  double jitter = 0.3;  // greatest random step of a vertex along the surface, share of the edge; 0: regular
  std::uint64_t seed = 1;
};

/// Which part of a thing a triangle is on, for its look and its material.
enum class Part : std::uint8_t { body, neck, cap, loop };

struct PartedMesh {
  TriangleMesh mesh;
  std::vector<Part> parts;  // |T|
};

/// All generators: an error sentence if a size makes no sense or more than kMostTriangles would come out.
inline constexpr int kMostTriangles = 4'000'000;

/// A sentence that says what is wrong with `meshing` for a thing of `extent` m, or nothing.
std::optional<std::string> find_fault(const Meshing& meshing, double extent);

/// Sphere about the origin: a geodesic icosahedron of 20 f^2 triangles, f = round(1.2 radius / edge_length).
core::Result<TriangleMesh> make_sphere(double radius, const Meshing& meshing);

/// A glass bauble: sphere about the origin, its top cut off where a cylindrical neck of `neck_radius` rises
/// by `neck_height`. Open at the neck's end, or, with `has_cap`, closed there by a cap joined to the neck
/// (Part::cap: its own look, the same shell).
struct OrnamentSizes {
  double radius = 0.04;        // m
  double neck_radius = 0.009;  // m
  double neck_height = 0.008;  // m
  bool has_cap = false;
};
core::Result<PartedMesh> make_ornament(const OrnamentSizes& sizes, const Meshing& meshing);

/// The ornament's metal cap as a mesh of its own, in the ornament's coordinates: a cup over the neck that
/// keeps `clearance` from it, and a wire loop on top (Part::loop; a loose part: allow it when mending).
core::Result<PartedMesh> make_ornament_cap(const OrnamentSizes& sizes, double clearance,
                                           const Meshing& meshing);

/// A pot: raised floor, foot ring at y = 0, curved wall, open rim at y = height. One sheet; thickness is a
/// number.
struct BowlSizes {
  double rim_radius = 0.08;    // m
  double foot_radius = 0.035;  // m, of the ring it stands on
  double foot_height = 0.006;  // m, of the floor above the foot; 0: flat
  double height = 0.07;        // m
};
core::Result<TriangleMesh> make_bowl(const BowlSizes& sizes, const Meshing& meshing);

/// Rectangle in the plane z = 0 about the origin, normal +z; width along x, height along y. Its border is
/// straight to the bit.
core::Result<TriangleMesh> make_pane(double width, double height, const Meshing& meshing);

/// The surface of a box about the origin: its eight corners and twelve triangles.
TriangleMesh make_box_surface(const Vec3& half_extent);

/// A capsule about the y axis, or, if half_length is 0, a sphere, as a polyhedron of `around` sides whose
/// corners lie on it: what takes surfaces only, as exports do, sees it so.
TriangleMesh make_capsule_surface(double radius, double half_length, int around = 32);

/// A vase with a wall: foot on y = 0, belly, neck, flared rim with a round lip; closed, for solids. Finer
/// than twice the wall, whatever `meshing` says, so that the two sides of the wall keep apart.
struct VaseSizes {
  double height = 0.25;         // m, to the top of the lip
  double foot_radius = 0.045;   // m
  double belly_radius = 0.075;  // m, at a third of the height
  double neck_radius = 0.03;    // m, at four fifths of it
  double rim_radius = 0.042;    // m
  double wall = 0.006;          // m, of the wall (measured along the radius) and of the floor
};
core::Result<TriangleMesh> make_vase(const VaseSizes& sizes, const Meshing& meshing);

/// Outer side and bottom of the same as one sheet, open at its rim on y = height, for shells; without `wall`.
core::Result<TriangleMesh> make_vase_sheet(const VaseSizes& sizes, const Meshing& meshing);

/// A bottle with a wall: flat bottom with a rounded edge on y = 0, straight body, shoulder, straight neck
/// with a round lip; closed, for solids. Finer than twice the wall, as a vase.
struct BottleSizes {
  double height = 0.3;         // m, to the top of the lip
  double radius = 0.037;       // m, of the body
  double neck_radius = 0.014;  // m
  double neck_length = 0.08;   // m
  double wall = 0.004;         // m, of the wall (along the radius); the floor has twice that
};
core::Result<TriangleMesh> make_bottle(const BottleSizes& sizes, const Meshing& meshing);

/// Outer side and bottom of the same as one sheet, open at the top, for shells; `wall` rounds its edge only.
core::Result<TriangleMesh> make_bottle_sheet(const BottleSizes& sizes, const Meshing& meshing);

/// A stemmed glass: foot on y = 0, stem, bowl, open rim at y = height. One sheet; the stem is a tube, open to
/// the bowl and below the foot.
struct WineGlassSizes {
  double height = 0.2;         // m
  double radius = 0.04;        // m, of the bowl where it is widest
  double rim_radius = 0.032;   // m
  double foot_radius = 0.035;  // m
  double stem_radius = 0.004;  // m
  double stem_length = 0.085;  // m, from the table to where the bowl begins
};
core::Result<TriangleMesh> make_wine_glass(const WineGlassSizes& sizes, const Meshing& meshing);

/// An egg: half an ellipsoid above the plane y = 0 and a longer or shorter half below; closed.
struct EggSizes {
  double radius = 0.022;          // m, at y = 0, where it is widest
  double blunt_height = 0.025;    // m, below
  double pointed_height = 0.032;  // m, above
};
core::Result<TriangleMesh> make_egg(const EggSizes& sizes, const Meshing& meshing);

/// What is turned on a lathe: a column, a plate, a cup, a ring. Closed, it is finer than twice its wall, as a
/// vase.
struct LatheSizes {
  /// (radius, height), m: from one end to the other, either way round. Only the ends may be on the axis; the
  /// last may be the first, which makes a ring.
  std::vector<Vec2> profile;
  bool is_smooth = false;  // the curve that rounds all corners: a quadratic B-spline of the points
  bool is_closed = false;  // ends that are not on the axis are joined to it by discs; for solids
};
/// What is wrong with it, or nothing.
std::optional<std::string> find_fault(const LatheSizes& sizes);
core::Result<TriangleMesh> make_lathe(const LatheSizes& sizes, const Meshing& meshing);

/// An upright animal in bands of armour: feet on y = 0, looking along z, 0.85 as wide as high. From an
/// implicit surface; closed. Edges are at most an eightieth of its height; `Meshing::jitter` and `seed` do
/// not apply.
core::Result<TriangleMesh> make_figure(double height, const Meshing& meshing);

/// An open hull, double-ended: keel along x through the origin's height, bow at +x, gunwales up. A lattice of
/// stations and strakes, the same on all four quarters; `Meshing::jitter` and `seed` do not apply. An edge
/// length of 1/15 of the usual length gives 300 triangles. One sheet; thickness is a number.
struct BoatSizes {
  double length = 1.0;  // m, over both stems
  double beam = 0.4;    // m, amidships
  double depth = 0.2;   // m, from keel to gunwale amidships
  double sheer = 0.1;   // m, by which the gunwales rise towards the ends
};
core::Result<TriangleMesh> make_boat(const BoatSizes& sizes, const Meshing& meshing);

/// A piece of a profile in the half plane (r >= 0, y): a straight line, an arc of a circle or a parabola.
struct ProfileSegment {
  enum class Kind : std::uint8_t { line, arc, parabola };
  Kind kind = Kind::line;
  Vec2 from = Vec2::Zero();
  Vec2 to = Vec2::Zero();
  Vec2 centre =
      Vec2::Zero();  // arc: the circle's centre (the shorter way round); parabola: the control point
  Part part = Part::body;
};

/// Turns a profile about the y axis. Segments follow each other; only the ends of the whole may touch the
/// axis, or, away from it, each other: a ring. The rings where segments meet are kept as edges. Faces look to
/// the right of the profile's direction: a profile that goes up has its faces outside.
core::Result<PartedMesh> make_surface_of_revolution(const std::vector<ProfileSegment>& profile,
                                                    const Meshing& meshing);

/// Torus about the y axis in the plane y = 0: a wire of `wire_radius` bent to a ring of `ring_radius` (>
/// wire_radius).
core::Result<TriangleMesh> make_torus(double ring_radius, double wire_radius, const Meshing& meshing);

/// Least angle of any triangle, radians: the measure of how well-shaped a mesh is. 0 without triangles.
double least_angle(const TriangleMesh& mesh);

}  // namespace shatterbox::geometry
