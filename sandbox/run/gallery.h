// A page that shows what runs have made: of each its goal, three pictures, numbers and the film.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sandbox/run/batch_plan.h"
#include "sandbox/run/drawing_cost.h"

namespace shatterbox::sandbox::run {

struct Exhibit {
  std::string name;
  std::filesystem::path folder;  // has film.mp4
  nlohmann::json report;         // of the run; a film of several shots has a list of them
  std::vector<DrawingCost> drawing;
};

/// Writes index.html into `folder`, and beside each film a picture of what broke and one of its end. What has
/// no film is told without pictures, and what was left out by its name. A sentence if it fails, else empty.
std::string write_gallery(const std::filesystem::path& folder, const std::vector<Exhibit>& exhibits,
                          const std::vector<LeftOut>& left_out);

}  // namespace shatterbox::sandbox::run
