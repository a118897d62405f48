#include "sandbox/report/summary.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "sandbox/report/json_report.h"
#include "sandbox/report/statistics.h"
#include "sandbox/scene/words.h"

namespace shatterbox::sandbox::report {

namespace {

using scene::counted;

constexpr std::size_t kMostRows = 5;

std::string bodies_line(const RunRecord& record) {
  return fmt::format(
      "{:g} s of \"{}\" in {}: {} at the start, {} at the end, {} of them born of breaks; at most "
      "{} triangles\n",
      record.simulated_seconds, record.scene, counted(record.world.steps, "step"),
      counted(record.world.bodies_start, "body", "bodies"), record.bodies_end, record.pieces,
      record.world.triangles_most);
}

/// The hardest impacts, in the order of time.
std::string impact_lines(const RunRecord& record) {
  std::vector<const world::ImpactRow*> rows;
  for (const world::ImpactRow& row : record.world.impacts) rows.push_back(&row);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto* a, const auto* b) { return a->ratio > b->ratio; });
  if (rows.size() > kMostRows) rows.resize(kMostRows);
  std::stable_sort(rows.begin(), rows.end(), [](const auto* a, const auto* b) { return a->time < b->time; });
  std::string text = fmt::format(
      "{} evaluated", counted(static_cast<long>(record.world.impacts.size()), "impact", "impacts"));
  if (record.world.solver.skipped > 0)
    text += fmt::format(", {} too weak to matter", record.world.solver.skipped);
  text += rows.empty() ? "\n" : ", the hardest:\n";
  for (const world::ImpactRow* row : rows) {
    text += fmt::format("  {:7.3f} s  {:<16} {:9.3g} N s in {:7.3g} ms  {:8.3g} of {:8.3g} MPa  {}\n",
                        row->time, row->body, row->impulse, 1e3 * row->duration, 1e-6 * row->stress,
                        1e-6 * row->strength, row->verdict);
  }
  return text;
}

/// Who cracked looks as before, and would seem not to have been hit.
std::string unbroken_line(const RunRecord& record) {
  std::set<std::string> cracked;
  for (const world::ImpactRow& row : record.world.impacts)
    if (row.verdict.starts_with("cracked, in one piece")) cracked.insert(row.body);
  if (cracked.empty()) return "nothing broke\n";
  return fmt::format("nothing broke into pieces, but {} cracked in one piece, which is not to be seen\n",
                     cracked.size() == 1 ? *cracked.begin() : fmt::format("{} bodies", cracked.size()));
}

std::string break_lines(const RunRecord& record) {
  const auto& breaks = record.world.breaks;
  if (breaks.empty()) return unbroken_line(record);
  std::string text = fmt::format("{}{}\n", counted(static_cast<long>(breaks.size()), "break", "breaks"),
                                 breaks.size() > kMostRows ? ", the first:" : ":");
  for (std::size_t i = 0; i < std::min(breaks.size(), kMostRows); ++i) {
    const world::BreakRow& row = breaks[i];
    const bool is_much = row.elastic_energy >= 1.0;
    const double scale = is_much ? 1.0 : 1e3;
    text += fmt::format(
        "  {:7.3f} s  {:<16} {}, {:.3g} cm2 of new area{}, {:.3g} of {:.3g} {} spent{}{}\n", row.time,
        row.body, row.pieces == 1 ? "cracked, in one piece" : fmt::format("{:>4} pieces", row.pieces),
        1e4 * row.new_area,
        row.grain_share > 0.0 ? fmt::format(" ({:.0f} % on grain boundaries)", 100.0 * row.grain_share) : "",
        scale * row.fracture_energy, scale * row.elastic_energy, is_much ? "J" : "mJ",
        row.energy_guard_active ? ", stopped by the energy" : "",
        row.generation_bound_active ? ", stopped by the bound on generations" : "");
  }
  return text;
}

/// The deepest.
std::string dent_lines(const RunRecord& record) {
  std::vector<const world::DentRow*> rows;
  for (const world::DentRow& row : record.world.dents) rows.push_back(&row);
  if (rows.empty()) return {};
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto* a, const auto* b) { return a->depth > b->depth; });
  std::string text = fmt::format("{}{}\n", counted(static_cast<long>(rows.size()), "dent", "dents"),
                                 rows.size() > kMostRows ? ", the deepest:" : ":");
  if (rows.size() > kMostRows) rows.resize(kMostRows);
  std::stable_sort(rows.begin(), rows.end(), [](const auto* a, const auto* b) { return a->time < b->time; });
  for (const world::DentRow* row : rows)
    text += row->share > 0.0
                ? fmt::format("  {:7.3f} s  {:<16} {:.3g} mm deep, {:.3g} J of flow{}\n", row->time,
                              row->body, 1e3 * row->depth, row->energy,
                              row->share < 1.0 ? fmt::format(", {:.0f} % of it, as far as there was room",
                                                             100.0 * row->share)
                                               : "")
                : fmt::format("  {:7.3f} s  {:<16} none: there was no room for it\n", row->time, row->body);
  return text;
}

std::string joint_line(const RunRecord& record) {
  const auto& joints = record.world.joints;
  if (joints.empty()) return {};
  long opened = 0;
  const world::JointRow *first = nullptr, *hardest = nullptr;  // that opened; of those that hold
  for (const world::JointRow& joint : joints) {
    if (joint.opened >= 0.0) {
      ++opened;
      // Of those that opened together the one that bore the most: the others may be far from the hit.
      if (first == nullptr ||
          std::pair(joint.opened, -joint.most_ratio) < std::pair(first->opened, -first->most_ratio))
        first = &joint;
    } else if (hardest == nullptr || joint.most_ratio > hardest->most_ratio) {
      hardest = &joint;
    }
  }
  std::string text = fmt::format("{}, {} of them opened",
                                 counted(static_cast<long>(joints.size()), "joint", "joints"), opened);
  if (first != nullptr)
    text += fmt::format(", the first at {:.3f} s, {} to {}: {}", first->opened, first->body_a, first->body_b,
                        first->verdict);
  if (hardest != nullptr)
    text += fmt::format("; of the others {} to {} {}", hardest->body_a, hardest->body_b, hardest->verdict);
  return text + "\n";
}

std::string time_lines(const RunRecord& record) {
  std::vector<double> frame, simulate, render, encode;
  for (const FrameRecord& f : record.frames) {
    frame.push_back(f.frame);
    simulate.push_back(f.simulate);
    render.push_back(f.render);
    encode.push_back(f.encode);
  }
  const auto line = [](const char* name, const std::vector<double>& values) {
    const Spread s = spread_of(values);
    return fmt::format("{} {:.1f} / {:.1f} / {:.1f}", name, s.median, s.p95, s.max);
  };
  std::string text =
      "time a frame, ms (median / p95 / worst): " + line("all", frame) + ", " + line("simulate", simulate);
  if (!record.gl_renderer.empty()) text += ", " + line("render", render) + ", " + line("encode", encode);
  text += "\n";
  std::vector<std::pair<double, std::string>> stages;
  double sum = 0.0;
  for (const auto& [name, values] : record.stages) {
    const double total = std::accumulate(values.begin(), values.end(), 0.0);
    stages.emplace_back(total, name);
    sum += total;
  }
  std::stable_sort(stages.begin(), stages.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  if (sum > 0.0) text += "the step's time:";
  for (const auto& [total, name] : stages) {
    if (total < 0.01 * sum) continue;
    text += fmt::format(" {} {:.0f} %,", name, 100.0 * total / sum);
  }
  if (sum > 0.0) text.back() = '\n';
  return text;
}

std::string crossing_line(const RunRecord& record) {
  const auto& contact = record.world.contact;
  if (contact.crossing_pairs == 0) return {};
  const std::size_t shown = std::min<std::size_t>(contact.crossing_names.size(), 3);
  std::string names;
  for (std::size_t i = 0; i < shown; ++i) names += (i > 0 ? ", " : "") + contact.crossing_names[i];
  return fmt::format("{} crossed when first seen and may pass until apart: {}{}\n",
                     counted(contact.crossing_pairs, "pair"), names,
                     contact.crossing_pairs > static_cast<long>(shown) ? ", ..." : "");
}

/// Two that find no room, of which one goes on to be pushed.
std::string held_back_line(const RunRecord& record) {
  constexpr int kNoticed = 12;  // steps in a row
  const auto& contact = record.world.contact;
  if (contact.longest_cut < kNoticed) return {};
  return fmt::format(
      "{} were held back by the failsafe for {} in a row: they find no room, and do not move as they would\n",
      contact.longest_cut_names, counted(contact.longest_cut, "step"));
}

std::string parted_line(const RunRecord& record) {
  const auto& names = record.world.contact.parted_names;
  if (names.empty()) return {};
  return fmt::format(
      "{} lay exactly on or in each other: the second of each was set aside by a hundred thousandth of its "
      "size: {}{}\n",
      counted(static_cast<long>(names.size()), "pair", "pairs"), names.front(),
      names.size() > 1 ? ", ..." : "");
}

/// Scripted bodies that something was in the way of: by more than rounding, and the braking that came of it.
std::string behind_lines(const RunRecord& record) {
  constexpr double kNoticed = 1e-6;  // m
  std::string text;
  for (const world::ScriptedRow& row : record.world.scripted) {
    if (row.most_behind <= kNoticed) continue;
    text += fmt::format("{} was held up: up to {:.3g} mm behind its path, {:.3g} mm at the end\n", row.body,
                        1e3 * row.most_behind, 1e3 * row.behind);
  }
  return text;
}

std::string error_line(const RunRecord& record) {
  double worst = 0.0;
  for (const world::BreakRow& row : record.world.breaks) {
    worst = std::max({worst, row.mass_error, row.momentum_error, row.angular_momentum_error});
  }
  const auto& w = record.world;
  const auto given_up = std::count_if(w.impacts.begin(), w.impacts.end(), [](const world::ImpactRow& row) {
    return row.verdict.starts_with("not evaluated");
  });
  return fmt::format(
      "errors: breaks {:.1g} (mass, momenta), momentum {:.1g} N s, energy rise {:.1g} J, least gap {:.2g} "
      "mm, stress solver {:.1g}, contact solver {:.1g} m/s, failsafe in {} ({:.2g} % of body-steps), {} not "
      "evaluated\n",
      worst, w.conservation.momentum_error, w.conservation.greatest_energy_rise, 1e3 * w.contact.least_gap,
      w.solver.worst_residual, w.contact.residual, counted(w.contact.failsafe_steps, "step"),
      100.0 * w.contact.frozen_share, counted(given_up, "impact"));
}

std::string audit_line(const RunRecord& record) {
  if (!record.has_audit) return {};
  const audit::AuditReport& a = record.audit;
  std::string text =
      fmt::format("audit of {}: {}, {}", counted(a.steps, "step", "steps"),
                  counted(a.crossings, "crossing", "crossings"), counted(a.passages, "passage", "passages"));
  if (a.first_time >= 0.0) text += fmt::format(", the first at {:.4f} s", a.first_time);
  if (a.exempt_pairs > 0)
    text += fmt::format("; apart: {} crossed from the start or from birth",
                        counted(a.exempt_pairs, "pair", "pairs"));
  if (a.group_pairs > 0)
    text += fmt::format("; apart: up to {} of one group crossed at once",
                        counted(a.group_pairs, "pair", "pairs"));
  text += fmt::format("; {:.1f} s on the clock\n", 1e-3 * record.audit_time);
  std::size_t shown = 0;
  for (std::size_t i = 0; i < a.findings.size() && shown < kMostRows; ++i) {
    const audit::Finding& f = a.findings[i];
    if (f.is_exempt) continue;
    ++shown;
    text += fmt::format("  {:8.4f} s  {}: {} ({}) and {} ({})\n", f.time, audit::name_of(f.kind),
                        record.audit_names[2 * i], f.feature_a, record.audit_names[2 * i + 1], f.feature_b);
  }
  return text;
}

}  // namespace

std::string make_summary(const RunRecord& record) {
  std::string text;
  if (record.is_interrupted) {
    text += fmt::format("interrupted at {:.2f} of {:g} s{}\n", record.simulated_seconds, record.asked_seconds,
                        record.goes_on ? "; with --resume it goes on" : "");
  }
  text += bodies_line(record) + impact_lines(record) + break_lines(record) + dent_lines(record) +
          joint_line(record) + time_lines(record) + crossing_line(record) + parted_line(record) +
          held_back_line(record) + behind_lines(record) + error_line(record) + audit_line(record);
  const double slowness =
      record.simulated_seconds > 0.0 ? record.wall_seconds / record.simulated_seconds : 0.0;
  const std::string pace =
      !(slowness > 0.0) ? std::string("no step was taken")
      : slowness > 1.0  ? fmt::format("{:.1f} times slower than real time", slowness)
                        : fmt::format("{:.1f} times faster than real time", 1.0 / std::max(slowness, 1e-9));
  text += fmt::format("{:.1f} s on the clock: {}; state {}\n", record.wall_seconds, pace,
                      hex_digits(record.state_hash));
  for (const std::string& output : record.outputs) text += "wrote " + output + "\n";
  return text;
}

}  // namespace shatterbox::sandbox::report
