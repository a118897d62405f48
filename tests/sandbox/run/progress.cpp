// The time still needed, as the bar tells it.
#include "sandbox/run/progress.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

using namespace shatterbox::sandbox::run;

namespace {

/// What is said on stderr while `talk` goes on.
template <class Talk>
std::string listen(const Talk& talk) {
  char name[] = "/tmp/progress_XXXXXX";
  const int file = mkstemp(name), usual = dup(STDERR_FILENO);
  std::fflush(stderr);
  dup2(file, STDERR_FILENO);
  talk();
  std::fflush(stderr);
  dup2(usual, STDERR_FILENO);
  close(usual);
  close(file);
  std::stringstream said;
  said << std::ifstream(name).rdbuf();
  std::remove(name);
  return said.str();
}

}  // namespace

TEST_CASE("a frame that takes long is told, and who is done says nothing any more") {
  const std::string said = listen([] {
    Progress progress(4, false, std::chrono::milliseconds(20));
    progress.show(1, "0.25 s");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    progress.clear();
    std::fprintf(stderr, "over\n");
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
  });
  INFO(said);
  CHECK(said.find(" 25 % after 0 s  0.25 s, nothing new for 0 s\n") != std::string::npos);
  CHECK(said.substr(said.size() - 5) == "over\n");
  CHECK(listen([] { Progress(4, false).show(1, "quick"); }).empty());
}

TEST_CASE("a bar tells at once what is done, and what comes right behind it a moment later") {
  const std::string said = listen([] {
    Progress progress(4, true, std::chrono::hours(1));
    progress.show(1, "meshing");
    progress.show(2, "factors");
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
  });
  INFO(said);
  CHECK(said.find(" 25 %  meshing") != std::string::npos);
  CHECK(said.find(" 50 %  factors") != std::string::npos);
}

TEST_CASE("a bar lies between nothing and all, whatever it is told") {
  const std::string said = listen([] {
    Progress progress(4, true, std::chrono::hours(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(120));
    progress.show(-2000000000, "below");
    progress.show(2000000000, "beyond");
  });
  INFO(said);
  CHECK(said.find("[" + std::string(30, '.') + "]   0 %  below") != std::string::npos);
  CHECK(said.find("[" + std::string(30, '#') + "] 100 %  beyond") != std::string::npos);
}

TEST_CASE("a film is as far as its last frame that was played and is finished") {
  const std::vector<int> shown{1, 2, 4, 8};
  CHECK(reached(shown, 3) == 4);
  CHECK(reached(shown, 4) == 8);
  CHECK(reached(shown, 60) == 8);  // an earlier run has drawn sixty, and four of them are played again
  CHECK(reached(shown, 0) == 0);
  CHECK(reached(shown, -5) == 0);  // the shots before this one are still being drawn
  CHECK(reached({}, 60) == 0);
}

TEST_CASE("a steady run says what is left") {
  std::deque<std::pair<double, int>> history;
  for (int i = 1; i <= 50; ++i) history.emplace_back(0.1 * i, i);
  CHECK(remaining_seconds(history, 100) == Approx(5.0).epsilon(0.02));
}

TEST_CASE("a run that has become slower says so") {
  std::deque<std::pair<double, int>> history;
  for (int i = 1; i <= 40; ++i) history.emplace_back(0.1 * i, i);
  for (int i = 1; i <= 20; ++i) history.emplace_back(4.0 + 1.0 * i, 40 + i);
  CHECK(remaining_seconds(history, 100) == Approx(40.0).epsilon(0.05));
}

TEST_CASE("nothing is promised at the start") {
  CHECK(remaining_seconds({}, 100) < 0.0);
  CHECK(remaining_seconds({{0.1, 1}, {0.2, 2}}, 100) < 0.0);
}
