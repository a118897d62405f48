// The closing words of a run, for people.
#pragma once

#include <string>

#include "sandbox/report/run_record.h"

namespace shatterbox::sandbox::report {

/// Several lines: what there was, what broke, the hardest impacts with their verdicts, time by stage, errors,
/// and how far from real time the run was.
std::string make_summary(const RunRecord& record);

}  // namespace shatterbox::sandbox::report
