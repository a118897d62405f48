// The program run again, as a process of its own: its memory, its caches and its end are its own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shatterbox::sandbox::run {

/// An empty folder for what the run writes; it goes with the object.
class WorkFolder {
 public:
  WorkFolder();
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  /// Empty if none could be made.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Runs this program with these arguments. Its exit status; what it says goes to `log`.
int run_again(const std::vector<std::string>& arguments, const std::filesystem::path& log);

}  // namespace shatterbox::sandbox::run
