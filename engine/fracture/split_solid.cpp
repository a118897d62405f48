#include "engine/fracture/split_solid.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "engine/core/index.h"
#include "engine/core/parallel.h"
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

/// The neighbour of each piece with the greatest common crack, -1 if there is none.
std::vector<int> find_partners(Size piece_count, const std::map<std::pair<int, int>, double>& common) {
  std::vector<int> partner(piece_count, -1);
  std::vector<double> greatest(piece_count, -1.0);
  const auto offer = [&](int piece, int other, double area) {
    if (area <= greatest[at(piece)]) return;
    greatest[at(piece)] = area;
    partner[at(piece)] = other;
  };
  for (const auto& [pieces, area] : common) {
    offer(pieces.first, pieces.second, area);
    offer(pieces.second, pieces.first, area);
  }
  return partner;
}

/// The number of a copied vertex in the piece that it was last asked for.
struct OwnNumber {
  int piece = -1, number = -1;
};

/// These cells alone, with vertices of their own.
geometry::SolidMesh part_of(const geometry::SolidMesh& whole, const std::vector<int>& cells, int number,
                            std::vector<OwnNumber>& own_numbers) {
  geometry::SolidMesh part;
  part.elements = whole.elements;
  part.cells.reserve(cells.size());
  for (const int c : cells) {
    geometry::SolidCell cell = whole.cells[at(c)];
    for (int& v : cell.vertices) {
      OwnNumber& own = own_numbers[at(v)];
      if (own.piece != number) {
        own = {number, static_cast<int>(part.vertex_source.size())};
        part.vertex_source.push_back(whole.vertex_source[at(v)]);
      }
      v = own.number;
    }
    part.cells.push_back(cell);
  }
  return part;
}

/// Pieces, by cells, that are those of an earlier division in which these were their numbers; -1 for others.
/// Since then pieces have been joined and none parted.
std::vector<int> find_unchanged(const std::vector<std::vector<int>>& cells, const std::vector<int>& earlier) {
  std::vector<int> number(cells.size(), -1);
  if (earlier.empty()) return number;
  std::vector<Size> size(at(*std::max_element(earlier.begin(), earlier.end()) + 1), 0);
  for (const int piece : earlier) ++size[at(piece)];
  for (Size p = 0; p < cells.size(); ++p)
    if (const int piece = earlier[at(cells[p].front())]; size[at(piece)] == cells[p].size())
      number[p] = piece;
  return number;
}

}  // namespace

SolidSplitter::SolidSplitter(SolidComplex complex, double least_width) : complex_(std::move(complex)) {
  settle(complex_);
  label();
  for (int round = 0; round < kMergeRounds; ++round) {
    core::stop_if_asked();
    if (!join_narrow(least_width)) break;
  }
}

/// What hangs together, by descending volume.
void SolidSplitter::label() {
  contacts_ = find_solid_contacts(complex_);
  int count = 0;
  piece_of_ = geometry::label_parts(complex_.cells.size(), contacts_, count);
  std::vector<double> volumes(at(count), 0.0);
  for (Size c = 0; c < piece_of_.size(); ++c) volumes[at(piece_of_[c])] += complex_.cells[c].volume;
  std::vector<int> order(at(count));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&volumes](int a, int b) {
    return volumes[at(a)] != volumes[at(b)] ? volumes[at(a)] > volumes[at(b)] : a < b;
  });
  std::vector<int> place(at(count));
  volumes_.clear();
  for (const int p : order) {
    place[at(p)] = static_cast<int>(volumes_.size());
    volumes_.push_back(volumes[at(p)]);
  }
  for (int& p : piece_of_) p = place[at(p)];
}

/// m2, of the open cracks between pieces (the lower number first).
std::map<std::pair<int, int>, double> SolidSplitter::find_common_areas() const {
  std::map<std::pair<int, int>, double> areas;
  for (const SolidFacet& facet : complex_.facets) {
    if (!is_open_crack(facet)) continue;
    const auto [a, b] = std::minmax(piece_of_[at(facet.cells[0])], piece_of_[at(facet.cells[1])]);
    if (a != b) areas[{a, b}] += facet_area_vector(complex_, facet).norm();
  }
  return areas;
}

/// One round of joining pieces that are too narrow; false if there was nothing to do.
bool SolidSplitter::join_narrow(double least_width) {
  std::vector<double> area(volumes_.size(), 0.0);
  for (const SolidFacet& facet : complex_.facets) {
    if (!is_open_crack(facet)) continue;
    const double own = facet_area_vector(complex_, facet).norm();
    for (const int c : facet.cells) area[at(piece_of_[at(c)])] += own;
  }
  const std::vector<int> partner = find_partners(volumes_.size(), find_common_areas());
  std::set<std::pair<int, int>> pairs;
  for (int p = 0; at(p) < volumes_.size(); ++p)
    if (partner[at(p)] >= 0 && volumes_[at(p)] <= 0.5 * least_width * area[at(p)])
      pairs.insert(std::minmax(p, partner[at(p)]));
  return unite(pairs);
}

bool SolidSplitter::join(const std::vector<PieceClash>& clashes) {
  const std::map<std::pair<int, int>, double> common = find_common_areas();
  const std::vector<int> partner = find_partners(volumes_.size(), common);
  std::set<std::pair<int, int>> pairs;
  for (const PieceClash& clash : clashes) {
    const auto [larger, smaller] = std::minmax(clash.a, clash.b < 0 ? clash.a : clash.b);
    if (common.count({larger, smaller}) > 0)
      pairs.insert({larger, smaller});
    else if (partner[at(smaller)] >= 0)
      pairs.insert(std::minmax(smaller, partner[at(smaller)]));
    else if (partner[at(larger)] >= 0)
      pairs.insert(std::minmax(larger, partner[at(larger)]));
  }
  return unite(pairs);
}

/// From now on the cracks between these pairs of pieces hold; false if there are none.
bool SolidSplitter::unite(const std::set<std::pair<int, int>>& pairs) {
  if (pairs.empty()) return false;
  for (SolidFacet& facet : complex_.facets) {
    if (!is_open_crack(facet)) continue;
    const auto pair = std::minmax(piece_of_[at(facet.cells[0])], piece_of_[at(facet.cells[1])]);
    if (pairs.count(pair) > 0) facet.kind = FacetKind::grain;
  }
  merged_count_ += static_cast<int>(pairs.size());
  std::vector<char> is_joined(volumes_.size(), 0);
  for (const auto& [larger, smaller] : pairs) is_joined[at(smaller)] = 1;
  was_merged_.resize(complex_.cells.size(), 0);
  for (Size c = 0; c < was_merged_.size(); ++c)
    if (is_joined[at(piece_of_[c])]) was_merged_[c] = 1;
  label();
  return true;
}

SolidSplit SolidSplitter::split() {
  SolidSplit split;
  split.merged_count = merged_count_;
  for (Size c = 0; c < was_merged_.size(); ++c)
    if (was_merged_[c]) split.merged_volume += complex_.cells[c].volume;
  std::vector<std::vector<int>> cells(volumes_.size());
  for (Size c = 0; c < piece_of_.size(); ++c) cells[at(piece_of_[c])].push_back(static_cast<int>(c));
  const std::vector<int> before = find_unchanged(cells, last_split_);
  last_split_ = piece_of_;
  // No two pieces' cells share a copy of a node, but where nothing more than nodes ever joined them.
  const geometry::SolidMesh whole = make_solid_mesh(complex_, contacts_);
  // The first is the greatest: beside it there is time for the others.
  split.pieces.resize(cells.size());
  core::parallel_for(std::min<Size>(cells.size(), 2), 1, [&](Size part) {
    geometry::PieceExtractor extractor(complex_);
    std::vector<OwnNumber> own_numbers(whole.vertex_source.size());
    for (Size p = part; p < (part == 0 ? 1 : cells.size()); ++p) {
      core::stop_if_asked();
      SolidPiece& piece = split.pieces[p];
      piece.before = before[p];
      if (piece.before >= 0) continue;
      piece.complex = extractor.extract(cells[p]);
      piece.mesh = part_of(whole, cells[p], static_cast<int>(p), own_numbers);
    }
  });
  return split;
}

SolidSplit split_solid(SolidComplex complex, double least_width) {
  return SolidSplitter(std::move(complex), least_width).split();
}

}  // namespace shatterbox::fracture
