// The verb `study`: error against run time, as CSV, plots and words.
#pragma once

#include <string>

namespace shatterbox::sandbox::run {

struct StudyOptions {
  std::string what;    // the name of a study, or a scene
  std::string folder;  // for its files; empty: study_NAME
  bool is_quick = false;
};

/// Runs the study. Returns the exit status.
int run_study(const StudyOptions& options);

}  // namespace shatterbox::sandbox::run
