#include "engine/fracture/crack_guide.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/SparseCholesky>

#include "engine/core/index.h"
#include "engine/stress/elimination_order.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kLeastConduction = 0.005;  // through a crack's plane, where the stress is sure
constexpr double kLeastShare = 0.02;  // of an element's volume that counts of one with hardly any material
constexpr double kHold = 1e-9;        // of the diagonal, so that a potential without a border is one
constexpr double kFaint = 1e-10;      // share of the greatest change below which a potential is but rounding
constexpr double kToNode = 0.15;      // of the change over the elements about: a node as near is on the crack
constexpr double kOnNode = 1e-6;      // likewise: what it then has, for nodes on the crack are positive

/// Gradients of the four corners' shape functions, 1/m.
std::array<Vec3, 4> shape_gradients(const geometry::TetMesh& mesh, int element) {
  const geometry::Tetrahedron& t = mesh.tetrahedra[at(element)];
  const Vec3& a = mesh.positions[at(t[0])];
  const Vec3 b = mesh.positions[at(t[1])] - a, c = mesh.positions[at(t[2])] - a,
             d = mesh.positions[at(t[3])] - a;
  const double six_volumes = b.cross(c).dot(d);
  std::array<Vec3, 4> gradients;
  gradients[1] = c.cross(d) / six_volumes;
  gradients[2] = d.cross(b) / six_volumes;
  gradients[3] = b.cross(c) / six_volumes;
  gradients[0] = -(gradients[1] + gradients[2] + gradients[3]);
  return gradients;
}

}  // namespace

struct CrackGuide::Factor {
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> solver;
};

Mat3 guide_conduction(const Vec3& across, double sureness) {
  return Mat3::Identity() - sureness * (1.0 - kLeastConduction) * across * across.transpose();
}

void settle_near_nodes(const geometry::TetMesh& mesh, const std::vector<double>& known,
                       std::vector<double>& field) {
  std::vector<double> change(field.size(), 0.0);
  for (const geometry::Tetrahedron& t : mesh.tetrahedra) {
    if (std::any_of(t.begin(), t.end(), [&](int v) { return known[at(v)] == 0.0; })) continue;
    const auto [low, high] =
        std::minmax({field[at(t[0])], field[at(t[1])], field[at(t[2])], field[at(t[3])]});
    for (const int v : t) change[at(v)] = std::max(change[at(v)], high - low);
  }
  for (Size v = 0; v < field.size(); ++v)
    if (known[v] != 0.0 && std::abs(field[v]) <= kToNode * change[v])
      field[v] = std::max(kOnNode * change[v], 1e-300);
}

CrackGuide::CrackGuide(const geometry::TetMesh& mesh, std::vector<GuideElement> elements)
    : mesh_(mesh), elements_(std::move(elements)), number_(mesh.positions.size(), -1) {
  for (const GuideElement& e : elements_)
    for (const int v : mesh_.tetrahedra[at(e.element)]) number_[at(v)] = 0;
  int count = 0;
  for (int& n : number_)
    if (n == 0) n = count++;
  dissect(count);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(10 * elements_.size() + at(count));
  double trace = 0.0;
  for (const GuideElement& e : elements_) {
    const std::array<Vec3, 4> gradients = shape_gradients(mesh_, e.element);
    const double full = geometry::tetrahedron_volume(mesh_, e.element);
    const double volume = std::max(e.volume, kLeastShare * full);
    const geometry::Tetrahedron& t = mesh_.tetrahedra[at(e.element)];
    for (Size i = 0; i < 4; ++i) {
      const Vec3 flow = volume * (e.conduction * gradients[i]);
      trace += flow.dot(gradients[i]);
      for (Size j = 0; j < 4; ++j) {
        const int row = number_[at(t[i])], column = number_[at(t[j])];
        if (row >= column) entries.emplace_back(row, column, flow.dot(gradients[j]));
      }
    }
  }
  for (int n = 0; n < count; ++n) entries.emplace_back(n, n, kHold * trace / count);
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  factor_ = std::make_unique<Factor>();
  factor_->solver.compute(matrix);
}

/// Numbers the unknowns as they are best eliminated. In three dimensions the factor is several times smaller
/// than by least degrees.
void CrackGuide::dissect(int count) {
  std::vector<std::array<int, 2>> edges;
  edges.reserve(6 * elements_.size());
  for (const GuideElement& e : elements_) {
    const geometry::Tetrahedron& t = mesh_.tetrahedra[at(e.element)];
    for (const auto& ends : geometry::kTetrahedronEdges) {
      const auto [low, high] = std::minmax(number_[at(t[at(ends[0])])], number_[at(t[at(ends[1])])]);
      edges.push_back({low, high});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const std::vector<int> rank = stress::rank_vertices(at(count), edges);
  for (int& n : number_)
    if (n >= 0) n = rank[at(n)];
}

CrackGuide::~CrackGuide() = default;
CrackGuide::CrackGuide(CrackGuide&&) noexcept = default;

std::vector<double> CrackGuide::potential(int element, const Vec3& place, const Vec3& normal) const {
  // A ball of sources and sinks, the elements about the start: the potential inside is nearly linear.
  const geometry::Tetrahedron& start = mesh_.tetrahedra[at(element)];
  VecX source = VecX::Zero(factor_->solver.rows());
  for (const GuideElement& e : elements_) {
    const geometry::Tetrahedron& t = mesh_.tetrahedra[at(e.element)];
    const bool is_near = std::any_of(
        t.begin(), t.end(), [&](int v) { return std::find(start.begin(), start.end(), v) != start.end(); });
    if (!is_near) continue;
    const std::array<Vec3, 4> gradients = shape_gradients(mesh_, e.element);
    const double volume = geometry::tetrahedron_volume(mesh_, e.element);
    for (Size i = 0; i < 4; ++i) source(number_[at(t[i])]) += volume * gradients[i].dot(normal);
  }
  const VecX flow = factor_->solver.solve(source);
  double here = 0.0;
  const std::array<Vec3, 4> gradients = shape_gradients(mesh_, element);
  for (Size i = 0; i < 4; ++i) {
    const double weight = (i == 0 ? 1.0 : 0.0) + gradients[i].dot(place - mesh_.positions[at(start[0])]);
    here += weight * flow(number_[at(start[i])]);
  }
  // The change of the potential over the elements about each node is the measure of what is near zero.
  std::vector<double> values(mesh_.positions.size(), 0.0), change(values.size(), 0.0);
  for (const GuideElement& e : elements_) {
    double low = 1e300, high = -1e300;
    for (const int v : mesh_.tetrahedra[at(e.element)]) {
      low = std::min(low, flow(number_[at(v)]));
      high = std::max(high, flow(number_[at(v)]));
    }
    for (const int v : mesh_.tetrahedra[at(e.element)]) change[at(v)] = std::max(change[at(v)], high - low);
  }
  const double faintest = kFaint * *std::max_element(change.begin(), change.end());
  for (Size v = 0; v < values.size(); ++v) {
    if (number_[v] < 0 || !(change[v] > faintest)) continue;
    const double value = flow(number_[v]) - here;
    values[v] = std::abs(value) < kToNode * change[v] ? kOnNode * change[v] : value;
  }
  return values;
}

}  // namespace shatterbox::fracture
