// Scenes that come along, run as a user runs them, and what must be true of each of their breaks.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/sandbox/run/running.h"

namespace shatterbox::sandbox::run {

/// The report of a run with these arguments.
inline nlohmann::json play(const Folder& folder, const std::string& arguments) {
  const Outcome outcome = program(folder, "run " + arguments + " --no-render --report r.json");
  INFO(arguments << "\n" << outcome.out << outcome.err);
  REQUIRE(outcome.status == 0);
  return read_json(folder / "r.json");
}

inline void check_breaks(const nlohmann::json& report) {
  for (const auto& row : report["breaks"]) {
    INFO(row.dump(1));
    CHECK(row["mass_error"].get<double>() < 1e-10);
    CHECK(row["momentum_error"].get<double>() < 1e-10);
    CHECK(row["angular_momentum_error"].get<double>() < 1e-10);
    CHECK(std::abs(row["energy_gain"].get<double>()) < 1e-10);
    CHECK(row["overlap"] == 0);
    CHECK(row["fracture_energy_j"].get<double>() <= row["elastic_energy_j"].get<double>());
  }
}

}  // namespace shatterbox::sandbox::run
