#include "sandbox/script/film_clock.h"

#include <algorithm>

namespace shatterbox::sandbox::script {

void FilmClock::change(double film_now, double factor, double ramp) {
  const double simulated = simulated_at(film_now), from = factor_at(film_now);
  film_ = film_now;
  simulated_ = simulated;
  from_ = ramp > 0.0 ? from : factor;
  to_ = factor;
  ramp_ = ramp;
}

double FilmClock::factor_at(double film) const {
  if (!(ramp_ > 0.0)) return to_;
  const double x = std::clamp((film - film_) / ramp_, 0.0, 1.0);
  return from_ + (to_ - from_) * x * x * (3.0 - 2.0 * x);
}

double FilmClock::simulated_at(double film) const {
  const double since = film - film_;
  if (!(ramp_ > 0.0)) return simulated_ + to_ * since;
  const double x = std::clamp(since / ramp_, 0.0, 1.0);
  // The integral of the factor: of 3x2 - 2x3 it is x3 - x4/2.
  const double in_ramp = ramp_ * (from_ * x + (to_ - from_) * x * x * x * (1.0 - 0.5 * x));
  return simulated_ + in_ramp + to_ * std::max(0.0, since - ramp_);
}

double FilmClock::film_at(double simulated) const {
  if (!(ramp_ > 0.0)) return film_ + (simulated - simulated_) / to_;
  double least = film_, most = film_ + (simulated - simulated_) / std::min(from_, to_);
  for (int halving = 0; halving < 100; ++halving) {
    const double middle = 0.5 * (least + most);
    if (!(least < middle && middle < most)) break;
    (simulated_at(middle) < simulated ? least : most) = middle;
  }
  return most;
}

}  // namespace shatterbox::sandbox::script
