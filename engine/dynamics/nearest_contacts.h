// Contacts of two surfaces that lie on each other with thousands of features: of those all but a few would be
// dropped, so they are measured in the order of what is known of them, and only as many as are asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/collision/contact.h"
#include "engine/collision/feature_gap.h"
#include "engine/core/buckets.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

/// A pair of features where the bodies start.
struct StartMeeting {
  collision::FeaturePoints points;
  Vec3 hint = Vec3::Zero();
  collision::FeatureGap gap;
};
StartMeeting meet_at_start(const WorkBody& a, const WorkBody& b, const collision::FeaturePair& features);

/// Whether that is a contact of the pair: within its margin, and where the surfaces are nearest. So close
/// that the direction cannot mislead, every feature counts.
bool is_contact(const WorkBody& a, const WorkBody& b, const collision::FeaturePair& features,
                const collision::FeatureGap& gap, double usual_gap, double margin);

/// So near every feature counts, in usual gaps.
inline constexpr double kAlwaysNear = 3.0;

/// A bound that is surely not above a gap that was measured, m.
float bound_of(double gap);

class NearestContacts {
 public:
  /// Of the features of a pair's search. `start_gaps` (m, in their order) are bounds, and become gaps where
  /// these are measured.
  NearestContacts(const WorkBody& a, const WorkBody& b, double usual_gap, const WorkPair& pair,
                  std::vector<float>& start_gaps);

  /// Of all features, m; the pair's margin if none is as near.
  double least_gap();

  /// Those that reduce_manifold() keeps of all contacts.
  std::vector<collision::Contact> keep(const std::vector<std::uint64_t>& loaded_keys, double loaded_reach,
                                       collision::KeptContacts kept);

 private:
  struct Found {
    double gap;
    std::uint64_t key;
    int contact;  // in contacts_
  };
  void measure_layer();
  std::optional<collision::Contact> find(std::uint64_t key) const;
  const collision::Contact* next();

  const WorkBody &a_, &b_;
  double usual_gap_;
  const WorkPair& pair_;
  std::vector<float>& start_gaps_;
  core::Buckets layers_;           // features by their bounds, those within the margin
  std::size_t measured_ = 0;       // layers
  double least_unmeasured_ = 0.0;  // m: none of the others is nearer
  double least_ = 0.0;             // m, of what was measured
  std::vector<collision::Contact> contacts_;
  std::vector<Found> found_;  // a heap of those that were not told: the nearest first
};

}  // namespace shatterbox::dynamics
