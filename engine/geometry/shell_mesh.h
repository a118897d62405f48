// A shell that may be cut: the material of well-shaped triangles ("elements"), divided into convex cells.
// Each cell owns a copy of its element's degrees of freedom (three vertices, three edge rotations); copies of
// neighbouring cells are one where their material touches along an element's edge. This is the virtual node
// algorithm on triangles [MBF04], applied to Morley's element as well.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/edge_topology.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// The uncut triangles of a shell in material space (the body space of the unbroken body). Never changed;
/// shared by all pieces that come from it.
struct ShellElements {
  TriangleMesh mesh;
  EdgeTopology topology;
};

/// The frame in which an element's strains and stresses are given: columns e1 (along its edge 0), e2 = n x
/// e1, n.
Mat3 facet_frame(const ShellElements& elements, int element);

/// Area of an element, m2.
double element_area(const ShellElements& elements, int element);

enum class SideKind : std::uint8_t {
  element_edge,  // on an edge of the element: the neighbour's material may go on
  crack,         // an open crack face
  grain,  // a grain boundary that is still closed: material goes on in another cell of the same element
};

/// A corner of a cell's polygon together with the side that leaves it, counter-clockwise.
struct ShellCorner {
  Vec2 barycentric = Vec2::Zero();  // weights of the element's corners 1 and 2; corner 0 has 1 - sum
  SideKind side = SideKind::element_edge;
  int side_id =
      0;  // element_edge: 0, 1 or 2; crack and grain: number of the cut, the same on both of its faces
};

/// A convex piece of one element's material.
struct ShellCell {
  int element = 0;
  std::array<int, 3> vertices{};  // degrees of freedom: virtual vertices at the element's corners
  std::array<int, 3>
      edges{};        // degrees of freedom: virtual edges, edge i from corner i to corner (i + 1) % 3
  double area = 0.0;  // m2, of the polygon
  int grain = -1;     // number of the grain, -1 without grains
  int first_corner = 0;
  int corner_count = 0;
};

struct ShellMesh {
  std::shared_ptr<const ShellElements> elements;
  std::vector<ShellCell> cells;
  std::vector<ShellCorner> corners;
  std::vector<int> vertex_source;  // |V|: the element mesh's vertex that a virtual vertex is a copy of
  std::vector<int> edge_source;    // |E|: the element mesh's edge that a virtual edge is a copy of

  int degree_of_freedom_count() const {
    return 3 * static_cast<int>(vertex_source.size()) + static_cast<int>(edge_source.size());
  }
};

/// Two cells whose material touches, along `length` metres of an element's edge or a closed facet inside an
/// element.
struct CellContact {
  int cell_a = 0, cell_b = 0;
  int side_a = 0, side_b = 0;  // number of the polygon's side in each cell
  double length = 0.0;         // m
};

/// The uncut shell: one cell a triangle.
ShellMesh make_shell_mesh(std::shared_ptr<const ShellElements> elements);

/// Parameter of a point on an element's edge `local_edge` (0, 1, 2), from the edge's lower-numbered vertex.
/// Both elements of an edge read the same number for a point that was made from a rounded parameter.
double edge_parameter(const ShellElements& elements, int element, int local_edge, const Vec2& barycentric);

/// The point with that parameter on an element's edge.
Vec2 barycentric_on_edge(const ShellElements& elements, int element, int local_edge, double parameter);

/// A parameter rounded to a multiple of 2^-40, so that 1 - parameter is exact and both elements of an edge
/// agree to the bit on the point.
double round_edge_parameter(double parameter);

/// Area of a cell's polygon as a share of its element's.
double area_fraction(const ShellMesh& mesh, const ShellCell& cell);

/// The same cells on elements of the same numbers that lie elsewhere.
ShellMesh on_elements(const ShellMesh& mesh, std::shared_ptr<const ShellElements> elements);

/// Sum of the cells' areas, m2.
double total_area(const ShellMesh& mesh);

/// Virtual vertices at which there is none of the mesh's material: it lies beyond a cut.
int count_virtual_vertices(const ShellMesh& mesh);

/// Position in material space of barycentric weights (of corners 1 and 2) in an element.
Vec3 position_in_element(const ShellElements& elements, int element, const Vec2& barycentric);

/// All pairs of cells whose material touches by more than `tolerance` (relative to the edge's length), in a
/// total order.
std::vector<CellContact> find_cell_contacts(const ShellMesh& mesh, double tolerance = 1e-6);

/// Gives every cell its virtual vertices and edges: copies of two cells become one where `contacts` says so.
/// Numbers follow the order of the cells.
void assign_degrees_of_freedom(ShellMesh& mesh, const std::vector<CellContact>& contacts);

}  // namespace shatterbox::geometry
