// The program run again, as a process of its own: its memory, its caches and its end are its own.
#pragma once

#include <sys/types.h>

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
  /// Why none could be made; else empty.
  const std::string& fault() const { return fault_; }

 private:
  std::filesystem::path path_;
  std::string fault_;
};

/// Starts this program in a folder; what it says goes to `log`. Its process; negative if there is none, and
/// `errno` says why.
/// Ctrl-C at the terminal does not reach it; when who started it is killed, it ends in order.
pid_t start_again(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                  const std::filesystem::path& log);

/// Waits for such a process. Its exit status. When this process is interrupted, it is too.
int wait_again(pid_t child);

/// Runs this program with these arguments. Its exit status; what it says goes to `log`. When this process is
/// interrupted, it is too.
int run_again(const std::vector<std::string>& arguments, const std::filesystem::path& log);

}  // namespace shatterbox::sandbox::run
