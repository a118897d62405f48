#include "sandbox/run/interrupt.h"

#include <csignal>

namespace shatterbox::sandbox::run {

namespace {

volatile std::sig_atomic_t g_interrupted = 0;  // the only thing a signal handler may touch

extern "C" void on_interrupt(int signal) {
  if (g_interrupted != 0) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  g_interrupted = 1;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;  // writing the video goes on undisturbed
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
}

bool is_interrupted() {
  return g_interrupted != 0;
}

}  // namespace shatterbox::sandbox::run
