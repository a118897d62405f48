#include "engine/stress/stress_bound.h"

#include <algorithm>

#include "engine/core/elementary.h"

// Why the bound holds. One cell, stress sigma_m + (2 z / t) sigma_b over the thickness, S the compliance of
// plane stress: its energy is W = V / 2 (sigma_m S sigma_m + sigma_b S sigma_b / 3), and sigma S sigma >= (1
// - nu^2) / E sigma_1^2 (least over the second principal stress, at nu sigma_1). With e_m + e_b / 3 = W / V
// the face stress is at most sqrt(2 E / (1 - nu^2)) (sqrt(e_m) + sqrt(e_b)) <= sqrt(2 E / (1 - nu^2) * 4 W /
// V), by Cauchy and Schwarz with 1 and
// 3. The cell's volume is the one its stiffness has: t A', A' = max(A, floor).
// An average with weights A_i / S, S = sum A_i: the first principal stress is convex, so it is at most
// sum A_i / S sqrt(k W_i / (t A'_i)) <= sqrt(k W / t) sqrt(sum A_i^2 / (S^2 A'_i)), again by Cauchy and
// Schwarz.
//
// Of a solid sigma S sigma >= (1 + nu) (1 - 2 nu) / ((1 - nu) E) sigma_1^2: least where the other two
// principal stresses are both nu / (1 - nu) sigma_1, that is where nothing stretches across. One constant
// stress a cell.

namespace shatterbox::stress {
namespace {

using Size = std::size_t;

double stiff_area(const geometry::ShellMesh& mesh, Size cell) {
  return stiffness_fraction(*mesh.elements, mesh.cells[cell]) *
         geometry::element_area(*mesh.elements, mesh.cells[cell].element);
}

/// S^2 / sum A_i^2 / A'_i of each cell and its neighbours.
template <class Contact, class Share, class Stiff>
std::vector<double> gather(Size cells, const std::vector<Contact>& contacts, const Share& share_of,
                           const Stiff& stiff_of) {
  std::vector<double> sum(cells), weighted(cells);
  const auto add = [&](Size to, Size from) {
    const double share = share_of(from);
    const double stiff = stiff_of(from);
    sum[to] += share;
    if (stiff > 0.0) weighted[to] += share * share / stiff;
  };
  for (Size c = 0; c < cells; ++c) add(c, c);
  for (const Contact& contact : contacts) {
    add(static_cast<Size>(contact.cell_a), static_cast<Size>(contact.cell_b));
    add(static_cast<Size>(contact.cell_b), static_cast<Size>(contact.cell_a));
  }
  for (Size c = 0; c < cells; ++c)
    // Without area there is no average: the cell's own stress is taken.
    sum[c] = weighted[c] > 0.0 ? sum[c] * sum[c] / weighted[c] : stiff_of(c);
  return sum;
}

}  // namespace

double least_stressed_area(const geometry::ShellMesh& mesh) {
  double least = 0.0;
  for (Size c = 0; c < mesh.cells.size(); ++c) {
    const double area = stiff_area(mesh, c);
    least = c == 0 ? area : std::min(least, area);
  }
  return least;
}

std::vector<double> stressed_areas(const geometry::ShellMesh& mesh,
                                   const std::vector<geometry::CellContact>& contacts) {
  return gather(
      mesh.cells.size(), contacts, [&](Size c) { return mesh.cells[c].area; },
      [&](Size c) { return stiff_area(mesh, c); });
}

double least_stressed_area(const geometry::ShellMesh& mesh,
                           const std::vector<geometry::CellContact>& contacts) {
  const std::vector<double> areas = stressed_areas(mesh, contacts);
  return areas.empty() ? 0.0 : *std::min_element(areas.begin(), areas.end());
}

double bending_bound(double thickness, double width, double reach, double force) {
  return 6.0 * force * reach / (width * thickness * thickness);
}

double stress_bound(const ShellProperties& properties, double least_area, double energy) {
  const double nu = properties.poisson_ratio;
  if (!(energy > 0.0) || !(least_area > 0.0)) return 0.0;
  return core::sqrt(8.0 * properties.youngs_modulus / (1.0 - nu * nu) * energy /
                    (properties.thickness * least_area));
}

std::vector<double> stressed_volumes(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh,
                                     const std::vector<geometry::SolidContact>& contacts) {
  const double unit = stiffness.length * stiffness.length * stiffness.length;
  return gather(
      mesh.cells.size(), contacts, [&](Size c) { return std::max(0.0, mesh.cells[c].volume); },
      [&](Size c) {
        const SolidElement& element = stiffness.solids[static_cast<Size>(mesh.cells[c].element)];
        return unit * element.volume * stiffness_fraction(stiffness, mesh.cells[c]);
      });
}

double stress_bound(const SolidStiffness& stiffness, double volume, double energy) {
  const double nu = stiffness.poisson_ratio;
  if (!(energy > 0.0) || !(volume > 0.0)) return 0.0;
  return core::sqrt(2.0 * stiffness.properties.youngs_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) *
                    energy / volume);
}

}  // namespace shatterbox::stress
