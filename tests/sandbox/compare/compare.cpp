// Films side by side: what pairs with what, what a tolerance lets pass, what the reports say.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "render/output/image_file.h"
#include "sandbox/compare/difference_report.h"
#include "sandbox/compare/film_difference.h"
#include "tests/sandbox/run/folder.h"

using namespace shatterbox;
using namespace shatterbox::sandbox;
using namespace shatterbox::sandbox::compare;
using run::Folder;

namespace {

render::Image plain(int level, int width = 40) {
  render::Image image(width, 30);
  for (auto& value : image.pixels) value = static_cast<std::uint8_t>(level);
  return image;
}

void write(const Folder& folder, const std::string& file, const render::Image& image) {
  std::filesystem::create_directories((folder / file).parent_path());
  REQUIRE(render::write_png(folder / file, image));
}

FilmDifference compare_folders(const Folder& folder, const Tolerance& tolerance = {}) {
  Film a(folder / "a"), b(folder / "b");
  return compare_films(a, b, tolerance);
}

}  // namespace

TEST_CASE("folders are compared by name: a missing picture does not shift the rest") {
  const Folder folder;
  for (const int i : {1, 2, 3}) write(folder, "a/frame_" + std::to_string(i) + ".png", plain(50 * i));
  for (const int i : {1, 3, 4}) write(folder, "b/frame_" + std::to_string(i) + ".png", plain(50 * i));
  const FilmDifference d = compare_folders(folder);
  CHECK(d.error.empty());
  REQUIRE(d.frames.size() == 4);
  CHECK(d.frames[0].excess.empty());
  CHECK(d.frames[1].excess == "the picture is missing");
  CHECK(d.frames[2].excess.empty());
  CHECK(d.frames[3].excess == "there is no such picture among the expected ones");
  CHECK(d.differing() == 2);
  REQUIRE(d.first() != nullptr);
  CHECK(d.first()->name == "frame_2.png");
}

TEST_CASE("pictures in folders of a folder are compared too") {
  const Folder folder;
  for (const char* name : {"a/x.png", "a/s/y.png", "b/x.png"}) write(folder, name, plain(100));
  write(folder, "b/s/y.png", plain(200));
  Film a(folder / "a"), b(folder / "b");
  const FilmDifference d = compare_films(a, b, {}, (folder / "d").string());
  REQUIRE(d.frames.size() == 2);
  CHECK(d.differing() == 1);
  CHECK(d.worst == "s/y.png");
  CHECK(std::filesystem::exists(folder / "d/s/y.png"));
  CHECK(d.first()->name == "s/y.png");
}

TEST_CASE("a difference of size is told with both sizes, what cannot be read with its name") {
  const Folder folder;
  write(folder, "a/x.png", plain(50));
  write(folder, "b/x.png", plain(50, 42));
  CHECK(compare_folders(folder).first()->excess == "42 x 30 pixels, 3 channels, instead of 40 x 30, 3");
  folder.write("b/x.png", "no picture");
  const FilmDifference d = compare_folders(folder);
  CHECK_FALSE(d.is_same());
  CHECK(d.error.find("x.png") != std::string::npos);
  CHECK_FALSE(Film(folder / "nothing").error().empty());
}

TEST_CASE("the picture of the worst frame is kept, and one for each that differs is written") {
  const Folder folder;
  for (const int i : {1, 2, 3}) write(folder, "a/" + std::to_string(i) + ".png", plain(100));
  write(folder, "b/1.png", plain(100));
  render::Image slight = plain(100);
  slight.pixels[0] = slight.pixels[300] = 200;
  write(folder, "b/2.png", slight);
  write(folder, "b/3.png", plain(120));
  std::filesystem::create_directories(folder / "d");
  Film a(folder / "a"), b(folder / "b");
  const FilmDifference d = compare_films(a, b, {}, (folder / "d").string());
  CHECK(d.worst == "3.png");
  CHECK(d.worst_picture.width == 40);
  CHECK_FALSE(std::filesystem::exists(folder / "d/1.png"));
  CHECK(std::filesystem::exists(folder / "d/2.png"));
  CHECK(std::filesystem::exists(folder / "d/3.png"));
}

TEST_CASE("a tolerance is a word or numbers, and whatever is wrong with it is told") {
  std::string problem;
  const auto given = parse_tolerance("levels=5,share=0.25,cluster=7,psnr=31.5,ssim=0.9", problem);
  REQUIRE(given);
  CHECK(given->levels == 5);
  CHECK(given->share == 0.25);
  CHECK(given->cluster == 7);
  CHECK(given->psnr == 31.5);
  CHECK(given->ssim == 0.9);
  CHECK(parse_tolerance("exact", problem)->levels == 0);
  CHECK(parse_tolerance("levels=3", problem)->psnr == Tolerance{}.psnr);
  const auto refused = [](const std::string& text, const std::string& part) {
    std::string why;
    INFO(text);
    CHECK_FALSE(parse_tolerance(text, why));
    INFO(why);
    CHECK(why.find(part) != std::string::npos);
  };
  refused("exakt", "did you mean \"exact\"?");
  refused("level=3", "did you mean \"levels\"?");
  refused("levels=", "levels=NUMBER");
  refused("levels=-1", "not below 0");
  refused("levels=300", "from 0 to 255");
  refused("levels=3,share", "share=NUMBER");
}

TEST_CASE("each number of a tolerance is asked") {
  render::Difference d;
  d.same_size = true;
  d.psnr = 70.0;
  d.ssim = 0.95;
  CHECK(find_excess(d, {}).empty());
  d.share_beyond = 2e-4;
  CHECK(find_excess(d, {}).find("levels apart") != std::string::npos);
  d.share_beyond = 0.0;
  d.largest_cluster = 5;
  CHECK(find_excess(d, {}).find("side by side") != std::string::npos);
  d.largest_cluster = 4;
  d.psnr = 59.0;
  CHECK(find_excess(d, {}).find("PSNR") != std::string::npos);
  d.psnr = 61.0;
  CHECK(find_excess(d, {2, 1e-4, 4, 60.0, 0.96}).find("SSIM") != std::string::npos);
}

TEST_CASE("reports: JSON has each frame's numbers, JUnit its failures, with nothing that breaks XML") {
  const Folder folder;
  write(folder, "a/1.png", plain(100));
  write(folder, "b/1.png", plain(100));
  write(folder, "a/2.png", plain(100));
  write(folder, "b/2.png", plain(110));
  const FilmDifference d = compare_folders(folder);
  const auto json = make_json(d);
  CHECK(json["same"] == false);
  CHECK(json["frames_compared"] == 2);
  CHECK(json["frames_differing"] == 1);
  CHECK(json["first"] == "2.png");
  CHECK(json["frames"][0]["psnr"].is_null());
  CHECK(json["frames"][1]["most"] == 10);
  CHECK(describe(d).find("1 of 2 pictures differs") == 0);
  const std::string xml = make_junit("a & b", {{"<1>", ""}, {"2", "\"far\" < apart\n"}});
  CHECK(xml.find("<testsuite name=\"a &amp; b\" tests=\"2\" failures=\"1\"") != std::string::npos);
  CHECK(xml.find("name=\"&lt;1&gt;\"/>") != std::string::npos);
  CHECK(make_junit("a", {{"1", "", "<broken>"}}).find("errors=\"1\"") != std::string::npos);
  CHECK(make_junit("a", {{"1", "", "<broken>"}}).find("<error message=\"&lt;broken&gt;\"/>") !=
        std::string::npos);
  CHECK(xml.find("<failure message=\"&quot;far&quot; &lt; apart \"/>") != std::string::npos);
}
