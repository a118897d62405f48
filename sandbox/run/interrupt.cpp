#include "sandbox/run/interrupt.h"

#include <atomic>
#include <csignal>

namespace shatterbox::sandbox::run {

namespace {

std::atomic<bool> g_interrupted{false};  // without locks, so a signal handler may touch it
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void on_interrupt(int signal) {
  if (!g_interrupted.exchange(true)) return;
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
  return g_interrupted;
}

}  // namespace shatterbox::sandbox::run
