#include "sandbox/compare/report_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "render/output/ending.h"

namespace shatterbox::sandbox::compare {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kReportVersion = 1;                // that this program reads
constexpr int kMostDepth = 32;                   // a report has six floors
constexpr std::uintmax_t kMostBytes = 64 << 20;  // the largest so far have three megabytes

struct TooDeep {};

core::Error no_report(const std::string& why) {
  return {fmt::format("it is no report: {}; shatterbox run SCENE --report FILE makes one", why)};
}

}  // namespace

bool is_report_name(const std::string& name) {
  return render::lower_case_ending(name) == ".json";
}

core::Result<Json> parse_report(std::string_view text) {
  if (text.size() > kMostBytes) return no_report("it is larger than any report");
  Json report;
  try {
    report = Json::parse(text, [](int depth, Json::parse_event_t /*event*/, const Json& /*parsed*/) {
      if (depth > kMostDepth) throw TooDeep{};
      return true;
    });
  } catch (const TooDeep&) {
    return no_report("it is nested too deeply");
  } catch (const Json::exception& fault) {
    const std::string sentence = fault.what();  // "[json.exception.parse_error.101] parse error at line ..
    const std::size_t end = sentence.find("] ");
    return no_report(end == std::string::npos ? sentence : sentence.substr(end + 2));
  }
  if (!report.is_object() || !report.contains("report_version")) return no_report("it has no report_version");
  if (report["report_version"] != kReportVersion)
    return core::Error{fmt::format("it is a report of version {}, and this program reads version {}",
                                   report["report_version"].dump(), kReportVersion)};
  if (report.contains("shots")) {
    const Json& shots = report["shots"];
    const bool is_list = shots.is_array() && std::all_of(shots.begin(), shots.end(),
                                                         [](const Json& shot) { return shot.is_object(); });
    if (!is_list) return no_report("its shots are no list of reports");
  }
  return report;
}

core::Result<Json> read_report(const std::string& file) {
  std::error_code code;
  if (std::filesystem::is_directory(file, code)) return core::Error{"it is a folder"};
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return core::Error{fmt::format("it cannot be read: {}", std::strerror(errno))};
  if (std::filesystem::file_size(file, code) > kMostBytes && !code)
    return no_report("it is larger than any report");
  return parse_report(std::string(std::istreambuf_iterator<char>(stream), {}));
}

}  // namespace shatterbox::sandbox::compare
