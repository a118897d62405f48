#include "sandbox/run/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

namespace shatterbox::sandbox::run {
namespace {

constexpr std::chrono::milliseconds kBarPause(100);  // between two times that a bar is drawn

}  // namespace

bool stderr_is_terminal() {
  return isatty(STDERR_FILENO) == 1;
}

double remaining_seconds(const std::deque<std::pair<double, int>>& history, int total) {
  if (history.size() < 2) return -1.0;
  const auto [now, done] = history.back();
  if (now < 0.5 || done * 20 < total) return -1.0;
  std::pair<double, int> since{0.0, 0};
  for (const auto& entry : history) {
    if (entry.second > done - std::max(1, done / 4)) break;
    since = entry;
  }
  if (done <= since.second) return -1.0;
  return (total - done) * (now - since.first) / (done - since.second);
}

int reached(std::span<const int> shown, int finished) {
  const std::size_t both = std::min(shown.size(), static_cast<std::size_t>(std::max(finished, 0)));
  return both > 0 ? shown[both - 1] : 0;
}

Progress::Progress(int total, bool is_bar, std::chrono::milliseconds patience)
    : total_(total),
      is_bar_(is_bar),
      patience_(patience),
      start_(std::chrono::steady_clock::now()),
      last_shown_(is_bar ? start_ - kBarPause : start_),
      last_news_(start_),
      watch_([this](const std::stop_token& stops) { wait_for_news(stops); }) {}

Progress::Progress(int total, bool is_bar)
    : Progress(total, is_bar, is_bar ? std::chrono::seconds(2) : std::chrono::seconds(30)) {}

Progress::~Progress() {
  clear();
}

void Progress::wait_for_news(const std::stop_token& stops) {
  std::unique_lock lock(mutex_);
  const auto pause = [&] { return is_bar_ && is_news_ ? kBarPause : patience_; };
  while (!stops.stop_requested() && !is_over_) {
    const bool was_news = is_news_;
    if (wakes_.wait_until(lock, stops, last_shown_ + pause(), [&] { return is_news_ != was_news; })) continue;
    const auto now = std::chrono::steady_clock::now();
    if (stops.stop_requested() || is_over_) return;
    if (now - last_shown_ < pause()) continue;
    if (is_bar_ && is_news_) {
      say(now, "", note_);
      continue;
    }
    const double waited = std::chrono::duration<double>(now - last_news_).count();
    say(now, "", fmt::format("{}{}nothing new for {:.0f} s", note_, note_.empty() ? "" : ", ", waited));
  }
}

void Progress::show(int done, const std::string& note) {
  if (total_ <= 0) return;
  done = std::clamp(done, 0, total_);
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - start_).count();
  if (history_.empty() || history_.back().second < done) history_.emplace_back(seconds, done);
  last_news_ = now;
  done_ = done;
  note_ = note;
  const bool is_last = is_bar_ && done >= total_;
  is_news_ = true;
  if (!is_last && now - last_shown_ < (is_bar_ ? kBarPause : patience_)) {
    wakes_.notify_all();
    return;
  }
  const double remaining = remaining_seconds(history_, total_);
  say(now, remaining < 0.0 ? "" : fmt::format("  {:.0f} s left", remaining), note);
}

void Progress::say(Time now, const std::string& left, const std::string& note) {
  last_shown_ = now;
  is_news_ = false;
  if (total_ <= 0 || is_over_) return;
  const int percent = 100 * done_ / total_;
  if (is_bar_) {
    constexpr int kWidth = 30;
    const int filled = kWidth * done_ / total_;
    fmt::print(stderr, "\r\x1b[K[{}{}] {:3} %{}  {}", std::string(static_cast<std::size_t>(filled), '#'),
               std::string(static_cast<std::size_t>(kWidth - filled), '.'), percent, left, note);
  } else {
    const double seconds = std::chrono::duration<double>(now - start_).count();
    fmt::print(stderr, "{:3} % after {:.0f} s{}  {}\n", percent, seconds, left, note);
  }
  std::fflush(stderr);
}

void Progress::clear() {
  const std::lock_guard lock(mutex_);
  if (is_bar_ && !is_over_) fmt::print(stderr, "\r\x1b[K");
  is_over_ = true;
}

}  // namespace shatterbox::sandbox::run
