#include "engine/geometry/generator_faults.h"

#include <cmath>
#include <sstream>

namespace shatterbox::geometry {

std::string metres(double value) {
  std::ostringstream text;
  text << value << " m";
  return text.str();
}

std::optional<std::string> find_size_fault(const std::string& what, double value, double least,
                                           const std::string& what_is_least) {
  if (std::isfinite(value) && value > least && value < 1e9) return std::nullopt;
  const std::string told = what_is_least.empty() ? "" : what_is_least + ", ";
  return what + " must be greater than " + told + metres(least) + " (it is " + metres(value) + ")";
}

core::Error too_fine(const Meshing& meshing) {
  return core::Error{"an edge length of " + metres(meshing.edge_length) + " would make more than " +
                     std::to_string(kMostTriangles) + " triangles; make it larger"};
}

std::optional<std::string> find_fault(const Meshing& meshing, double extent) {
  if (!std::isfinite(meshing.edge_length) || meshing.edge_length <= 0.0)
    return "the edge length must be greater than 0 (it is " + metres(meshing.edge_length) + ")";
  if (!(std::isfinite(meshing.jitter) && meshing.jitter >= 0.0 && meshing.jitter <= 0.5)) {
    std::ostringstream text;
    text << "jitter must be from 0 to 0.5 (it is " << meshing.jitter << ")";
    return text.str();
  }
  // Finer than this is too many triangles for any surface, and the counts would not fit an int.
  if (meshing.edge_length < 1e-5 * extent) return too_fine(meshing).message;
  return std::nullopt;
}

}  // namespace shatterbox::geometry
