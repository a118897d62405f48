// Scenes that come along, step by step under the audit: nothing crosses or passes, nobody hangs.
#include <catch2/catch.hpp>
#include <cstdint>
#include <sstream>

#include "tests/scenes/play.h"

using namespace shatterbox::sandbox::run;

namespace {

/// A scene, how far past its first break or hit it is run, and whether anything breaks until then.
struct Audited {
  const char* scene;
  const char* seconds;
  bool breaks;
};

constexpr int kMostCut = 8;  // steps in a row that one body may be held back

void check_audited(const Audited& audited, const std::string& rate) {
  const Folder folder;
  const auto report = play(folder, std::string(audited.scene) + " --audit --seconds " + audited.seconds +
                                       " --set scene.steps_per_second=" + rate);
  INFO(audited.scene << " at " << rate << " steps a second: " << report["contact"].dump(1));
  CHECK(report["audit"]["steps"].get<int>() > 0);
  CHECK(report["audit"]["crossings"] == 0);
  CHECK(report["audit"]["passages"] == 0);
  CHECK(report["contact"]["crossing_pairs_at_start"] == 0);
  CHECK(report["contact"]["frozen_share"].get<double>() < 0.01);
  CHECK(report["contact"]["longest_cut"].get<int>() <= kMostCut);
  CHECK(report["breaks"].empty() != audited.breaks);
  CHECK((audited.breaks || report["contact"]["most"].get<int>() > 0));  // it has come to something
}

}  // namespace

TEST_CASE("five scenes of thin things as they come along: nothing crosses and nobody hangs") {
  for (const Audited& audited : {Audited{"boats_edge", "0.9", false},
                                 {"card_house", "0.5", false},
                                 {"rain", "1.2", false},
                                 {"plate_stack", "0.4", false},
                                 {"bowls", "2", false}})
    check_audited(audited, "240");
}

namespace {

/// Two boats that meet rim on rim in twenty placements, at three speeds.
void check_boats(const std::string& rate) {
  const Folder folder;
  std::uint32_t dice = 1;
  const auto between = [&](double low, double high) {
    dice = 1664525U * dice + 1013904223U;
    return low + (high - low) * (dice >> 8) / 16777216.0;
  };
  int hits = 0;
  for (int placement = 0; placement < 20; ++placement) {
    std::ostringstream place;
    place << " --set 'upper.position=[" << between(-0.2, 0.2) << ", 1.3, " << between(-0.15, 0.15)
          << "]' --set 'upper.rotation=[180, " << between(0.0, 180.0) << ", " << between(-10.0, 10.0) << "]'";
    for (const char* speed : {"1", "10", "100"}) {
      const auto report =
          play(folder, "boats_edge --audit --seconds 0.6 --set scene.steps_per_second=" + rate + place.str() +
                           " --set 'upper.velocity=[0, -" + speed + ", 0]'");
      INFO(place.str() << " at " << speed << " m/s, " << rate << " steps a second");
      CHECK(report["audit"]["crossings"] == 0);
      CHECK(report["audit"]["passages"] == 0);
      hits += report["contact"]["most"].get<int>() > 1 ? 1 : 0;
    }
  }
  CHECK(hits > 50);  // at 100 m/s some touch in one point
}

}  // namespace

TEST_CASE("two boats rim on rim in twenty placements at 1 and 10 and 100 m/s: neither passes") {
  check_boats("240");
}

TEST_CASE("two boats rim on rim at 60 and 960 steps a second: neither passes", "[.][long]") {
  check_boats("60");
  check_boats("960");
}

TEST_CASE("scenes at 60 and 240 and 960 steps a second: nothing crosses and nobody hangs", "[.][long]") {
  for (const Audited& audited : {Audited{"boats_edge", "1.5", false},
                                 {"card_house", "1.9", false},
                                 {"rain", "1.5", false},
                                 {"bowls", "3", false},
                                 {"plate_stack", "1.2", true},
                                 {"champagne_tower", "0.7", true},
                                 {"ornament", "0.6", true},
                                 {"bowl", "0.6", true},
                                 {"window", "0.5", true},
                                 {"tempered", "0.1", true},
                                 {"bottle", "0.6", true},
                                 {"egg", "0.4", true},
                                 {"pots", "0.9", true},
                                 {"panel", "1.8", true},
                                 {"slab", "0.32", true},
                                 {"dominoes", "1.5", false},
                                 {"arch", "1.4", false},
                                 {"tablet", "0.45", true},
                                 {"vase", "0.65", true},
                                 {"lintel", "0.55", true},
                                 {"overload", "1", true},
                                 {"colonnade", "0.7", true},
                                 {"crater", "0.4", true},
                                 {"wall", "0.45", true},
                                 {"brick_wall", "0.6", true},
                                 {"mortar_wall", "0.5", true},
                                 {"wrecking_ball", "0.85", true},
                                 {"blast", "0.5", true},
                                 {"boats_edge --set 'upper.velocity=[0, -10, 0]'", "0.9", false},
                                 {"boats_edge --set 'upper.velocity=[0, -100, 0]'", "0.9", false},
                                 {"boats_pile --set boats.repeat.count=100", "2.5", false},
                                 {"ornaments --set ornaments.repeat.count=9", "0.5", true},
                                 {"walls --set 'wall.repeat.count=[4, 1, 1]'", "0.3", true},
                                 {"armadillo --set figure.element_size=0.03", "0.25", true}})
    for (const char* rate : {"60", "240", "960"}) check_audited(audited, rate);
}
