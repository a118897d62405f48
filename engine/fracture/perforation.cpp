#include "engine/fracture/perforation.h"

#include <algorithm>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/fracture/perforation_law.h"
#include "engine/geometry/solid_contacts.h"

namespace shatterbox::fracture {
namespace {

using core::at;
using geometry::PunchSide;

constexpr double kPlugClearance = 0.02;   // of the section's diameter: by which the hole is wider, all around
constexpr double kPlugTaper = 0.1;        // by which it widens along the way: plugs are cones of some degrees
constexpr int kPunchSides = 24;           // of a round hole; at most so many of any
constexpr double kLeastTurn = 1e-5;       // rad, between two sides
constexpr double kLeastSquareness = 0.5;  // cosine: beyond 60 degrees strikers ricochet
constexpr double kMostPlug = 0.5;         // of the body: a hole is in what is more than the hole
constexpr double kShareThatCounts = 0.1;  // of the energy that a hole takes, from which it is looked for

Vec2 normal_at(double angle) {
  const core::SinCos turned = core::sin_cos(angle);
  return {turned.cos, turned.sin};
}

/// Directions of the hole's sides, by angle: those of the core's own sides, and about its round ones as many
/// more as make a circle of kPunchSides.
std::vector<Vec2> side_normals(const Striker& striker) {
  std::vector<double> angles;
  const std::size_t n = striker.core.size();
  if (n > 1 && n <= static_cast<std::size_t>(kPunchSides))
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 side = striker.core[(i + 1) % n] - striker.core[i];
      angles.push_back(core::atan2(-side.x(), side.y()));
    }
  const double step = 2.0 * core::kPi / kPunchSides;
  if (angles.empty()) {
    for (int i = 0; i < kPunchSides; ++i) angles.push_back(step * i);
  } else if (striker.radius > 0.0) {
    std::sort(angles.begin(), angles.end());
    const std::size_t given = angles.size();
    for (std::size_t i = 0; i < given; ++i) {
      const double gap = i + 1 < given ? angles[i + 1] - angles[i] : angles[0] + 2.0 * core::kPi - angles[i];
      const int parts = static_cast<int>(gap / step + 0.5);
      for (int k = 1; k < parts; ++k) angles.push_back(angles[i] + gap * k / parts);
    }
  }
  std::sort(angles.begin(), angles.end());
  std::vector<Vec2> normals;
  // One side in two parts is one.
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double next = i + 1 < angles.size() ? angles[i + 1] : angles.front() + 2.0 * core::kPi;
    if (next - angles[i] > kLeastTurn) normals.push_back(normal_at(angles[i]));
  }
  return normals;
}

double support_of_core(const Striker& striker, const Vec2& normal) {
  double most = -1e300;
  for (const Vec2& corner : striker.core) most = std::max(most, normal.dot(corner));
  return most + striker.radius;
}

/// The depth at which the material of these cells begins.
double find_front(const geometry::SolidComplex& complex, const std::vector<char>& is_inside,
                  const Vec3& direction) {
  double front = 1e300;
  for (std::size_t c = 0; c < is_inside.size(); ++c) {
    if (!is_inside[c]) continue;
    const geometry::SolidPart& part = complex.cells[c];
    for (int f = 0; f < part.facet_count; ++f) {
      const geometry::SolidFacet& facet =
          complex.facets[at(complex.cell_facets[at(part.first_facet + f)] / 2)];
      for (int k = 0; k < facet.side_count; ++k)
        front =
            std::min(front, direction.dot(complex.position(complex.side_begin(complex.sides_of(facet)[k]))));
    }
  }
  return front;
}

/// m3, of the cells whose middle is in the striker's way: hardly more than a guess. 0: elements are too large
/// for one.
double guess_volume(const geometry::SolidComplex& complex, const std::vector<int>& cells,
                    const std::vector<PunchSide>& sides) {
  double volume = 0.0;
  for (const int c : cells) {
    const geometry::SolidPart& part = complex.cells[at(c)];
    const Vec3 middle = cell_centre(complex, part);
    if (std::all_of(sides.begin(), sides.end(),
                    [&](const PunchSide& side) { return side.normal.dot(middle) <= side.offset; }))
      volume += part.volume;
  }
  return volume;
}

double kinetic_energy_of(const Striker& striker) {
  return 0.5 * striker.speed * striker.speed / (1.0 / striker.mass + striker.struck_inverse_mass);
}

/// m2, of the striker's section with straight sides, wider by the clearance.
double area_of_way(const Striker& striker) {
  const double clearance = kPlugClearance * section_of(striker).diameter;
  const std::vector<Vec2> normals = side_normals(striker);
  double area = 0.0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vec2& own = normals[i];
    const double reach = support_of_core(striker, own) + clearance;
    // Along its side, from the foot of its normal to the corner that it shares with a neighbour.
    const auto corner = [&](const Vec2& other) {
      const double sine = own.x() * other.y() - own.y() * other.x();
      return (support_of_core(striker, other) + clearance - reach * own.dot(other)) / sine;
    };
    area += 0.5 * reach *
            (corner(normals[(i + 1) % normals.size()]) -
             corner(normals[(i + normals.size() - 1) % normals.size()]));
  }
  return area;
}

/// The half spaces whose common part is the striker's way, wider by the clearance from the depth `front` (m,
/// along the direction) on and by the taper beyond it.
std::vector<PunchSide> sides_of_way(const Striker& striker, double front, double taper) {
  const double clearance = kPlugClearance * section_of(striker).diameter;
  std::vector<PunchSide> sides;
  for (const Vec2& normal : side_normals(striker)) {
    const Vec3 across = normal.x() * striker.first + normal.y() * striker.second;
    const double reach = across.dot(striker.centre) + support_of_core(striker, normal) + clearance;
    sides.push_back({across - taper * striker.direction, reach - taper * front});
  }
  return sides;
}

}  // namespace

double Perforation::momentum_share() const {
  return 1.0 - core::sqrt(std::max(0.0, 1.0 - 1.0 / ratio()));
}

std::optional<Perforation> find_perforation(const geometry::SolidComplex& complex,
                                            const material::Material& material, const Striker& striker,
                                            double least_width, int tag) {
  const double flow = flow_stress(material);
  const StrikerSection section = section_of(striker);
  if (!(flow > 0.0) || !(section.area > 0.0) || !(striker.mass > 0.0) || !(striker.speed > 0.0) ||
      striker.core.empty())
    return std::nullopt;
  Perforation out;
  out.striker = striker;
  out.there = kinetic_energy_of(striker);
  if (striker.squareness < kLeastSquareness) return out;
  const std::vector<PunchSide> way = sides_of_way(striker, 0.0, 0.0);
  std::vector<int> cells = find_punch_cells(complex, way, striker.place);
  const double guess = guess_volume(complex, cells, way) / section.area;
  if (cells.empty()) return std::nullopt;
  out.thickness = guess;
  out.work = out.needed = perforation_work({guess, section.area, section.perimeter, striker.flatness}, flow);
  if (out.there < kShareThatCounts * out.needed) return out;
  // What is straight in his way tells how thick it is and where it begins; the plug is a cone from there.
  geometry::SolidComplex straight = complex;
  const geometry::Punched core = punch_out(straight, way, std::move(cells), tag);
  if (!(core.volume > 0.0)) return std::nullopt;  // nothing is in his way
  out.thickness = core.volume / area_of_way(striker);
  out.sides = sides_of_way(striker, find_front(straight, core.is_inside, striker.direction), kPlugTaper);
  cells = find_punch_cells(complex, out.sides, striker.place);
  auto cut = std::make_shared<geometry::SolidComplex>(complex);
  const geometry::Punched punched = punch_out(*cut, out.sides, std::move(cells), tag);
  out.part_count = count_parts(*cut);
  if (out.part_count <= count_parts(complex)) return std::nullopt;
  if (!(punched.volume > least_width * punched.wall_area)) return std::nullopt;
  if (punched.volume > kMostPlug * total_volume(complex)) return std::nullopt;
  out.complex = std::move(cut);
  out.plug_volume = punched.volume;
  out.wall_area = punched.wall_area;
  out.plug_mass = material.density * punched.volume;
  out.work = perforation_work({out.thickness, section.area, section.perimeter, striker.flatness}, flow);
  out.needed = perforation_energy(out.work, striker.mass, out.plug_mass);
  return out;
}

}  // namespace shatterbox::fracture
