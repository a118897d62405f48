#include "sandbox/run/screen.h"

namespace shatterbox::sandbox::run {

std::string Screen::add(recording::Panels panels, int number, bool is_painted) const {
  if (recording != nullptr)
    if (std::string fault = recording->add(panels); !fault.empty()) return fault;
  if (is_painted && !painter->add(std::move(panels), number)) return painter->error();
  return {};
}

}  // namespace shatterbox::sandbox::run
