// The verb `diff`: two pictures, folders of pictures, videos or reports side by side.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "sandbox/compare/difference_report.h"
#include "sandbox/run/outputs.h"

namespace shatterbox::sandbox::run {

/// What to call a difference, and where to tell of it.
struct FindingOptions {
  std::string tolerance = "default";
  std::string report;           // JSON
  std::string junit;            // XML
  std::string pictures_folder;  // PNGs of what differs
};

struct DiffOptions {
  std::string expected, actual;  // pictures, folders of them, videos, or two reports
  std::string picture;           // PNG of the worst frame's difference
  FindingOptions findings;
};

/// What is written of findings in files of their own; the pictures are not among them.
void add_outputs(const FindingOptions& options, Outputs& outputs);

/// Writes JSON and JUnit where they were asked for; a sentence if that fails, else empty.
std::string write_findings(const FindingOptions& options, const nlohmann::ordered_json& report,
                           const std::string& suite, const std::vector<compare::TestCase>& cases);

/// Compares, says what it found, writes what was asked for. Returns the exit status.
int run_diff(const DiffOptions& options);

}  // namespace shatterbox::sandbox::run
