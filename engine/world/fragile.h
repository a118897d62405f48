// What the world knows of a body that can break, beside its shape: all that the verdict and the cut need.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "engine/body/body.h"
#include "engine/fracture/decide_shell.h"
#include "engine/fracture/decide_solid.h"

namespace shatterbox::world {

/// Immutable once made; pieces get their own.
struct Fragile {
  std::variant<fracture::ShellSubject, fracture::SolidSubject> subject;
  double size = 0.0;                       // m, twice the bounding radius of the unbroken body
  double density = 0.0;                    // kg/m3
  std::optional<double> contact_duration;  // s
  /// Number of the look; empty for all 0. Of a shell per element, of a solid per triangle of its given
  /// surface.
  std::vector<std::uint8_t> parts;

  const material::Material& material() const {
    return std::visit([](const auto& s) -> const material::Material& { return s.material; }, subject);
  }
};

/// By body, in the order of their birth.
using Fragiles = std::map<body::BodyId, std::shared_ptr<const Fragile>>;

/// Shares of the unbroken body's size: how far a piece's surface stands back from its crack faces, and the
/// width below which a piece joins its neighbour because contact could not resolve it.
inline constexpr double kKerf = 1e-4;
inline constexpr double kLeastWidth = 1e-3;

}  // namespace shatterbox::world
