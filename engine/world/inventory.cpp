#include "engine/world/inventory.h"

#include <set>

#include "engine/core/bytes.h"
#include "engine/world/state.h"

namespace shatterbox::world {
namespace {

using core::bytes_in;

/// Of things that several bodies may share, each once.
template <class Thing, class Bytes>
PartCount count_shared(const char* part, const std::set<const Thing*>& things, const Bytes& bytes_of) {
  PartCount sum{part, 0, 0.0};
  for (const Thing* thing : things) {
    if (thing == nullptr) continue;
    ++sum.count;
    sum.bytes += bytes_of(*thing);
  }
  return sum;
}

/// What of the element matrices is for curvature: rows of strain, and stiffness of all but the corners'
/// moves.
double bending_bytes(const stress::ShellStiffness& stiffness) {
  constexpr int kMembrane = 9, kCurvatures = 3;
  constexpr int kEntries =
      stress::kElementDofs * (stress::kElementDofs + 1) / 2 - kMembrane * (kMembrane + 1) / 2;
  constexpr int kNumbers = kCurvatures * stress::kElementDofs + kEntries;
  return static_cast<double>(stiffness.matrices.size() * kNumbers * sizeof(double));
}

/// Copies of nodes that pieces have beyond their own material.
PartCount count_virtual_nodes(const Fragiles& fragiles) {
  PartCount sum{"virtual_nodes", 0, 0.0};
  for (const auto& [id, fragile] : fragiles) {
    if (const auto* solid = std::get_if<fracture::SolidSubject>(&fragile->subject))
      sum.count += geometry::count_virtual_nodes(*solid->complex);
    else
      sum.count += geometry::count_virtual_vertices(*std::get<fracture::ShellSubject>(fragile->subject).mesh);
  }
  sum.bytes = static_cast<double>(sum.count) * sizeof(Vec3);
  return sum;
}

/// Bodies whose rest is being watched.
PartCount count_resting(const std::vector<body::Body>& bodies) {
  PartCount sum{"sleeping", 0, 0.0};
  for (const body::Body& body : bodies) sum.count += body.is_dynamic() && body.quiet_time > 0.0 ? 1 : 0;
  sum.bytes = static_cast<double>(sum.count) * (sizeof(Pose) + sizeof(double));
  return sum;
}

}  // namespace

std::optional<geometry::TetQuality> World::tetrahedra(body::BodyId id) const {
  const auto fragile = state_->moving.fragiles.find(id);
  if (fragile == state_->moving.fragiles.end()) return std::nullopt;
  const auto* solid = std::get_if<fracture::SolidSubject>(&fragile->second->subject);
  if (solid == nullptr) return std::nullopt;
  return geometry::measure_quality(solid->complex->elements->mesh);
}

std::vector<PartCount> World::inventory() const {
  const State& s = *state_;
  std::set<const body::Shape*> surfaces;
  std::set<const stress::ShellStiffness*> stiffnesses;
  std::set<const stress::ShellSystemCache*> systems;
  std::set<const fracture::FlawField*> flaws;
  std::set<const fracture::GrainField*> grains;
  for (const body::Body& body : s.moving.bodies)
    if (body::is_mesh(body.shape->kind)) surfaces.insert(body.shape.get());
  std::set<const geometry::SolidComplex*> complexes;
  std::set<const fracture::SolidFlawField*> solid_flaws;
  std::set<const fracture::SpaceGrains*> solid_grains;
  for (const auto& [id, fragile] : s.moving.fragiles) {
    if (const auto* solid = std::get_if<fracture::SolidSubject>(&fragile->subject)) {
      complexes.insert(solid->complex.get());
      solid_flaws.insert(solid->flaws.get());
      solid_grains.insert(solid->grains.get());
      continue;
    }
    const auto& subject = std::get<fracture::ShellSubject>(fragile->subject);
    systems.insert(subject.systems.get());
    if (subject.systems) stiffnesses.insert(subject.systems->shared_stiffness().get());
    flaws.insert(subject.flaws.get());
    grains.insert(subject.grains.get());
  }
  std::set<const stress::ShellStiffness*> bending;
  for (const stress::ShellStiffness* stiffness : stiffnesses)
    if (stiffness->properties.has_bending) bending.insert(stiffness);
  PartCount factors{"factors", 0, 0.0};
  for (const stress::ShellSystemCache* cache : systems) {
    if (cache == nullptr) continue;
    factors.count += cache->count();
    factors.bytes += cache->bytes();
  }
  PartCount all_flaws = count_shared(
      "flaws", flaws, [](const fracture::FlawField& f) { return bytes_in(f.flaws, f.first_of_element); });
  const PartCount flaws_in_volume = count_shared("flaws", solid_flaws, [](const fracture::SolidFlawField& f) {
    return bytes_in(f.flaws, f.first_of_element);
  });
  all_flaws.count += flaws_in_volume.count;
  all_flaws.bytes += flaws_in_volume.bytes;
  PartCount all_grains = count_shared("grains", grains, [](const fracture::GrainField& g) {
    return bytes_in(g.seeds, g.energies, g.first_of_element);
  });
  const PartCount grains_in_volume = count_shared("grains", solid_grains, [](const fracture::SpaceGrains& g) {
    return bytes_in(g.seeds, g.near, g.first_of_node, g.reach);
  });
  all_grains.count += grains_in_volume.count;
  all_grains.bytes += grains_in_volume.bytes;
  PartCount pairs{"near_pairs", 0, 0.0}, friction{"friction", 0, 0.0};
  for (const dynamics::PairState& pair : s.moving.contact.pairs) {
    ++pairs.count;
    pairs.bytes += static_cast<double>(sizeof pair) + bytes_in(pair.contacts);
    for (const dynamics::RememberedContact& contact : pair.contacts)
      friction.count += contact.friction_impulse.isZero(0.0) ? 0 : 1;
  }
  friction.bytes = static_cast<double>(friction.count) * sizeof(Vec3);
  const auto memory = static_cast<long>(s.moving.memories.size());
  const auto hands = static_cast<long>(s.hands.size());
  return {
      count_shared("surfaces", surfaces,
                   [](const body::Shape& shape) {
                     return bytes_in(shape.surface.positions, shape.surface.triangles, shape.topology.edges,
                                     shape.topology.triangle_edges);
                   }),
      count_shared("shell_stiffness", stiffnesses,
                   [](const stress::ShellStiffness& k) { return bytes_in(k.matrices, k.vertex_rank); }),
      count_shared("bending", bending, bending_bytes),
      factors,
      count_shared("tetrahedra", complexes,
                   [](const geometry::SolidComplex& c) {
                     return bytes_in(c.vertices, c.edges, c.sides, c.facets, c.cell_facets, c.cells);
                   }),
      all_flaws,
      all_grains,
      count_virtual_nodes(s.moving.fragiles),
      {"impact_memory", memory, static_cast<double>(memory) * sizeof(ImpactMemory)},
      pairs,
      friction,
      {"continuous_tests", s.report.contact.ways_tested, s.report.contact.test_bytes},
      count_resting(s.moving.bodies),
      {"hands", hands, static_cast<double>(hands) * sizeof(dynamics::Hand)},
  };
}

}  // namespace shatterbox::world
