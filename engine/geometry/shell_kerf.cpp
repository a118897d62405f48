#include "engine/geometry/shell_kerf.h"

#include <algorithm>
#include <span>

#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kFlat = 1e-7;           // rad: planes that differ by less are one
constexpr double kMitreSoftness = 0.02;  // bounds how far a sharp corner retreats along its bisector
constexpr double kLeastAreaKept = 0.4;   // of a triangle, after the kerf
constexpr double kNearer = 1e-9;         // of a kerf: nearer to an older face than it was
constexpr int kMovingRounds = 3;         // rounds in which vertices near a crack move along with it
constexpr int kHalvingRounds = 10;       // rounds in which a kerf that is still too wide is halved

/// Where a vertex may go without leaving the planes of its triangles.
class Freedom {
 public:
  void stay_in_plane(const Vec3& normal) {
    if (planes_ == 0) {
      vector_ = normal;
      planes_ = 1;
    } else if (planes_ == 1) {
      const Vec3 fold = vector_.cross(normal);
      if (fold.squaredNorm() < kFlat * kFlat) return;
      vector_ = fold.normalized();
      planes_ = 2;
    } else if (planes_ == 2 && std::abs(vector_.dot(normal)) > kFlat) {
      planes_ = 3;
    }
  }
  bool is_fold() const { return planes_ == 2; }
  bool is_corner() const { return planes_ == 3; }
  const Vec3& fold() const { return vector_; }
  /// What is left of a shift.
  Vec3 allowed(const Vec3& shift) const {
    if (is_corner()) return Vec3::Zero();
    return is_fold() ? Vec3(shift.dot(vector_) * vector_) : shift;
  }

 private:
  int planes_ = 0;              // that differ, at most 3
  Vec3 vector_ = Vec3::Zero();  // of one plane the normal, of two their common line
};

std::vector<Freedom> find_freedoms(const TriangleMesh& mesh, const std::vector<Vec3>& triangle_normals) {
  std::vector<Freedom> freedoms(mesh.positions.size());
  for (Size t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t]) freedoms[at(v)].stay_in_plane(triangle_normals[t]);
  return freedoms;
}

/// The border of one vertex.
using Border = std::span<const BorderNormal>;

bool is_tip(const Border& border) {
  for (const BorderNormal& n : border)
    for (const BorderNormal& m : border)
      if (n.kind == BorderKind::crack && m.kind == BorderKind::crack && n.element == m.element &&
          n.side_id == m.side_id && n.inward.dot(m.inward) < -0.5)
        return true;  // both lips of one cut meet here
  return false;
}

/// The shift that stands back from the new faces and slides along the rim and the `held` older faces.
Vec3 sliding_retreat(const Border& border, const std::vector<const BorderNormal*>& held,
                     const Freedom& freedom, double kerf) {
  Mat3 matrix = kMitreSoftness * Mat3::Identity();
  Vec3 right = Vec3::Zero();
  for (const BorderNormal& n : border) {
    if (n.kind == BorderKind::older_crack) continue;
    matrix += n.inward * n.inward.transpose();
    if (n.kind == BorderKind::crack) right += kerf * n.inward;
  }
  for (const BorderNormal* n : held) matrix += n->inward * n->inward.transpose();
  if (freedom.is_fold())
    return freedom.fold().dot(right) / freedom.fold().dot(matrix * freedom.fold()) * freedom.fold();
  return matrix.inverse() * right;
}

/// The retreat of one vertex from all its crack faces, along the rim where it lies on one; zero at a tip.
/// Never nearer to an older face, and never out over the rim.
Vec3 find_retreat(const Border& border, const Freedom& freedom, double kerf) {
  if (freedom.is_corner() || is_tip(border)) return Vec3::Zero();
  std::vector<const BorderNormal*> held;
  Vec3 shift = sliding_retreat(border, held, freedom, kerf);
  const auto comes_nearer = [&](const BorderNormal& n) {
    return n.kind != BorderKind::crack && n.inward.dot(shift) < 0.0;
  };
  while (true) {
    const Size before = held.size();
    for (const BorderNormal& n : border)
      if (comes_nearer(n) && std::find(held.begin(), held.end(), &n) == held.end()) held.push_back(&n);
    if (held.size() == before) break;
    shift = sliding_retreat(border, held, freedom, kerf);
  }
  if (held.empty()) return shift;
  // What is soft of it is taken out; between two older faces nothing may be left.
  for (const BorderNormal* n : held)
    if (comes_nearer(*n)) shift = freedom.allowed(shift - n->inward.dot(shift) * n->inward);
  const bool fits = std::none_of(border.begin(), border.end(), [&](const BorderNormal& n) {
    return n.kind == BorderKind::older_crack && n.inward.dot(shift) < -kNearer * kerf;
  });
  return fits ? shift : Vec3::Zero();
}

std::vector<int> collapsed(const TriangleMesh& mesh, const std::vector<Vec3>& shift) {
  std::vector<int> bad;
  const std::vector<Vec3>& x = mesh.positions;
  for (Size t = 0; t < mesh.triangles.size(); ++t) {
    const auto [i, j, k] = mesh.triangles[t];
    if (shift[at(i)].isZero(0.0) && shift[at(j)].isZero(0.0) && shift[at(k)].isZero(0.0)) continue;
    const Vec3 before = (x[at(j)] - x[at(i)]).cross(x[at(k)] - x[at(i)]);
    const Vec3 after = (x[at(j)] + shift[at(j)] - x[at(i)] - shift[at(i)])
                           .cross(x[at(k)] + shift[at(k)] - x[at(i)] - shift[at(i)]);
    if (!(after.dot(before) >= kLeastAreaKept * before.squaredNorm())) bad.push_back(static_cast<int>(t));
  }
  return bad;
}

using Within = std::function<bool(int, const Vec3&)>;

/// Triangles that a shift would lead out of the whole.
std::vector<int> leaving(const TriangleMesh& mesh, const std::vector<Vec3>& shift, const Within& is_within) {
  std::vector<int> bad;
  for (Size t = 0; is_within && t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    const auto is_out = [&](Size i) {
      const Size v = at(triangle[i]), w = at(triangle[(i + 1) % 3]);
      if (shift[v].isZero(0.0) && shift[w].isZero(0.0)) return false;
      const Vec3 from = mesh.positions[v] + shift[v], to = mesh.positions[w] + shift[w];
      const int number = static_cast<int>(t);
      return (!shift[v].isZero(0.0) && !is_within(number, from)) || !is_within(number, 0.5 * (from + to)) ||
             (!shift[w].isZero(0.0) && !is_within(number, to));
    };
    if (is_out(0) || is_out(1) || is_out(2)) bad.push_back(static_cast<int>(t));
  }
  return bad;
}

/// Vertices inside move along with the crack, so that slivers beside it do not narrow the kerf.
void move_along(const TriangleMesh& mesh, const std::vector<char>& is_border,
                const std::vector<Freedom>& freedoms, std::vector<Vec3>& shift) {
  std::vector<int> bad = collapsed(mesh, shift);
  for (int round = 0; round < kMovingRounds && !bad.empty(); ++round) {
    for (const int t : bad) {
      const Triangle& triangle = mesh.triangles[at(t)];
      Vec3 largest = Vec3::Zero();
      for (const int v : triangle)
        if (shift[at(v)].squaredNorm() > largest.squaredNorm()) largest = shift[at(v)];
      for (const int v : triangle)
        if (!is_border[at(v)] && shift[at(v)].squaredNorm() < largest.squaredNorm())
          shift[at(v)] = freedoms[at(v)].allowed(largest);
    }
    bad = collapsed(mesh, shift);
  }
}

/// Halves what `find` calls bad until nothing is. The last resort: the vertices of a triangle that is bad
/// still stay where they were, and so do those around it.
template <class Find>
void halve(const TriangleMesh& mesh, std::vector<Vec3>& shift, const Find& find) {
  std::vector<int> bad = find();
  for (int round = 1; round <= kHalvingRounds && !bad.empty(); ++round) {
    for (const int t : bad)
      for (const int v : mesh.triangles[at(t)]) shift[at(v)] *= round < kHalvingRounds ? 0.5 : 0.0;
    bad = find();
  }
  for (int round = 0; round < 100 && !bad.empty(); ++round) {
    for (const int t : bad)
      for (const int v : mesh.triangles[at(t)]) shift[at(v)].setZero();
    bad = find();
  }
}

/// Keeps every triangle's orientation, at least kLeastAreaKept of its area, and all of it within the whole.
void limit(const TriangleMesh& mesh, const std::vector<char>& is_border, const std::vector<Freedom>& freedoms,
           const Within& is_within, std::vector<Vec3>& shift) {
  move_along(mesh, is_border, freedoms, shift);
  halve(mesh, shift, [&] { return collapsed(mesh, shift); });
  if (!is_within) return;
  halve(mesh, shift, [&] {
    std::vector<int> bad = leaving(mesh, shift, is_within);
    return bad.empty() ? collapsed(mesh, shift) : bad;
  });
}

/// Calls `action(border)` for each vertex of a border that has a new face.
template <class Action>
void for_cracked(const std::vector<BorderNormal>& normals, const Action& action) {
  for (Size first = 0; first < normals.size();) {
    Size last = first;
    bool has_crack = false;
    for (; last < normals.size() && normals[last].vertex == normals[first].vertex; ++last)
      has_crack = has_crack || normals[last].kind == BorderKind::crack;
    if (has_crack) action(Border(normals.data() + first, last - first));
    first = last;
  }
}

/// The narrowest stand-off of a crack vertex that is not a tip.
double least_kerf_of(const std::vector<BorderNormal>& normals, const std::vector<Freedom>& freedoms,
                     const std::vector<Vec3>& shift, double kerf) {
  double least = kerf;
  for_cracked(normals, [&](const Border& border) {
    const int vertex = border.front().vertex;
    if (find_retreat(border, freedoms[at(vertex)], kerf).isZero(0.0)) return;  // a tip
    for (const BorderNormal& n : border)
      if (n.kind == BorderKind::crack) least = std::min(least, shift[at(vertex)].dot(n.inward));
  });
  return std::max(least, 0.0);
}

}  // namespace

double stand_back(TriangleMesh& mesh, const std::vector<Vec3>& triangle_normals,
                  const std::vector<BorderNormal>& normals, double kerf, const Within& is_within) {
  const std::vector<Freedom> freedoms = find_freedoms(mesh, triangle_normals);
  std::vector<Vec3> shift(mesh.positions.size(), Vec3::Zero());
  std::vector<char> is_border(mesh.positions.size(), 0);
  for (const BorderNormal& n : normals) is_border[at(n.vertex)] = 1;
  for_cracked(normals, [&](const Border& border) {
    const int vertex = border.front().vertex;
    shift[at(vertex)] = find_retreat(border, freedoms[at(vertex)], kerf);
  });
  limit(mesh, is_border, freedoms, is_within, shift);
  for (Size v = 0; v < shift.size(); ++v) mesh.positions[v] += shift[v];
  return least_kerf_of(normals, freedoms, shift, kerf);
}

}  // namespace shatterbox::geometry
