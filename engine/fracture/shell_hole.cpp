#include "engine/fracture/shell_hole.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/index.h"
#include "engine/fracture/split_shell.h"
#include "engine/fracture/voronoi_cells.h"

namespace shatterbox::fracture {
namespace {

using core::at;

// Of the section's diameter: by which the hole is wider, all around. Its corners are moved away from vertices
// of the mesh by up to a twentieth of an edge.
constexpr double kSheetClearance = 0.05;
constexpr double kAlongTheWay =
    0.2;  // cosine: where a sheet is nearly along the way another side of it begins

/// Cells (ascending) that may reach into the way and hang together there, none along it, with the one nearest
/// to where he touched.
std::vector<int> find_way_cells(const geometry::ShellMesh& mesh,
                                const std::vector<geometry::CellContact>& contacts,
                                const std::vector<geometry::PunchSide>& sides, const Striker& striker) {
  std::vector<char> is_in(mesh.cells.size(), 0);
  int nearest = -1;
  double least = 1e300;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const geometry::ShellCell& cell = mesh.cells[c];
    std::vector<Vec3> corners;
    Vec3 middle = Vec3::Zero();
    for (int i = 0; i < cell.corner_count; ++i) {
      corners.push_back(position_in_element(*mesh.elements, cell.element,
                                            mesh.corners[at(cell.first_corner + i)].barycentric));
      middle += corners.back() / cell.corner_count;
    }
    const Vec3 normal = geometry::facet_frame(*mesh.elements, cell.element).col(2);
    if (std::abs(normal.dot(striker.direction)) < kAlongTheWay) continue;
    const bool reaches = std::all_of(sides.begin(), sides.end(), [&](const geometry::PunchSide& side) {
      return std::any_of(corners.begin(), corners.end(),
                         [&](const Vec3& x) { return side.normal.dot(x) <= side.offset; });
    });
    if (!reaches) continue;
    is_in[c] = 1;
    const double distance = (middle - striker.place).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    nearest = static_cast<int>(c);
  }
  if (nearest < 0) return {};
  std::vector<std::vector<int>> neighbours(mesh.cells.size());
  for (const geometry::CellContact& contact : contacts) {
    if (is_in[at(contact.cell_a)] == 0 || is_in[at(contact.cell_b)] == 0) continue;
    neighbours[at(contact.cell_a)].push_back(contact.cell_b);
    neighbours[at(contact.cell_b)].push_back(contact.cell_a);
  }
  std::vector<int> found{nearest};
  is_in[at(nearest)] = 0;
  for (std::size_t next = 0; next < found.size(); ++next)
    for (const int neighbour : neighbours[at(found[next])]) {
      if (is_in[at(neighbour)] == 0) continue;
      is_in[at(neighbour)] = 0;
      found.push_back(neighbour);
    }
  std::sort(found.begin(), found.end());
  return found;
}

/// The plug's seed, and its mirror images in the hole's sides.
std::vector<CellSeed> mirrored_seeds(const std::vector<geometry::PunchSide>& sides, const Striker& striker) {
  const Vec3 middle =
      striker.centre + striker.direction.dot(striker.place - striker.centre) * striker.direction;
  std::vector<CellSeed> seeds{{middle, true, 0}};
  for (const geometry::PunchSide& side : sides)
    seeds.push_back({middle + 2.0 * (side.offset - side.normal.dot(middle)) * side.normal, false, 0});
  return seeds;
}

/// m2, of the cells that were cut out.
double area_within(const geometry::ShellMesh& mesh, const std::vector<char>& is_cut,
                   const std::vector<CellSeed>& seeds) {
  double area = 0.0;
  for (const geometry::ShellCell& cell : mesh.cells) {
    if (is_cut[at(cell.element)] == 0) continue;
    Vec2 middle = Vec2::Zero();
    for (int i = 0; i < cell.corner_count; ++i)
      middle += mesh.corners[at(cell.first_corner + i)].barycentric / cell.corner_count;
    const Vec3 place = position_in_element(*mesh.elements, cell.element, middle);
    const double own = (place - seeds[0].position).squaredNorm();
    if (std::all_of(seeds.begin() + 1, seeds.end(),
                    [&](const CellSeed& seed) { return (place - seed.position).squaredNorm() >= own; }))
      area += cell.area;
  }
  return area;
}

int count_pieces(const geometry::ShellMesh& mesh, const std::vector<geometry::CellContact>& contacts) {
  int count = 0;
  label_pieces(mesh.cells.size(), contacts, count);
  return count;
}

}  // namespace

std::optional<ShellHole> find_perforation(const ShellSubject& subject, const Striker& striker,
                                          double least_width, int crack) {
  std::optional<Perforation> begun = begin_perforation(subject.material, striker);
  if (!begun) return std::nullopt;
  ShellHole out{std::move(*begun), nullptr, {}, {}};
  const geometry::ShellMesh& mesh = *subject.mesh;
  const std::vector<geometry::CellContact>& contacts = subject.systems->figures().contacts;
  const double clearance = kSheetClearance * section_of(striker).diameter;
  out.sides = sides_of_way(striker, clearance);
  const std::vector<int> cells = find_way_cells(mesh, contacts, out.sides, striker);
  const WayMaterial way = find_way_material(mesh, subject.thickness, cells, striker, clearance);
  if (!ask_for_hole(subject.material, way, out)) return out;

  CellSetup setup;
  for (const int c : cells) setup.elements.push_back(mesh.cells[at(c)].element);
  std::sort(setup.elements.begin(), setup.elements.end());
  setup.elements.erase(std::unique(setup.elements.begin(), setup.elements.end()), setup.elements.end());
  setup.seeds = mirrored_seeds(out.sides, striker);
  setup.crack = crack;
  ShellCutter cutter(mesh);
  CellCracks cracks = cut_cells(cutter, ElementPlanes(*mesh.elements), setup);
  auto cut = std::make_shared<geometry::ShellMesh>(cutter.mesh(&out.contacts));
  const int parts = count_pieces(*cut, out.contacts);
  if (parts <= count_pieces(mesh, contacts)) return std::nullopt;
  std::vector<char> is_cut(mesh.elements->mesh.triangles.size(), 0);
  for (const int element : setup.elements) is_cut[at(element)] = 1;
  const double area = area_within(*cut, is_cut, setup.seeds);
  if (!(area > least_width * cracks.length)) return out;
  if (area > kMostPlug * total_area(mesh)) return std::nullopt;
  out.slack = clearance;
  out.mesh = std::move(cut);
  out.segments = std::move(cracks.segments);
  take_plug(area * subject.thickness, subject.material.density, cracks.length * subject.thickness, parts,
            out);
  return out;
}

}  // namespace shatterbox::fracture
