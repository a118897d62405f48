#include "engine/fracture/solid_hole.h"

#include <utility>

#include "engine/geometry/solid_contacts.h"

namespace shatterbox::fracture {
namespace {

constexpr double kPlugClearance = 0.02;  // of the section's diameter: by which the hole is wider, all around
constexpr double kPlugTolerance =
    0.01;                           // of it: a plug's sharp corner, which stands back, may stand out so far
constexpr double kPlugTaper = 0.1;  // by which it widens along the way: plugs are cones of some degrees

}  // namespace

std::optional<SolidHole> find_perforation(const geometry::SolidComplex& complex,
                                          const material::Material& material, const Striker& striker,
                                          double least_width, int tag) {
  std::optional<Perforation> begun = begin_perforation(material, striker);
  if (!begun) return std::nullopt;
  SolidHole out{std::move(*begun), nullptr};
  // What is straight in his way tells how thick it is and where it begins; the plug is a cone from there.
  const double clearance = kPlugClearance * section_of(striker).diameter;
  const std::vector<int> cells = find_punch_cells(complex, sides_of_way(striker, clearance), striker.place);
  const WayMaterial way = find_way_material(complex, cells, striker, clearance);
  if (!ask_for_hole(material, way, out)) return out;
  const std::vector<geometry::PunchSide> sides = sides_of_way(striker, clearance, kPlugTaper, way.front);
  std::vector<int> groups(complex.cells.size(), -1);
  for (const int cell : find_punch_cells(complex, sides, striker.place))
    groups[static_cast<std::size_t>(cell)] = 0;
  auto cut = std::make_shared<geometry::SolidComplex>(complex);
  const geometry::Punched punched = punch_out(*cut, {{sides, 0}}, std::move(groups), tag);
  const double volume = punched.volumes.front();
  const int part_count = count_parts(*cut);
  if (part_count <= count_parts(complex)) return std::nullopt;
  if (!(volume > least_width * punched.wall_area)) return out;
  if (volume > kMostPlug * total_volume(complex)) return std::nullopt;
  out.complex = std::move(cut);
  out.sides = sides;
  out.slack = kPlugTolerance * section_of(striker).diameter;
  take_plug(volume, material.density, punched.wall_area, part_count, out);
  return out;
}

}  // namespace shatterbox::fracture
