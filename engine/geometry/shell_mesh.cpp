#include "engine/geometry/shell_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/core/disjoint_sets.h"
#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

/// A side of a cell that lies on an element's edge: the stretch of the edge, from its lower-numbered vertex.
struct Stretch {
  int edge;
  double begin, end;
  int cell, side;
};

/// Sorts by an integer below `count` first, then by `less`; in linear time where there are many items.
template <class Item, class Key, class Less>
void sort_by_key(std::vector<Item>& items, Size count, const Key& key, const Less& less) {
  if (4 * items.size() < count) {
    std::sort(items.begin(), items.end(),
              [&](const Item& a, const Item& b) { return key(a) != key(b) ? key(a) < key(b) : less(a, b); });
    return;
  }
  std::vector<int> first(count + 1, 0);
  for (const Item& item : items) ++first[at(key(item)) + 1];
  for (Size k = 0; k < count; ++k) first[k + 1] += first[k];
  std::vector<Item> sorted(items.size());
  std::vector<int> next = first;
  for (const Item& item : items) sorted[at(next[at(key(item))]++)] = item;
  for (Size k = 0; k < count; ++k)
    if (first[k + 1] - first[k] > 1)
      std::sort(sorted.begin() + first[k], sorted.begin() + first[k + 1], less);
  items = std::move(sorted);
}

std::vector<Stretch> collect_stretches(const ShellMesh& mesh) {
  std::vector<Stretch> stretches;
  const ShellElements& elements = *mesh.elements;
  for (Size c = 0; c < mesh.cells.size(); ++c) {
    const ShellCell& cell = mesh.cells[c];
    for (int s = 0; s < cell.corner_count; ++s) {
      const ShellCorner& corner = mesh.corners[at(cell.first_corner + s)];
      if (corner.side != SideKind::element_edge) continue;
      const ShellCorner& next = mesh.corners[at(cell.first_corner + (s + 1) % cell.corner_count)];
      const double p = edge_parameter(elements, cell.element, corner.side_id, corner.barycentric);
      const double q = edge_parameter(elements, cell.element, corner.side_id, next.barycentric);
      const int edge = elements.topology.triangle_edges[at(cell.element)][at(corner.side_id)];
      stretches.push_back({edge, std::min(p, q), std::max(p, q), static_cast<int>(c), s});
    }
  }
  sort_by_key(
      stretches, elements.topology.edges.size(), [](const Stretch& s) { return s.edge; },
      [](const Stretch& a, const Stretch& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.side < b.side;
      });
  return stretches;
}

double edge_length(const ShellElements& elements, int edge) {
  const auto& ends = elements.topology.edges[at(edge)];
  return (elements.mesh.positions[at(ends[1])] - elements.mesh.positions[at(ends[0])]).norm();
}

void add_edge_contacts(const ShellMesh& mesh, double tolerance, std::vector<CellContact>& contacts) {
  const std::vector<Stretch> stretches = collect_stretches(mesh);
  for (Size first = 0; first < stretches.size();) {
    Size last = first;
    while (last < stretches.size() && stretches[last].edge == stretches[first].edge) ++last;
    const double length = edge_length(*mesh.elements, stretches[first].edge);
    for (Size i = first; i < last; ++i)
      for (Size j = i + 1; j < last; ++j) {
        const Stretch& a = stretches[i];
        const Stretch& b = stretches[j];
        if (mesh.cells[at(a.cell)].element == mesh.cells[at(b.cell)].element) continue;
        const double overlap = std::min(a.end, b.end) - std::max(a.begin, b.begin);
        if (overlap > tolerance) contacts.push_back({a.cell, b.cell, a.side, b.side, overlap * length});
      }
    first = last;
  }
}

/// Closed facets inside an element: sides of one number that run against each other. One cell's side may face
/// parts of several others, where a crack has crossed it.
void add_facet_contacts(const ShellMesh& mesh, double tolerance, std::vector<CellContact>& contacts) {
  struct Facet {
    int element, id, cell, side;
    Vec3 begin, end;
  };
  std::vector<Facet> facets;
  for (Size c = 0; c < mesh.cells.size(); ++c) {
    const ShellCell& cell = mesh.cells[c];
    for (int s = 0; s < cell.corner_count; ++s) {
      const ShellCorner& corner = mesh.corners[at(cell.first_corner + s)];
      if (corner.side != SideKind::grain) continue;
      const ShellCorner& next = mesh.corners[at(cell.first_corner + (s + 1) % cell.corner_count)];
      facets.push_back({cell.element, corner.side_id, static_cast<int>(c), s,
                        position_in_element(*mesh.elements, cell.element, corner.barycentric),
                        position_in_element(*mesh.elements, cell.element, next.barycentric)});
    }
  }
  std::sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) {
    return std::array{a.element, a.id, a.cell, a.side} < std::array{b.element, b.id, b.cell, b.side};
  });
  for (Size i = 0; i < facets.size(); ++i)
    for (Size j = i + 1; j < facets.size(); ++j) {
      const Facet& a = facets[i];
      const Facet& b = facets[j];
      if (a.element != b.element || a.id != b.id) break;
      if (a.cell == b.cell) continue;
      const Vec3 along = a.end - a.begin;
      const double length = along.norm();
      if (!(length > 0.0) || along.dot(b.end - b.begin) >= 0.0) continue;
      const double from = std::max(0.0, along.dot(b.end - a.begin) / length);
      const double to = std::min(length, along.dot(b.begin - a.begin) / length);
      if (to - from > tolerance * length) contacts.push_back({a.cell, b.cell, a.side, b.side, to - from});
    }
}

}  // namespace

Mat3 facet_frame(const ShellElements& elements, int element) {
  const Triangle& t = elements.mesh.triangles[at(element)];
  const Vec3& a = elements.mesh.positions[at(t[0])];
  const Vec3 ab = elements.mesh.positions[at(t[1])] - a;
  const Vec3 ac = elements.mesh.positions[at(t[2])] - a;
  Mat3 frame;
  frame.col(0) = ab.normalized();
  frame.col(2) = ab.cross(ac).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

double element_area(const ShellElements& elements, int element) {
  const Triangle& t = elements.mesh.triangles[at(element)];
  const Vec3& a = elements.mesh.positions[at(t[0])];
  return 0.5 * (elements.mesh.positions[at(t[1])] - a).cross(elements.mesh.positions[at(t[2])] - a).norm();
}

int count_virtual_vertices(const ShellMesh& mesh) {
  std::vector<char> is_material(mesh.vertex_source.size(), 0);
  for (const ShellCell& cell : mesh.cells)
    for (int k = 0; k < cell.corner_count; ++k) {
      const Vec2& b = mesh.corners[at(cell.first_corner + k)].barycentric;
      const Vec3 weights(1.0 - (b.x() + b.y()), b.x(), b.y());
      for (int i = 0; i < 3; ++i)
        if (weights(i) == 1.0) is_material[at(cell.vertices[at(i)])] = 1;
    }
  return static_cast<int>(std::count(is_material.begin(), is_material.end(), 0));
}

Vec3 position_in_element(const ShellElements& elements, int element, const Vec2& barycentric) {
  const Triangle& t = elements.mesh.triangles[at(element)];
  const Vec3& a = elements.mesh.positions[at(t[0])];
  return a + barycentric.x() * (elements.mesh.positions[at(t[1])] - a) +
         barycentric.y() * (elements.mesh.positions[at(t[2])] - a);
}

double edge_parameter(const ShellElements& elements, int element, int local_edge, const Vec2& barycentric) {
  const Triangle& triangle = elements.mesh.triangles[at(element)];
  const std::array<double, 3> weights{1.0 - barycentric.x() - barycentric.y(), barycentric.x(),
                                      barycentric.y()};
  const Size i = at(local_edge);
  const Size j = (i + 1) % 3;
  // The weight of the edge's higher-numbered vertex is the parameter along the edge.
  return triangle[i] < triangle[j] ? weights[j] : weights[i];
}

Vec2 barycentric_on_edge(const ShellElements& elements, int element, int local_edge, double parameter) {
  const Triangle& triangle = elements.mesh.triangles[at(element)];
  const Size i = at(local_edge);
  const Size j = (i + 1) % 3;
  std::array<double, 3> weights{};
  weights[triangle[i] < triangle[j] ? j : i] = parameter;
  weights[triangle[i] < triangle[j] ? i : j] = 1.0 - parameter;
  return {weights[1], weights[2]};
}

double round_edge_parameter(double parameter) {
  return std::floor(parameter * 0x1.0p40 + 0.5) * 0x1.0p-40;
}

double area_fraction(const ShellMesh& mesh, const ShellCell& cell) {
  double twice = 0.0;
  const Vec2& origin = mesh.corners[at(cell.first_corner)].barycentric;
  for (int i = 1; i + 1 < cell.corner_count; ++i) {
    const Vec2 a = mesh.corners[at(cell.first_corner + i)].barycentric - origin;
    const Vec2 b = mesh.corners[at(cell.first_corner + i + 1)].barycentric - origin;
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice;  // the reference triangle has the area one half
}

ShellMesh on_elements(const ShellMesh& mesh, std::shared_ptr<const ShellElements> elements) {
  ShellMesh moved = mesh;
  moved.elements = std::move(elements);
  for (ShellCell& cell : moved.cells)
    cell.area = area_fraction(moved, cell) * element_area(*moved.elements, cell.element);
  return moved;
}

double total_area(const ShellMesh& mesh) {
  double area = 0.0;
  for (const ShellCell& cell : mesh.cells) area += cell.area;
  return area;
}

ShellMesh make_shell_mesh(std::shared_ptr<const ShellElements> elements) {
  ShellMesh mesh;
  mesh.elements = std::move(elements);
  const Size count = mesh.elements->mesh.triangles.size();
  const std::array<Vec2, 3> barycentric{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)};
  for (Size t = 0; t < count; ++t) {
    ShellCell cell;
    cell.element = static_cast<int>(t);
    cell.vertices = mesh.elements->mesh.triangles[t];
    cell.edges = mesh.elements->topology.triangle_edges[t];
    cell.area = element_area(*mesh.elements, cell.element);
    cell.first_corner = static_cast<int>(mesh.corners.size());
    cell.corner_count = 3;
    for (int i = 0; i < 3; ++i) mesh.corners.push_back({barycentric[at(i)], SideKind::element_edge, i});
    mesh.cells.push_back(cell);
  }
  mesh.vertex_source.resize(mesh.elements->mesh.positions.size());
  std::iota(mesh.vertex_source.begin(), mesh.vertex_source.end(), 0);
  mesh.edge_source.resize(mesh.elements->topology.edges.size());
  std::iota(mesh.edge_source.begin(), mesh.edge_source.end(), 0);
  return mesh;
}

std::vector<CellContact> find_cell_contacts(const ShellMesh& mesh, double tolerance) {
  std::vector<CellContact> contacts;
  add_edge_contacts(mesh, tolerance, contacts);
  add_facet_contacts(mesh, tolerance, contacts);
  sort_by_key(
      contacts, mesh.cells.size(), [](const CellContact& c) { return c.cell_a; },
      [](const CellContact& a, const CellContact& b) {
        return std::array{a.cell_b, a.side_a, a.side_b} < std::array{b.cell_b, b.side_a, b.side_b};
      });
  return contacts;
}

void assign_degrees_of_freedom(ShellMesh& mesh, const std::vector<CellContact>& contacts) {
  core::DisjointSets vertices(3 * mesh.cells.size());
  core::DisjointSets edges(3 * mesh.cells.size());
  const ShellElements& elements = *mesh.elements;
  for (const CellContact& contact : contacts) {
    const ShellCell& a = mesh.cells[at(contact.cell_a)];
    const ShellCell& b = mesh.cells[at(contact.cell_b)];
    if (a.element == b.element) {  // inside one element everything is common
      for (int i = 0; i < 3; ++i) {
        vertices.unite(3 * contact.cell_a + i, 3 * contact.cell_b + i);
        edges.unite(3 * contact.cell_a + i, 3 * contact.cell_b + i);
      }
      continue;
    }
    // On a shared edge its two ends and its rotation are.
    const int i = mesh.corners[at(a.first_corner + contact.side_a)].side_id;
    const int j = mesh.corners[at(b.first_corner + contact.side_b)].side_id;
    edges.unite(3 * contact.cell_a + i, 3 * contact.cell_b + j);
    for (const int v : {i, (i + 1) % 3})
      for (const int w : {j, (j + 1) % 3})
        if (elements.mesh.triangles[at(a.element)][at(v)] == elements.mesh.triangles[at(b.element)][at(w)])
          vertices.unite(3 * contact.cell_a + v, 3 * contact.cell_b + w);
  }
  mesh.vertex_source.clear();
  mesh.edge_source.clear();
  std::vector<int> vertex_number(3 * mesh.cells.size(), -1);
  std::vector<int> edge_number(3 * mesh.cells.size(), -1);
  for (Size c = 0; c < mesh.cells.size(); ++c)
    for (Size i = 0; i < 3; ++i) {
      ShellCell& cell = mesh.cells[c];
      int& vertex = vertex_number[at(vertices.find(static_cast<int>(3 * c + i)))];
      if (vertex < 0) {
        vertex = static_cast<int>(mesh.vertex_source.size());
        mesh.vertex_source.push_back(elements.mesh.triangles[at(cell.element)][i]);
      }
      cell.vertices[i] = vertex;
      int& edge = edge_number[at(edges.find(static_cast<int>(3 * c + i)))];
      if (edge < 0) {
        edge = static_cast<int>(mesh.edge_source.size());
        mesh.edge_source.push_back(elements.topology.triangle_edges[at(cell.element)][i]);
      }
      cell.edges[i] = edge;
    }
}

}  // namespace shatterbox::geometry
