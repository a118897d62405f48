#include "sandbox/compare/junit.h"

#include <algorithm>

#include <fmt/format.h>

namespace shatterbox::sandbox::compare {

namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;  // control characters are not allowed in XML
    }
  }
  return out;
}

}  // namespace

std::string make_junit(const std::string& suite, const std::vector<TestCase>& cases) {
  const auto failures =
      std::count_if(cases.begin(), cases.end(), [](const TestCase& one) { return !one.failure.empty(); });
  const auto errors =
      std::count_if(cases.begin(), cases.end(), [](const TestCase& one) { return !one.error.empty(); });
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  text += fmt::format("<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\">\n", escaped(suite),
                      cases.size(), failures, errors);
  for (const TestCase& one : cases) {
    text += fmt::format("  <testcase classname=\"{}\" name=\"{}\"", escaped(suite), escaped(one.name));
    std::string found;
    if (!one.failure.empty()) found = fmt::format("    <failure message=\"{}\"/>\n", escaped(one.failure));
    if (!one.error.empty()) found += fmt::format("    <error message=\"{}\"/>\n", escaped(one.error));
    text += found.empty() ? "/>\n" : ">\n" + found + "  </testcase>\n";
  }
  return text + "</testsuite>\n";
}

}  // namespace shatterbox::sandbox::compare
