// Scenes that come along, step by step under the audit: nothing crosses or passes, nobody hangs.
#include <catch2/catch.hpp>

#include "tests/scenes/play.h"

using namespace shatterbox::sandbox::run;

namespace {

/// A scene, how far past its first break or hit it is run, and whether anything breaks until then.
struct Audited {
  const char* scene;
  const char* seconds;
  bool breaks;
};

constexpr int kMostCut = 8;  // steps in a row that one pair may be held back

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
                                 {"crater", "0.4", true},
                                 {"wall", "0.45", true},
                                 {"brick_wall", "0.6", true},
                                 {"mortar_wall", "0.5", true},
                                 {"wrecking_ball", "0.85", true},
                                 {"blast", "0.5", true}})
    for (const char* rate : {"60", "240", "960"}) check_audited(audited, rate);
}
