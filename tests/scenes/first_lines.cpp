// What the first lines of scenes say, of runs that end soon after the first break.
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/scenes/play.h"

using namespace shatterbox::sandbox::run;

namespace {

struct Band {
  int least, most;
};

/// Runs it under the audit; so many pieces are there at the end.
nlohmann::json play_audited(const std::string& arguments, const Band& pieces) {
  const Folder folder;
  auto report = play(folder, arguments + " --audit");
  INFO(arguments);
  REQUIRE(!report["breaks"].empty());
  check_breaks(report);
  CHECK(report["pieces"].get<int>() >= pieces.least);
  CHECK(report["pieces"].get<int>() <= pieces.most);
  CHECK(report["audit"]["crossings"] == 0);
  CHECK(report["audit"]["passages"] == 0);
  CHECK(report["contact"]["crossing_pairs_at_start"] == 0);
  const auto& kept = report["conservation"];
  CHECK(kept["greatest_energy_rise_j"].get<double>() < 1e-3 * kept["kinetic_energy_j"].get<double>());
  CHECK(kept["momentum_error_ns"].get<double>() < 1e-9);
  return report;
}

/// Of the breaks, those of a body and its pieces.
long count_breaks_of(const nlohmann::json& report, const std::string& body) {
  return std::count_if(report["breaks"].begin(), report["breaks"].end(), [&](const auto& row) {
    return row["body"].template get<std::string>().starts_with(body);
  });
}

double height_of_first_break(const nlohmann::json& report) {
  return report["breaks"][0]["place"][1].get<double>();
}

}  // namespace

TEST_CASE("bottle: breaks where its side meets the floor and into shards") {
  const auto report = play_audited("bottle --seconds 0.5", {15, 100});
  CHECK(height_of_first_break(report) < 0.005);
  CHECK(report["breaks"][0]["pieces"].get<int>() >= 3);
}

TEST_CASE("tablet: breaks from the corner that it falls on into few pieces") {
  const auto report = play_audited("tablet --seconds 0.42", {6, 60});
  CHECK(height_of_first_break(report) < 0.02);
}

TEST_CASE("vase: breaks on the floor into some twenty pieces") {
  const auto report = play_audited("vase --seconds 0.62", {8, 60});
  CHECK(height_of_first_break(report) < 0.02);
}

TEST_CASE("pots: as many pieces of stoneware at 60 and 240 and 960 steps a second") {
  const Folder folder;
  double least = 1e9, most = 0.0;
  for (const char* rate : {"60", "240", "960"}) {
    double pieces = 0.0;
    for (const char* seed : {"1", "2", "3", "4"})
      pieces += play(folder, std::string("pots --seconds 1 --set scene.steps_per_second=") + rate +
                                 " --seed " + seed)["pieces"]
                    .get<double>();
    least = std::min(least, pieces);
    most = std::max(most, pieces);
  }
  CAPTURE(least, most);
  CHECK(least > 40.0);
  CHECK(most < 1.4 * least);
}

TEST_CASE("lintel: snaps across the edge of steel and mostly round its grains") {
  const auto report = play_audited("lintel --seconds 0.42", {2, 100});
  CHECK(report["breaks"][0]["grain_share"].get<double>() > 0.5);
}

TEST_CASE("overload: bears five bricks, though they sleep, and breaks under the sixth") {
  const auto report = play_audited("overload --seconds 0.97", {2, 10});
  CHECK(report["breaks"][0]["body"] == "board");
  CHECK(report["breaks"][0]["time"].get<double>() > 0.9);  // the sixth comes at 0.9 s
}

TEST_CASE("colonnade: bears its slabs, until a ball takes a column away") {
  const Folder folder;
  const auto standing = play(folder, "colonnade --set throw.at=9 --seconds 0.5");
  CHECK(standing["breaks"].empty());
  CHECK(standing["conservation"]["kinetic_energy_j"].get<double>() < 0.1);
  const auto report = play_audited("colonnade --seconds 0.8", {20, 150});
  CHECK(report["breaks"][0]["body"] == "column[7]");
  const auto& left = report["conservation"]["potential_energy_j"];
  CHECK(left.get<double>() < standing["conservation"]["potential_energy_j"].get<double>() - 200.0);
}

TEST_CASE("brick_wall: the ball breaks some of ninety bricks and takes others along") {
  const auto report = play_audited("brick_wall --seconds 0.5", {20, 150});
  CHECK(count_breaks_of(report, "ball") == 0);
}

TEST_CASE("wall: the ball goes through and the wall above the hole is shards", "[.][long]") {
  play_audited("wall --seconds 0.45", {40, 300});
}

TEST_CASE("wrecking_ball: bricks that the ball swings into break and its chain holds", "[.][long]") {
  const auto report = play_audited("wrecking_ball --seconds 0.9", {50, 400});
  CHECK(count_breaks_of(report, "ball") == 0);
}
