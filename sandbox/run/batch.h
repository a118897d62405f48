// Many runs, several at a time, each in a process and a folder of its own, and one table of what came of
// them.
#pragma once

#include <string>
#include <vector>

namespace shatterbox::sandbox::run {

struct BatchOptions {
  std::vector<std::string> scenes;     // files, names, or folders
  std::vector<std::string> with;       // scenes of folders that would be left out, since they take long
  std::vector<std::string> sweeps;     // NAME.key=value,value,..
  std::vector<std::string> run_words;  // options of every run
  std::string folder = "batch";
  int jobs = 0;              // at a time; 0: one a core
  bool has_gallery = false;  // a page of their films
  bool resumes = false;      // what is done is not done again, what was cut short goes on
};

/// Runs all, prints the table. The greatest exit status of the runs.
int run_batch(const BatchOptions& options);

}  // namespace shatterbox::sandbox::run
