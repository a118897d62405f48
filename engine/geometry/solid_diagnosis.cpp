// What a solid's surface must be beyond a shell's: closed, facing outwards, not passing through itself.
#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/index.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/mesh_diagnosis.h"
#include "engine/geometry/mesh_findings.h"
#include "engine/geometry/orientation.h"
#include "engine/geometry/self_crossings.h"
#include "engine/geometry/winding.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

MendedMesh refused(MeshFindings& findings) {
  MendedMesh mended;
  mended.diagnosis = std::move(findings.diagnosis);
  return mended;
}

void refuse_open(const MendedMesh& mended, const EdgeTopology& topology, MeshFindings& findings) {
  int count = 0, first = -1;
  for (int e = 0; e < static_cast<int>(topology.edges.size()); ++e)
    if (topology.is_boundary(e) && count++ == 0) first = e;
  MeshFinding& finding = findings.report(MeshFault::open_border, Severity::refused, count);
  const auto& ends = topology.edges[at(first)];
  finding.vertex = mended.vertex_source[at(ends[0])];
  finding.triangle =
      mended.triangle_source[at(topology.edge_triangles[at(topology.first_triangle[at(first)])])];
  finding.place = 0.5 * (mended.mesh.positions[at(ends[0])] + mended.mesh.positions[at(ends[1])]);
  finding.sentence = "The surface of a solid must be closed, but " +
                     counted(count, "edge has", "edges have") + " a triangle on one side only, first at " +
                     at_place(finding.place) + ". Close the hole, or make it a shell with a thickness.";
}

/// True if `p` is inside of an odd number of the parts but `part`.
bool is_in_hollow(const TriangleMesh& mesh, const std::vector<int>& parts, int part, const Vec3& p,
                  const Vec3& far) {
  bool is_inside = false;
  for (Size t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    if (parts[t] != part && passage_of_edge(p, far,
                                            {mesh.positions[at(corners[0])], mesh.positions[at(corners[1])],
                                             mesh.positions[at(corners[2])]}) != 0)
      is_inside = !is_inside;
  }
  return is_inside;
}

/// Turns parts that face the wrong way: the outer ones outwards, those in them inwards, and so on.
void turn_parts(MendedMesh& mended, const Winding& winding, MeshFindings& findings) {
  TriangleMesh& mesh = mended.mesh;
  Box box;
  for (const Vec3& p : mesh.positions) box.include(p);
  const Vec3 far = box.high + Vec3(0.31, 0.47, 0.17) * (box.high - box.low).maxCoeff();
  int count = 0, first = -1;
  for (int part = 0; part < winding.part_count; ++part) {
    TriangleMesh alone{mesh.positions, {}};
    for (Size t = 0; t < mesh.triangles.size(); ++t)
      if (winding.part[t] == part) alone.triangles.push_back(mesh.triangles[t]);
    const Vec3& p = mesh.positions[at(alone.triangles[0][0])];
    const bool is_hollow = winding.part_count > 1 && is_in_hollow(mesh, winding.part, part, p, far);
    if ((enclosed_volume(alone) < 0.0) == is_hollow) continue;
    for (Size t = 0; t < mesh.triangles.size(); ++t) {
      if (winding.part[t] != part) continue;
      if (first < 0) first = static_cast<int>(t);
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    }
    ++count;
  }
  if (count == 0) return;
  MeshFinding& finding = findings.report(MeshFault::mixed_winding, Severity::mended, count);
  const std::string words = findings.say_triangle(finding, mended.triangle_source[at(first)]);
  finding.sentence = counted(count, "closed part of the surface was", "closed parts of the surface were") +
                     " inside out (first " + words + "): turned.";
}

/// False if the surface passes through itself.
bool test_self_crossing(const MendedMesh& mended, MeshFindings& findings) {
  const SelfCrossings crossings = find_self_crossings(mended.mesh);
  if (crossings.count == 0) return true;
  MeshFinding& finding = findings.report(MeshFault::self_crossing, Severity::refused, crossings.count);
  finding.triangle = mended.triangle_source[at(crossings.first_triangle)];
  finding.place = crossings.place;
  finding.sentence =
      counted(crossings.count, "pair of triangles passes", "pairs of triangles pass") +
      " through each other, first triangle " + std::to_string(finding.triangle + 1) + " and triangle " +
      std::to_string(mended.triangle_source[at(crossings.second_triangle)] + 1) + " at " +
      at_place(finding.place) + ": what is inside cannot be told. Unite the parts in the modelling tool.";
  return false;
}

}  // namespace

MendedMesh mend_solid(const TriangleMesh& mesh, const MendOptions& options) {
  MendOptions loose = options;
  loose.allow_loose_parts = true;
  MendedMesh mended = mend(mesh, loose);
  if (mended.diagnosis.refused()) return mended;
  MeshFindings findings(mesh);
  findings.diagnosis = std::move(mended.diagnosis);
  const EdgeTopology topology = build_edge_topology(mended.mesh.triangles);
  if (!findings.diagnosis.is_closed) {
    refuse_open(mended, topology, findings);
    return refused(findings);
  }
  if (!test_self_crossing(mended, findings)) return refused(findings);
  turn_parts(mended, make_windings_agree(mended.mesh, topology), findings);
  std::stable_sort(findings.diagnosis.findings.begin(), findings.diagnosis.findings.end(),
                   [](const MeshFinding& a, const MeshFinding& b) { return a.fault < b.fault; });
  mended.diagnosis = std::move(findings.diagnosis);
  return mended;
}

}  // namespace shatterbox::geometry
