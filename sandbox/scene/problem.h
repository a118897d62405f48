// What is wrong with an input, where, and how to mend it: the common coin of everything that reads scenes.
#pragma once

#include <string>
#include <vector>

namespace shatterbox::sandbox::scene {

/// A place in a text: lines and columns count from 1; line 0 means the whole file.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
};

struct Problem {
  Place place;
  std::string message;
  std::string hint;  // how to mend it; may be empty
};

using Problems = std::vector<Problem>;

/// Adds one.
void book(Problems& problems, Place place, std::string message, std::string hint = "");

/// "file:line:column", or the file alone.
std::string describe(const Place& place);

/// "file:line:column: message" and, on a line of its own, the hint.
std::string describe(const Problem& problem);

/// All problems, ordered by place, a line break between them; equal ones once.
std::string describe(Problems problems);

}  // namespace shatterbox::sandbox::scene
