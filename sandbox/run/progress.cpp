#include "sandbox/run/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

namespace shatterbox::sandbox::run {

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

Progress::Progress(int total, bool is_bar)
    : total_(total), is_bar_(is_bar), start_(std::chrono::steady_clock::now()), last_shown_(start_) {}

Progress::~Progress() {
  clear();
}

void Progress::show(int done, const std::string& note) {
  if (total_ <= 0) return;
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - start_).count();
  if (history_.empty() || history_.back().second < done) history_.emplace_back(seconds, done);
  const bool is_last = is_bar_ && done >= total_;
  if (!is_last && now - last_shown_ < (is_bar_ ? std::chrono::milliseconds(100) : std::chrono::seconds(30)))
    return;
  last_shown_ = now;
  const double remaining = remaining_seconds(history_, total_);
  const std::string left = remaining < 0.0 ? "" : fmt::format("  {:.0f} s left", remaining);
  if (is_bar_) {
    constexpr int kWidth = 30;
    const int filled = kWidth * std::min(done, total_) / total_;
    fmt::print(stderr, "\r\x1b[K[{}{}] {:3} %{}  {}", std::string(static_cast<std::size_t>(filled), '#'),
               std::string(static_cast<std::size_t>(kWidth - filled), '.'), 100 * done / total_, left, note);
  } else {
    fmt::print(stderr, "{:3} % after {:.0f} s{}  {}\n", 100 * done / total_, seconds, left, note);
  }
  std::fflush(stderr);
}

void Progress::clear() {
  if (is_bar_) fmt::print(stderr, "\r\x1b[K");
  is_bar_ = false;
}

}  // namespace shatterbox::sandbox::run
