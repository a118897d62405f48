#include "engine/geometry/mesh_findings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>

#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using core::at;

constexpr double kMostCoordinate =
    1e60;  // m: areas and inertias of anything larger leave the range of a double

/// Eigen's own test for finiteness subtracts, which traps on what it looks for.
bool is_usable(const Vec3& p) {
  for (const double x : {p.x(), p.y(), p.z()})
    if (!std::isfinite(x) || std::abs(x) >= kMostCoordinate) return false;
  return true;
}

}  // namespace

std::string counted(int count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string at_place(const Vec3& place) {
  std::ostringstream text;
  text << "(" << place.x() << ", " << place.y() << ", " << place.z() << ")";
  return text.str();
}

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

MeshFinding& MeshFindings::report(MeshFault fault, Severity severity, int count) {
  MeshFinding finding;
  finding.fault = fault;
  finding.severity = severity;
  finding.count = count;
  diagnosis.findings.push_back(finding);
  return diagnosis.findings.back();
}

std::string MeshFindings::say_vertex(MeshFinding& finding, int given_vertex) const {
  finding.vertex = given_vertex;
  finding.place = given_.positions[at(given_vertex)];
  return "vertex " + std::to_string(given_vertex + 1) + " at " + at_place(finding.place);
}

std::string MeshFindings::say_triangle(MeshFinding& finding, int given_triangle) const {
  const Triangle& t = given_.triangles[at(given_triangle)];
  finding.triangle = given_triangle;
  finding.place =
      (given_.positions[at(t[0])] + given_.positions[at(t[1])] + given_.positions[at(t[2])]) / 3.0;
  return "triangle " + std::to_string(given_triangle + 1) + " at " + at_place(finding.place);
}

bool MeshFindings::test_empty() {
  if (!given_.triangles.empty()) return true;
  report(MeshFault::empty, Severity::refused, 0).sentence =
      given_.positions.empty()
          ? "The mesh is empty: it has no vertices and no triangles."
          : "The mesh has vertices but no triangles; export its faces, not only its points.";
  return false;
}

bool MeshFindings::test_numbers() {
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

bool MeshFindings::test_indices() {
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
                     std::to_string(std::int64_t{wrong} + 1) + ", but there are " + std::to_string(vertices) +
                     " vertices. The file is cut short or its numbering is wrong.";
  return false;
}

void MeshFindings::count_unused() {
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

}  // namespace shatterbox::geometry
