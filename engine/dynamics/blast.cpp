#include "engine/dynamics/blast.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "engine/body/polyhedron.h"
#include "engine/core/elementary.h"

namespace shatterbox::dynamics {

namespace {

using body::ShapeKind;

constexpr double kTntEnergy = 4.184e6;  // J/kg, by definition
constexpr double kTntDensity = 1600.0;  // kg/m3, of the charge, within which the law ends
constexpr double kImpulse = 200.0;      // Pa s m / kg^(2/3)
constexpr double kPassing = 1.2e-3;     // s / (kg^(1/6) m^(1/2))
constexpr double kPatchSize = 0.3;      // of the bounding radius
constexpr int kParts = 8;               // of a box's edge, and of a quarter of a sphere's equator

/// A small part of a surface, body space.
struct Facet {
  Vec3 middle;
  Vec3 area;  // m2, along the normal outwards
};

double charge_of(double energy) {
  return energy / kTntEnergy;
}

std::vector<Facet> box_facets(const Vec3& half) {
  std::vector<Facet> facets;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0})
      for (int i = 0; i < kParts; ++i)
        for (int j = 0; j < kParts; ++j) {
          Facet facet{Vec3::Zero(), Vec3::Zero()};
          facet.middle[axis] = side * half[axis];
          facet.middle[u] = half[u] * ((2 * i + 1.0) / kParts - 1.0);
          facet.middle[v] = half[v] * ((2 * j + 1.0) / kParts - 1.0);
          facet.area[axis] = side * 4.0 * half[u] * half[v] / (kParts * kParts);
          facets.push_back(facet);
        }
  }
  return facets;
}

/// Bands of equal height have equal areas.
std::vector<Facet> ball_facets(double radius) {
  constexpr int kBands = 4 * kParts, kRound = 4 * kParts;
  std::vector<Facet> facets;
  for (int i = 0; i < kBands; ++i)
    for (int j = 0; j < kRound; ++j) {
      const double height = (2 * i + 1.0) / kBands - 1.0;
      const double angle = core::kPi * (2 * j + 1.0) / kRound;
      const double ring = core::sqrt(1.0 - height * height);
      const Vec3 normal(ring * core::cos(angle), height, ring * core::sin(angle));
      facets.push_back({radius * normal, (4.0 * core::kPi * radius * radius / (kBands * kRound)) * normal});
    }
  return facets;
}

std::vector<Facet> facets_of(const body::Shape& shape) {
  if (shape.kind == ShapeKind::box) return box_facets(shape.half_extent);
  if (shape.kind == ShapeKind::sphere) return ball_facets(shape.radius);
  const geometry::TriangleMesh surface = body::find_polyhedron(shape);
  std::vector<Facet> facets;
  for (const geometry::Triangle& t : surface.triangles) {
    const Vec3& a = surface.positions[static_cast<std::size_t>(t[0])];
    const Vec3& b = surface.positions[static_cast<std::size_t>(t[1])];
    const Vec3& c = surface.positions[static_cast<std::size_t>(t[2])];
    facets.push_back({(a + b + c) / 3.0, 0.5 * (b - a).cross(c - a)});
  }
  return facets;
}

/// Sums over the facets of one patch.
struct PatchSum {
  Vec3 impulse = Vec3::Zero(), moment = Vec3::Zero();  // moment: of the magnitude, about the origin
  double magnitude = 0.0, area = 0.0;
};

std::array<int, 3> cell_of(const Vec3& point, double size) {
  std::array<int, 3> cell{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    cell[axis] = static_cast<int>(std::floor(point[static_cast<Eigen::Index>(axis)] / size));
  return cell;
}

/// J: of a shell what its parts take each for itself, before they share it; of others that of the whole.
double energy_taken(const std::vector<BlastPatch>& patches, const body::Body& body, double surface_area) {
  double parts = 0.0;
  Vec3 impulse = Vec3::Zero(), angular_impulse = Vec3::Zero();
  for (const BlastPatch& patch : patches) {
    if (surface_area > 0.0 && patch.area > 0.0)
      parts += 0.5 * patch.impulse.squaredNorm() / (body.shape->mass * patch.area / surface_area);
    impulse += patch.impulse;
    angular_impulse += (patch.point - body.pose.translation).cross(patch.impulse);
  }
  if (body.shape->kind == ShapeKind::shell) return parts;
  return 0.5 * body.inverse_mass * impulse.squaredNorm() +
         0.5 * angular_impulse.dot(body.inverse_inertia_world() * angular_impulse);
}

}  // namespace

double free_impulse(double energy, double distance) {
  const double charge = charge_of(energy);
  const double radius = core::pow(3.0 * charge / (4.0 * core::kPi * kTntDensity), 1.0 / 3.0);
  return kImpulse * core::pow(charge, 2.0 / 3.0) / std::max(distance, radius);
}

double blast_duration(double energy, double distance) {
  return kPassing * core::pow(charge_of(energy), 1.0 / 6.0) * core::sqrt(distance);
}

std::vector<BlastPatch> find_blast_patches(const Blast& blast, const body::Body& body,
                                           const LineOfSight& sight) {
  if (body.shape->kind == ShapeKind::plane) return {};
  const bool has_two_sides = body.shape->kind == ShapeKind::shell;
  const double size = kPatchSize * body.shape->bounding_radius;
  std::map<std::array<int, 3>, PatchSum> sums;
  double solid_angle = 0.0, surface_area = 0.0;
  for (const Facet& facet : facets_of(*body.shape)) {
    const double area = facet.area.norm();
    surface_area += area;
    const Vec3 middle = body.pose.apply(facet.middle);
    const Vec3 way = middle - blast.centre;
    const double distance = way.norm();
    if (!(area > 0.0) || !(distance > 0.0)) continue;
    Vec3 inwards = -(body.pose.rotation * facet.area) / area;
    double cosine = inwards.dot(way) / distance;
    if (has_two_sides && cosine < 0.0) {
      inwards = -inwards;
      cosine = -cosine;
    }
    if (!(cosine > 0.0) || sight.is_blocked(blast.centre, middle)) continue;
    const double impulse =
        area * free_impulse(blast.energy, distance) * (1.0 + 3.0 * cosine * cosine - 2.0 * cosine);
    PatchSum& sum = sums[cell_of(facet.middle, size)];
    sum.impulse += impulse * inwards;
    sum.moment += impulse * middle;
    sum.magnitude += impulse;
    sum.area += area;
    solid_angle += area * cosine / (distance * distance);
  }
  std::vector<BlastPatch> patches;
  for (const auto& [cell, sum] : sums) {
    if (!(sum.magnitude > 0.0)) continue;
    BlastPatch patch{sum.moment / sum.magnitude, sum.impulse, sum.area, blast.duration};
    if (!(patch.duration > 0.0))
      patch.duration = blast_duration(blast.energy, (patch.point - blast.centre).norm());
    patches.push_back(patch);
  }
  const double most = blast.energy * solid_angle / (4.0 * core::kPi);
  const double taken = energy_taken(patches, body, surface_area);
  if (taken > most)
    for (BlastPatch& patch : patches) patch.impulse *= core::sqrt(most / taken);
  return patches;
}

}  // namespace shatterbox::dynamics
