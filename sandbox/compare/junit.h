// JUnit XML for test farms.
#pragma once

#include <string>
#include <vector>

namespace shatterbox::sandbox::compare {

/// One test of a suite: it passes without a failure and an error.
struct TestCase {
  std::string name, failure;
  std::string error{};  // why it could not be made
};

/// One suite, as Jenkins, GitLab and their like read it.
std::string make_junit(const std::string& suite, const std::vector<TestCase>& cases);

}  // namespace shatterbox::sandbox::compare
