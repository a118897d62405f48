#include "sandbox/scene/clean_solid.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "engine/core/elementary.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/remade_surface.h"
#include "engine/geometry/self_crossings.h"
#include "engine/world/forms.h"

namespace shatterbox::sandbox::scene {
namespace {

constexpr double kSpacing = 0.5;        // of an element
constexpr double kUsualElements = 1e4;  // in the box about a mesh whose elements are not told
constexpr double kFinest = 5e-3;        // of its size, is a spacing then
constexpr int kMostFinerSpacing = 3;    // times, where it cannot be made so

core::Result<std::string> remake_once(world::SolidDescription& solid, double spacing) {
  if (std::any_of(solid.parts.begin(), solid.parts.end(), [](int part) { return part != 0; }))
    return core::Error{"it has parts of different looks"};
  auto made = geometry::remake_surface(solid.mesh, spacing);
  if (!made) return core::Error{made.error()};
  solid.mesh = std::move(made.value().mesh);
  if (!solid.parts.empty()) solid.parts.assign(solid.mesh.triangles.size(), 0);
  return fmt::format(
      "what is inside was told by winding numbers, and the surface made anew: edges are rounded off by up to "
      "{:.2g} mm{}{}",
      1e3 * kSpacing * spacing,
      made.value().bridged_share > 0.0
          ? fmt::format(", {:.2g} % of it is over holes", 100.0 * made.value().bridged_share)
          : "",
      made.value().lost_share > 0.0
          ? fmt::format(", {:.2g} % of the mesh, too thin for it, is lost", 100.0 * made.value().lost_share)
          : "");
}

/// Parts that hardly reach into each other need it finer.
core::Result<std::string> remake(world::SolidDescription& solid, double spacing) {
  core::Result<std::string> done = remake_once(solid, spacing);
  for (int finer = 2; !done && finer <= kMostFinerSpacing; ++finer)
    if (auto again = remake_once(solid, spacing / finer)) done = std::move(again);
  return done;
}

}  // namespace

core::Result<std::string> close_holes(world::SolidDescription& solid) {
  if (solid.element_size > 0.0) return remake(solid, kSpacing * solid.element_size);
  const geometry::Box box = geometry::box_of(solid.mesh);
  const Vec3 extent = box.high - box.low;
  const double element = core::pow(12.0 * extent.prod() / kUsualElements, 1.0 / 3.0);
  return remake(solid, std::max(kSpacing * element, kFinest * extent.maxCoeff()));
}

core::Result<std::string> unite_crossings(world::SolidDescription& solid) {
  const geometry::SelfCrossings crossings = geometry::find_self_crossings(solid.mesh);
  if (crossings.count == 0) return core::Error{""};
  auto done = remake(solid, kSpacing * world::element_size_of(solid));
  const std::string fault = fmt::format("triangles pass through each other ({} {}, first {} and {})",
                                        crossings.count, crossings.count == 1 ? "pair" : "pairs",
                                        crossings.first_triangle + 1, crossings.second_triangle + 1);
  if (!done) return core::Error{fault + ", and " + done.error()};
  return fault + ": " + done.value();
}

}  // namespace shatterbox::sandbox::scene
