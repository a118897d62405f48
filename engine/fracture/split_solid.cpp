#include "engine/fracture/split_solid.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

#include "engine/core/disjoint_sets.h"
#include "engine/core/index.h"
#include "engine/core/stop.h"

namespace shatterbox::fracture {
namespace {

using geometry::FacetKind;
using geometry::SolidComplex;
using geometry::SolidContact;
using geometry::SolidFacet;
using Size = std::size_t;
using core::at;

constexpr int kMergeRounds = 8;

/// The number of each cell's piece; pieces are numbered by their first cells.
std::vector<int> label_cells(Size cell_count, const std::vector<SolidContact>& contacts, int& piece_count) {
  core::DisjointSets pieces(cell_count);
  for (const SolidContact& contact : contacts) pieces.unite(contact.cell_a, contact.cell_b);
  std::vector<int> label(cell_count, -1);
  piece_count = 0;
  for (Size c = 0; c < cell_count; ++c) {
    const int root = pieces.find(static_cast<int>(c));
    label[c] = root == static_cast<int>(c) ? piece_count++ : label[at(root)];
  }
  return label;
}

bool is_open(const SolidFacet& facet) {
  return facet.parts[0] < 0 && facet.kind == FacetKind::crack && facet.cells[0] >= 0 && facet.cells[1] >= 0;
}

/// One round of joining pieces that are too narrow; false if there was nothing to do.
bool merge_once(SolidComplex& complex, const std::vector<SolidContact>& contacts, double least_width,
                SolidSplit& split) {
  int count = 0;
  const std::vector<int> label = label_cells(complex.cells.size(), contacts, count);
  std::vector<double> volume(at(count), 0.0), area(at(count), 0.0);
  for (Size c = 0; c < complex.cells.size(); ++c) volume[at(label[c])] += complex.cells[c].volume;
  for (const SolidFacet& facet : complex.facets) {
    if (!is_open(facet)) continue;
    const double own = facet_area_vector(complex, facet).norm();
    for (const int c : facet.cells) area[at(label[at(c)])] += own;
  }
  const auto is_narrow = [&](int p) { return volume[at(p)] <= 0.5 * least_width * area[at(p)]; };
  std::map<std::pair<int, int>, double> common;  // narrow piece, neighbour: area of their common crack
  for (const SolidFacet& facet : complex.facets) {
    if (!is_open(facet)) continue;
    const int a = label[at(facet.cells[0])];
    const int b = label[at(facet.cells[1])];
    if (a == b || (!is_narrow(a) && !is_narrow(b))) continue;
    const double own = facet_area_vector(complex, facet).norm();
    if (is_narrow(a)) common[{a, b}] += own;
    if (is_narrow(b)) common[{b, a}] += own;
  }
  if (common.empty()) return false;
  std::vector<int> partner(at(count), -1);
  std::vector<double> greatest(at(count), -1.0);
  for (const auto& [pieces, own] : common)
    if (own > greatest[at(pieces.first)]) {
      greatest[at(pieces.first)] = own;
      partner[at(pieces.first)] = pieces.second;
    }
  for (SolidFacet& facet : complex.facets) {
    if (!is_open(facet)) continue;
    const int a = label[at(facet.cells[0])];
    const int b = label[at(facet.cells[1])];
    if (a != b && (partner[at(a)] == b || partner[at(b)] == a)) facet.kind = FacetKind::grain;
  }
  for (int p = 0; p < count; ++p) {
    const int q = partner[at(p)];
    if (q < 0 || (partner[at(q)] == p && q > p)) continue;  // of two that join each other one is counted
    ++split.merged_count;
    split.merged_volume += volume[at(p)];
  }
  return true;
}

}  // namespace

SolidSplit split_solid(SolidComplex complex, double least_width) {
  SolidSplit split;
  settle(complex);
  std::vector<SolidContact> contacts = find_solid_contacts(complex);
  for (int pass = 0; pass < kMergeRounds; ++pass) {
    core::stop_if_asked();
    if (!merge_once(complex, contacts, least_width, split)) break;
    contacts = find_solid_contacts(complex);
  }
  int count = 0;
  const std::vector<int> label = label_cells(complex.cells.size(), contacts, count);
  std::vector<std::vector<int>> cells(at(count));
  std::vector<double> volumes(at(count), 0.0);
  for (Size c = 0; c < complex.cells.size(); ++c) {
    cells[at(label[c])].push_back(static_cast<int>(c));
    volumes[at(label[c])] += complex.cells[c].volume;
  }
  std::vector<int> order(at(count));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&volumes](int a, int b) {
    return volumes[at(a)] != volumes[at(b)] ? volumes[at(a)] > volumes[at(b)] : a < b;
  });
  // No two pieces' cells share a copy of a node, but where nothing more than nodes ever joined them.
  const geometry::SolidMesh whole = make_solid_mesh(complex, contacts);
  std::vector<std::array<int, 2>> own_number(whole.vertex_source.size(), {-1, -1});  // piece, number in it
  geometry::PieceExtractor extractor(complex);
  for (const int p : order) {
    core::stop_if_asked();
    SolidPiece piece;
    piece.complex = extractor.extract(cells[at(p)]);
    piece.mesh.elements = whole.elements;
    for (const int c : cells[at(p)]) {
      geometry::SolidCell cell = whole.cells[at(c)];
      for (int& v : cell.vertices) {
        auto& own = own_number[at(v)];
        if (own[0] != p) {
          own = {p, static_cast<int>(piece.mesh.vertex_source.size())};
          piece.mesh.vertex_source.push_back(whole.vertex_source[at(v)]);
        }
        v = own[1];
      }
      piece.mesh.cells.push_back(cell);
    }
    split.pieces.push_back(std::move(piece));
  }
  return split;
}

}  // namespace shatterbox::fracture
