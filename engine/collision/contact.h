// One place where two bodies touch or may soon touch, as the solver wants it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/core/vec.h"

namespace shatterbox::collision {

/// What gives a contact its normal, and so how that turns with the bodies.
enum class NormalOf : char {
  place,   // where both were when they touched, or soon will: it stays as it is
  face_a,  // a face of a, with whom it turns
  face_b,  // likewise
  edges,   // an edge of each: across both
  ball     // a sphere and what is nearest to it: measured anew
};

struct Contact {
  std::uint64_t key = 0;           // names both features within the pair: the same from step to step
  Vec3 on_a = Vec3::Zero();        // m, world, material point of a at the start of the step
  Vec3 on_b = Vec3::Zero();        // m, world, material point of b at the start of the step
  Vec3 normal = Vec3::UnitY();     // unit, from b towards a
  double gap = 0.0;                // m, along the normal at the start of the step
  double lean = 0.5;               // where impulses act: 1 at a's point, 0 at b's, as the bodies slide apart
  bool is_time_of_impact = false;  // found on the path, not at its start
  NormalOf normal_of = NormalOf::place;
  Vec3 edge_a = Vec3::Zero(), edge_b = Vec3::Zero();  // unit, at the start of the step, of two edges
};

/// Makes the normal that of two edges in these directions (of any length) if it is across both, and they are
/// not so nearly parallel that a little turn of theirs would be a great one of it.
void set_crossing_edges(const Vec3& edge_a, const Vec3& edge_b, Contact& contact);

/// The contact's normal once the bodies have turned so far since the start of the step. Not for balls.
Vec3 turned_normal(const Contact& contact, const Mat3& turn_a, const Mat3& turn_b);

/// Few contacts that stand for all that were offered, the most important first: none within `radius` (m) of
/// another that points the same way.
class KeptContacts {
 public:
  KeptContacts(double radius, std::size_t most);
  bool is_full() const { return kept_.size() >= most_; }
  void offer(const Contact& contact);
  /// Ascending by key.
  std::vector<Contact> take();

 private:
  double radius_;
  std::size_t most_;
  std::vector<Contact> kept_;
};

/// Keeps those in `loaded_keys` (ascending) first while they are within `loaded_reach` (m), so that what
/// rests keeps its feet; then nearest first; at most `cap`.
void reduce_manifold(std::vector<Contact>& contacts, const std::vector<std::uint64_t>& loaded_keys,
                     double loaded_reach, double radius, std::size_t cap);

}  // namespace shatterbox::collision
