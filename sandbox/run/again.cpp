#include "sandbox/run/again.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <thread>

#include <fmt/format.h>

#include "sandbox/run/interrupt.h"
#include "sandbox/run/options.h"

namespace shatterbox::sandbox::run {

namespace {

namespace fs = std::filesystem;

void say_to(const fs::path& log) {
  const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0) return;
  dup2(file, STDOUT_FILENO);
  dup2(file, STDERR_FILENO);
}

/// This program with these arguments, after `prepare` in the new process.
template <class Prepare>
pid_t start(const std::vector<std::string>& arguments, const Prepare& prepare) {
  std::vector<std::string> words{"shatterbox"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t child = fork();
  if (child != 0) return child;
  prepare();
  execv("/proc/self/exe", pointers.data());
  _exit(127);
}

}  // namespace

WorkFolder::WorkFolder() {
  std::error_code code;
  const fs::path folder = fs::temp_directory_path(code);
  std::string name = (folder / "shatterbox-XXXXXX").string();
  if (!code && mkdtemp(name.data()) != nullptr) {
    path_ = name;
    return;
  }
  const char* const asked = std::getenv("TMPDIR");
  fault_ = fmt::format("no folder for what is written meanwhile can be made in {}: {}\n    {}",
                       asked != nullptr ? asked : folder.string(),
                       code ? code.message() : std::strerror(errno), "TMPDIR names the folder for that");
}

WorkFolder::~WorkFolder() {
  std::error_code code;
  if (!path_.empty()) fs::remove_all(path_, code);
}

pid_t start_again(const std::vector<std::string>& arguments, const fs::path& folder, const fs::path& log) {
  return start(arguments, [&, parent = getpid()] {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);     // who started it may be killed; nobody would wait for it then
    if (getppid() != parent) _exit(127);  // it was, just before
    if (chdir(folder.c_str()) != 0) _exit(127);
    say_to(log);
  });
}

int wait_again(pid_t child) {
  int status = 0;
  bool is_told = false;
  for (pid_t ended = 0; ended == 0;) {
    ended = waitpid(child, &status, WNOHANG);
    if (ended < 0) return kFailed;
    if (ended == 0 && is_interrupted() && !is_told) {
      kill(child, SIGINT);
      is_told = true;
    }
    if (ended == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : kFailed;
}

int run_again(const std::vector<std::string>& arguments, const fs::path& log) {
  const pid_t child = start(arguments, [&log] { say_to(log); });
  return child > 0 ? wait_again(child) : kFailed;
}

}  // namespace shatterbox::sandbox::run
