// Who touches whom in a cut solid, and the degrees of freedom that follow: the virtual node algorithm [MBF04]
// on tetrahedra. Every cell has a copy of its element's four nodes; copies are one where material touches.
#pragma once

#include <vector>

#include "engine/geometry/solid_complex.h"
#include "engine/geometry/solid_mesh.h"

namespace shatterbox::geometry {

/// All pairs of cells whose material holds together over a facet, each with the common area, in a total order
/// (cell_a < cell_b). The complex is settled.
std::vector<SolidContact> find_solid_contacts(const SolidComplex& complex);

/// The number of each cell's part, which hangs together; parts are numbered by their first cells.
std::vector<int> label_parts(std::size_t cell_count, const std::vector<SolidContact>& contacts,
                             int& part_count);

/// How many parts a settled complex falls into.
int count_parts(const SolidComplex& complex);

/// The cells of a settled complex (of the same numbers) with their virtual vertices: of cells of two elements
/// the copies of their common nodes are one, of cells of one element all four, where they touch. Numbers
/// follow the order of the cells.
SolidMesh make_solid_mesh(const SolidComplex& complex, const std::vector<SolidContact>& contacts);

}  // namespace shatterbox::geometry
