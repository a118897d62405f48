#include "engine/core/stop.h"

namespace shatterbox::core {

namespace {

thread_local const StopQuestion* present_question = nullptr;

}  // namespace

StopScope::StopScope(const StopQuestion* question) : outer_(present_question) {
  present_question = question != nullptr && *question ? question : nullptr;
}

StopScope::~StopScope() {
  present_question = outer_;
}

const StopQuestion* StopScope::current() {
  return present_question;
}

void stop_if_asked() {
  if (present_question != nullptr && (*present_question)()) throw Stopped();
}

}  // namespace shatterbox::core
