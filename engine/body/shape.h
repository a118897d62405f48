// The immutable form of a body, shared by its copies. Body space: origin at the centre of mass, axes of the
// mesh.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/edge_topology.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::body {

enum class ShapeKind : std::uint8_t {
  plane,    // the half space y <= 0 of body space is solid; always static
  box,      // half_extent about the origin
  sphere,   // radius about the origin
  capsule,  // all that is no further than radius from the y axis between -half_length and half_length
  shell,    // an infinitely thin triangle mesh; open or closed
  solid,    // the inside of a closed triangle mesh
};

/// True for what is a triangle mesh to contact, pictures, audit and export.
constexpr bool is_mesh(ShapeKind kind) {
  return kind == ShapeKind::shell || kind == ShapeKind::solid;
}

/// True for what rolls: the material point that touches is another one a moment later.
constexpr bool is_round(ShapeKind kind) {
  return kind == ShapeKind::sphere || kind == ShapeKind::capsule;
}

/// True for what has an inside between faces, edges and corners.
constexpr bool is_closed(ShapeKind kind) {
  return kind == ShapeKind::solid || kind == ShapeKind::box;
}

struct Shape {
  ShapeKind kind = ShapeKind::sphere;
  Vec3 half_extent = Vec3::Zero();  // box, m
  double radius = 0.0;              // sphere and capsule, m
  double half_length = 0.0;         // capsule, m: from its middle to the middle of each round end

  // Shell and solid: the one surface for contact, pictures, audit and export.
  geometry::TriangleMesh surface;         // body space
  geometry::EdgeTopology topology;        // of the surface
  std::vector<std::uint8_t> crack_edges;  // shell, per edge of the surface: 1 on a crack face
  std::vector<std::uint8_t> crack_faces;  // solid, per triangle: 1 on a crack face; empty for none
  std::vector<int> triangle_grains;       // per triangle: number of the grain, -1 without
  std::vector<int> triangle_elements;     // per triangle: element of the stress that is behind it; or empty
  std::vector<std::uint8_t> triangle_parts;  // per triangle: number of the look; empty for all 0
  double thickness = 0.0;                    // m; 0 for solids
  double width = 0.0;                        // m, solid: volume over the two greatest sides of its box

  // Material space is that of the unbroken body: x_material = x_body + material_from_body.
  Vec3 material_from_body = Vec3::Zero();  // m
  double seat = 0.0;  // m: pieces of one body whose common place is so far apart still sit beside each other

  double mass = 0.0;             // kg; 0 for planes
  Mat3 inertia = Mat3::Zero();   // about the centre of mass, body space, kg m2
  double bounding_radius = 0.0;  // about the origin, m; infinite shapes have 0
  double least_gap = 0.0;  // m: this surface was born this close to another one; contact never opens it wider
};

}  // namespace shatterbox::body
