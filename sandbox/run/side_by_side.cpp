#include "sandbox/run/side_by_side.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "sandbox/run/batch_plan.h"
#include "sandbox/run/interrupt.h"
#include "sandbox/run/progress.h"
#include "sandbox/run/showing.h"

namespace shatterbox::sandbox::run {

namespace {

constexpr std::size_t kMostPanels = 4;

/// One of the worlds, and what it shows when it is over.
struct Panel {
  std::string label;
  std::unique_ptr<Showing> showing;
  bool is_over = false;
  std::vector<render::Frame> last;
};

void label(const std::string& text, std::vector<render::Frame>& samples) {
  for (render::Frame& sample : samples)
    sample.caption = sample.caption.empty() ? text : text + "\n" + sample.caption;
}

/// The next frame of all. False when all are over.
bool advance(std::vector<Panel>& panels) {
  bool goes_on = false;
  for (Panel& panel : panels) {
    panel.is_over = panel.is_over || !panel.showing->advance();
    goes_on = goes_on || !panel.is_over;
  }
  return goes_on;
}

}  // namespace

std::vector<std::string> compared_settings(const std::string& compare, scene::Problems& problems) {
  scene::Problems ignored;
  const Sweep sweep = parse_sweep(compare, ignored);
  if (!ignored.empty() || sweep.values.size() < 2 || sweep.values.size() > kMostPanels) {
    scene::book(problems, scene::Place{"--compare", 0, 0},
                fmt::format("\"{}\" does not name two to four values of a setting", compare),
                "write NAME.key=a,b, for example pane.thickness=0.003,0.006");
    return {};
  }
  std::vector<std::string> settings;
  for (const std::string& value : sweep.values) settings.push_back(sweep.key + "=" + value);
  return settings;
}

void check_compare(const Options& options, scene::Problems& problems) {
  const auto refuse_output = [&](const char* option, bool is_asked) {
    if (is_asked)
      scene::book(problems, scene::Place{option, 0, 0}, "holds one world, and --compare shows several",
                  "leave one of them out");
  };
  refuse_output("--meshes", !options.meshes_folder.empty());
  refuse_output("--export", !options.model.empty());
  refuse_output("--tables", !options.tables_folder.empty());
  refuse_output("--truth", !options.truth_folder.empty());
  refuse_output("--resume", options.resumes);
}

std::string play_side_by_side(std::vector<Job*> jobs, std::vector<Recorder*> recorders,
                              const Screen& screen) {
  std::vector<Panel> panels(jobs.size());
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    panels[i].label = jobs[i]->options.overrides.back();
    panels[i].showing = std::make_unique<Showing>(*jobs[i], *recorders[i], static_cast<int>(i));
  }
  Progress progress(panels.front().showing->expected(), stderr_is_terminal());
  for (int frame = 0; advance(panels); ++frame) {
    const bool is_drawn =
        screen.painter != nullptr && std::any_of(panels.begin(), panels.end(), [](const Panel& panel) {
          return !panel.is_over && panel.showing->is_due();
        });
    std::vector<std::vector<render::Frame>> pictures;
    for (Panel& panel : panels) {
      if (!panel.is_over) {
        panel.last = panel.showing->expose(screen.takes(is_drawn));
        label(panel.label, panel.last);
      }
      pictures.push_back(panel.last);
    }
    if (std::string fault = screen.add(std::move(pictures), frame, is_drawn); !fault.empty()) return fault;
    progress.show(frame + 1, fmt::format("{:.2f} s", panels.front().showing->world().time()));
  }
  for (Panel& panel : panels) panel.showing->finish();
  return {};
}

}  // namespace shatterbox::sandbox::run
