#include "engine/stress/block_rows.h"

#include "engine/core/buckets.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

/// The corners of cells that each virtual vertex is: 4 cell + corner.
core::Buckets find_incidence(const geometry::SolidMesh& mesh) {
  return {mesh.vertex_source.size(), 4 * mesh.cells.size(),
          [&](Size corner) { return mesh.cells[corner / 4].vertices[corner % 4]; }};
}

/// Some rows of the matrix by themselves.
struct RowRange {
  std::vector<int> counts, column;
  std::vector<double> entries;
};

class RowBuilder {
 public:
  RowBuilder(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh, const core::Buckets& incidence)
      : stiffness_(stiffness), mesh_(mesh), incidence_(incidence), place_(mesh.vertex_source.size(), -1) {}

  RowRange build(Size begin, Size end) {
    RowRange range;
    const auto corners = at(incidence_.first[end] - incidence_.first[begin]);
    range.column.reserve(corners);  // hardly more: a row has fewer neighbours than tetrahedra
    range.entries.reserve(9 * corners);
    for (Size row = begin; row < end; ++row) {
      const Size first = range.column.size();
      const int begin_corner = incidence_.first[row], end_corner = incidence_.first[row + 1];
      if (begin_corner < end_corner) place_of(static_cast<int>(row), first, range);
      for (int k = begin_corner; k < end_corner; ++k) add_corner(incidence_.items[at(k)], first, range);
      range.counts.push_back(static_cast<int>(range.column.size() - first));
      for (Size block = first; block < range.column.size(); ++block) place_[at(range.column[block])] = -1;
    }
    return range;
  }

 private:
  Size place_of(int column, Size first, RowRange& range) {
    int& place = place_[at(column)];
    if (place < 0) {
      place = static_cast<int>(range.column.size() - first);
      range.column.push_back(column);
      range.entries.resize(range.entries.size() + 9, 0.0);
    }
    return first + at(place);
  }

  /// What one cell adds to the row of one of its corners.
  void add_corner(int corner, Size first, RowRange& range) {
    const geometry::SolidCell& cell = mesh_.cells[at(corner / 4)];
    const SolidElement& element = stiffness_.solids[at(cell.element)];
    const double weight = element.modulus * element.volume * stiffness_fraction(stiffness_, cell);
    const double lambda = weight * stiffness_.lame_lambda(), mu = weight * stiffness_.lame_mu();
    const Vec3& g = element.gradients[at(corner % 4)];
    for (Size j = 0; j < 4; ++j) {
      const Vec3& h = element.gradients[j];
      double* const block = &range.entries[9 * place_of(cell.vertices[j], first, range)];
      const double along = mu * ((g[0] * h[0] + g[1] * h[1]) + g[2] * h[2]);
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          block[3 * a + b] += (lambda * (g[a] * h[b]) + mu * (g[b] * h[a])) + (a == b ? along : 0.0);
    }
  }

  const SolidStiffness& stiffness_;
  const geometry::SolidMesh& mesh_;
  const core::Buckets& incidence_;
  std::vector<int> place_;  // |V|: of a column in the row being made, or -1
};

}  // namespace

BlockRows assemble_stiffness(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh) {
  constexpr Size kGrain = 4 * kRowGrain;
  const core::Buckets incidence = find_incidence(mesh);
  const Size vertices = mesh.vertex_source.size();
  std::vector<RowRange> ranges((vertices + kGrain - 1) / kGrain);
  core::parallel_chunks(vertices, kGrain, [&](Size begin, Size end) {
    ranges[begin / kGrain] = RowBuilder(stiffness, mesh, incidence).build(begin, end);
  });
  BlockRows rows;
  rows.first.push_back(0);
  std::vector<Size> begins;
  for (const RowRange& range : ranges) {
    begins.push_back(at(rows.first.back()));
    for (const int count : range.counts) rows.first.push_back(rows.first.back() + count);
  }
  rows.column.resize(at(rows.first.back()));
  rows.entries.resize(9 * rows.column.size());
  core::parallel_for(ranges.size(), 1, [&](Size r) {
    std::copy(ranges[r].column.begin(), ranges[r].column.end(), &rows.column[begins[r]]);
    std::copy(ranges[r].entries.begin(), ranges[r].entries.end(), &rows.entries[9 * begins[r]]);
  });
  return rows;
}

}  // namespace shatterbox::stress
