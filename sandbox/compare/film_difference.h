// Two films side by side, picture by picture.
#pragma once

#include <string>
#include <vector>

#include "render/output/compare.h"
#include "sandbox/compare/film.h"
#include "sandbox/compare/tolerance.h"

namespace shatterbox::sandbox::compare {

struct FrameDifference {
  std::string name;
  render::Difference difference;
  std::string excess;  // why the pictures are not the same; empty: they are
};

struct FilmDifference {
  std::vector<FrameDifference> frames;  // of the expected film, and what the other one has beyond them
  std::string worst;                    // the name of the frame whose picture was kept; empty: none differs
  render::Image worst_picture;          // difference_picture() of it
  std::string error;                    // what could not be read; the comparison is then worth nothing

  bool is_same() const;
  long differing() const;  // frames
  /// The first frame that differs; nullptr if none does.
  const FrameDifference* first() const;
};

/// Compares picture by picture: those of folders by name, others by place. The worst picture is the one with
/// the most pixels beyond the tolerance. With a `pictures_folder`, the picture of every frame that differs is
/// written there.
FilmDifference compare_films(Film& expected, Film& actual, const Tolerance& tolerance,
                             const std::string& pictures_folder = {});

}  // namespace shatterbox::sandbox::compare
