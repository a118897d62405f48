#include "engine/dynamics/nearest_contacts.h"

#include <algorithm>

#include "engine/core/index.h"

namespace shatterbox::dynamics {
namespace {

using core::at;

constexpr double kLocalSlack = 0.1;  // sine: neighbouring features may lead closer by this
constexpr std::size_t kLayers = 64;  // of the margin; those of one are measured at once

// Nearest on top.
constexpr auto kFurther = [](const auto& x, const auto& y) {
  return x.gap > y.gap || (x.gap == y.gap && x.key > y.key);
};

}  // namespace

StartMeeting meet_at_start(const WorkBody& a, const WorkBody& b, const collision::FeaturePair& features) {
  StartMeeting meeting;
  meeting.points = collision::gather(features, *a.collider, a.placed.start, *b.collider, b.placed.start);
  meeting.hint = direction_hint(a, b, meeting.points);
  meeting.gap = collision::measure(meeting.points, meeting.hint);
  return meeting;
}

bool is_contact(const WorkBody& a, const WorkBody& b, const collision::FeaturePair& features,
                const collision::FeatureGap& gap, double usual_gap, double margin) {
  if (!(gap.gap <= margin)) return false;
  return gap.gap <= kAlwaysNear * usual_gap ||
         collision::is_local_minimum(features, gap, *a.collider, a.placed.start, *b.collider, b.placed.start,
                                     kLocalSlack);
}

float bound_of(double gap) {
  return collision::round_down(gap * (1.0 - 1e-9));
}

NearestContacts::NearestContacts(const WorkBody& a, const WorkBody& b, double usual_gap, const WorkPair& pair,
                                 std::vector<float>& start_gaps)
    : a_(a), b_(b), usual_gap_(usual_gap), pair_(pair), start_gaps_(start_gaps), least_(pair.margin) {
  const double layers_per_metre = kLayers / pair.margin;
  layers_ = core::Buckets(kLayers, start_gaps.size(), [&](std::size_t i) {
    if (start_gaps[i] > pair.margin) return -1;
    return static_cast<int>(std::clamp(layers_per_metre * start_gaps[i], 0.0, kLayers - 1.0));
  });
}

void NearestContacts::measure_layer() {
  for (const int feature : layers_.of(measured_)) {
    const collision::FeaturePair& features = pair_.search->features[at(feature)];
    const StartMeeting start = meet_at_start(a_, b_, features);
    start_gaps_[at(feature)] = bound_of(start.gap.gap);
    least_ = std::min(least_, start.gap.gap);
    if (!is_contact(a_, b_, features, start.gap, usual_gap_, pair_.margin)) continue;
    contacts_.push_back(collision::contact_here(features, start.points, start.gap));
    found_.push_back({start.gap.gap, features.key(), static_cast<int>(contacts_.size()) - 1});
    std::push_heap(found_.begin(), found_.end(), kFurther);
  }
  ++measured_;
  while (measured_ < kLayers && layers_.of(measured_).empty()) ++measured_;
  least_unmeasured_ = 1e300;
  if (measured_ == kLayers) return;
  for (const int feature : layers_.of(measured_))
    least_unmeasured_ = std::min(least_unmeasured_, static_cast<double>(start_gaps_[at(feature)]));
}

double NearestContacts::least_gap() {
  while (measured_ < kLayers && (measured_ == 0 || least_unmeasured_ < least_)) measure_layer();
  return least_;
}

// That of the features with this key, if it is one.
std::optional<collision::Contact> NearestContacts::find(std::uint64_t key) const {
  const auto features = collision::FeaturePair::of_key(key);
  const StartMeeting start = meet_at_start(a_, b_, features);
  if (!is_contact(a_, b_, features, start.gap, usual_gap_, pair_.margin)) return std::nullopt;
  return collision::contact_here(features, start.points, start.gap);
}

// By gap, then key; null: there is no other.
const collision::Contact* NearestContacts::next() {
  while (measured_ < kLayers && (found_.empty() || !(found_.front().gap < least_unmeasured_)))
    measure_layer();
  if (found_.empty()) return nullptr;
  std::pop_heap(found_.begin(), found_.end(), kFurther);
  const int next = found_.back().contact;
  found_.pop_back();
  return &contacts_[at(next)];
}

std::vector<collision::Contact> NearestContacts::keep(const std::vector<std::uint64_t>& loaded_keys,
                                                      double loaded_reach, collision::KeptContacts kept) {
  std::vector<collision::Contact> loaded;
  for (const std::uint64_t key : loaded_keys) {
    const std::optional<collision::Contact> contact = find(key);
    if (contact && contact->gap < loaded_reach) loaded.push_back(*contact);
  }
  std::stable_sort(loaded.begin(), loaded.end(),
                   [&](const auto& x, const auto& y) { return x.gap - loaded_reach < y.gap - loaded_reach; });
  for (const collision::Contact& contact : loaded)
    if (!kept.is_full()) kept.offer(contact);
  while (!kept.is_full()) {
    const collision::Contact* contact = next();
    if (!contact) break;
    kept.offer(*contact);
  }
  return kept.take();
}

}  // namespace shatterbox::dynamics
