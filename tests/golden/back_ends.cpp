// EGL draws the bits that OSMesa draws, of scenes that show every pass, and says it in words where it cannot.
#include <catch2/catch.hpp>

#include "tests/sandbox/run/running.h"

using namespace shatterbox::sandbox::run;

namespace {

const std::string kScenesKept = SHATTERBOX_SOURCE_DIR "/tests/golden/goldens/";

/// Of --gl egl here: nothing if it draws, else why not, which is told.
bool has_egl(const Folder& folder) {
  std::ofstream(folder / "small.toml") << kSmallScene;
  const Outcome outcome = program(folder, "run small.toml --gl egl --size 16x16 --stills 0 --frames first");
  if (outcome.status == 0) return true;
  WARN("not compared, for there is no EGL here: " << outcome.err);
  CHECK(outcome.err.find("EGL") != std::string::npos);
  return false;
}

/// A golden's own run with a back-end; the report.
nlohmann::json draw(const Folder& folder, const std::string& golden, const std::string& back_end) {
  const auto kept = read_json(kScenesKept + golden + "/golden.json");
  std::string arguments = " " + kept["scene"].get<std::string>();
  for (const std::string word : kept["arguments"]) arguments += " '" + word + "'";
  const std::string name = golden + "_" + back_end;
  const Outcome outcome = program(
      folder, "run" + arguments + " --gl " + back_end + " --frames " + name + " --report " + name + ".json");
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  return read_json(folder / (name + ".json"));
}

}  // namespace

TEST_CASE("both back-ends draw the same bytes") {
  const Folder folder;
  if (!has_egl(folder)) return;
  // Paint and a moving camera; glass; many bodies on wood.
  for (const char* golden : {"ornament", "window", "plate_stack"}) {
    INFO(golden);
    const auto usual = draw(folder, golden, "osmesa"), other = draw(folder, golden, "egl");
    CHECK(usual["state_hash"] == other["state_hash"]);
    CHECK_FALSE(usual["frame_hashes"].empty());
    CHECK(usual["frame_hashes"] == other["frame_hashes"]);
    const std::string name = golden;
    const Outcome difference = program(folder, "diff " + name + "_osmesa " + name + "_egl --tolerance exact");
    INFO(difference.out << difference.err);
    CHECK(difference.status == 0);
    const std::string usual_name = usual["gl_renderer"], other_name = other["gl_renderer"];
    CHECK(usual_name.find("llvmpipe") == 0);
    CHECK(usual_name.find(", OSMesa") != std::string::npos);
    CHECK(other_name.find("llvmpipe") == 0);
    CHECK(other_name.find(", EGL") != std::string::npos);
  }
}

TEST_CASE("an EGL that finds nothing to draw with is told in words") {
  const Folder folder;
  if (!has_egl(folder)) return;
  const std::string run = " run small.toml --gl egl --size 16x16 --stills 0 --frames second";
  const Outcome without = shell(folder, "__EGL_VENDOR_LIBRARY_FILENAMES=/nowhere " SHATTERBOX_PROGRAM + run);
  CHECK(without.status == 3);
  CHECK(without.err.find("EGL has no device that draws on the processor") != std::string::npos);
  CHECK(without.err.find("libgl1-mesa-dri") != std::string::npos);
  const Outcome wrong = program(folder, "run small.toml --gl eagle");
  CHECK(wrong.status == 2);
  CHECK((wrong.out + wrong.err).find("egl") != std::string::npos);
}
