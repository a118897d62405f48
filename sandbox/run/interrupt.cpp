#include "sandbox/run/interrupt.h"

#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>

namespace shatterbox::sandbox::run {

namespace {

constexpr std::int64_t kOnce = 500;  // ms: what sends one to a process and to its group sends one (timeout)

std::atomic<std::int64_t> g_first{0};  // ms; 0: none came. Without locks, so a signal handler may touch it
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

std::int64_t milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);  // a handler may
  return now.tv_sec * 1000 + now.tv_nsec / 1000000 + 1;
}

extern "C" void on_interrupt(int signal) {
  std::int64_t first = 0;
  const std::int64_t now = milliseconds();
  if (g_first.compare_exchange_strong(first, now) || now - first < kOnce) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void on_ends(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;  // writing the video goes on undisturbed
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

void heed_interrupts() {
  on_ends(SIG_DFL);
}

void catch_interrupts() {
  on_ends(on_interrupt);
  std::signal(SIGPIPE, SIG_IGN);
}

bool is_interrupted() {
  return g_first != 0;
}

}  // namespace shatterbox::sandbox::run
