// What scripts do to films, seen from outside.
#include <catch2/catch.hpp>

#include "tests/sandbox/run/running.h"

using namespace shatterbox::sandbox::run;

namespace {

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

}  // namespace

TEST_CASE("slow motion makes the film longer, not the world, and gives the same pictures twice") {
  const Folder folder;
  write_text(folder / "small.toml", kSmallScene);
  write_text(folder / "slow.toml",
             "[[event]]\nat = 0.1\ndo = \"speed\"\nfactor = 0.25\n"
             "[[event]]\nat = 0.2\ndo = \"speed\"\nfactor = 1\n");
  const std::string picture = "run small.toml --size 64x48 --frames ";
  REQUIRE(program(folder, picture + "a --report a.json").status == 0);
  REQUIRE(program(folder, picture + "b --script slow.toml --report b.json --meshes m").status == 0);
  REQUIRE(program(folder, picture + "c --script slow.toml --report c.json --stills 0.15").status == 0);
  const auto plain = read_json(folder / "a.json"), slow = read_json(folder / "b.json"),
             still = read_json(folder / "c.json");
  CHECK(slow["state_hash"] == plain["state_hash"]);
  CHECK(slow["simulated_seconds"] == plain["simulated_seconds"]);
  CHECK(plain["video_seconds"].get<double>() == Approx(0.5));
  CHECK(slow["video_seconds"].get<double>() == Approx(0.1 + 4 * 0.1 + 0.3));
  REQUIRE(slow["frame_hashes"].size() == 48);
  // Before the change the films are the same; after it they are again, 0.3 s later.
  for (std::size_t i = 0; i <= 6; ++i) CHECK(slow["frame_hashes"][i] == plain["frame_hashes"][i]);
  for (std::size_t i = 30; i < 48; ++i) CHECK(slow["frame_hashes"][i] == plain["frame_hashes"][i - 18]);
  for (std::size_t i = 7; i <= 30; ++i) CHECK(slow["frame_hashes"][i] != slow["frame_hashes"][i - 1]);
  REQUIRE(still["frame_hashes"].size() == 1);
  CHECK(still["frame_hashes"][0] == slow["frame_hashes"][18]);
  CHECK(fs::exists(folder / "m" / "frame_000047.obj"));
}
