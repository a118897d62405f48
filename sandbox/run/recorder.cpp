#include "sandbox/run/recorder.h"

#include <sys/resource.h>

#include <algorithm>

namespace shatterbox::sandbox::run {

void Recorder::watch(world::World& world) {
  world.watch([this](const world::Moment& moment) { tracer_.note(moment); });
}

void Recorder::note_broken_off(const world::World& world) {
  tracer_.drop_step(world.steps() + 1);
}

void Recorder::note_step(const world::World& world) {
  most_contacts_ = std::max(most_contacts_, world.report().contact.contacts);
  hits_ += world.report().contact.hits;
}

void Recorder::note_frame(const world::World& world, double simulate, double audit) {
  const world::WorldReport& report = world.report();
  report::FrameRecord frame;
  frame.simulate = frame.frame = simulate;
  frame.audit = audit;
  frame.contacts = most_contacts_;
  frame.hits = hits_;
  for (const body::Body& body : world.bodies()) {
    if (!body.is_dynamic()) continue;
    ++frame.movable;
    if (body.is_awake) ++frame.awake;
  }
  frame.impacts = static_cast<int>(report.impacts.size() - impacts_);
  frame.breaks = static_cast<int>(report.breaks.size() - breaks_);
  frame.solves = report.solver.solves - solves_;
  const auto& stages = report.stages.stages();  // in the order of their first call: new ones come last
  stage_sums_.resize(stages.size(), 0.0);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    if (i == record.stages.size()) {
      record.stages.emplace_back(stages[i].name, std::vector<double>(record.frames.size(), 0.0));
    }
    record.stages[i].second.push_back(stages[i].milliseconds - stage_sums_[i]);
    stage_sums_[i] = stages[i].milliseconds;
  }
  record.frames.push_back(frame);
  most_contacts_ = 0;
  hits_ = 0;
  impacts_ = report.impacts.size();
  breaks_ = report.breaks.size();
  solves_ = report.solver.solves;
}

void Recorder::note_pictures(const Painted& painted, int first) {
  record.gl_renderer = painted.gl_renderer;
  record.load.emplace_back("renderer", painted.start);
  note_parts(painted.parts);
  for (std::size_t i = 0; i < painted.frame.size(); ++i) {
    if (painted.numbers[i] < first) continue;
    const auto number = static_cast<std::size_t>(painted.numbers[i] - first);
    if (number >= record.frames.size()) continue;
    record.frame_hashes.push_back(painted.hashes[i]);
    if (painted.frame[i] < 0.0) {  // an earlier run drew it
      ++record.kept_frames;
      continue;
    }
    report::FrameRecord& frame = record.frames[number];
    frame.render = painted.render[i];
    frame.encode = painted.encode[i];
    // Since the picture before a still many frames have passed that were not drawn.
    const int before = i > 0 ? painted.numbers[i - 1] : first - 1;
    frame.frame = painted.numbers[i] == before + 1 ? std::max(painted.frame[i] - frame.audit, 0.0)
                                                   : std::max(frame.simulate, frame.render + frame.encode);
    for (std::size_t pass = 0; pass < painted.passes.size(); ++pass) {
      const auto& [name, times] = painted.passes[pass];
      if (pass == record.passes.size()) record.passes.emplace_back(name, std::vector<double>());
      record.passes[pass].second.push_back(times[i]);
    }
  }
  std::erase_if(record.passes, [](const auto& pass) {  // those that only other shots of the film have
    return std::all_of(pass.second.begin(), pass.second.end(), [](double time) { return time == 0.0; });
  });
}

void Recorder::note_parts(const std::vector<world::PartCount>& parts) {
  for (const world::PartCount& part : parts) {
    const auto known = std::find_if(record.inventory.begin(), record.inventory.end(),
                                    [&part](const world::PartCount& row) { return row.part == part.part; });
    if (known == record.inventory.end())
      record.inventory.push_back(part);
    else
      *known = part;
  }
}

void Recorder::finish(const world::World& world, double wall_seconds) {
  record.wall_seconds = wall_seconds;
  record.simulated_seconds = world.time();
  record.state_hash = world.state_hash();
  record.world = world.report();
  std::vector<world::PartCount> parts = world.inventory();
  for (const char* of_pictures : {"level_sets", "overlays", "shadow", "encoder"})
    parts.push_back({of_pictures, 0, 0.0});
  std::swap(parts, record.inventory);
  note_parts(parts);
  record.trace = std::move(tracer_.trace);
  for (const body::Body& body : world.bodies()) {
    ++record.bodies_end;
    record.has_sleepers |= body.sleeps();
    record.pieces += world.ancestry(body.id).parent != 0 ? 1 : 0;
    record.triangles_end += static_cast<long>(body.shape->surface.triangles.size());
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  record.peak_memory = static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace shatterbox::sandbox::run
