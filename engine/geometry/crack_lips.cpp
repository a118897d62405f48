#include "engine/geometry/crack_lips.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "engine/core/elementary.h"
#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr int kMostRounds = 16;   // in which what has begun to overlap is held, too
constexpr int kMostMeetings = 2;  // in one round
constexpr double kKept = 0.01;    // of the faces' mean size, that what is held keeps apart
constexpr double kMet = 1e-3;     // tolerance of a solve: the next one mends what it leaves
constexpr double kPull = 1e4;     // of what is held on what is about
constexpr double kAlone =
    0.05;  // of what a vertex's neighbours hold it with: so far, some four edges, it goes on
constexpr double kLeastPull = 1e-2;  // what hangs hardly on a copied vertex opens hardly, and is let go

/// A corner of a crack's faces, as it is behind and in front: how far it is from there to here is a sum of
/// moves.
struct LipPoint {
  std::array<int, 8> vertices{};
  std::array<double, 8> pulls{};  // above zero in front, below behind
  Size count = 0;
  double stiffness = 0.0;      // sum of the squares
  Vec3 normal = Vec3::Zero();  // unit, to the front
  bool is_held = false;

  Vec3 gap(const std::vector<Vec3>& moves) const {
    Vec3 sum = Vec3::Zero();
    for (Size k = 0; k < count; ++k) sum += pulls[k] * moves[at(vertices[k])];
    return sum;
  }
};

class LipParter {
 public:
  LipParter(const CopiedSolid& copied, std::vector<Vec3>& moves) : copied_(copied), moves_(moves) {
    double sizes = 0.0;
    for (const auto& lip : copied.lips) {
      const SolidFacet &behind = facet_of(lip[0]), &in_front = facet_of(lip[1]);
      sizes += core::sqrt(facet_area_vector(copied.complex, behind).norm());
      std::vector<int>& own = points_of_.emplace_back();
      for (int i = 0; i < behind.side_count; ++i)
        own.push_back(point_of(corner_of(behind, i), corner_of(in_front, i)));
    }
    kept_ = kKept * sizes / std::max<double>(1.0, static_cast<double>(copied.lips.size()));
  }

  void part() {
    for (int round = 0; round < kMostRounds && hold_overlapping(); ++round)
      for (int time = 0; time < kMostMeetings; ++time) meet();
  }

 private:
  const SolidFacet& facet_of(int facet) const { return copied_.complex.facets[at(facet)]; }
  int corner_of(const SolidFacet& facet, int i) const {
    return copied_.complex.side_begin(copied_.complex.sides_of(facet)[i]);
  }

  int point_of(int behind, int in_front) {
    const auto [found, is_new] = known_.try_emplace({behind, in_front}, static_cast<int>(points_.size()));
    if (!is_new) return found->second;
    LipPoint point;
    add(in_front, 1.0, point);
    add(behind, -1.0, point);
    for (Size k = 0; k < point.count; ++k) point.stiffness += point.pulls[k] * point.pulls[k];
    points_.push_back(point);
    return found->second;
  }

  void add(int corner, double sign, LipPoint& point) const {
    const SolidVertex& vertex = copied_.complex.vertices[at(corner)];
    for (Size k = 0; k < 4 && vertex.nodes[k] >= 0; ++k) {
      const auto end = point.vertices.begin() + static_cast<std::ptrdiff_t>(point.count);
      const auto known =
          static_cast<Size>(std::find(point.vertices.begin(), end, vertex.nodes[k]) - point.vertices.begin());
      if (known == point.count) point.vertices[point.count++] = vertex.nodes[k];
      point.pulls[known] += sign * vertex.weights[k];
    }
  }

  Vec3 moved(int corner) const {
    const SolidVertex& vertex = copied_.complex.vertices[at(corner)];
    Vec3 place = vertex.position;
    for (Size k = 0; k < 4 && vertex.nodes[k] >= 0; ++k)
      place += vertex.weights[k] * moves_[at(vertex.nodes[k])];
    return place;
  }

  /// m2, of a facet as it has moved.
  Vec3 area_of(const SolidFacet& facet) const {
    Vec3 area = Vec3::Zero();
    const Vec3 origin = moved(corner_of(facet, 0));
    for (int i = 1; i + 1 < facet.side_count; ++i)
      area += 0.5 * (moved(corner_of(facet, i)) - origin).cross(moved(corner_of(facet, i + 1)) - origin);
    return area;
  }

  void find_normals() {
    for (LipPoint& point : points_) point.normal.setZero();
    for (Size l = 0; l < points_of_.size(); ++l) {
      const Vec3 area = area_of(facet_of(copied_.lips[l][0])) + area_of(facet_of(copied_.lips[l][1]));
      for (const int p : points_of_[l]) points_[at(p)].normal += area;
    }
    for (LipPoint& point : points_) point.normal.stableNormalize();
  }

  /// False if there is nothing new.
  bool hold_overlapping() {
    find_normals();
    bool has_new = false;
    for (LipPoint& point : points_) {
      if (point.is_held || point.stiffness < kLeastPull || point.gap(moves_).dot(point.normal) >= 0.0)
        continue;
      point.is_held = has_new = true;
    }
    return has_new;
  }

  /// The change of the moves by which all that is held stands as far apart as is kept; what is about goes
  /// along, ever less.
  void meet() {
    std::vector<Eigen::Triplet<double>> pulls;
    std::vector<const LipPoint*> held;
    for (const LipPoint& point : points_) {
      if (!point.is_held) continue;
      for (Size k = 0; k < point.count; ++k)
        pulls.emplace_back(static_cast<int>(held.size()), point.vertices[k], point.pulls[k]);
      held.push_back(&point);
    }
    const auto vertex_count = static_cast<Eigen::Index>(moves_.size());
    Eigen::SparseMatrix<double> matrix(static_cast<Eigen::Index>(held.size()), vertex_count);
    matrix.setFromTriplets(pulls.begin(), pulls.end());
    Eigen::MatrixX3d off(static_cast<Eigen::Index>(held.size()), 3);
    for (Size i = 0; i < held.size(); ++i)
      off.row(static_cast<Eigen::Index>(i)) = held[i]->gap(moves_) - kept_ * held[i]->normal;
    const Eigen::SparseMatrix<double> all = company() + kPull * matrix.transpose() * matrix;
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(all);
    solver.setTolerance(kMet);
    const Eigen::MatrixX3d change = solver.solve(kPull * (matrix.transpose() * off));
    for (Size v = 0; v < moves_.size(); ++v)
      moves_[v] -= change.row(static_cast<Eigen::Index>(v)).transpose();
  }

  /// What neighbours ask of each other: to go alike, and not far.
  const Eigen::SparseMatrix<double>& company() {
    if (company_.rows() > 0) return company_;
    std::vector<Eigen::Triplet<double>> entries;
    for (const Tetrahedron& t : copied_.complex.elements->mesh.tetrahedra)
      for (const auto& [a, b] : kTetrahedronEdges) {
        const int i = t[at(a)], j = t[at(b)];
        entries.emplace_back(i, j, -1.0);
        entries.emplace_back(j, i, -1.0);
        entries.emplace_back(i, i, 1.0 + kAlone);
        entries.emplace_back(j, j, 1.0 + kAlone);
      }
    company_.resize(static_cast<Eigen::Index>(moves_.size()), static_cast<Eigen::Index>(moves_.size()));
    company_.setFromTriplets(entries.begin(), entries.end());
    for (Eigen::Index i = 0; i < company_.rows(); ++i)
      if (company_.coeff(i, i) == 0.0) company_.coeffRef(i, i) = 1.0;  // of no element
    return company_;
  }

  const CopiedSolid& copied_;
  std::vector<Vec3>& moves_;
  std::map<std::pair<int, int>, int> known_;  // points by their vertices behind and in front
  std::vector<LipPoint> points_;
  std::vector<std::vector<int>> points_of_;  // by lip
  Eigen::SparseMatrix<double> company_;
  double kept_ = 0.0;  // m
};

}  // namespace

void part_lips(const CopiedSolid& copied, std::vector<Vec3>& moves) {
  LipParter(copied, moves).part();
}

}  // namespace shatterbox::geometry
