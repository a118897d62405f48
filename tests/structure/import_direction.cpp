#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "tests/structure/import_rules.h"
#include "tests/structure/local_names.h"

namespace shatterbox::structure {
namespace {

std::string joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& s : sentences) text += s + "\n";
  return text;
}

/// A small house of its own, to plant faults in.
class PlantedHouse {
 public:
  PlantedHouse()
      : root_(std::filesystem::temp_directory_path() / ("structure_" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(root_);
  }
  PlantedHouse(const PlantedHouse&) = delete;
  PlantedHouse& operator=(const PlantedHouse&) = delete;
  ~PlantedHouse() { std::filesystem::remove_all(root_); }

  void write(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  void plant(const std::string& path, const std::string& include) const {
    write(path, "#pragma once\n#include \"" + include + "\"\n");
  }
  std::string wrong() const { return joined(find_wrong_includes(read_sources(root_))); }
  std::string circles() const { return joined(find_circles(read_sources(root_))); }
  std::string shared_names() const { return joined(find_shared_local_names(root_)); }
  std::string unreached() const { return joined(find_unreached(root_, read_sources(root_))); }

 private:
  std::filesystem::path root_;
};

const std::filesystem::path kRoot = SHATTERBOX_SOURCE_DIR;

}  // namespace

TEST_CASE("includes go down the floors, or stay in their folder") {
  const auto files = read_sources(kRoot);
  REQUIRE(files.size() > 20);
  CHECK(joined(find_wrong_includes(files)) == "");
}

TEST_CASE("no file includes itself by a circle") {
  CHECK(joined(find_circles(read_sources(kRoot))) == "");
}

TEST_CASE("every source is built and every header is used") {
  CHECK(joined(find_unreached(kRoot, read_sources(kRoot))) == "");
}

TEST_CASE("no two files of a namespace have a constant or a type of their own under one name") {
  CHECK(joined(find_shared_local_names(kRoot)) == "");
}

TEST_CASE("control: names that two files share are found, those of other namespaces are not") {
  const PlantedHouse house;
  const auto file = [](const std::string& scope, const std::string& text) {
    return "namespace " + scope + " {\nnamespace {\n" + text + "\n}  // namespace\n}  // namespace " + scope +
           "\n";
  };
  house.write("engine/core/a.cpp",
              file("core", "constexpr double kSmall = 1e-9;\nstruct Row {\n};\nusing Size = std::size_t;"));
  house.write("engine/core/b.cpp", file("core::only_b", "const int kSmall = 3;\nstruct Row {\n};"));
  house.write("engine/body/c.cpp", file("body", "const int kSmall = 3;\nstruct Row {\n};"));
  house.write("engine/core/d.cpp", file("core", "using Size = std::size_t;\nconst int kLarge = 2;"));
  CHECK(house.shared_names() == "");
  house.write("engine/core/e.cpp", file("core", "const char* const kSmall = \"\";\nstruct Row {\n};"));
  house.write("engine/core/f.cpp", file("core", "using Size = int;"));
  for (const char* test : {"tests/engine/core/a.cpp", "tests/engine/core/b.cpp", "tests/engine/body/c.cpp"})
    house.write(test, "namespace {\n\nstruct Case {\n};\n\n}  // namespace\n");
  CHECK(house.shared_names() ==
        "core::Row is defined by engine/core/a.cpp and by engine/core/e.cpp\n"
        "core::Size is defined by engine/core/a.cpp and by engine/core/f.cpp\n"
        "core::kSmall is defined by engine/core/a.cpp and by engine/core/e.cpp\n"
        "tests/engine/core/Case is defined by tests/engine/core/a.cpp and by tests/engine/core/b.cpp\n");
}

TEST_CASE("control: a house without faults passes") {
  const PlantedHouse house;
  house.write("engine/core/a.h", "#pragma once\n#include <vector>\n");
  house.plant("engine/geometry/b.h", "engine/core/a.h");
  house.plant("engine/body/c.h", "engine/geometry/b.h");
  house.plant("engine/fracture/d.h", "engine/stress/e.h");
  house.plant("engine/stress/e.h", "engine/geometry/b.h");
  house.plant("engine/world/f.h", "engine/fracture/d.h");
  house.plant("render/pass/g.h", "render/gpu/h.h");
  house.write("render/gpu/h.h",
              "#pragma once\n#include <glm/glm.hpp>\n// #include \"engine/core/a.h\"\n/*\n#include "
              "<Eigen/Core>\n*/\n");
  house.plant("sandbox/view/i.h", "render/pass/g.h");
  house.plant("sandbox/view/j.h", "engine/world/f.h");
  CHECK(house.wrong() == "");
  CHECK(house.circles() == "");
}

TEST_CASE("control: each planted wrong arrow is found") {
  struct Planted {
    const char* path;
    const char* include;
    const char* words;
  };
  for (const Planted& p : {Planted{"engine/core/a.h", "engine/geometry/b.h", "an arrow up"},
                           Planted{"engine/geometry/a.h", "engine/body/b.h", "an arrow up"},
                           Planted{"engine/geometry/a.h", "engine/material/b.h", "siblings"},
                           Planted{"engine/stress/a.h", "engine/body/b.h", "siblings"},
                           Planted{"engine/body/a.h", "engine/stress/b.h", "siblings"},
                           Planted{"engine/fracture/a.h", "engine/collision/b.h", "siblings"},
                           Planted{"engine/dynamics/a.h", "engine/world/b.h", "an arrow up"},
                           Planted{"engine/cellar/a.h", "engine/core/b.h", "has no floor"},
                           Planted{"engine/world/a.h", "render/renderer.h", "neither render nor sandbox"},
                           Planted{"engine/world/a.h", "sandbox/run/b.h", "neither render nor sandbox"},
                           Planted{"engine/world/a.h", "glm/glm.hpp", "without glm/"},
                           Planted{"engine/core/a.h", "../core/b.h", "begin at the root"},
                           Planted{"engine/core/a.h", "tests/support/b.h", "do not include tests"},
                           Planted{"render/pass/a.h", "engine/core/vec.h", "neither engine nor sandbox"},
                           Planted{"render/pass/a.h", "Eigen/Core", "Eigen stays out"},
                           Planted{"render/pass/a.h", "libavcodec/avcodec.h", "names FFmpeg"}}) {
    const PlantedHouse house;
    house.plant(p.path, p.include);
    INFO(p.path << " includes " << p.include << ": " << house.wrong());
    CHECK(house.wrong().find(p.words) != std::string::npos);
  }
}

TEST_CASE("control: circles, headers without guard and files that nobody builds are found") {
  const PlantedHouse house;
  house.plant("engine/core/a.h", "engine/core/b.h");
  house.plant("engine/core/b.h", "engine/core/c.h");
  house.plant("engine/core/c.h", "engine/core/a.h");
  CHECK(house.circles() == "engine/core/a.h -> engine/core/b.h -> engine/core/c.h -> engine/core/a.h\n");
  house.write("engine/core/bare.h", "int x;\n");
  CHECK(house.wrong().find("bare.h: a header without #pragma once") != std::string::npos);
  house.write("engine/core/CMakeLists.txt", "part(core SOURCES built.cpp\n  # left.cpp\n)\n");
  house.write("engine/core/built.cpp", "\n");
  house.write("engine/core/left.cpp", "\n");
  CHECK(house.unreached().find("left.cpp: no CMakeLists.txt") != std::string::npos);
  CHECK(house.unreached().find("built.cpp") == std::string::npos);
  CHECK(house.unreached().find("bare.h: no file includes") != std::string::npos);
}

}  // namespace shatterbox::structure
