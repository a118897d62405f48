#include "render/output/video_file.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <ctime>
#include <deque>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "render/output/video_kept.h"
#include "render/output/video_plain.h"
#include "render/output/video_stream.h"

namespace shatterbox::render {
namespace {

double thread_cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

}  // namespace

// Frames go in under the mutex; the thread takes them out, encodes them without it, and leaves its first
// failure.
struct VideoFile::Encoder {
  std::filesystem::path path, part;
  VideoSettings settings;
  VideoStream stream;
  std::thread thread;
  mutable std::mutex mutex;
  std::condition_variable room, work;
  std::deque<Image> waiting;
  bool is_ending = false, is_closed = false;
  Status status;
  long frames = 0;
  std::size_t most_waiting = 0;  // pictures
  std::atomic<double> cpu_ms{0};

  // What is kept is copied first, beside the part that it comes from: a run that is killed meanwhile loses
  // nothing.
  Status open(const VideoFormat& format) {
    if (settings.keep == 0) return stream.open(part, format, settings);
    const std::filesystem::path next = path.string() + ".next";
    std::error_code problem;
    Status opened = stream.open(next, format, settings);
    if (opened) opened = stream.keep(std::filesystem::exists(part) ? part : path, settings.keep);
    if (!opened) return opened;
    std::filesystem::rename(next, part, problem);
    return problem ? Status{problem.message()} : Status{};
  }

  Status with_name(Status s) const { return s.ok() ? s : Status{path.string() + ": " + s.error}; }

  void run() {
    for (;;) {
      Image image;
      {
        std::unique_lock lock(mutex);
        work.wait(lock, [this] { return is_ending || !waiting.empty(); });
        if (waiting.empty()) break;
        image = std::move(waiting.front());
        waiting.pop_front();
      }
      room.notify_one();
      Status result = stream.encode(image);
      cpu_ms = thread_cpu_ms();
      if (!result) {
        fail(std::move(result));
        return;
      }
    }
    Status result = stream.finish();
    cpu_ms = thread_cpu_ms();
    if (!result) fail(std::move(result));
  }

  void fail(Status result) {
    {
      const std::lock_guard lock(mutex);
      status = with_name(std::move(result));
      waiting.clear();
    }
    room.notify_all();
  }
};

Status can_write_video(const std::filesystem::path& path) {
  const VideoFormat* format = find_format(path);
  if (format == nullptr) {
    return {path.string() + ": the name of a video must end in .mp4, .mkv, .webm or .gif"};
  }
  if (avcodec_find_encoder_by_name(format->encoder) == nullptr) {
    return {path.string() + ": this libavcodec has no encoder " + format->encoder};
  }
  return {};
}

long count_kept_frames(const std::filesystem::path& path, long most) {
  const std::filesystem::path part = path.string() + ".part";
  return count_whole_groups(std::filesystem::exists(part) ? part : path, most);
}

VideoFile::VideoFile(std::filesystem::path path, const VideoSettings& settings)
    : encoder_(std::make_unique<Encoder>()) {
  Encoder& e = *encoder_;
  e.path = std::move(path);
  e.part = e.path.string() + ".part";
  e.settings = settings;
  e.status = can_write_video(e.path);
  if (!e.status) return;
  av_log_set_level(AV_LOG_ERROR);
  const VideoFormat& format = *find_format(e.path);
  e.status = check_settings(settings, format);
  if (e.status) e.status = e.open(format);
  e.status = e.with_name(std::move(e.status));
  if (e.status) e.thread = std::thread([&e] { e.run(); });
}

VideoFile::~VideoFile() {
  static_cast<void>(close());
}

Status VideoFile::add(Image image) {
  Encoder& e = *encoder_;
  std::unique_lock lock(e.mutex);
  if (e.is_closed) return {e.path.string() + ": is closed already"};
  if (image.width != e.settings.width || image.height != e.settings.height ||
      (image.channels != 3 && image.channels != 4)) {
    return {e.path.string() + ": a frame of another size than the video"};
  }
  const auto limit = static_cast<std::size_t>(std::max(e.settings.queue, 1));
  e.room.wait(lock, [&] { return !e.status.ok() || e.waiting.size() < limit; });
  if (!e.status) return e.status;
  e.waiting.push_back(std::move(image));
  ++e.frames;
  e.most_waiting = std::max(e.most_waiting, e.waiting.size());
  lock.unlock();
  e.work.notify_one();
  return {};
}

Status VideoFile::close() {
  Encoder& e = *encoder_;
  {
    const std::lock_guard lock(e.mutex);
    if (e.is_closed) return e.status;
    e.is_closed = e.is_ending = true;
  }
  e.work.notify_one();
  if (e.thread.joinable()) e.thread.join();
  const std::lock_guard lock(e.mutex);
  if (!e.status) return e.status;
  std::error_code problem;
  if (std::string(find_format(e.path)->muxer) == "mp4") {  // fragments play too: keep them if this fails
    const std::filesystem::path plain = e.path.string() + ".plain";
    if (write_plain_mp4(e.part, plain)) std::filesystem::rename(plain, e.part, problem);
  }
  std::filesystem::rename(e.part, e.path, problem);
  if (problem) e.status = {e.path.string() + ": " + problem.message()};
  return e.status;
}

Status VideoFile::status() const {
  const std::lock_guard lock(encoder_->mutex);
  return encoder_->status;
}

long VideoFile::frames() const {
  const std::lock_guard lock(encoder_->mutex);
  return encoder_->frames;
}

double VideoFile::encode_cpu_ms() const {
  return encoder_->cpu_ms;
}

double VideoFile::waiting_bytes() const {
  const std::lock_guard lock(encoder_->mutex);
  return 3.0 * static_cast<double>(encoder_->most_waiting) * encoder_->settings.width *
         encoder_->settings.height;
}

}  // namespace shatterbox::render
