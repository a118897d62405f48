#include "engine/geometry/mesh_diagnosis.h"

#include <algorithm>
#include <numeric>

#include "engine/core/index.h"
#include "engine/geometry/edge_topology.h"
#include "engine/geometry/flat_triangles.h"
#include "engine/geometry/mesh_findings.h"
#include "engine/geometry/vertex_fans.h"
#include "engine/geometry/weld.h"
#include "engine/geometry/winding.h"

namespace shatterbox::geometry {
namespace {

using core::at;

/// One mesh on its way through all tests; each returns false if it refuses.
class Mender {
 public:
  Mender(const TriangleMesh& given, const MendOptions& options)
      : given_(given), options_(options), findings_(given) {}

  MendedMesh run() {
    if (findings_.test_given()) {
      mesh_ = given_;
      triangle_source_.resize(given_.triangles.size());
      std::iota(triangle_source_.begin(), triangle_source_.end(), 0);
      vertex_source_.resize(given_.positions.size());
      std::iota(vertex_source_.begin(), vertex_source_.end(), 0);
      findings_.count_unused();
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
  const Vec3& position(int vertex) const { return mesh_.positions[at(vertex)]; }

  void weld() {
    const std::vector<int> first = find_equal_positions(mesh_.positions);
    int count = 0;
    int place = -1;
    for (std::size_t v = 0; v < first.size(); ++v)
      if (first[v] != static_cast<int>(v) && count++ == 0) place = static_cast<int>(v);
    if (count == 0) return;
    for (Triangle& t : mesh_.triangles)
      for (int& v : t) v = first[at(v)];
    MeshFinding& finding = findings_.report(MeshFault::duplicate_vertices, Severity::mended, count);
    const std::string words = findings_.say_vertex(finding, place);
    finding.sentence = counted(count, "vertex lies", "vertices lie") + " exactly on another one (first " +
                       words + "): welded.";
  }

  void drop_flat() {
    const FlatTriangles flat = remove_flat_triangles(mesh_, triangle_source_);
    if (flat.count == 0) return;
    MeshFinding& finding = findings_.report(MeshFault::degenerate_triangles, Severity::mended, flat.count);
    const std::string words = findings_.say_triangle(finding, flat.first);
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
    MeshFinding& finding = findings_.report(MeshFault::duplicate_triangles, Severity::mended, count);
    const auto first = at(static_cast<int>(std::find(is_kept.begin(), is_kept.end(), 0) - is_kept.begin()));
    const std::string words = findings_.say_triangle(finding, triangle_source_[first]);
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
    findings_.report(MeshFault::empty, Severity::refused, 0).sentence =
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
    MeshFinding& finding = findings_.report(MeshFault::non_manifold_edges, Severity::refused, count);
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
                       " triangles). A surface has two: take the inner wall out, or make two bodies.";
    return false;
  }

  bool orient() {
    winding_ = make_windings_agree(mesh_, topology_);
    if (winding_.one_sided_triangle >= 0) {
      MeshFinding& finding = findings_.report(MeshFault::not_orientable, Severity::refused, 1);
      finding.sentence = "The surface has only one side, like a Moebius strip (seen at " +
                         findings_.say_triangle(finding, triangle_source_[at(winding_.one_sided_triangle)]) +
                         "): stress on its two faces cannot be told apart. Cut it open somewhere.";
      return false;
    }
    findings_.diagnosis.part_count = winding_.part_count;
    findings_.diagnosis.is_closed = winding_.is_closed;
    say_turned();
    return true;
  }

  void say_turned() {
    const int turned = winding_.turned_count, parts = winding_.inside_out_parts;
    if (turned == 0 && parts == 0) return;
    const bool is_whole = parts == 1 && winding_.part_count == 1;
    MeshFinding& finding =
        findings_.report(MeshFault::mixed_winding, Severity::mended,
                         turned > 0 ? turned : (is_whole ? static_cast<int>(mesh_.triangles.size()) : parts));
    const int first = turned > 0 ? winding_.first_turned : winding_.first_inside_out;
    const std::string words =
        findings_.say_triangle(finding, triangle_source_[at(is_whole && turned == 0 ? 0 : first)]);
    if (turned > 0)
      finding.sentence = counted(turned, "triangle is", "triangles are") +
                         " wound against the neighbours (first " + words + "): turned.";
    else if (is_whole)
      finding.sentence = "The closed surface is inside out: all triangles turned.";
    else
      finding.sentence =
          counted(parts, "closed part is", "closed parts are") + " inside out (" + words + "): turned.";
  }

  void split_fans() {
    const SplitFans split = split_vertex_fans(mesh_, vertex_source_);
    if (split.count == 0) return;
    MeshFinding& finding = findings_.report(MeshFault::non_manifold_vertices, Severity::mended, split.count);
    const std::string words = findings_.say_vertex(finding, split.first);
    finding.sentence = counted(split.count, "vertex joins", "vertices join") +
                       " surfaces that touch nowhere else (first " + words +
                       "): each gets a vertex of its own.";
  }

  void test_parts() {
    if (findings_.diagnosis.part_count <= 1) return;
    MeshFinding& finding = findings_.report(MeshFault::loose_parts,
                                            options_.allow_loose_parts ? Severity::noted : Severity::refused,
                                            findings_.diagnosis.part_count);
    const auto second = std::find(winding_.part.begin(), winding_.part.end(), 1) - winding_.part.begin();
    const std::string words = findings_.say_triangle(finding, triangle_source_[at(static_cast<int>(second))]);
    finding.sentence =
        "The mesh has " + std::to_string(findings_.diagnosis.part_count) +
        " loose parts (the second begins with " + words + ")" +
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
    MeshFinding& finding = findings_.report(MeshFault::slivers, Severity::noted, count);
    const std::string words = findings_.say_triangle(finding, first);
    finding.sentence = counted(count, "triangle is", "triangles are") + " very thin (first " + words +
                       "): stress there is not exact. Mesh the surface again with more even triangles.";
  }

  MendedMesh result() {
    std::stable_sort(findings_.diagnosis.findings.begin(), findings_.diagnosis.findings.end(),
                     [](const MeshFinding& a, const MeshFinding& b) { return a.fault < b.fault; });
    MendedMesh mended;
    mended.diagnosis = std::move(findings_.diagnosis);
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
  Winding winding_;        // likewise, from orient on
  MeshFindings findings_;
};

}  // namespace

MeshDiagnosis diagnose(const TriangleMesh& mesh, const MendOptions& options) {
  return mend(mesh, options).diagnosis;
}

MendedMesh mend(const TriangleMesh& mesh, const MendOptions& options) {
  return Mender(mesh, options).run();
}

}  // namespace shatterbox::geometry
