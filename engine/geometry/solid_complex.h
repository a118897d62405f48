// The material of a solid as a complex of polyhedra: cells (parts of one element's material) bounded by
// plane, convex facets over common edges and vertices. A facet is shared by the two cells on its sides, an
// edge by all its facets: what divides one of them divides it for all, so a cut leaves no T-junction and
// every cell stays closed, by counting alone.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/solid_mesh.h"

namespace shatterbox::geometry {

enum class FacetKind : std::uint8_t {
  element_face,  // on the face between two elements: material goes on
  outer,         // the surface of the uncut solid
  crack,         // open: material is parted
  old_crack,     // a crack face of the border, from which the surface has stood back (keep_kerf)
  grain,         // a boundary that holds: between grains, or between parts that were merged again
};

/// A point of the complex: a mean of corners ("nodes") of one element, only those with a weight.
struct SolidVertex {
  Vec3 position = Vec3::Zero();               // m, material space
  std::array<int, 4> nodes{-1, -1, -1, -1};   // ascending, then -1; vertices of the element mesh
  std::array<double, 4> weights{0, 0, 0, 0};  // positive, sum 1; 0 where there is no node
  Vec3 kerf = Vec3::Zero();                   // m: from here to where the piece's surface has it (keep_kerf)
  bool has_kerf = false;
};

struct SolidEdge {
  std::array<int, 2> ends{};         // vertices
  std::array<int, 2> parts{-1, -1};  // edges it was divided into: from ends[0], to ends[1]; or -1
};

struct SolidFacet {
  int first_side = 0, side_count = 0;  // in `sides`; counter-clockwise seen from in front
  std::array<int, 2> cells{-1, -1};    // behind and in front; -1: nothing
  FacetKind kind = FacetKind::element_face;
  std::int16_t plane = -1;           // crack: those of one tag and number here lie in one plane; -1: alone
  int tag = -1;                      // outer: number of the given triangle; crack, grain: of the cut
  std::array<int, 2> parts{-1, -1};  // facets it was divided into, or -1
};

struct SolidPart {
  int element = 0;
  int grain = -1;                        // number of the grain, -1 without grains
  int first_facet = 0, facet_count = 0;  // in `cell_facets`
  bool is_measured = false;              // volume and centroid are known
  double volume = 0.0;                   // m3; of what is narrower than the cuts' snapping hardly below zero
  Vec3 centroid = Vec3::Constant(0.25);  // as in SolidCell
};

/// A facet of a crack with material on both of its sides.
inline bool is_open_crack(const SolidFacet& facet) {
  return facet.parts[0] < 0 && facet.kind == FacetKind::crack && facet.cells[0] >= 0 && facet.cells[1] >= 0;
}

/// Edges and facets that were divided stay, with their parts; lists that name them are brought up to date
/// when they are read (settle_facet, settle_cell).
struct SolidComplex {
  std::shared_ptr<const SolidElements> elements;
  std::vector<SolidVertex> vertices;
  std::vector<SolidEdge> edges;
  std::vector<int> sides;  // 2 * edge, + 1 where the edge is run backwards
  std::vector<SolidFacet> facets;
  std::vector<int> cell_facets;  // 2 * facet, + 1 where the cell is in front of the facet
  std::vector<SolidPart> cells;

  /// The vertices where a side (2 * edge + direction) begins and ends.
  int side_begin(int side) const { return edges[at_(side / 2)].ends[at_(side % 2)]; }
  int side_end(int side) const { return edges[at_(side / 2)].ends[at_(1 - side % 2)]; }
  const int* sides_of(const SolidFacet& facet) const { return sides.data() + facet.first_side; }
  const Vec3& position(int vertex) const { return vertices[at_(vertex)].position; }

 private:
  static constexpr std::size_t at_(int i) { return static_cast<std::size_t>(i); }
};

/// A plane, convex polygon of the material's border or between two cells, for build_solid_complex.
struct FacetLoop {
  int first_corner = 0, corner_count = 0;  // in `corners`; counter-clockwise seen from in front
  std::array<int, 2> cells{-1, -1};        // behind (its outward normal is the polygon's) and in front; or -1
  FacetKind kind = FacetKind::element_face;
  int tag = -1;  // as in SolidFacet
};

/// A solid's material as polygons: what it takes to embed a surface in elements that reach beyond it. Each
/// cell is the closed polyhedron of its facets, each a connected part of one element's material, not
/// necessarily convex. A polygon names all vertices on its border, also those that only its neighbours need.
struct SolidMaterial {
  std::vector<SolidVertex> vertices;
  std::vector<int> corners;        // vertices of the loops
  std::vector<FacetLoop> facets;   // no two facets, or sides of them, overlap
  std::vector<int> cell_elements;  // per cell: its element
};

/// The complex of tetrahedra that are full of material: one cell each, of the element's number. Facets of the
/// border are `outer`, tagged with the triangle of boundary_surface(mesh, topology).
SolidComplex make_solid_complex(std::shared_ptr<const SolidElements> elements);

/// The complex of material that fills its elements in part.
SolidComplex build_solid_complex(std::shared_ptr<const SolidElements> elements,
                                 const SolidMaterial& material);

/// Parts a settled facet along a new edge between two of its corners (places `begin` < `end` in its list of
/// sides, which goes round): its first part has the sides from `begin` on, its second the others. Returns the
/// parts.
std::array<int, 2> divide_facet(SolidComplex& complex, int facet, int begin, int end);

/// Puts the parts of divided edges in a facet's list of sides.
void settle_facet(SolidComplex& complex, int facet);

/// Puts the parts of divided facets in a cell's list of facets; settle_cell settles these, too.
void settle_facet_list(SolidComplex& complex, int cell);
void settle_cell(SolidComplex& complex, int cell);

/// Area vector of a settled facet, m2: its normal, pointing to the front, times its area.
Vec3 facet_area_vector(const SolidComplex& complex, const SolidFacet& facet);

/// Numbers of the facets with nothing on one of their sides, ascending.
std::vector<int> find_border_facets(const SolidComplex& complex);

/// Centroid of a measured cell, m.
Vec3 cell_centre(const SolidComplex& complex, const SolidPart& cell);

/// Settles all facets and cells and makes all volumes and centroids known.
void settle(SolidComplex& complex);

/// Sum of the cells' volumes, m3, of a settled complex.
double total_volume(const SolidComplex& complex);

/// Nodes of the complex's elements at which there is none of its material: it lies beyond a cut, or beyond
/// the surface that was embedded.
int count_virtual_nodes(const SolidComplex& complex);

/// Takes pieces out of a settled complex; what it needs for that is made once.
class PieceExtractor {
 public:
  explicit PieceExtractor(const SolidComplex& complex);

  /// The part of the complex that consists of some of its cells, numbered anew in their order. Facets towards
  /// other cells have nothing there any more.
  SolidComplex extract(const std::vector<int>& cells);

 private:
  struct Number {
    int stamp = 0, value = 0;
  };

  int copy_facet(int number, SolidComplex& out);
  int copy_edge(int number, SolidComplex& out);

  const SolidComplex& complex_;
  std::vector<Number> vertices_, edges_, facets_;  // in the piece that is being taken out
  int stamp_ = 0;
};

/// True if every settled cell is closed: its facets' sides cancel in pairs. For tests and assertions.
bool are_cells_closed(const SolidComplex& complex);

}  // namespace shatterbox::geometry
