#include <fmt/format.h>

#include "sandbox/scene/read_event.h"

namespace shatterbox::sandbox::scene {

namespace {

const Range kFilmTime = between(0.0, 1e4, "s");

}  // namespace

Speed read_speed(TableReader& reader) {
  Speed speed;
  if (const auto factor = reader.number("factor", between(1e-4, 100.0))) {
    speed.factor = *factor;
  } else if (!reader.has("factor")) {
    reader.add_problem(reader.table().place, fmt::format("{} has no \"factor\"", reader.what()),
                       "add factor = 0.1: a tenth of the true speed");
  }
  speed.ramp = reader.number("ramp", kFilmTime).value_or(speed.ramp);
  return speed;
}

}  // namespace shatterbox::sandbox::scene
