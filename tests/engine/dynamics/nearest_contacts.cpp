// Contacts of surfaces with thousands of near features: against all of them, sorted.
#include "engine/dynamics/nearest_contacts.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <vector>

#include "engine/collision/feature_list.h"
#include "tests/engine/dynamics/facing_sheets.h"

namespace shatterbox::dynamics {
namespace {

using test::kGap;

// Sheets, all features within twice the margin, and what every one of them comes to.
struct Dense {
  explicit Dense(core::Random& random) : sheets(random, 24) {
    sheets.pair.margin = 6.0 * kGap;
    auto search = std::make_shared<FeatureSearch>();
    search->margin = 12.0 * kGap;
    for (WorkBody* w : {&sheets.a, &sheets.b}) collision::refit_boxes(w->placed);
    collision::list_near_features(sheets.a.placed, sheets.b.placed, search->margin, search->features);
    for (const collision::FeaturePair& features : search->features) {
      const StartMeeting start = meet_at_start(sheets.a, sheets.b, features);
      gaps.push_back(start.gap.gap);
      if (is_contact(sheets.a, sheets.b, features, start.gap, kGap, sheets.pair.margin))
        contacts.push_back(collision::contact_here(features, start.points, start.gap));
    }
    sheets.pair.search = search;
  }

  // Something below the gaps, by up to `off` m.
  std::vector<float> bounds(core::Random& random, double off) const {
    std::vector<float> below;
    for (const double gap : gaps) below.push_back(bound_of(gap - random.uniform(0.0, off)));
    return below;
  }
  NearestContacts nearest(std::vector<float>& bounds) const {
    return {sheets.a, sheets.b, kGap, sheets.pair, bounds};
  }
  double least() const { return *std::min_element(gaps.begin(), gaps.end()); }

  test::FacingSheets sheets;
  std::vector<double> gaps;  // m, of all features
  std::vector<collision::Contact> contacts;
};

bool are_same(const std::vector<collision::Contact>& x, const std::vector<collision::Contact>& y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const auto& c, const auto& d) {
    return c.key == d.key && c.gap == d.gap && c.on_a == d.on_a && c.on_b == d.on_b && c.normal == d.normal &&
           c.normal_of == d.normal_of;
  });
}

}  // namespace

TEST_CASE("of very many features those contacts are kept that are kept of all, whatever is known of gaps") {
  core::Random random(3);
  for (int n = 0; n < 3; ++n) {
    const Dense dense(random);
    REQUIRE(dense.contacts.size() > 2000);
    std::vector<std::uint64_t> loaded;  // some that are contacts, and one that is not
    for (std::size_t i = 0; i < dense.contacts.size(); i += 997) loaded.push_back(dense.contacts[i].key);
    loaded.push_back(dense.sheets.pair.search->features.back().key());
    std::sort(loaded.begin(), loaded.end());
    const struct {
      double radius;
      std::size_t cap;
    } manifolds[] = {{0.08, 8}, {0.04, 16}, {0.3, 1000}, {0.0, 300}};
    for (const double off : {0.0, kGap, 20.0 * kGap}) {
      for (const auto& [radius, cap] : manifolds) {
        auto all = dense.contacts;
        collision::reduce_manifold(all, loaded, 2.0 * kGap, radius, cap);
        auto bounds = dense.bounds(random, off);
        NearestContacts nearest = dense.nearest(bounds);
        CAPTURE(n, off, radius, cap);
        CHECK(nearest.least_gap() == dense.least());
        CHECK(are_same(nearest.keep(loaded, 2.0 * kGap, {radius, cap}), all));
        // What was measured is known, and what was not stays a bound.
        CHECK(std::equal(bounds.begin(), bounds.end(), dense.gaps.begin(),
                         [](float bound, double gap) { return bound <= gap; }));
      }
    }
  }
}

TEST_CASE("of very many features only those are measured that may be among the nearest") {
  core::Random random(4);
  const Dense dense(random);
  const auto count_measured = [&](double off, std::size_t cap) {
    const auto before = dense.bounds(random, off);
    auto bounds = before;
    dense.nearest(bounds).keep({}, 0.0, {0.08, cap});
    std::size_t count = 0;
    for (std::size_t i = 0; i < bounds.size(); ++i) count += bounds[i] != before[i] ? 1 : 0;
    return static_cast<double>(count) / static_cast<double>(bounds.size());
  };
  const double all = count_measured(0.1 * kGap, 1000);  // there are not so many
  CAPTURE(all);
  CHECK(count_measured(0.1 * kGap, 8) < 0.4 * all);
}

TEST_CASE("where no feature is within the margin there is no contact") {
  core::Random random(5);
  Dense dense(random);
  dense.sheets.pair.margin = 0.5 * dense.least();
  auto bounds = dense.bounds(random, 20.0 * kGap);
  NearestContacts nearest = dense.nearest(bounds);
  CHECK(nearest.least_gap() == dense.sheets.pair.margin);
  CHECK(nearest.keep({dense.contacts.front().key}, kGap, {0.08, 8}).empty());
}

}  // namespace shatterbox::dynamics
