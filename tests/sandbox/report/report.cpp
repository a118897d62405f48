// The report's fields by their names, its statistics, and the OBJ of a frame.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/geometry/edge_topology.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/mass_properties.h"
#include "engine/world/world.h"
#include "sandbox/report/json_report.h"
#include "sandbox/report/obj_frames.h"
#include "sandbox/report/statistics.h"
#include "sandbox/report/summary.h"

using namespace shatterbox;
using namespace shatterbox::sandbox::report;

namespace {

RunRecord some_record() {
  RunRecord record;
  record.version = "0.1.0";
  record.scene = "test";
  record.state_hash = 0x123;
  record.frame_hashes = {1, 2};
  record.simulated_seconds = 1.0;
  record.wall_seconds = 2.0;
  world::ImpactRow impact;
  impact.body = "vase";
  impact.ratio = 0.62;
  impact.verdict = "held: 0.62 of its strength";
  record.world.impacts.push_back(impact);
  world::BreakRow row;
  row.body = "vase";
  row.pieces = 12;
  row.merged = 2;
  row.mass = 2.0;
  row.merged_mass = 0.5;
  record.world.breaks.push_back(row);
  for (int i = 0; i < 4; ++i) {
    FrameRecord frame;
    frame.frame = i + 1.0;
    frame.contacts = i == 0 ? 0 : 10 * i;
    frame.breaks = i == 2 ? 1 : 0;
    frame.awake = i == 3 ? 0 : 1;
    record.frames.push_back(frame);
  }
  record.passes.push_back({"shadow", {3.0, 1.0, 1.0, 0.0}});
  record.stages.push_back({"motion", {1.0, 2.0, 3.0, 4.0}});
  record.load.emplace_back("meshes", 5.0);
  return record;
}

}  // namespace

TEST_CASE("the report has the fields of its description, by name") {
  const auto json = make_json(some_record());
  for (const char* name :
       {"report_version", "version",      "scene",     "seed",       "steps",        "simulated_seconds",
        "video_seconds",  "wall_seconds", "threads",   "state_hash", "frame_hashes", "bodies",
        "pieces",         "merged",       "triangles", "impacts",    "breaks",       "contact",
        "conservation",   "solver",       "used",      "left_out",   "time_ms",      "load_ms",
        "peak_memory_mb", "warnings"}) {
    INFO(name);
    CHECK(json.contains(name));
  }
  CHECK(json["state_hash"] == "0000000000000123");
  CHECK(json["frame_hashes"][1] == "0000000000000002");
  for (const char* name : {"time", "body", "impulse_ns", "duration_s", "stress_pa", "strength_pa", "ratio",
                           "verdict", "place"}) {
    INFO(name);
    CHECK(json["impacts"][0].contains(name));
  }
  for (const char* name :
       {"time", "body", "pieces", "new_area_m2", "grain_share", "fracture_energy_j", "elastic_energy_j",
        "mass_error", "momentum_error", "angular_momentum_error", "overlap", "energy_gain"}) {
    INFO(name);
    CHECK(json["breaks"][0].contains(name));
  }
  for (const char* name : {"on", "steps", "crossings", "passages", "first_time"})
    CHECK(json["audit"].contains(name));
  for (const char* name : {"most", "failsafe_steps", "frozen_share", "least_gap"})
    CHECK(json["contact"].contains(name));
  for (const char* name : {"frame", "simulate", "render", "encode", "stages", "passes", "phases"}) {
    CHECK(json["time_ms"].contains(name));
  }
  for (const char* name : {"before", "impact", "breaking", "after", "busy", "rest"}) {
    for (const char* field : {"frames", "median", "p95", "max", "contacts", "awake"}) {
      CHECK(json["time_ms"]["phases"][name].contains(field));
    }
  }
  CHECK(json["merged"]["count"] == 2);
  CHECK(json["merged"]["mass_share"] == 0.25);
  CHECK(json["time_ms"]["stages"]["motion"]["median"] == 2.5);
  CHECK(json["time_ms"]["passes"]["shadow"]["max"] == 3.0);
}

TEST_CASE("the audit's findings are in the report and in the closing words") {
  RunRecord record = some_record();
  CHECK(make_summary(record).find("audit") == std::string::npos);
  CHECK(make_json(record)["audit"]["on"] == false);
  record.has_audit = true;
  record.audit.steps = 10;
  record.audit.crossings = 1;
  record.audit.first_time = 0.25;
  record.audit.findings.push_back({3, 0.25, audit::FindingKind::crossing, 1, 2, 7, 8, false});
  record.audit_names = {"cup", "plate"};
  const auto json = make_json(record)["audit"];
  CHECK(json["crossings"] == 1);
  CHECK(json["first_time"] == 0.25);
  CHECK(json["findings"][0]["b"] == "plate");
  CHECK(json["findings"][0]["feature_b"] == 8);
  const std::string text = make_summary(record);
  CHECK(text.find("1 crossing, 0 passages, the first at 0.2500 s") != std::string::npos);
  CHECK(text.find("cup (7) and plate (8)") != std::string::npos);
}

TEST_CASE("who cracks in one piece is named where nothing breaks: it looks as before") {
  RunRecord record = some_record();
  record.world.breaks.clear();
  record.world.impacts.clear();
  CHECK(make_summary(record).find("nothing broke\n") != std::string::npos);
  for (int i = 0; i < 2; ++i) {
    record.world.impacts.emplace_back();
    record.world.impacts.back().body = "vase";
    record.world.impacts.back().verdict = "cracked, in one piece: 1.53 of its strength";
  }
  CHECK(make_summary(record).find("nothing broke into pieces, but vase cracked in one piece") !=
        std::string::npos);
  record.world.impacts.back().body = "cup";
  CHECK(make_summary(record).find("but 2 bodies cracked in one piece") != std::string::npos);
}

TEST_CASE("who is held back step after step is named in the report and in the closing words") {
  RunRecord record = some_record();
  record.world.contact.longest_cut = 11;
  record.world.contact.longest_cut_names = "drum / bead";
  CHECK(make_summary(record).find("held back") == std::string::npos);
  record.world.contact.longest_cut = 12;
  CHECK(make_summary(record).find("drum / bead were held back by the failsafe for 12 steps in a row") !=
        std::string::npos);
  CHECK(make_json(record)["contact"]["longest_cut_names"] == "drum / bead");
}

TEST_CASE("that an interrupted run goes on is said of one that does") {
  RunRecord record = some_record();
  record.is_interrupted = true;
  CHECK(make_summary(record).find("interrupted at") == 0);
  CHECK(make_summary(record).find("--resume") == std::string::npos);
  record.goes_on = true;
  CHECK(make_summary(record).find("; with --resume it goes on\n") != std::string::npos);
}

TEST_CASE("numbers that are not finite become null, not broken JSON") {
  RunRecord record = some_record();
  record.world.contact.least_gap = std::numeric_limits<double>::infinity();
  const auto text = make_json(record).dump();
  CHECK(nlohmann::json::parse(text)["contact"]["least_gap"].is_null());
}

TEST_CASE("median, 95th percentile and worst") {
  CHECK(spread_of({}).max == 0.0);
  CHECK(spread_of({3.0}).median == 3.0);
  CHECK(spread_of({4.0, 1.0, 3.0, 2.0}).median == 2.5);
  std::vector<double> hundred;
  for (int i = 100; i >= 1; --i) hundred.push_back(i);
  CHECK(spread_of(hundred).p95 == 95.0);
  CHECK(spread_of(hundred).max == 100.0);
}

TEST_CASE("stages, solves and who is awake are told by phase, and the dearest frame by stage") {
  RunRecord record = some_record();
  for (FrameRecord& frame : record.frames) frame.movable = 4;
  record.frames[2].solves = 7;
  record.frames[3].solves = 2;
  const auto times = make_json(record)["time_ms"];
  CHECK(times["phases"]["breaking"]["stages"]["motion"]["max"] == 3.0);
  CHECK(times["phases"]["after"]["stages"]["motion"]["median"] == 3.5);
  CHECK(times["phases"]["after"]["solves"] == 9);
  CHECK(times["phases"]["after"]["awake_share"] == 0.125);
  CHECK(times["dearest"]["frame"] == 3);
  CHECK(times["dearest"]["ms"] == 4.0);
  CHECK(times["dearest"]["stages"]["motion"] == 4.0);
  CHECK(times["dearest"]["solves"] == 2);
}

TEST_CASE("frames are sorted into phases") {
  const auto phases = phases_of(some_record().frames);
  CHECK(phases[0].frame_times == std::vector<double>{1.0});       // before
  CHECK(phases[2].frame_times == std::vector<double>{3.0});       // breaking
  CHECK(phases[3].frame_times == std::vector<double>{3.0, 4.0});  // after
  CHECK(phases[4].frame_times == std::vector<double>{4.0});       // busy: 30 contacts of 30
  CHECK(phases[5].frame_times == std::vector<double>{4.0});       // rest
}

TEST_CASE("the impact phase is the frames with more hits than the median by ten") {
  std::vector<FrameRecord> frames(5);
  const int hits[] = {3, 4, 14, 15, 2};  // the median is 4
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].frame = static_cast<double>(i);
    frames[i].hits = hits[i];
    frames[i].impacts = 1;  // evaluated stress does not count
  }
  CHECK(phases_of(frames)[1].frame_times == std::vector<double>{3.0});
}

TEST_CASE("the closing words tell verdicts, breaks and speed") {
  const std::string text = make_summary(some_record());
  INFO(text);
  for (const char* part : {"held: 0.62 of its strength", "12 pieces", "2.0 times slower than real time",
                           "motion 100 %", "errors:", "0000000000000123"}) {
    CHECK(text.find(part) != std::string::npos);
  }
}

TEST_CASE("of joints that open together the closing words name the one that bore the most") {
  RunRecord record = some_record();
  const auto add = [&](const char* body, double opened, double ratio) {
    world::JointRow row;
    row.body_a = body;
    row.body_b = "wall";
    row.opened = opened;
    row.most_ratio = ratio;
    row.verdict = "opened";
    record.world.joints.push_back(row);
  };
  add("corner", 0.5, 1.1);
  add("middle", 0.5, 9.0);
  add("top", 0.6, 20.0);
  CHECK(make_summary(record).find("3 of them opened, the first at 0.500 s, middle to wall: opened") !=
        std::string::npos);
}

TEST_CASE("exported boxes and spheres and capsules are closed and wound outwards") {
  CHECK(geometry::enclosed_volume(geometry::make_box_surface(Vec3(0.5, 1.0, 1.5))) ==
        Approx(6.0).epsilon(1e-14));
  const double volume = geometry::enclosed_volume(geometry::make_capsule_surface(1.0, 0.0));
  CHECK(volume > 4.0);
  CHECK(volume < 4.18879);
  const double middle = geometry::enclosed_volume(geometry::make_capsule_surface(1.0, 0.5)) - volume;
  CHECK(middle > 3.1);
  CHECK(middle < 3.14159);
  for (const double half_length : {0.0, 0.5}) {
    const auto topology =
        geometry::build_edge_topology(geometry::make_capsule_surface(1.0, half_length).triangles);
    for (int edge = 0; edge < static_cast<int>(topology.edges.size()); ++edge)
      CHECK(topology.triangle_count(edge) == 2);
  }
}

TEST_CASE("an OBJ frame has a group a body, in world space, to the bit") {
  world::World world{world::WorldSettings{}};
  const auto material = world.add_material(material::Material{});
  world::BodyDescription box;
  box.name = "a box";
  box.form = world::BoxDescription{Vec3(0.1, 0.2, 0.3)};
  box.material = material.value();
  box.pose.translation = Vec3(1.0 / 3.0, 2.0, 3.0);
  REQUIRE(world.add_body(box).ok());
  const std::string text = make_obj(world.bodies(), world.time());
  CHECK(text.find("o a_box#1\n") != std::string::npos);
  std::istringstream stream(text);
  std::string line;
  int vertices = 0, faces = 0;
  double most = 0.0;
  while (std::getline(stream, line)) {
    std::istringstream words(line);
    std::string kind;
    double x = 0.0;
    words >> kind >> x;
    if (kind == "v") {
      ++vertices;
      most = std::max(most, x);
    }
    faces += kind == "f" ? 1 : 0;
  }
  CHECK(vertices == 8);
  CHECK(faces == 12);
  CHECK(most == 1.0 / 3.0 + 0.1);
}
