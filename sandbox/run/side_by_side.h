// --compare NAME.key=a,b: the same scene with two to four values of one setting, beside each other in one
// film.
#pragma once

#include <string>
#include <vector>

#include "sandbox/run/job.h"
#include "sandbox/run/screen.h"

namespace shatterbox::sandbox::run {

/// The settings "NAME.key=a", "NAME.key=b", .. of "NAME.key=a,b,..": commas within brackets or quotes part
/// nothing. None, with a problem, if there are not two to four.
std::vector<std::string> compared_settings(const std::string& compare, scene::Problems& problems);

/// What a run with several worlds side by side cannot write goes to `problems`.
void check_compare(const Options& options, scene::Problems& problems);

/// Plays all, in step with each other; who is over first stays as it is. A sentence if it failed, else empty.
std::string play_side_by_side(std::vector<Job*> jobs, std::vector<Recorder*> recorders, const Screen& screen);

}  // namespace shatterbox::sandbox::run
