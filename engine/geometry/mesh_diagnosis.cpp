#include "engine/geometry/mesh_diagnosis.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "engine/core/index.h"
#include "engine/geometry/edge_topology.h"
#include "engine/geometry/flat_triangles.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/weld.h"

namespace shatterbox::geometry {
namespace {

constexpr double kMostCoordinate =
    1e60;  // m: areas and inertias of anything larger leave the range of a double

using core::at;

std::string at_place(const Vec3& place) {
  std::ostringstream text;
  text << "(" << place.x() << ", " << place.y() << ", " << place.z() << ")";
  return text.str();
}

/// Eigen's own test for finiteness subtracts, which traps on what it looks for.
bool is_usable(const Vec3& p) {
  for (const double x : {p.x(), p.y(), p.z()})
    if (!std::isfinite(x) || std::abs(x) >= kMostCoordinate) return false;
  return true;
}

/// "1 vertex", "3 vertices".
std::string counted(int count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// +1 if the triangle runs along the edge from its lesser to its greater vertex, -1 otherwise.
int direction_along(const Triangle& t, const std::array<int, 2>& edge) {
  for (std::size_t i = 0; i < 3; ++i)
    if (t[i] == edge[0] && t[(i + 1) % 3] == edge[1]) return 1;
  return -1;
}

/// One mesh on its way through all tests; each returns false if it refuses.
class Mender {
 public:
  Mender(const TriangleMesh& given, const MendOptions& options) : given_(given), options_(options) {}

  MendedMesh run() {
    if (test_empty() && test_numbers() && test_indices()) {
      mesh_ = given_;
      triangle_source_.resize(given_.triangles.size());
      std::iota(triangle_source_.begin(), triangle_source_.end(), 0);
      vertex_source_.resize(given_.positions.size());
      std::iota(vertex_source_.begin(), vertex_source_.end(), 0);
      count_unused();
      weld();
      drop_flat();
      drop_duplicates();
      drop_unused();
      if (test_rest() && test_edges() && orient()) {
        split_fans();
        test_parts();
        note_slivers();
      }
    }
    return result();
  }

 private:
  MeshFinding& report(MeshFault fault, Severity severity, int count) {
    MeshFinding finding;
    finding.fault = fault;
    finding.severity = severity;
    finding.count = count;
    diagnosis_.findings.push_back(finding);
    return diagnosis_.findings.back();
  }

  /// Sets the place to a vertex of the given mesh, and says it.
  std::string say_vertex(MeshFinding& finding, int given_vertex) const {
    finding.vertex = given_vertex;
    finding.place = given_.positions[at(given_vertex)];
    return "vertex " + std::to_string(given_vertex + 1) + " at " + at_place(finding.place);
  }

  std::string say_triangle(MeshFinding& finding, int given_triangle) const {
    const Triangle& t = given_.triangles[at(given_triangle)];
    finding.triangle = given_triangle;
    finding.place =
        (given_.positions[at(t[0])] + given_.positions[at(t[1])] + given_.positions[at(t[2])]) / 3.0;
    return "triangle " + std::to_string(given_triangle + 1) + " at " + at_place(finding.place);
  }

  const Vec3& position(int vertex) const { return mesh_.positions[at(vertex)]; }

  bool test_empty() {
    if (!given_.triangles.empty()) return true;
    report(MeshFault::empty, Severity::refused, 0).sentence =
        given_.positions.empty()
            ? "The mesh is empty: it has no vertices and no triangles."
            : "The mesh has vertices but no triangles; export its faces, not only its points.";
    return false;
  }

  bool test_numbers() {
    int count = 0;
    int first = -1;
    for (std::size_t v = 0; v < given_.positions.size(); ++v) {
      const Vec3& p = given_.positions[v];
      if (is_usable(p)) continue;
      if (count++ == 0) first = static_cast<int>(v);
    }
    if (count == 0) return true;
    MeshFinding& finding = report(MeshFault::not_finite, Severity::refused, count);
    finding.vertex = first;
    finding.sentence = counted(count, "vertex has a coordinate", "vertices have coordinates") +
                       " that is no number or absurdly large, first vertex " + std::to_string(first + 1) +
                       " at " + at_place(given_.positions[at(first)]) +
                       ". Export the mesh again, or correct the file there.";
    return false;
  }

  bool test_indices() {
    const int vertices = static_cast<int>(given_.positions.size());
    int count = 0;
    int first = -1;
    int wrong = 0;
    for (std::size_t t = 0; t < given_.triangles.size(); ++t)
      for (const int v : given_.triangles[t]) {
        if (v >= 0 && v < vertices) continue;
        if (count++ == 0) {
          first = static_cast<int>(t);
          wrong = v;
        }
      }
    if (count == 0) return true;
    MeshFinding& finding = report(MeshFault::index_out_of_range, Severity::refused, count);
    finding.triangle = first;
    finding.sentence = "Triangle " + std::to_string(first + 1) + " names vertex " +
                       std::to_string(std::int64_t{wrong} + 1) + ", but there are " +
                       std::to_string(vertices) +
                       " vertices. The file is cut short or its numbering is wrong.";
    return false;
  }

  void count_unused() {
    std::vector<std::uint8_t> is_used(given_.positions.size(), 0);
    for (const Triangle& t : given_.triangles)
      for (const int v : t) is_used[at(v)] = 1;
    const int count = static_cast<int>(std::count(is_used.begin(), is_used.end(), 0));
    if (count == 0) return;
    MeshFinding& finding = report(MeshFault::unused_vertices, Severity::mended, count);
    const auto first = std::find(is_used.begin(), is_used.end(), 0) - is_used.begin();
    const std::string place = say_vertex(finding, static_cast<int>(first));
    finding.sentence = counted(count, "vertex is", "vertices are") + " not used by any triangle (first " +
                       place + "): dropped.";
  }

  void weld() {
    const std::vector<int> first = find_equal_positions(mesh_.positions);
    int count = 0;
    int place = -1;
    for (std::size_t v = 0; v < first.size(); ++v)
      if (first[v] != static_cast<int>(v) && count++ == 0) place = static_cast<int>(v);
    if (count == 0) return;
    for (Triangle& t : mesh_.triangles)
      for (int& v : t) v = first[at(v)];
    MeshFinding& finding = report(MeshFault::duplicate_vertices, Severity::mended, count);
    const std::string words = say_vertex(finding, place);
    finding.sentence = counted(count, "vertex lies", "vertices lie") + " exactly on another one (first " +
                       words + "): welded.";
  }

  void drop_flat() {
    const FlatTriangles flat = remove_flat_triangles(mesh_, triangle_source_);
    if (flat.count == 0) return;
    MeshFinding& finding = report(MeshFault::degenerate_triangles, Severity::mended, flat.count);
    const std::string words = say_triangle(finding, flat.first);
    finding.sentence = counted(flat.count, "triangle has", "triangles have") + " no area (first " + words +
                       "): dropped without opening a slit.";
  }

  void keep_triangles(const std::vector<std::uint8_t>& is_kept) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (!is_kept[t]) continue;
      mesh_.triangles[kept] = mesh_.triangles[t];
      triangle_source_[kept++] = triangle_source_[t];
    }
    mesh_.triangles.resize(kept);
    triangle_source_.resize(kept);
  }

  void drop_duplicates() {
    std::vector<int> order(mesh_.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    std::vector<Triangle> sorted = mesh_.triangles;
    for (Triangle& t : sorted) std::sort(t.begin(), t.end());
    std::sort(order.begin(), order.end(), [&](int a, int b) {
      return sorted[at(a)] != sorted[at(b)] ? sorted[at(a)] < sorted[at(b)] : a < b;
    });
    std::vector<std::uint8_t> is_kept(mesh_.triangles.size(), 1);
    for (std::size_t i = 1; i < order.size(); ++i)
      if (sorted[at(order[i])] == sorted[at(order[i - 1])]) is_kept[at(order[i])] = 0;
    const int count = static_cast<int>(std::count(is_kept.begin(), is_kept.end(), 0));
    if (count == 0) return;
    MeshFinding& finding = report(MeshFault::duplicate_triangles, Severity::mended, count);
    const auto first = at(static_cast<int>(std::find(is_kept.begin(), is_kept.end(), 0) - is_kept.begin()));
    const std::string words = say_triangle(finding, triangle_source_[first]);
    finding.sentence = counted(count, "triangle has", "triangles have") +
                       " the same corners as another one (first " + words + "): dropped.";
    keep_triangles(is_kept);
  }

  void drop_unused() {
    std::vector<std::uint8_t> is_used(mesh_.positions.size(), 0);
    for (const Triangle& t : mesh_.triangles)
      for (const int v : t) is_used[at(v)] = 1;
    std::size_t kept = 0;
    for (std::size_t v = 0; v < is_used.size(); ++v)
      if (is_used[v]) vertex_source_[kept++] = vertex_source_[v];
    vertex_source_.resize(kept);
    drop_unused_vertices(mesh_);
  }

  bool test_rest() {
    if (!mesh_.triangles.empty()) return true;
    report(MeshFault::empty, Severity::refused, 0).sentence =
        "Nothing is left of the mesh: no triangle has an area. Is it scaled to nothing along an axis?";
    return false;
  }

  bool test_edges() {
    topology_ = build_edge_topology(mesh_.triangles);
    int count = 0;
    int first = -1;
    for (std::size_t e = 0; e < topology_.edges.size(); ++e)
      if (topology_.triangle_count(static_cast<int>(e)) > 2 && count++ == 0) first = static_cast<int>(e);
    if (count == 0) return true;
    MeshFinding& finding = report(MeshFault::non_manifold_edges, Severity::refused, count);
    const auto& ends = topology_.edges[at(first)];
    finding.vertex = vertex_source_[at(ends[0])];
    finding.triangle =
        triangle_source_[at(topology_.edge_triangles[at(topology_.first_triangle[at(first)])])];
    finding.place = 0.5 * (position(ends[0]) + position(ends[1]));
    finding.sentence = counted(count, "edge belongs", "edges belong") +
                       " to more than two triangles, first the edge from vertex " +
                       std::to_string(finding.vertex + 1) + " to vertex " +
                       std::to_string(vertex_source_[at(ends[1])] + 1) + " at " + at_place(finding.place) +
                       " (" + std::to_string(topology_.triangle_count(first)) +
                       " triangles). A shell is a single sheet: take the inner wall out, or make two bodies.";
    return false;
  }

  /// Walks over the edges, turning triangles so that neighbours agree; the smaller half of a part is turned.
  bool orient() {
    const std::size_t triangles = mesh_.triangles.size();
    part_.assign(triangles, -1);
    std::vector<std::uint8_t> is_turned(triangles, 0);
    int turned = 0;
    int first_turned = -1;
    for (std::size_t seed = 0; seed < triangles; ++seed) {
      if (part_[seed] >= 0) continue;
      std::vector<std::size_t> members{seed};
      part_[seed] = diagnosis_.part_count++;
      for (std::size_t i = 0; i < members.size(); ++i)
        if (!visit_neighbours(members, members[i], is_turned)) return false;
      const auto minority =
          std::count_if(members.begin(), members.end(), [&](std::size_t t) { return is_turned[t]; });
      if (2 * static_cast<std::size_t>(minority) > members.size())
        for (const std::size_t t : members) is_turned[t] = !is_turned[t];
    }
    for (std::size_t t = 0; t < triangles; ++t) {
      if (!is_turned[t]) continue;
      std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
      if (turned++ == 0) first_turned = triangle_source_[t];
    }
    diagnosis_.is_closed =
        std::none_of(topology_.edges.begin(), topology_.edges.end(),
                     [&, e = 0](const auto&) mutable { return topology_.is_boundary(e++); });
    const bool is_inside_out =
        diagnosis_.is_closed && diagnosis_.part_count == 1 && enclosed_volume(mesh_) < 0.0;
    if (is_inside_out)
      for (Triangle& t : mesh_.triangles) std::swap(t[1], t[2]);
    if (turned > 0 || is_inside_out) {
      MeshFinding& finding = report(MeshFault::mixed_winding, Severity::mended,
                                    turned > 0 ? turned : static_cast<int>(triangles));
      const std::string words = say_triangle(finding, turned > 0 ? first_turned : triangle_source_[0]);
      finding.sentence = turned > 0 ? counted(turned, "triangle is", "triangles are") +
                                          " wound against the neighbours (first " + words + "): turned."
                                    : std::string("The closed surface is inside out: all triangles turned.");
    }
    return true;
  }

  bool visit_neighbours(std::vector<std::size_t>& members, std::size_t t,
                        std::vector<std::uint8_t>& is_turned) {
    for (const int edge : topology_.triangle_edges[t]) {
      if (topology_.triangle_count(edge) != 2) continue;
      const auto begin = at(topology_.first_triangle[at(edge)]);
      const int one = topology_.edge_triangles[begin];
      const auto other = at(one == static_cast<int>(t) ? topology_.edge_triangles[begin + 1] : one);
      const auto& ends = topology_.edges[at(edge)];
      const bool agrees =
          direction_along(mesh_.triangles[t], ends) != direction_along(mesh_.triangles[other], ends);
      const bool wanted = agrees ? is_turned[t] : !is_turned[t];
      if (part_[other] < 0) {
        part_[other] = part_[t];
        is_turned[other] = wanted;
        members.push_back(other);
      } else if (static_cast<bool>(is_turned[other]) != wanted) {
        diagnosis_.part_count = 0;
        MeshFinding& finding = report(MeshFault::not_orientable, Severity::refused, 1);
        finding.sentence = "The surface has only one side, like a Moebius strip (seen at " +
                           say_triangle(finding, triangle_source_[other]) +
                           "): stress on its two faces cannot be told apart. Cut it open somewhere.";
        return false;
      }
    }
    return true;
  }

  /// A vertex whose triangles form several fans, joined in it alone, gets a copy for each further fan.
  void split_fans() {
    std::vector<std::vector<std::size_t>> around(mesh_.positions.size());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (const int v : mesh_.triangles[t]) around[at(v)].push_back(t);
    int count = 0;
    int first = -1;
    const int vertices = static_cast<int>(mesh_.positions.size());
    for (int v = 0; v < vertices; ++v) {
      std::vector<std::size_t> rest = around[at(v)];
      bool is_split = false;
      for (int fan = 0; !rest.empty(); ++fan) {
        const std::vector<std::size_t> members = take_fan(rest, v);
        if (fan == 0) continue;
        is_split = true;
        const int copy = static_cast<int>(mesh_.positions.size());
        mesh_.positions.push_back(Vec3(mesh_.positions[at(v)]));
        vertex_source_.push_back(vertex_source_[at(v)]);
        for (const std::size_t t : members)
          std::replace(mesh_.triangles[t].begin(), mesh_.triangles[t].end(), v, copy);
      }
      if (is_split && count++ == 0) first = vertex_source_[at(v)];
    }
    if (count == 0) return;
    MeshFinding& finding = report(MeshFault::non_manifold_vertices, Severity::mended, count);
    const std::string words = say_vertex(finding, first);
    finding.sentence = counted(count, "vertex joins", "vertices join") +
                       " surfaces that touch nowhere else (first " + words +
                       "): each gets a vertex of its own.";
  }

  /// Takes out of `rest` the triangles reachable from its first one over edges at v.
  std::vector<std::size_t> take_fan(std::vector<std::size_t>& rest, int v) const {
    std::vector<std::size_t> members{rest.front()};
    rest.erase(rest.begin());
    const auto shares_edge = [&](const Triangle& a, const Triangle& b) {
      return std::any_of(a.begin(), a.end(),
                         [&](int w) { return w != v && std::find(b.begin(), b.end(), w) != b.end(); });
    };
    for (std::size_t i = 0; i < members.size(); ++i)
      for (auto r = rest.begin(); r != rest.end();) {
        if (shares_edge(mesh_.triangles[members[i]], mesh_.triangles[*r])) {
          members.push_back(*r);
          r = rest.erase(r);
        } else {
          ++r;
        }
      }
    return members;
  }

  void test_parts() {
    if (diagnosis_.part_count <= 1) return;
    MeshFinding& finding =
        report(MeshFault::loose_parts, options_.allow_loose_parts ? Severity::noted : Severity::refused,
               diagnosis_.part_count);
    const auto second = std::find(part_.begin(), part_.end(), 1) - part_.begin();
    const std::string words = say_triangle(finding, triangle_source_[at(static_cast<int>(second))]);
    finding.sentence =
        "The mesh has " + std::to_string(diagnosis_.part_count) + " loose parts (the second begins with " +
        words + ")" +
        (options_.allow_loose_parts ? "; they move as one rigid body."
                                    : ". Join them, make a body of each, or allow loose parts.");
  }

  void note_slivers() {
    int count = 0;
    int first = -1;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (flatness(mesh_, mesh_.triangles[t]) >= options_.sliver_ratio) continue;
      if (count++ == 0) first = triangle_source_[t];
    }
    if (count == 0) return;
    MeshFinding& finding = report(MeshFault::slivers, Severity::noted, count);
    const std::string words = say_triangle(finding, first);
    finding.sentence = counted(count, "triangle is", "triangles are") + " very thin (first " + words +
                       "): stress there is not exact. Mesh the surface again with more even triangles.";
  }

  MendedMesh result() {
    std::stable_sort(diagnosis_.findings.begin(), diagnosis_.findings.end(),
                     [](const MeshFinding& a, const MeshFinding& b) { return a.fault < b.fault; });
    MendedMesh mended;
    mended.diagnosis = std::move(diagnosis_);
    if (mended.diagnosis.refused()) return mended;
    mended.mesh = std::move(mesh_);
    mended.triangle_source = std::move(triangle_source_);
    mended.vertex_source = std::move(vertex_source_);
    return mended;
  }

  const TriangleMesh& given_;
  const MendOptions& options_;
  TriangleMesh mesh_;
  std::vector<int> triangle_source_;
  std::vector<int> vertex_source_;
  EdgeTopology topology_;  // of mesh_ from test_edges on
  std::vector<int> part_;  // per triangle
  MeshDiagnosis diagnosis_;
};

}  // namespace

bool MeshDiagnosis::refused() const {
  return std::any_of(findings.begin(), findings.end(),
                     [](const MeshFinding& f) { return f.severity == Severity::refused; });
}

const MeshFinding* MeshDiagnosis::find(MeshFault fault) const {
  for (const MeshFinding& finding : findings)
    if (finding.fault == fault) return &finding;
  return nullptr;
}

std::string MeshDiagnosis::sentences(Severity severity) const {
  std::string text;
  for (const MeshFinding& finding : findings)
    if (finding.severity == severity) text += (text.empty() ? "" : "\n") + finding.sentence;
  return text;
}

MeshDiagnosis diagnose(const TriangleMesh& mesh, const MendOptions& options) {
  return mend(mesh, options).diagnosis;
}

MendedMesh mend(const TriangleMesh& mesh, const MendOptions& options) {
  return Mender(mesh, options).run();
}

}  // namespace shatterbox::geometry
