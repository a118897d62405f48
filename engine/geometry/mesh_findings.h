// What is said about a given mesh, and what can be told before anything is changed. For mesh_diagnosis.cpp.
#pragma once

#include <string>

#include "engine/geometry/mesh_diagnosis.h"

namespace shatterbox::geometry {

/// "1 vertex", "3 vertices".
std::string counted(int count, const char* one, const char* many);

/// "(x, y, z)".
std::string at_place(const Vec3& place);

class MeshFindings {
 public:
  explicit MeshFindings(const TriangleMesh& given) : given_(given) {}

  MeshDiagnosis diagnosis;

  /// Adds one. Good until the next.
  MeshFinding& report(MeshFault fault, Severity severity, int count);

  /// Sets the place to a vertex of the given mesh, and says it.
  std::string say_vertex(MeshFinding& finding, int given_vertex) const;
  /// Likewise a triangle, by its middle.
  std::string say_triangle(MeshFinding& finding, int given_triangle) const;

  /// False, with a refusal, if there are no triangles, numbers that are none, or vertices that are not there.
  bool test_given() { return test_empty() && test_numbers() && test_indices(); }
  void count_unused();

 private:
  bool test_empty();
  bool test_numbers();
  bool test_indices();

  const TriangleMesh& given_;
};

}  // namespace shatterbox::geometry
