#include "sandbox/report/json_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/elementary.h"
#include "sandbox/report/statistics.h"
#include "sandbox/report/text_file.h"

namespace shatterbox::sandbox::report {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json vector(const Vec3& v) {
  return Json::array({number(v.x()), number(v.y()), number(v.z())});
}

Json impacts(const world::WorldReport& report) {
  Json list = Json::array();
  for (const world::ImpactRow& row : report.impacts) {
    list.push_back({{"time", number(row.time)},
                    {"body", row.body},
                    {"impulse_ns", number(row.impulse)},
                    {"duration_s", number(row.duration)},
                    {"stress_pa", number(row.stress)},
                    {"strength_pa", number(row.strength)},
                    {"ratio", number(row.ratio)},
                    {"verdict", row.verdict},
                    {"place", vector(row.place)}});
    if (!(row.von_mises > 0.0)) continue;
    list.back()["von_mises_pa"] = number(row.von_mises);
    list.back()["yield_pa"] = number(row.yield);
    if (!(row.perforation_energy > 0.0)) continue;
    list.back()["perforation_j"] = number(row.perforation_energy);
    list.back()["perforation_ratio"] = number(row.perforation_ratio);
  }
  return list;
}

Json tetrahedra(const std::string& body, const geometry::TetQuality& quality) {
  const auto degrees = [](double angle) { return number(angle * 180.0 / core::kPi); };
  return {{"body", body},
          {"count", quality.count},
          {"edge_m", number(quality.mean_edge_length)},
          {"dihedral_degrees",
           {{"least", degrees(quality.least_dihedral)},
            {"median_least", degrees(quality.median_least_dihedral)},
            {"greatest", degrees(quality.greatest_dihedral)}}},
          {"aspect", {{"median", number(quality.median_aspect)}, {"worst", number(quality.worst_aspect)}}}};
}

Json dents(const world::WorldReport& report) {
  Json list = Json::array();
  for (const world::DentRow& row : report.dents) {
    list.push_back({{"time", number(row.time)},
                    {"body", row.body},
                    {"depth_m", number(row.depth)},
                    {"volume_change", number(row.volume_change)},
                    {"energy_j", number(row.energy)},
                    {"flowed_m3", number(row.flowed_volume)},
                    {"torn_m2", number(row.torn_area)},
                    {"von_mises_pa", number(row.von_mises)},
                    {"yield_pa", number(row.yield)},
                    {"share", number(row.share)},
                    {"cut", row.is_cut},
                    {"mass_error", number(row.mass_error)},
                    {"place", vector(row.place)}});
  }
  return list;
}

Json breaks(const world::WorldReport& report) {
  Json list = Json::array();
  for (const world::BreakRow& row : report.breaks) {
    list.push_back({{"time", number(row.time)},
                    {"body", row.body},
                    {"pieces", row.pieces},
                    {"place", vector(row.place)},
                    {"new_area_m2", number(row.new_area)},
                    {"grain_share", number(row.grain_share)},
                    {"fracture_energy_j", number(row.fracture_energy)},
                    {"elastic_energy_j", number(row.elastic_energy)},
                    {"mass_error", number(row.mass_error)},
                    {"momentum_error", number(row.momentum_error)},
                    {"angular_momentum_error", number(row.angular_momentum_error)},
                    {"overlap", world::count_overlaps(row)},
                    {"energy_gain", number(row.energy_gain)},
                    {"generation", row.generation},
                    {"crack_generations", row.crack_generations},
                    {"energy_guard_active", row.energy_guard_active},
                    {"generation_bound_active", row.generation_bound_active},
                    {"merged", row.merged}});
  }
  return list;
}

Json joints(const world::WorldReport& report) {
  Json list = Json::array();
  for (const world::JointRow& row : report.joints) {
    list.push_back({{"name", row.name},
                    {"a", row.body_a},
                    {"b", row.body_b},
                    {"area_m2", number(row.area)},
                    {"verdict", row.verdict},
                    {"opened", row.opened < 0.0 ? Json(nullptr) : number(row.opened)},
                    {"ratio", number(row.most_ratio)},
                    {"tension_pa", number(row.tension)},
                    {"shear_pa", number(row.shear)},
                    {"force_n", vector(row.force)},
                    {"moment_nm", vector(row.moment)},
                    {"struck", row.is_struck}});
  }
  return list;
}

Json merged(const world::WorldReport& report) {
  int count = 0;
  double merged = 0.0, broken = 0.0;
  for (const world::BreakRow& row : report.breaks) {
    count += row.merged;
    merged += row.merged_mass;
    broken += row.mass;
  }
  return {{"count", count}, {"mass_share", number(broken > 0.0 ? merged / broken : 0.0)}};
}

/// The first findings; all of them would be a flood.
constexpr std::size_t kMostFindings = 200;

Json audit(const RunRecord& record) {
  const audit::AuditReport& report = record.audit;
  Json json = {{"on", record.has_audit},
               {"steps", report.steps},
               {"crossings", report.crossings},
               {"passages", report.passages},
               {"first_time", report.first_time < 0.0 ? Json(nullptr) : number(report.first_time)}};
  if (!record.has_audit) return json;
  json["exempt"] = {{"pairs", report.exempt_pairs},
                    {"crossings", report.exempt_crossings},
                    {"passages", report.exempt_passages}};
  json["one_group"] = {{"pairs", report.group_pairs}};
  json["unsettled"] = report.unsettled;
  json["time_ms"] = number(record.audit_time);
  json["findings"] = Json::array();
  for (std::size_t i = 0; i < std::min(report.findings.size(), kMostFindings); ++i) {
    const audit::Finding& f = report.findings[i];
    json["findings"].push_back({{"step", f.step},
                                {"time", number(f.time)},
                                {"what", audit::name_of(f.kind)},
                                {"a", record.audit_names[2 * i]},
                                {"b", record.audit_names[2 * i + 1]},
                                {"feature_a", f.feature_a},
                                {"feature_b", f.feature_b},
                                {"exempt", f.is_exempt}});
  }
  return json;
}

/// The frame that took longest, by stage.
Json dearest(const RunRecord& record) {
  const auto frame =
      std::max_element(record.frames.begin(), record.frames.end(),
                       [](const FrameRecord& a, const FrameRecord& b) { return a.frame < b.frame; });
  if (frame == record.frames.end()) return nullptr;
  const auto number_of_frame = static_cast<std::size_t>(frame - record.frames.begin());
  Json stages = Json::object();
  for (const auto& [name, times] : times_of(record.stages, {number_of_frame}))
    if (!times.empty()) stages[name] = number(times.front());
  return {{"frame", number_of_frame},
          {"ms", number(frame->frame)},
          {"stages", stages},
          {"breaks", frame->breaks},
          {"solves", frame->solves}};
}

Json times(const RunRecord& record) {
  std::vector<double> frame, simulate, render, encode;
  for (const FrameRecord& f : record.frames) {
    frame.push_back(f.frame);
    simulate.push_back(f.simulate);
    render.push_back(f.render);
    encode.push_back(f.encode);
  }
  Json phases = Json::object();
  for (const Phase& phase : phases_of(record.frames)) {
    Json entry = {{"frames", phase.frame_times.size()}};
    entry.update(make_spread(phase.frame_times));
    entry["contacts"] = number(phase.contacts);
    entry["awake"] = number(phase.awake);
    entry["awake_share"] = number(phase.awake_share);
    entry["solves"] = phase.solves;
    entry["stages"] = make_spreads(times_of(record.stages, phase.frames));
    phases[phase.name] = entry;
  }
  return {{"frame", make_spread(frame)},
          {"simulate", make_spread(simulate)},
          {"render", make_spread(render)},
          {"encode", make_spread(encode)},
          {"stages", make_spreads(record.stages)},
          {"passes", make_spreads(record.passes)},
          {"phases", phases},
          {"dearest", dearest(record)}};
}

Json make_trace(const Trace& trace) {
  Json json = {{"quantities", trace_quantities()}, {"names", Json::object()}, {"rows", Json::array()}};
  for (const auto& [id, name] : trace.names) json["names"][std::to_string(id)] = name;
  for (const TraceRow& row : trace.rows)
    json["rows"].push_back({row.step, row.part, row.parts, row.pass, row.stage, row.changed});
  return json;
}

}  // namespace

std::string hex_digits(std::uint64_t number) {
  return fmt::format("{:016x}", number);
}

Json make_spread(const std::vector<double>& values) {
  const Spread s = spread_of(values);
  return {{"median", number(s.median)}, {"p95", number(s.p95)}, {"max", number(s.max)}};
}

Json make_json(const RunRecord& record) {
  const world::WorldReport& w = record.world;
  Json json;
  json["report_version"] = kReportVersion;
  json["version"] = record.version;
  json["compiler"] = record.compiler;
  json["gl_renderer"] = record.gl_renderer;
  json["scene"] = record.scene;
  json["goal"] = record.goal;
  json["seed"] = record.seed;
  json["steps"] = w.steps;
  json["steps_per_second"] = record.steps_per_second;
  json["simulated_seconds"] = number(record.simulated_seconds);
  json["video_seconds"] =
      number(static_cast<double>(record.frames.size()) / std::max(record.frames_per_second, 1));
  json["wall_seconds"] = number(record.wall_seconds);
  json["interrupted"] = record.is_interrupted;
  json["threads"] = record.threads;
  json["state_hash"] = hex_digits(record.state_hash);
  json["frame_hashes"] = Json::array();
  for (const std::uint64_t hash : record.frame_hashes) json["frame_hashes"].push_back(hex_digits(hash));
  if (record.kept_frames > 0) json["kept_frames"] = record.kept_frames;
  json["bodies"] = {{"start", w.bodies_start}, {"end", record.bodies_end}};
  json["pieces"] = record.pieces;
  json["merged"] = merged(w);
  json["triangles"] = {
      {"start", w.triangles_start}, {"end", record.triangles_end}, {"max", w.triangles_most}};
  if (w.tetrahedra_most > 0)
    json["tetrahedra"] = {
        {"start", w.tetrahedra_start}, {"end", w.tetrahedra_end}, {"max", w.tetrahedra_most}};
  for (const auto& [body, quality] : record.tetrahedra)
    json["tetrahedra"]["meshes"].push_back(tetrahedra(body, quality));
  json["impacts"] = impacts(w);
  json["breaks"] = breaks(w);
  if (!w.dents.empty()) json["dents"] = dents(w);
  if (!w.joints.empty()) json["joints"] = joints(w);
  json["audit"] = audit(record);
  json["contact"] = {{"most", w.contact.most_contacts},
                     {"failsafe_steps", w.contact.failsafe_steps},
                     {"frozen_share", number(w.contact.frozen_share)},
                     {"longest_cut", w.contact.longest_cut},
                     {"longest_cut_names", w.contact.longest_cut_names},
                     {"crossing_pairs_at_start", w.contact.crossing_pairs},
                     {"crossing_names", w.contact.crossing_names},
                     {"parted_names", w.contact.parted_names},
                     {"least_gap", number(w.contact.least_gap)}};
  if (w.contact.drift > 0.0) json["contact"]["drift"] = number(w.contact.drift);
  for (const world::ScriptedRow& row : w.scripted)
    json["scripted"].push_back(
        {{"body", row.body}, {"behind", number(row.behind)}, {"most_behind", number(row.most_behind)}});
  json["conservation"] = {{"momentum", vector(w.conservation.momentum)},
                          {"kinetic_energy_j", number(w.conservation.kinetic_energy)},
                          {"potential_energy_j", number(w.conservation.potential_energy)},
                          {"greatest_energy_rise_j", number(w.conservation.greatest_energy_rise)},
                          {"momentum_error_ns", number(w.conservation.momentum_error)}};
  json["solver"] = {{"worst_residual", number(w.solver.worst_residual)},
                    {"contact_residual", number(w.contact.residual)},
                    {"solves", w.solver.solves},
                    {"skipped", w.solver.skipped},
                    {"factorisations", w.solver.factorisations}};
  json["used"] = record.used;
  json["idle"] = record.idle;
  json["left_out"] = record.left_out;
  json["parts"] = Json::object();
  for (const world::PartCount& row : record.inventory)
    json["parts"][row.part] = {{"count", row.count}, {"bytes", number(row.bytes)}};
  json["time_ms"] = times(record);
  json["load_ms"] = Json::object();
  for (const auto& [name, milliseconds] : record.load) json["load_ms"][name] = number(milliseconds);
  json["peak_memory_mb"] = number(record.peak_memory);
  json["warnings"] = record.warnings;
  if (!record.trace.rows.empty()) json["trace"] = make_trace(record.trace);
  return json;
}

Json make_spreads(const TimesByName& times) {
  Json spreads = Json::object();
  for (const auto& [name, values] : times) spreads[name] = make_spread(values);
  return spreads;
}

std::string write_report(const std::string& path, const std::vector<const RunRecord*>& shots) {
  if (shots.size() == 1) return write_text(path, make_json(*shots.front()).dump(2) + "\n");
  Json json = {{"report_version", kReportVersion}, {"shots", Json::array()}};
  for (const RunRecord* shot : shots) json["shots"].push_back(make_json(*shot));
  return write_text(path, json.dump(2) + "\n");
}

}  // namespace shatterbox::sandbox::report
