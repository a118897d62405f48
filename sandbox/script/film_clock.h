// The two times of a film: seconds that it shows on the screen, and seconds of the world. They are one and
// the same until the script slows the film down.
#pragma once

namespace shatterbox::sandbox::script {

class FilmClock {
 public:
  /// From `film_now` (s of the film) on the factor goes smoothly, within `ramp` seconds of the film, from
  /// what it is then to `factor`. Times before `film_now` cannot be asked for any more.
  void change(double film_now, double factor, double ramp);

  /// The world's time that is shown, s.
  double simulated_at(double film) const;
  /// When that time of the world is shown, s of the film.
  double film_at(double simulated) const;
  /// Seconds of the world in a second of the film.
  double factor_at(double film) const;

 private:
  double film_ = 0.0, simulated_ = 0.0;  // s, of the last change
  double from_ = 1.0, to_ = 1.0, ramp_ = 0.0;
};

}  // namespace shatterbox::sandbox::script
