// Small meshes with closed-form answers for the tests of stress.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "engine/core/elementary.h"
#include "engine/core/random.h"
#include "engine/geometry/shell_mesh.h"
#include "engine/stress/shell_stiffness.h"
#include "sandbox/study/shell_models.h"

namespace shatterbox::stress::testing {

using namespace sandbox::study::model;

/// Makes the cells of each element two: cut by the line lambda_1 = share (from edge 0 to edge 1), an open
/// crack. Used on whole columns of elements to cut plates.
inline geometry::ShellMesh cut_between(const geometry::ShellMesh& mesh, double x) {
  using namespace geometry;
  ShellMesh cut;
  cut.elements = mesh.elements;
  for (const ShellCell& cell : mesh.cells) {
    // Both sides of the plane, by clipping the polygon.
    for (const double side : {1.0, -1.0}) {
      ShellCell piece = cell;
      piece.first_corner = static_cast<int>(cut.corners.size());
      piece.corner_count = 0;
      const auto distance = [&](const ShellCorner& corner) {
        return side * (position_in_element(*mesh.elements, cell.element, corner.barycentric).x() - x);
      };
      for (int c = 0; c < cell.corner_count; ++c) {
        const ShellCorner& a = mesh.corners[static_cast<std::size_t>(cell.first_corner + c)];
        const ShellCorner& b =
            mesh.corners[static_cast<std::size_t>(cell.first_corner + (c + 1) % cell.corner_count)];
        const double da = distance(a), db = distance(b);
        if (da > 0.0) {
          cut.corners.push_back(a);
          ++piece.corner_count;
        }
        if ((da > 0.0) != (db > 0.0)) {
          ShellCorner crossing = a;
          crossing.barycentric = a.barycentric + da / (da - db) * (b.barycentric - a.barycentric);
          if (da > 0.0) {  // leaves: the crack begins here
            crossing.side = SideKind::crack;
            crossing.side_id = 0;
          }
          cut.corners.push_back(crossing);
          ++piece.corner_count;
        }
      }
      if (piece.corner_count < 3) {
        cut.corners.resize(static_cast<std::size_t>(piece.first_corner));
        continue;
      }
      double doubled = 0.0;
      for (int c = 1; c + 1 < piece.corner_count; ++c) {
        const Vec2 o = cut.corners[static_cast<std::size_t>(piece.first_corner)].barycentric;
        const Vec2 p = cut.corners[static_cast<std::size_t>(piece.first_corner + c)].barycentric - o;
        const Vec2 q = cut.corners[static_cast<std::size_t>(piece.first_corner + c + 1)].barycentric - o;
        doubled += p.x() * q.y() - p.y() * q.x();
      }
      piece.area = doubled * element_area(*mesh.elements, cell.element);
      cut.cells.push_back(piece);
    }
  }
  assign_degrees_of_freedom(cut, find_cell_contacts(cut));
  return cut;
}

}  // namespace shatterbox::stress::testing
