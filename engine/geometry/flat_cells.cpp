#include "engine/geometry/flat_cells.h"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

double facet_area(const std::vector<Vec3>& positions, const SolidMaterial& material, const FacetLoop& facet) {
  const int* corners = material.corners.data() + facet.first_corner;
  Vec3 sum = Vec3::Zero();
  for (int i = 2; i < facet.corner_count; ++i)
    sum += (positions[at(corners[i - 1])] - positions[at(corners[0])])
               .cross(positions[at(corners[i])] - positions[at(corners[0])]);
  return 0.5 * sum.norm();
}

struct Contact {
  int flat, other;
  double area;
};

/// For each cell the one it goes to: itself if it has a volume, or no neighbour that has.
std::vector<int> find_owners(const std::vector<Vec3>& positions, const EmbeddedMaterial& embedded) {
  std::vector<int> owner(embedded.volumes.size());
  std::vector<Contact> contacts;
  for (Size c = 0; c < owner.size(); ++c) owner[c] = embedded.volumes[c] > 0.0 ? static_cast<int>(c) : -1;
  for (const FacetLoop& facet : embedded.material.facets)
    for (const Size side : {Size{0}, Size{1}}) {
      const int flat = facet.cells[side], other = facet.cells[1 - side];
      if (other >= 0 && flat >= 0 && owner[at(flat)] < 0)
        contacts.push_back({flat, other, facet_area(positions, embedded.material, facet)});
    }
  // The widest contact with a cell that has an owner comes first; then again, for those behind flat cells.
  std::sort(contacts.begin(), contacts.end(), [](const Contact& p, const Contact& q) {
    if (p.flat != q.flat) return p.flat < q.flat;
    return p.area != q.area ? p.area > q.area : p.other < q.other;
  });
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    std::vector<std::pair<int, int>> found;
    for (const Contact& contact : contacts)
      if (owner[at(contact.flat)] < 0 && owner[at(contact.other)] >= 0 &&
          (found.empty() || found.back().first != contact.flat))
        found.push_back({contact.flat, owner[at(contact.other)]});
    for (const auto& [flat, to] : found) owner[at(flat)] = to;
    has_changed = !found.empty();
  }
  for (Size c = 0; c < owner.size(); ++c)
    if (owner[c] < 0) owner[c] = static_cast<int>(c);
  return owner;
}

template <class Value>
void keep(std::vector<Value>& values, const std::vector<int>& owner) {
  Size kept = 0;
  for (Size c = 0; c < owner.size(); ++c)
    if (owner[c] == static_cast<int>(c)) values[kept++] = values[c];
  values.resize(kept);
}

}  // namespace

void join_flat_cells(const std::vector<Vec3>& positions, EmbeddedMaterial& embedded) {
  if (std::none_of(embedded.volumes.begin(), embedded.volumes.end(), [](double v) { return v <= 0.0; }))
    return;
  const std::vector<int> owner = find_owners(positions, embedded);
  std::vector<int> number(owner.size(), -1);
  int count = 0;
  for (Size c = 0; c < owner.size(); ++c)
    if (owner[c] == static_cast<int>(c)) number[c] = count++;
  for (Size c = 0; c < owner.size(); ++c)
    if (owner[c] != static_cast<int>(c)) embedded.is_whole[at(owner[c])] = 0;
  SolidMaterial& material = embedded.material;
  std::vector<int> corners;
  Size kept = 0;
  for (FacetLoop facet : material.facets) {
    for (int& cell : facet.cells)
      if (cell >= 0) cell = number[at(owner[at(cell)])];
    if (facet.cells[0] == facet.cells[1]) continue;
    const auto first = material.corners.begin() + facet.first_corner;
    facet.first_corner = static_cast<int>(corners.size());
    corners.insert(corners.end(), first, first + facet.corner_count);
    material.facets[kept++] = facet;
  }
  material.facets.resize(kept);
  material.corners = std::move(corners);
  keep(material.cell_elements, owner);
  keep(embedded.volumes, owner);
  keep(embedded.centroids, owner);
  keep(embedded.is_whole, owner);
}

}  // namespace shatterbox::geometry
