#include "engine/geometry/solid_complex.h"

#include <algorithm>
#include <cassert>

#include "engine/core/index.h"
#include "engine/core/parallel.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kNoVolume = 1e-14;  // of an element's: a cell below has no centroid of its own

/// Appends the undivided parts of a side, in its direction.
void append_side(const SolidComplex& complex, int side, std::vector<int>& out) {
  const SolidEdge& edge = complex.edges[at(side / 2)];
  if (edge.parts[0] < 0) {
    out.push_back(side);
    return;
  }
  const int back = side % 2;
  append_side(complex, 2 * edge.parts[at(back)] + back, out);
  append_side(complex, 2 * edge.parts[at(1 - back)] + back, out);
}

void append_facet(const SolidComplex& complex, int facet_side, std::vector<int>& out) {
  const SolidFacet& facet = complex.facets[at(facet_side / 2)];
  if (facet.parts[0] < 0) {
    out.push_back(facet_side);
    return;
  }
  for (const int part : facet.parts) append_facet(complex, 2 * part + facet_side % 2, out);
}

/// Adds six times the volume of the cone from `apex` to the facet, fanned out from its first corner, and 24
/// times its first moment about the apex.
void add_cone(const SolidComplex& complex, const SolidFacet& facet, const Vec3& apex, double sign,
              double& volume, Vec3& moment) {
  const int* sides = complex.sides_of(facet);
  const Vec3 first = complex.position(complex.side_begin(sides[0])) - apex;
  Vec3 previous = complex.position(complex.side_end(sides[0])) - apex;
  for (int i = 1; i + 1 < facet.side_count; ++i) {
    const Vec3 next = complex.position(complex.side_end(sides[i])) - apex;
    const double part = sign * first.dot(previous.cross(next));
    volume += part;
    moment += part * (first + previous + next);
    previous = next;
  }
}

struct Moments {
  Vec3 apex = Vec3::Zero();          // a vertex of the cell, so that small cells lose no digits
  double volume = 0.0;               // m3
  Vec3 first_moment = Vec3::Zero();  // about the apex, m4
};

Moments cell_moments(const SolidComplex& complex, int number) {
  const SolidPart& cell = complex.cells[at(number)];
  const int* facets = complex.cell_facets.data() + cell.first_facet;
  Moments moments;
  moments.apex = complex.position(complex.side_begin(complex.sides_of(complex.facets[at(facets[0] / 2)])[0]));
  for (int i = 0; i < cell.facet_count; ++i)
    add_cone(complex, complex.facets[at(facets[i] / 2)], moments.apex, facets[i] % 2 == 0 ? 1.0 : -1.0,
             moments.volume, moments.first_moment);
  moments.volume /= 6.0;
  moments.first_moment /= 24.0;
  return moments;
}

/// Makes the volume and the centroid of a settled cell known.
void measure_cell(SolidComplex& complex, int number) {
  SolidPart& cell = complex.cells[at(number)];
  const Moments moments = cell_moments(complex, number);
  const Tetrahedron& nodes = complex.elements->mesh.tetrahedra[at(cell.element)];
  const std::vector<Vec3>& x = complex.elements->mesh.positions;
  const Vec3 a = x[at(nodes[1])] - x[at(nodes[0])];
  const Vec3 b = x[at(nodes[2])] - x[at(nodes[0])];
  const Vec3 c = x[at(nodes[3])] - x[at(nodes[0])];
  const double whole = a.dot(b.cross(c));
  cell.is_measured = true;
  cell.volume = moments.volume;
  Vec3 centroid = moments.apex - x[at(nodes[0])];
  if (moments.volume > kNoVolume * whole) centroid += moments.first_moment / moments.volume;
  cell.centroid = Vec3(centroid.dot(b.cross(c)), centroid.dot(c.cross(a)), centroid.dot(a.cross(b))) / whole;
}

SolidVertex node_vertex(const TetMesh& mesh, int node) {
  SolidVertex vertex;
  vertex.position = mesh.positions[at(node)];
  vertex.nodes[0] = node;
  vertex.weights[0] = 1.0;
  return vertex;
}

/// Lists, per cell, its facets in ascending order.
void collect_cell_facets(SolidComplex& complex) {
  for (SolidPart& cell : complex.cells) cell.facet_count = 0;
  for (const SolidFacet& facet : complex.facets)
    for (const int cell : facet.cells)
      if (cell >= 0) ++complex.cells[at(cell)].facet_count;
  int first = 0;
  for (SolidPart& cell : complex.cells) {
    cell.first_facet = first;
    first += cell.facet_count;
    cell.facet_count = 0;
  }
  complex.cell_facets.resize(at(first));
  for (Size f = 0; f < complex.facets.size(); ++f)
    for (int side = 0; side < 2; ++side) {
      const int number = complex.facets[f].cells[at(side)];
      if (number < 0) continue;
      SolidPart& cell = complex.cells[at(number)];
      complex.cell_facets[at(cell.first_facet + cell.facet_count++)] = 2 * static_cast<int>(f) + side;
    }
}

bool has_divided_edge(const SolidComplex& complex, const SolidFacet& facet) {
  const int* sides = complex.sides_of(facet);
  return std::any_of(sides, sides + facet.side_count,
                     [&](int side) { return complex.edges[at(side / 2)].parts[0] >= 0; });
}

bool has_divided_facet(const SolidComplex& complex, const SolidPart& cell) {
  const int* facets = complex.cell_facets.data() + cell.first_facet;
  return std::any_of(facets, facets + cell.facet_count,
                     [&](int facet) { return complex.facets[at(facet / 2)].parts[0] >= 0; });
}

}  // namespace

SolidComplex make_solid_complex(std::shared_ptr<const SolidElements> elements) {
  SolidComplex complex;
  const TetMesh& mesh = elements->mesh;
  const TetTopology& topology = elements->topology;
  complex.vertices.reserve(mesh.positions.size());
  for (Size v = 0; v < mesh.positions.size(); ++v)
    complex.vertices.push_back(node_vertex(mesh, static_cast<int>(v)));
  complex.edges.reserve(topology.edges.size());
  for (const auto& ends : topology.edges) complex.edges.push_back({ends, {-1, -1}});
  complex.facets.resize(topology.faces.size());
  complex.sides.resize(3 * topology.faces.size());
  complex.cells.resize(mesh.tetrahedra.size());
  complex.cell_facets.resize(4 * mesh.tetrahedra.size());
  int border_count = 0;
  for (Size t = 0; t < mesh.tetrahedra.size(); ++t) {
    const Tetrahedron& corners = mesh.tetrahedra[t];
    complex.cells[t] = {static_cast<int>(t),
                        -1,
                        4 * static_cast<int>(t),
                        4,
                        true,
                        tetrahedron_volume(mesh, static_cast<int>(t)),
                        Vec3::Constant(0.25)};
    for (Size f = 0; f < 4; ++f) {
      const int number = topology.tetrahedron_faces[t][f];
      SolidFacet& facet = complex.facets[at(number)];
      const bool is_first = topology.face_tetrahedra[at(number)][0] == static_cast<int>(t);
      complex.cell_facets[4 * t + f] = 2 * number + (is_first ? 0 : 1);
      facet.cells[is_first ? 0 : 1] = static_cast<int>(t);
      if (!is_first) continue;
      facet.first_side = 3 * number;
      facet.side_count = 3;
      if (topology.face_tetrahedra[at(number)][1] < 0) {
        facet.kind = FacetKind::outer;
        facet.tag = border_count++;
      }
      for (Size k = 0; k < 3; ++k) {
        const int a = kTetrahedronFaces[f][k];
        const int b = kTetrahedronFaces[f][(k + 1) % 3];
        Size e = 0;
        while (kTetrahedronEdges[e] != std::array{std::min(a, b), std::max(a, b)}) ++e;
        complex.sides[at(3 * number) + k] =
            2 * topology.tetrahedron_edges[t][e] + (corners[at(a)] < corners[at(b)] ? 0 : 1);
      }
    }
  }
  complex.elements = std::move(elements);
  return complex;
}

SolidComplex build_solid_complex(std::shared_ptr<const SolidElements> elements,
                                 const SolidMaterial& material) {
  SolidComplex complex;
  complex.elements = std::move(elements);
  complex.vertices = material.vertices;
  struct Side {
    std::array<int, 2> ends;
    int place;  // in `sides`
  };
  std::vector<Side> found;
  for (const FacetLoop& loop : material.facets) {
    complex.facets.push_back(
        {static_cast<int>(found.size()), loop.corner_count, loop.cells, loop.kind, -1, loop.tag, {-1, -1}});
    for (int i = 0; i < loop.corner_count; ++i) {
      const int a = material.corners[at(loop.first_corner + i)];
      const int b = material.corners[at(loop.first_corner + (i + 1) % loop.corner_count)];
      complex.sides.push_back(a < b ? 0 : 1);
      found.push_back({{std::min(a, b), std::max(a, b)}, static_cast<int>(found.size())});
    }
  }
  std::sort(found.begin(), found.end(), [](const Side& a, const Side& b) {
    return a.ends != b.ends ? a.ends < b.ends : a.place < b.place;
  });
  for (const Side& side : found) {
    if (complex.edges.empty() || complex.edges.back().ends != side.ends)
      complex.edges.push_back({side.ends, {-1, -1}});
    complex.sides[at(side.place)] += 2 * (static_cast<int>(complex.edges.size()) - 1);
  }
  for (const int element : material.cell_elements)
    complex.cells.push_back({element, -1, 0, 0, false, 0.0, Vec3::Constant(0.25)});
  collect_cell_facets(complex);
  settle(complex);
  return complex;
}

std::array<int, 2> divide_facet(SolidComplex& complex, int number, int begin, int end) {
  const SolidFacet facet = complex.facets[at(number)];
  const int n = facet.side_count;
  const auto corner = [&](int i) { return complex.side_begin(complex.sides[at(facet.first_side + i % n)]); };
  const int chord = static_cast<int>(complex.edges.size());
  complex.edges.push_back({{corner(begin), corner(end)}, {-1, -1}});
  std::array<int, 2> parts{};
  for (Size p = 0; p < 2; ++p) {
    SolidFacet part = facet;
    part.first_side = static_cast<int>(complex.sides.size());
    for (int i = p == 0 ? begin : end; i < (p == 0 ? end : begin + n); ++i)
      complex.sides.push_back(int(complex.sides[at(facet.first_side + i % n)]));
    complex.sides.push_back(2 * chord + (p == 0 ? 1 : 0));
    part.side_count = static_cast<int>(complex.sides.size()) - part.first_side;
    parts[p] = static_cast<int>(complex.facets.size());
    complex.facets.push_back(part);
  }
  complex.facets[at(number)].parts = parts;
  return parts;
}

void settle_facet(SolidComplex& complex, int number) {
  SolidFacet& facet = complex.facets[at(number)];
  const int old = facet.first_side;
  if (!has_divided_edge(complex, facet)) return;
  facet.first_side = static_cast<int>(complex.sides.size());
  for (int i = 0; i < facet.side_count; ++i) append_side(complex, complex.sides[at(old + i)], complex.sides);
  facet.side_count = static_cast<int>(complex.sides.size()) - facet.first_side;
}

void settle_facet_list(SolidComplex& complex, int number) {
  SolidPart& cell = complex.cells[at(number)];
  const int old = cell.first_facet;
  if (!has_divided_facet(complex, cell)) return;
  cell.first_facet = static_cast<int>(complex.cell_facets.size());
  for (int i = 0; i < cell.facet_count; ++i)
    append_facet(complex, complex.cell_facets[at(old + i)], complex.cell_facets);
  cell.facet_count = static_cast<int>(complex.cell_facets.size()) - cell.first_facet;
}

void settle_cell(SolidComplex& complex, int number) {
  settle_facet_list(complex, number);
  const SolidPart& cell = complex.cells[at(number)];
  for (int i = 0; i < cell.facet_count; ++i)
    settle_facet(complex, complex.cell_facets[at(cell.first_facet + i)] / 2);
}

Vec3 facet_area_vector(const SolidComplex& complex, const SolidFacet& facet) {
  const int* sides = complex.sides_of(facet);
  const Vec3& origin = complex.position(complex.side_begin(sides[0]));
  Vec3 previous = complex.position(complex.side_end(sides[0])) - origin;
  Vec3 twice = Vec3::Zero();
  for (int i = 1; i + 1 < facet.side_count; ++i) {
    const Vec3 next = complex.position(complex.side_end(sides[i])) - origin;
    twice += previous.cross(next);
    previous = next;
  }
  return 0.5 * twice;
}

std::vector<int> find_border_facets(const SolidComplex& complex) {
  constexpr Size kGrain = 8192;
  return core::find_where(complex.facets.size(), kGrain, [&](Size f) {
    const SolidFacet& facet = complex.facets[f];
    return facet.parts[0] < 0 && (facet.cells[0] < 0) != (facet.cells[1] < 0);
  });
}

void settle(SolidComplex& complex) {
  // Few have changed: they are found on all threads, and settled one after the other.
  constexpr Size kGrain = 8192;
  const auto stale_facets = core::find_where(complex.facets.size(), kGrain, [&](Size f) {
    return complex.facets[f].parts[0] < 0 && has_divided_edge(complex, complex.facets[f]);
  });
  for (const int f : stale_facets) settle_facet(complex, f);
  const auto stale_cells = core::find_where(
      complex.cells.size(), kGrain, [&](Size c) { return has_divided_facet(complex, complex.cells[c]); });
  for (const int c : stale_cells) settle_facet_list(complex, c);
  core::parallel_for(complex.cells.size(), 1024, [&](Size c) {
    if (!complex.cells[c].is_measured) measure_cell(complex, static_cast<int>(c));
  });
}

Vec3 cell_centre(const SolidComplex& complex, const SolidPart& cell) {
  const TetMesh& mesh = complex.elements->mesh;
  const Tetrahedron& t = mesh.tetrahedra[at(cell.element)];
  const Vec3& origin = mesh.positions[at(t[0])];
  Vec3 centre = origin;
  for (int i = 0; i < 3; ++i) centre += cell.centroid(i) * (mesh.positions[at(t[at(i + 1)])] - origin);
  return centre;
}

double total_volume(const SolidComplex& complex) {
  double sum = 0.0;
  for (const SolidPart& cell : complex.cells) sum += cell.volume;
  return sum;
}

int count_virtual_nodes(const SolidComplex& complex) {
  const TetMesh& mesh = complex.elements->mesh;
  std::vector<char> state(mesh.positions.size(), 0);  // 1: of an element here; 2: material
  for (const SolidPart& cell : complex.cells)
    for (const int node : mesh.tetrahedra[at(cell.element)]) state[at(node)] = 1;
  for (const SolidVertex& vertex : complex.vertices)
    if (vertex.nodes[0] >= 0 && vertex.nodes[1] < 0) state[at(vertex.nodes[0])] = 2;
  return static_cast<int>(std::count(state.begin(), state.end(), 1));
}

PieceExtractor::PieceExtractor(const SolidComplex& complex)
    : complex_(complex),
      vertices_(complex.vertices.size()),
      edges_(complex.edges.size()),
      facets_(complex.facets.size()) {}

SolidComplex PieceExtractor::extract(const std::vector<int>& cells) {
  SolidComplex out;
  out.elements = complex_.elements;
  ++stamp_;
  for (Size c = 0; c < cells.size(); ++c) {
    SolidPart cell = complex_.cells[at(cells[c])];
    const int* facets = complex_.cell_facets.data() + cell.first_facet;
    cell.first_facet = static_cast<int>(out.cell_facets.size());
    for (int i = 0; i < cell.facet_count; ++i) {
      const int number = copy_facet(facets[i] / 2, out);
      out.facets[at(number)].cells[at(facets[i] % 2)] = static_cast<int>(c);
      out.cell_facets.push_back(2 * number + facets[i] % 2);
    }
    out.cells.push_back(cell);
  }
  return out;
}

int PieceExtractor::copy_facet(int number, SolidComplex& out) {
  Number& own = facets_[at(number)];
  if (own.stamp == stamp_) return own.value;
  own = {stamp_, static_cast<int>(out.facets.size())};
  SolidFacet facet = complex_.facets[at(number)];
  const int* sides = complex_.sides_of(facet);
  facet.first_side = static_cast<int>(out.sides.size());
  for (int k = 0; k < facet.side_count; ++k)
    out.sides.push_back(2 * copy_edge(sides[k] / 2, out) + sides[k] % 2);
  facet.cells = {-1, -1};
  out.facets.push_back(facet);
  return own.value;
}

int PieceExtractor::copy_edge(int number, SolidComplex& out) {
  Number& own = edges_[at(number)];
  if (own.stamp == stamp_) return own.value;
  own = {stamp_, static_cast<int>(out.edges.size())};
  SolidEdge edge = complex_.edges[at(number)];
  for (int& v : edge.ends) {
    Number& vertex = vertices_[at(v)];
    if (vertex.stamp != stamp_) {
      vertex = {stamp_, static_cast<int>(out.vertices.size())};
      out.vertices.push_back(complex_.vertices[at(v)]);
    }
    v = vertex.value;
  }
  out.edges.push_back(edge);
  return own.value;
}

bool are_cells_closed(const SolidComplex& complex) {
  std::vector<int> balance(complex.edges.size(), 0);
  for (Size c = 0; c < complex.cells.size(); ++c) {
    const SolidPart& cell = complex.cells[c];
    const auto visit = [&](int sign, auto&& action) {
      for (int i = 0; i < cell.facet_count; ++i) {
        const int facet = complex.cell_facets[at(cell.first_facet + i)];
        const SolidFacet& f = complex.facets[at(facet / 2)];
        if (f.cells[at(facet % 2)] != static_cast<int>(c)) return false;
        for (int k = 0; k < f.side_count; ++k) {
          const int side = complex.sides_of(f)[k];
          action(balance[at(side / 2)], sign * ((side + facet) % 2 == 0 ? 1 : -1));
        }
      }
      return true;
    };
    bool is_closed = visit(1, [](int& count, int step) { count += step; });
    visit(1, [&](int& count, int) {
      is_closed = is_closed && count == 0;
      count = 0;
    });
    if (!is_closed) return false;
  }
  return true;
}

}  // namespace shatterbox::geometry
