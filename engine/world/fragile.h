// What the world knows of a body that can break, beside its shape: all that the verdict and the cut need.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "engine/body/body.h"
#include "engine/fracture/decide_shell.h"

namespace shatterbox::world {

/// Immutable once made; pieces get their own.
struct Fragile {
  fracture::ShellSubject subject;
  double size = 0.0;                        // m, twice the bounding radius of the unbroken body
  double density = 0.0;                     // kg/m3
  std::optional<double> contact_duration;   // s
  std::vector<std::uint8_t> element_parts;  // per element: number of the look; empty for all 0
};

/// By body, in the order of their birth.
using Fragiles = std::map<body::BodyId, std::shared_ptr<const Fragile>>;

/// Shares of the unbroken body's size: how far a piece's surface stands back from its crack faces, and the
/// width below which a piece joins its neighbour because contact could not resolve it.
inline constexpr double kKerf = 1e-4;
inline constexpr double kLeastWidth = 1e-3;

/// The kept factors of a subject's mesh, for `stiffness`; the support is that of its clamped vertices, with
/// no turning about an edge between two of them.
std::shared_ptr<stress::ShellSystemCache> make_systems(
    const fracture::ShellSubject& subject, std::shared_ptr<const stress::ShellStiffness> stiffness);

/// The shape of a shell: the true cut gives mass, centre and inertia, the surface stands back from crack
/// faces.
std::shared_ptr<const body::Shape> make_shell_shape(std::shared_ptr<const geometry::ShellMesh> mesh,
                                                    const Fragile& fragile, double thickness);

}  // namespace shatterbox::world
