// Videos are decoded again by the ffmpeg tool and compared frame by frame.
#include "render/output/video_file.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>
#include <vector>

#include "render/output/compare.h"

using namespace shatterbox::render;
namespace fs = std::filesystem;

namespace {

constexpr int kWidth = 160, kHeight = 90;

// A soft gradient and a square that moves.
Image frame_at(int i) {
  Image image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool is_square = x >= 20 + i && x < 60 + i && y >= 30 && y < 60;
      image.at(x, y)[0] = is_square ? 200 : static_cast<std::uint8_t>(60 + x / 2);
      image.at(x, y)[1] = is_square ? 40 : static_cast<std::uint8_t>(80 + y);
      image.at(x, y)[2] = is_square ? 30 : 120;
    }
  }
  return image;
}

std::vector<Image> decode(const fs::path& path, const std::string& muxer = "") {
  const std::string command = "ffmpeg -v error " + (muxer.empty() ? "" : "-f " + muxer) + " -i '" +
                              path.string() + "' -f rawvideo -pix_fmt rgb24 - 2>/dev/null";
  std::vector<Image> frames;
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  Image image(kWidth, kHeight);
  while (std::fread(image.pixels.data(), 1, image.pixels.size(), pipe) == image.pixels.size())
    frames.push_back(image);
  pclose(pipe);
  return frames;
}

VideoSettings settings() {
  VideoSettings s;
  s.width = kWidth;
  s.height = kHeight;
  return s;
}

}  // namespace

TEST_CASE("each kind of video holds every frame, as it was") {
  for (const char* ending : {".mp4", ".mkv", ".webm", ".gif"}) {
    INFO(ending);
    const fs::path path = fs::temp_directory_path() / (std::string("shatterbox_video") + ending);
    VideoFile video(path, settings());
    constexpr int kFrames = 45;
    for (int i = 0; i < kFrames; ++i) REQUIRE(video.add(frame_at(i)).ok());
    const Status status = video.close();
    INFO(status.error);
    REQUIRE(status.ok());
    CHECK(video.frames() == kFrames);
    CHECK_FALSE(fs::exists(path.string() + ".part"));
    const std::vector<Image> back = decode(path);
    if (std::string(ending) != ".gif") {  // gif knows hundredths of a second only: the tool drops and doubles
      REQUIRE(back.size() == kFrames);
      for (int i = 0; i < kFrames; i += 11)
        CHECK(compare(frame_at(i), back[static_cast<std::size_t>(i)]).psnr > 30.0);
    } else {
      REQUIRE_FALSE(back.empty());
      CHECK(compare(frame_at(0), back[0]).psnr > 30.0);
    }
    fs::remove(path);
  }
}

TEST_CASE("colours come back through BT.709 within a few levels") {
  const fs::path path = fs::temp_directory_path() / "shatterbox_colour.mp4";
  VideoSettings s = settings();
  s.crf = 4;
  VideoFile video(path, s);
  Image plain(kWidth, kHeight);
  for (std::size_t i = 0; i < plain.pixels.size(); i += 3) {
    plain.pixels[i] = 200;
    plain.pixels[i + 1] = 40;
    plain.pixels[i + 2] = 90;
  }
  for (int i = 0; i < 5; ++i) REQUIRE(video.add(plain).ok());
  REQUIRE(video.close().ok());
  const auto back = decode(path);
  REQUIRE(back.size() == 5);
  CHECK(compare(plain, back[2]).most <= 4);
  fs::remove(path);
}

TEST_CASE("a run that is killed leaves a part that plays") {
  for (const char* ending : {".mp4", ".mkv"}) {
    INFO(ending);
    const fs::path path = fs::temp_directory_path() / (std::string("shatterbox_killed") + ending);
    const fs::path part = path.string() + ".part";
    fs::remove(part);
    const pid_t child = fork();
    if (child == 0) {
      VideoFile video(path, settings());
      for (int i = 0; i < 200; ++i) static_cast<void>(video.add(frame_at(i % 90)));
      for (;;) pause();
    }
    REQUIRE(child > 0);
    std::uintmax_t size = 0;
    int quiet = 0;
    for (int i = 0; i < 300 && quiet < 10; ++i) {  // until the file has grown and stopped growing
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      const std::uintmax_t now = fs::exists(part) ? fs::file_size(part) : 0;
      quiet = now > 2000 && now == size ? quiet + 1 : 0;
      size = now;
    }
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    CHECK_FALSE(fs::exists(path));
    const auto back = decode(part, std::string(ending) == ".mp4" ? "mp4" : "matroska");
    CHECK(back.size() >= 90);
    REQUIRE_FALSE(back.empty());
    CHECK(compare(frame_at(0), back[0]).psnr > 30.0);
    fs::remove(part);
  }
}

TEST_CASE("a finished mp4 has its index first and no fragments, and every frame at its time") {
  const fs::path path = fs::temp_directory_path() / "shatterbox_plain.mp4";
  VideoFile video(path, settings());
  for (int i = 0; i < 70; ++i) REQUIRE(video.add(frame_at(i)).ok());
  REQUIRE(video.close().ok());
  CHECK_FALSE(fs::exists(path.string() + ".plain"));
  std::vector<std::string> boxes;  // a box: four bytes of length, most significant first, and four letters
  FILE* file = std::fopen(path.c_str(), "rb");
  unsigned char head[8];
  while (std::fread(head, 1, 8, file) == 8) {
    boxes.emplace_back(reinterpret_cast<const char*>(head) + 4, 4);
    const long length = head[0] * 16777216L + head[1] * 65536L + head[2] * 256L + head[3];
    REQUIRE(length >= 8);
    REQUIRE(std::fseek(file, length - 8, SEEK_CUR) == 0);
  }
  std::fclose(file);
  REQUIRE(boxes.size() >= 3);
  CHECK(boxes[0] == "ftyp");
  CHECK(boxes[1] == "moov");
  CHECK(std::find(boxes.begin(), boxes.end(), "moof") == boxes.end());
  const std::string command =
      "ffprobe -v error -show_entries stream=nb_frames,start_time,duration,r_frame_rate -of csv=p=0 '" +
      path.string() + "'";
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  char line[200] = {};
  CHECK(std::fgets(line, sizeof line, pipe) != nullptr);
  pclose(pipe);
  CHECK(std::string(line) == "60/1,0.000000,1.166667,70\n");
  const std::vector<Image> back = decode(path);
  REQUIRE(back.size() == 70);
  for (const std::size_t i : {0U, 35U, 69U})
    CHECK(compare(frame_at(static_cast<int>(i)), back[i]).psnr > 30.0);
  fs::remove(path);
}

TEST_CASE("what cannot be written is refused in words and never crashes") {
  CHECK_FALSE(can_write_video("x.avi").ok());
  CHECK(can_write_video("x.MP4").ok());
  VideoFile nowhere("/nowhere/at/all/x.mp4", settings());
  CHECK_FALSE(nowhere.status().ok());
  CHECK_FALSE(nowhere.add(frame_at(0)).ok());
  CHECK_FALSE(nowhere.close().ok());
  VideoSettings odd = settings();
  odd.width = 161;
  CHECK(VideoFile("/tmp/shatterbox_odd.mp4", odd).status().error.find("even") != std::string::npos);
  const fs::path path = fs::temp_directory_path() / "shatterbox_wrong_size.mp4";
  VideoFile video(path, settings());
  CHECK_FALSE(video.add(Image(8, 8)).ok());
  CHECK(video.add(frame_at(0)).ok());
  CHECK(video.close().ok());
  CHECK_FALSE(video.add(frame_at(0)).ok());
  fs::remove(path);
}

TEST_CASE("the same frames give the same file") {
  std::vector<std::string> bytes;
  for (int run = 0; run < 2; ++run) {
    const fs::path path = fs::temp_directory_path() / "shatterbox_same.mp4";
    VideoFile video(path, settings());
    for (int i = 0; i < 20; ++i) REQUIRE(video.add(frame_at(i)).ok());
    REQUIRE(video.close().ok());
    FILE* file = std::fopen(path.c_str(), "rb");
    std::string all(fs::file_size(path), '\0');
    CHECK(std::fread(all.data(), 1, all.size(), file) == all.size());
    std::fclose(file);
    bytes.push_back(all);
    fs::remove(path);
  }
  CHECK(bytes[0] == bytes[1]);
}

TEST_CASE("a video goes on behind what a run that was cut short has left") {
  for (const char* ending : {".mp4", ".mkv", ".webm"}) {
    const fs::path path = fs::temp_directory_path() / (std::string("shatterbox_kept") + ending);
    const fs::path part = path.string() + ".part", cut = path.string() + ".cut";
    constexpr int kFrames = 120;
    const auto picture = [](int i) { return frame_at(i % 90); };
    {
      VideoFile video(path, settings());
      for (int i = 0; i < kFrames; ++i) REQUIRE(video.add(picture(i)).ok());
      fs::copy_file(part, cut, fs::copy_options::overwrite_existing);  // as a kill at this moment leaves it
      REQUIRE(video.close().ok());
    }
    fs::remove(path);
    const std::uintmax_t size = fs::file_size(cut);
    long last = 1000;
    for (const std::uintmax_t left : {size, size * 3 / 5, size / 3, std::uintmax_t{100}}) {
      INFO(ending << ", " << left << " of " << size << " bytes");
      fs::copy_file(cut, part, fs::copy_options::overwrite_existing);
      fs::resize_file(part, left);
      VideoSettings s = settings();
      s.keep = count_kept_frames(path, kFrames);
      CHECK(s.keep <= last);
      CHECK(s.keep % 30 == 0);  // whole groups
      if (left == size) {
        CHECK(s.keep >= 60);
        // Of a film that is ahead of what is known: no group that is cut.
        for (const auto& [known, kept] : {std::pair{59, 30}, {60, 60}, {30, 30}, {29, 0}, {0, 0}})
          CHECK(count_kept_frames(path, known) == kept);
      }
      last = s.keep;
      VideoFile video(path, s);
      CHECK(static_cast<long>(decode(part).size()) == s.keep);  // nothing is lost by another kill
      for (int i = static_cast<int>(s.keep); i < kFrames; ++i) REQUIRE(video.add(picture(i)).ok());
      const Status status = video.close();
      INFO(status.error);
      REQUIRE(status.ok());
      const std::vector<Image> back = decode(path);
      REQUIRE(back.size() == kFrames);
      for (int i = 0; i < kFrames; ++i) {
        INFO("frame " << i);
        CHECK(compare(picture(i), back[static_cast<std::size_t>(i)]).psnr > 30.0);
      }
      fs::remove(path);
    }
    CHECK(last == 0);
    fs::remove(cut);
  }
  CHECK(count_kept_frames(fs::temp_directory_path() / "shatterbox_none.mp4", 100) == 0);
}
