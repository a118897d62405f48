// Which parts of the program a scene needs and why, which it leaves out, and, after a run, which it used.
#pragma once

#include <string>
#include <vector>

#include "sandbox/report/run_record.h"
#include "sandbox/run/options.h"
#include "sandbox/scene/scene_description.h"

namespace shatterbox::sandbox::run {

struct PartPlan {
  std::string name;
  bool is_needed = false;
  std::string why;  // or why not
};

/// All parts, in the order in which a step comes to them, then those of the outputs. What is not needed is
/// not made.
std::vector<PartPlan> plan_parts(const scene::SceneDescription& scene, const Options& options);

/// After a run: sorts the parts into used, idle (there, but nothing came to them) and left out.
void sort_parts(const std::vector<PartPlan>& parts, report::RunRecord& record);

/// The verb: loads the scene, takes its first steps and draws its first picture, and tells what that needs
/// and takes.
int plan_scene(const Options& options, bool is_lean);

}  // namespace shatterbox::sandbox::run
