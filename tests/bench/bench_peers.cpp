// The same pile in Shatterbox, Bullet and ODE, one thread and two: frame by frame in turn, so that all see
// the same neighbours on the machine. Prints times, crossings and ratios.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sandbox/report/statistics.h"
#include "tests/bench/our_pile.h"

namespace {

using namespace shatterbox;
using namespace shatterbox::bench;
using Clock = std::chrono::steady_clock;

struct Runner {
  std::unique_ptr<PeerPile> pile;
  int threads = 1;
  std::vector<double> wall, cpu;  // ms a step
  std::vector<int> contacts;
  long crossings = 0;
  double height = 0.0;  // m
};

double cpu_milliseconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto milliseconds = [](const timeval& t) {
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
  };
  return milliseconds(usage.ru_utime) + milliseconds(usage.ru_stime);
}

void step(Runner& runner) {
  const double cpu = cpu_milliseconds();
  const auto start = Clock::now();
  runner.pile->step();
  runner.wall.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  runner.cpu.push_back(cpu_milliseconds() - cpu);
  runner.contacts.push_back(runner.pile->contacts());
}

/// The times of the steps with at least 80 % of the engine's own greatest number of contacts.
std::vector<double> busy(const Runner& runner, const std::vector<double>& times) {
  const int most = *std::max_element(runner.contacts.begin(), runner.contacts.end());
  std::vector<double> list;
  for (std::size_t i = 0; i < times.size(); ++i)
    if (most > 0 && runner.contacts[i] >= 0.8 * most) list.push_back(times[i]);
  return list;
}

void print_table(const std::vector<Runner>& runners, nlohmann::ordered_json& rows) {
  using sandbox::report::spread_of;
  fmt::print("ms a step\n{:<16}{:>8}{:>10}{:>10}{:>10}{:>11}{:>10}{:>10}{:>12}{:>9}{:>14}\n", "engine",
             "threads", "busy", "p95", "worst", "busy CPU", "all", "contacts", "crossings", "height",
             "busy, ratio");
  const double ours = spread_of(busy(runners.front(), runners.front().wall)).median;
  for (const Runner& runner : runners) {
    const auto all = spread_of(runner.wall), most = spread_of(busy(runner, runner.wall));
    const double cpu = spread_of(busy(runner, runner.cpu)).median;
    const int contacts = *std::max_element(runner.contacts.begin(), runner.contacts.end());
    const double ratio = ours > 0.0 ? most.median / ours : 0.0;
    fmt::print("{:<16}{:>8}{:>10.2f}{:>10.2f}{:>10.2f}{:>11.2f}{:>10.2f}{:>10}{:>12}{:>9.3f}{:>14.2f}\n",
               runner.pile->engine(), runner.threads, most.median, most.p95, most.max, cpu, all.median,
               contacts, runner.crossings, runner.height, ratio);
    rows.push_back({{"engine", runner.pile->engine()},
                    {"threads", runner.threads},
                    {"busy", {{"median", most.median}, {"p95", most.p95}, {"max", most.max}, {"cpu", cpu}}},
                    {"all", {{"median", all.median}, {"p95", all.p95}, {"max", all.max}}},
                    {"contacts", contacts},
                    {"crossings", runner.crossings},
                    {"mean_height_m", runner.height},
                    {"busy_ratio", ratio}});
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::string scene = "boats_pile", report;
  std::vector<std::string> changes;
  std::vector<int> threads{1, 2};
  double seconds = 5.0;
  CLI::App app("The same pile in Shatterbox, Bullet and ODE", "bench_peers");
  app.add_option("SCENE", scene, "a scene of shells, boxes, spheres and planes")->capture_default_str();
  app.add_option("--set", changes, "NAME.key=value")->allow_extra_args(false);
  app.add_option("--seconds", seconds, "s to simulate")->capture_default_str();
  app.add_option("--threads", threads, "threads")->delimiter(',')->capture_default_str();
  app.add_option("--report", report, "JSON");
  CLI11_PARSE(app, argc, argv);

  std::vector<Runner> runners;
  PeerScene peer_scene;
  for (const int count : threads) {
    std::string fault;
    OurPile ours = make_our_pile(scene, changes, count, fault);
    if (!ours.pile) {
      fmt::print(stderr, "{}\n", fault);
      return 2;
    }
    peer_scene = std::move(ours.scene);
    const auto add = [&](std::unique_ptr<PeerPile> pile) {
      if (pile) runners.push_back({std::move(pile), count, {}, {}, {}, 0, 0.0});
    };
    add(std::move(ours.pile));
#ifdef SHATTERBOX_HAS_BULLET
    add(make_bullet_pile(peer_scene, count));
#endif
#ifdef SHATTERBOX_HAS_ODE
    add(make_ode_pile(peer_scene, count));
#endif
  }
  const auto steps = static_cast<int>(seconds / peer_scene.time_step + 0.5);
  for (int i = 0; i < steps; ++i)
    for (Runner& runner : runners) step(runner);
  for (Runner& runner : runners) {
    runner.crossings = count_crossings(peer_scene, *runner.pile);
    runner.height = mean_height(peer_scene, *runner.pile);
  }
  auto rows = nlohmann::ordered_json::array();
  print_table(runners, rows);
  if (!report.empty()) std::ofstream(report) << rows.dump(2) << "\n";
  return 0;
}
