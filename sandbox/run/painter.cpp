#include "sandbox/run/painter.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include "engine/core/clock.h"
#include "render/output/image_file.h"
#include "render/output/light_sum.h"
#include "render/output/npz_file.h"
#include "render/output/video_file.h"
#include "sandbox/recording/bytes.h"

namespace shatterbox::sandbox::run {

namespace {

using core::Clock;
using core::milliseconds_since;
// So many frames the world may be ahead of the pictures: while it takes its time over one in which much
// breaks, those before it are drawn.
constexpr std::size_t kMostWaiting = 8;

struct Waiting {
  std::vector<std::vector<render::Frame>> panels;  // of each the samples
  int number = 0;
};

/// In how many columns panels stand beside each other.
int columns_of(int panels) {
  return panels == 4 ? 2 : panels;
}

/// Panels of one size, a dark line between them.
render::Image join(const std::vector<render::Image>& panels) {
  const int columns = columns_of(static_cast<int>(panels.size()));
  const int width = panels.front().width, height = panels.front().height;
  render::Image out(width * columns, height * (static_cast<int>(panels.size()) / columns));
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const int left = static_cast<int>(i) % columns * width, top = static_cast<int>(i) / columns * height;
    for (int y = 0; y < height; ++y) {
      const bool is_line = y == 0 && top > 0;
      std::uint8_t* const to = out.at(left, top + y);
      if (!is_line) std::memcpy(to, panels[i].at(0, y), 3 * static_cast<std::size_t>(width));
      if (left > 0) std::memset(to, 0, 3);
    }
  }
  return out;
}

}  // namespace

std::uint64_t hash_image(const render::Image& image) {
  core::Hash hash;
  hash.add(static_cast<std::uint64_t>(image.width)).add(static_cast<std::uint64_t>(image.height));
  recording::add_bytes(hash, image.pixels.data(), image.pixels.size());
  return hash.value();
}

std::string picture_file(const std::string& folder, int number) {
  return fmt::format("{}/frame_{:06}.png", folder, number);
}

std::string truth_file(const std::string& folder, int number) {
  return fmt::format("{}/truth_{:06}.npz", folder, number);
}

struct Painter::Room {
  PainterSettings settings;
  std::optional<render::VideoFile> video;
  Painted painted;

  mutable std::mutex mutex;
  std::condition_variable changed;
  std::deque<Waiting> waiting;
  bool is_ending = false;
  std::vector<Picture> pictures;  // written
  std::string error;
  std::string opening_fault;  // of the video; never changes once the thread runs
  std::atomic<int> finished{0};
  std::thread thread;

  void fail(std::string sentence) {
    const std::lock_guard lock(mutex);
    if (error.empty()) error = std::move(sentence);
    changed.notify_all();
  }

  /// A frame is over: those that had none of a pass, spent none.
  void fill_passes() {
    for (auto& [name, times] : painted.passes) times.resize(painted.numbers.size(), 0.0);
  }

  std::optional<Waiting> next() {
    std::unique_lock lock(mutex);
    changed.wait(lock, [this] { return !waiting.empty() || is_ending; });
    if (waiting.empty()) return std::nullopt;
    auto first = std::move(waiting.front());
    waiting.pop_front();
    changed.notify_all();
    return first;
  }

  /// What the picture shows in numbers, to disk. False if that failed.
  bool write_truth(render::Renderer& renderer, int number) {
    const render::Truth truth = renderer.find_truth();
    const glm::mat4 rows = glm::transpose(truth.world_from_camera);  // GLM's are columns
    const std::array<float, 9> intrinsics{truth.focal, 0,           0.5F * static_cast<float>(truth.width),
                                          0,           truth.focal, 0.5F * static_cast<float>(truth.height),
                                          0,           0,           1};
    const int width = truth.width, height = truth.height;
    const std::array arrays{
        render::make_array<float>("depth", "<f4", {height, width}, truth.depths),
        render::make_array<glm::vec3>("normal", "<f4", {height, width, 3}, truth.normals),
        render::make_array<std::uint32_t>("id", "<u4", {height, width}, truth.ids),
        render::make_array<glm::mat4>("world_from_camera", "<f4", {4, 4}, std::span(&rows, 1)),
        render::make_array<float>("intrinsics", "<f4", {3, 3}, intrinsics)};
    const auto status = render::write_npz(truth_file(settings.truth_folder, number), arrays);
    if (!status) fail(status.error);
    return status.ok();
  }

  /// Pictures to disk. False if that failed.
  bool write(render::Image image, int number) {
    if (!settings.frames_folder.empty()) {
      const auto status = render::write_png(picture_file(settings.frames_folder, number), image);
      if (!status) return fail(status.error), false;
    }
    if (!video) return true;
    const auto status = video->add(std::move(image));
    if (!status) fail(status.error);
    return status.ok();
  }

  render::Image draw(render::Renderer& renderer, const render::Frame& frame) {
    render::Image image = renderer.render(frame);
    const std::size_t number = painted.numbers.size();
    auto next = painted.passes.begin();  // where a pass that no frame had yet has its place
    for (const auto& pass : renderer.pass_times().passes) {
      auto times = std::find_if(painted.passes.begin(), painted.passes.end(),
                                [&pass](const auto& named) { return named.first == pass.name; });
      if (times == painted.passes.end())
        times = painted.passes.insert(next, {pass.name, std::vector<double>()});
      times->second.resize(number + 1, 0.0);
      times->second[number] += pass.wall_ms;
      next = times + 1;
    }
    return image;
  }

  void count_parts(const std::vector<render::Renderer>& renderers) {
    world::PartCount shadow{"shadow", 0, 0.0}, encoder{"encoder", 0, 0.0};
    for (const render::Renderer& renderer : renderers) {
      shadow.count += renderer.has_shadow_maps() ? 1 : 0;
      shadow.bytes += renderer.shadow_bytes();
    }
    if (video) encoder = {"encoder", 1, video->waiting_bytes()};
    painted.parts = {shadow, encoder};
  }

  render::Image expose(render::Renderer& renderer, const std::vector<render::Frame>& samples) {
    if (samples.size() == 1) return draw(renderer, samples.front());
    render::LightSum sum;
    // Backwards: the truth is of what was drawn last, and its moment is the first.
    for (std::size_t i = samples.size(); i-- > 0;) sum.add(draw(renderer, samples[i]));
    return sum.mean();
  }

  void paint() {
    const auto start = Clock::now();
    std::vector<render::Renderer> renderers;  // of each panel, so that each keeps what has not changed
    for (int i = 0; i < settings.panels; ++i)
      renderers.emplace_back(settings.size, settings.quality, settings.back_end);
    painted.gl_renderer = renderers.front().gl_renderer();
    auto last = start;
    double encoded = 0.0;
    const bool has_files = !settings.frames_folder.empty() || !settings.truth_folder.empty();
    while (auto waited = next()) {
      const auto& [panels, number] = *waited;
      if (painted.start == 0.0) {  // compiles the shaders for this processor; not a frame's cost
        for (std::size_t i = 0; i < panels.size(); ++i) (void)renderers[i].render(panels[i].front());
        for (render::Renderer& renderer : renderers) renderer.set_timing(settings.has_pass_times);
        painted.start = milliseconds_since(start);
        last = Clock::now();
      }
      const auto begin = Clock::now();
      std::vector<render::Image> images;
      for (std::size_t i = 0; i < panels.size(); ++i) images.push_back(expose(renderers[i], panels[i]));
      render::Image image = images.size() == 1 ? std::move(images.front()) : join(images);
      painted.numbers.push_back(number);
      painted.render.push_back(milliseconds_since(begin));
      const std::uint64_t hash = hash_image(image);
      painted.hashes.push_back(hash);
      const auto written = Clock::now();
      if (!settings.truth_folder.empty() && !write_truth(renderers.front(), number)) return;
      if (!write(std::move(image), number)) return;
      const double encoder = video ? video->encode_cpu_ms() : 0.0;
      painted.encode.push_back(encoder - encoded + (has_files ? milliseconds_since(written) : 0.0));
      encoded = encoder;
      painted.frame.push_back(milliseconds_since(last));
      fill_passes();
      last = Clock::now();
      finished.store(static_cast<int>(painted.numbers.size()));
      const std::lock_guard lock(mutex);
      pictures.push_back({number, hash});
    }
    count_parts(renderers);
  }
};

Painter::Painter(PainterSettings settings) : room_(std::make_unique<Room>()) {
  room_->settings = std::move(settings);
  const PainterSettings& s = room_->settings;
  room_->pictures = s.kept;
  room_->finished = static_cast<int>(s.kept.size());
  for (const Picture& picture : s.kept) {
    Painted& painted = room_->painted;
    painted.numbers.push_back(picture.number);
    painted.hashes.push_back(picture.hash);
    for (std::vector<double>* times : {&painted.frame, &painted.render, &painted.encode})
      times->push_back(-1.0);
  }
  if (!s.video.empty()) {
    render::VideoSettings video;
    video.width = s.size.width * columns_of(s.panels);
    video.height = s.size.height * (s.panels / columns_of(s.panels));
    video.frames_per_second = s.frames_per_second;
    video.keep = static_cast<long>(s.kept.size());
    room_->video.emplace(s.video, video);
    if (!room_->video->status()) room_->error = room_->opening_fault = room_->video->status().error;
  }
  room_->thread = std::thread([room = room_.get()] {
    try {
      room->paint();
    } catch (const std::exception& fault) {
      room->fail(fault.what());
    }
  });
}

Painter::~Painter() {
  (void)finish();
}

bool Painter::add(std::vector<std::vector<render::Frame>> panels, int number) {
  std::unique_lock lock(room_->mutex);
  room_->changed.wait(lock, [this] { return room_->waiting.size() < kMostWaiting || !room_->error.empty(); });
  if (!room_->error.empty()) return false;
  room_->waiting.push_back({std::move(panels), number});
  room_->changed.notify_all();
  return true;
}

bool Painter::finish() {
  {
    const std::lock_guard lock(room_->mutex);
    room_->is_ending = true;
    room_->changed.notify_all();
  }
  if (room_->thread.joinable()) {
    room_->thread.join();
    if (room_->video) {
      const auto status = room_->video->close();
      if (!status) room_->fail(status.error);
    }
  }
  return error().empty();
}

int Painter::finished_frames() const {
  return room_->finished.load();
}

std::vector<Picture> Painter::pictures() const {
  const std::lock_guard lock(room_->mutex);
  return room_->pictures;
}

std::string Painter::error() const {
  const std::lock_guard lock(room_->mutex);
  return room_->error;
}

const std::string& Painter::opening_fault() const {
  return room_->opening_fault;
}

const Painted& Painter::painted() const {
  return room_->painted;
}

}  // namespace shatterbox::sandbox::run
