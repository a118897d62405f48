#include "sandbox/scene/polygons.h"

#include "engine/geometry/weld.h"

namespace shatterbox::sandbox::scene {

void Polygons::add(const std::vector<std::size_t>& corners) {
  if (corners.size() < 3 || corners.size() > kMostCorners) {
    ++left_out;
    return;
  }
  polygon_count += corners.size() > 3 ? 1 : 0;
  lines += 'f';
  for (const std::size_t corner : corners) lines += ' ' + std::to_string(corner + 1);
  lines += '\n';
}

core::Result<geometry::TriangleMesh> make_triangles(Polygons polygons, const std::filesystem::path& path,
                                                    std::vector<std::string>* notes) {
  for (std::size_t v = 0; v < polygons.positions.size(); ++v)
    if (!polygons.positions[v].allFinite())
      return mesh_fault(path, 0, "vertex " + std::to_string(v + 1) + " has a coordinate that is no number");
  if (polygons.positions.size() > kMostVertices) return mesh_fault(path, 0, "too many vertices");
  if (polygons.lines.empty()) return mesh_fault(path, 0, "there are no triangles in it");
  core::Result<geometry::TriangleMesh> mesh =
      cut_polygons(std::move(polygons.positions), polygons.lines, path);
  if (!mesh) return mesh;
  const int welded = geometry::weld_equal_positions(mesh.value());
  if (!notes) return mesh;
  if (polygons.left_out > 0)
    notes->push_back(path.string() + ": " + std::to_string(polygons.left_out) + " points and lines left out");
  if (polygons.polygon_count > 0)
    notes->push_back(path.string() + ": " + std::to_string(polygons.polygon_count) +
                     " polygons cut into triangles");
  if (welded > 0)
    notes->push_back(path.string() + ": " + std::to_string(welded) +
                     " vertices welded that lie exactly on another one");
  return mesh;
}

}  // namespace shatterbox::sandbox::scene
