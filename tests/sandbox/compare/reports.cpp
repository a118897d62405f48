// Reports side by side: what differs is told by its place, what a machine makes of it is left aside.
#include <catch2/catch.hpp>

#include "sandbox/compare/report_difference.h"
#include "sandbox/compare/report_file.h"

using namespace shatterbox::sandbox::compare;
using Json = nlohmann::ordered_json;

namespace {

Json make_report() {
  return Json::parse(
      R"({"report_version": 1, "version": "0.1.0", "seed": 1, "wall_seconds": 2.5, "threads": 2,
    "state_hash": "00000000000000aa", "frame_hashes": ["01", "02"], "pieces": 40, "goal": "glass",
    "impacts": [{"time": 0.1, "stress_pa": 100.0, "ratio": 5.214, "verdict": "broke: 5.21 of its strength"},
                {"time": 0.2, "stress_pa": 200.0, "ratio": 0.5, "verdict": "held: 0.5 of its strength"}],
    "solver": {"worst_residual": 1e-9, "solves": 3}, "time_ms": {"frame": {"median": 1}},
    "load_ms": {}, "peak_memory_mb": 100, "parts": {"encoder": {"bytes": 2073600}}, "contact": {"least_gap": null}})");
}

std::vector<std::string> places(const ReportDifference& difference) {
  std::vector<std::string> list;
  for (const FieldDifference& field : difference.fields)
    for (const ValueDifference& value : field.differences) list.push_back(value.place);
  return list;
}

using Places = std::vector<std::string>;

}  // namespace

TEST_CASE("what a machine makes of a report is no difference") {
  const Json a = make_report();
  Json b = a;
  b["wall_seconds"] = 99.0;
  b["time_ms"]["frame"]["median"] = 7;
  b["load_ms"]["meshes"] = 3.0;
  b["peak_memory_mb"] = 1;
  b["parts"]["encoder"]["bytes"] = 691200;
  b["threads"] = 64;
  b["version"] = "9";
  b["kept_frames"] = 5;
  const ReportDifference difference = compare_reports(a, b, 0.0);
  CHECK(difference.is_same());
  CHECK(difference.compared() == 18);
  CHECK(describe(difference) == "reports: the same in 18 values\n");
}

TEST_CASE("each difference is told with its place and by how much") {
  const Json a = make_report();
  Json b = a;
  b["pieces"] = 50;
  b["impacts"][1]["stress_pa"] = 100.0;
  b["contact"]["least_gap"] = 0.1;
  b["frame_hashes"].push_back("03");
  b["solver"].erase("solves");
  b["audit"] = {{"on", true}};
  const ReportDifference difference = compare_reports(a, b, 0.0);
  CHECK(places(difference) == Places{"frame_hashes", "pieces", "impacts[1].stress_pa", "solver.solves",
                                     "contact.least_gap", "audit"});
  const auto json = make_json(difference);
  CHECK(json["same"] == false);
  CHECK(json["values_differing"] == 6);
  CHECK(json["differences"][0]["expected"] == "2 entries");
  CHECK(json["differences"][1]["relative"].get<double>() == Approx(0.2));
  CHECK(json["differences"][2]["relative"].get<double>() == Approx(0.5));
  CHECK(json["differences"][3]["actual"] == "nothing");
  CHECK(json["differences"][4]["relative"].is_null());
  const std::string words = describe(difference);
  CHECK(words.find("6 of ") != std::string::npos);
  CHECK(words.find("by most  impacts[1].stress_pa: 200.0 and 100.0 (50 %)") != std::string::npos);
  const auto cases = test_cases(difference);
  const auto of = [&cases](const std::string& name) {
    const auto found =
        std::find_if(cases.begin(), cases.end(), [&](const auto& one) { return one.name == name; });
    REQUIRE(found != cases.end());
    return found->failure;
  };
  CHECK(of("goal").empty());
  CHECK(of("pieces") == "pieces: 40 and 50 (20 %)");
}

TEST_CASE("within a tolerance numbers may differ and what measures rounding is left aside") {
  const Json a = make_report();
  Json b = a;
  b["impacts"][0]["stress_pa"] = 100.9;
  b["impacts"][0]["ratio"] = 5.25;
  b["impacts"][0]["verdict"] = "broke: 5.25 of its strength";
  b["state_hash"] = "00000000000000bb";
  b["frame_hashes"][0] = "11";
  b["solver"]["worst_residual"] = 1e-7;
  CHECK(compare_reports(a, b, 0.0).differing() == 6);
  CHECK(compare_reports(a, b, 0.01).is_same());
  CHECK(places(compare_reports(a, b, 0.008)) == Places{"impacts[0].stress_pa"});
  b["impacts"][0]["verdict"] = "held: 5.25 of its strength";
  CHECK(places(compare_reports(a, b, 0.01)) == Places{"impacts[0].verdict"});
  // A number that changes its sign is twice as far from itself.
  b = a;
  b["impacts"][0]["stress_pa"] = -100.0;
  CHECK(compare_reports(a, b, 0.99).differing() == 1);
}

TEST_CASE("shots are compared one by one") {
  const Json one = make_report();
  Json other = one;
  other["pieces"] = 41;
  const Json a = {{"report_version", 1}, {"shots", {one, one}}};
  CHECK(places(compare_reports(a, {{"report_version", 1}, {"shots", {one, other}}}, 0.0)) ==
        Places{"shots[1].pieces"});
  CHECK(places(compare_reports(a, {{"report_version", 1}, {"shots", Json::array({one})}}, 0.0)) ==
        Places{"shots"});
  CHECK_FALSE(compare_reports(a, one, 0.0).is_same());
  CHECK(compare_reports(a, a, 0.0).is_same());
}

TEST_CASE("what is no report is refused in words") {
  CHECK(parse_report(make_report().dump()).ok());
  CHECK(parse_report("\xEF\xBB\xBF" + make_report().dump()).ok());
  const std::string deep(100000, '[');
  for (const std::string& wrong :
       {std::string(), std::string("[]"), std::string("{}"), std::string("{\"report_version\": 1"), deep,
        std::string("{\"report_version\": 2}"), std::string("{\"report_version\": {}}"),
        std::string("{\"report_version\": 1, \"shots\": 3}"), std::string("{\"report_version\": 1e999}"),
        std::string("{\"report_version\": 1, \"shots\": [3]}"), std::string("{\"\xff\": 1}")}) {
    INFO(wrong.substr(0, 50));
    const auto report = parse_report(wrong);
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().find("report") != std::string::npos);
  }
  CHECK(parse_report(deep).error().find("too deeply") != std::string::npos);
  CHECK(parse_report("{\"report_version\": 2}").error().find("version 2") != std::string::npos);
  CHECK_FALSE(read_report("no/such/report.json").ok());
}

TEST_CASE("tolerances of reports") {
  std::string problem;
  CHECK(parse_report_tolerance("default", problem) == 0.0);
  CHECK(parse_report_tolerance("exact", problem) == 0.0);
  CHECK(parse_report_tolerance("0.01", problem) == 0.01);
  CHECK(problem.empty());
  for (const char* wrong : {"video", "", "-1", "1", "nan", "0.1x", "levels=3"}) {
    problem.clear();
    CHECK_FALSE(parse_report_tolerance(wrong, problem));
    CHECK_FALSE(problem.empty());
  }
}

namespace {

/// Two bodies over a step of two stages, as a report keeps it.
Json make_traced() {
  Json report = make_report();
  report["trace"] = Json::parse(R"({"quantities": ["position", "velocity", "contacts"],
    "names": {"3": "pane", "17": "ball"},
    "rows": [[1, 1, 1, 1, "acts", "3 0:0000000a 1:0000000b;17 0:0000000c 1:0000000d"],
             [1, 1, 1, 1, "motion", "0 2:00000001;3 1:0000001b;17 0:0000001c 1:0000001d"],
             [2, 1, 2, 1, "motion", "17 0:0000002c"]]})");
  return report;
}

}  // namespace

TEST_CASE("traces tell the first step and stage and body and quantity in which two runs part") {
  const Json a = make_traced();
  Json b = a;
  CHECK(compare_reports(a, b, 0.0).is_same());
  b["state_hash"] = "00000000000000bb";
  b["trace"]["rows"][1][5] = "0 2:00000002;3 1:0000001b;17 0:0000001c 1:0000002d";
  b["trace"]["rows"][2][5] = "17 0:0000003c";
  CHECK(places(compare_reports(a, b, 0.0)) ==
        Places{"state_hash", "step 1, stage motion (part 1 of 1, pass 1), body 17 \"ball\", velocity"});
  CHECK(describe(compare_reports(a, b, 0.0))
            .find("first    step 1, stage motion (part 1 of 1, pass 1), body 17 "
                  "\"ball\", velocity: 0000001d and 0000002d\n") != std::string::npos);

  // More bodies in the same stage, one of which did not change at all.
  b["trace"]["rows"][1][5] = "3 1:0000001b 0:0000005a;17 0:0000001c";
  CHECK(places(compare_reports(a, b, 0.0)).back() ==
        "step 1, stage motion (part 1 of 1, pass 1), body 3 \"pane\", position (and 1 more body)");
  // Only what is between the bodies.
  b = a;
  b["trace"]["rows"][1][5] = "0 2:00000009;3 1:0000001b;17 0:0000001c 1:0000001d";
  CHECK(places(compare_reports(a, b, 0.0)).back() ==
        "step 1, stage motion (part 1 of 1, pass 1), all bodies together, contacts");
  // Another stage, and an end.
  b = a;
  b["trace"]["rows"][2][2] = 4;
  ReportDifference difference = compare_reports(a, b, 0.0);
  CHECK(places(difference) == Places{"step 2"});
  CHECK(describe(difference)
            .find("stage motion (part 1 of 2, pass 1) and stage motion (part 1 of 4, pass 1)") !=
        std::string::npos);
  b["trace"]["rows"].erase(2);
  difference = compare_reports(a, b, 0.0);
  CHECK(describe(difference).find("step 2: stage motion (part 1 of 2, pass 1) and nothing") !=
        std::string::npos);
}

TEST_CASE("who has no traces is told to make them and a trace alone is no difference") {
  const Json a = make_report();
  Json b = a;
  b["state_hash"] = "00000000000000bb";
  CHECK(describe(compare_reports(a, b, 0.0)).find("run both with --trace") != std::string::npos);
  CHECK(describe(compare_reports(make_traced(), b, 0.0)).find("run both with --trace") != std::string::npos);
  CHECK(compare_reports(make_traced(), a, 0.0).is_same());
  Json c = make_traced();
  c["trace"]["rows"][0][5] = "";
  CHECK(compare_reports(make_traced(), c, 0.1).is_same());
  CHECK_FALSE(compare_reports(make_traced(), c, 0.0).is_same());
  for (const char* trace : {"3", "[]", "{\"rows\": 1}", "{\"rows\": [1, [2]], \"names\": []}"}) {
    c["trace"] = Json::parse(trace);
    CHECK(compare_reports(c, c, 0.0).is_same());
    (void)describe(compare_reports(make_traced(), c, 0.0));
  }
}
