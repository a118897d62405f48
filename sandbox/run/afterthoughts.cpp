#include <algorithm>
#include <map>
#include <set>
#include <span>

#include <fmt/format.h>

#include "engine/core/elementary.h"
#include "engine/world/forms.h"
#include "sandbox/run/doubts.h"

namespace shatterbox::sandbox::run {

namespace {

using body::Body;

/// m, root of the area of a half-disc at a surface that an even stress (Pa) drives on.
double crack_length(const material::Material& material, double stress) {
  return 2.0 / core::kPi * material.young * material.fracture_energy / (stress * stress);
}

void doubt_coarse_solids(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                         scene::Problems& doubts) {
  std::map<int, const world::ImpactRow*> held;  // by entry
  const world::WorldReport& report = built.world.report();
  std::set<int> cracked;  // the same
  for (const world::ImpactRow& row : report.impacts) {
    const auto origin = built.origins.find(row.id);  // none: a piece
    if (origin == built.origins.end()) continue;
    if (row.verdict.starts_with("cracked")) cracked.insert(origin->second.entry);
    if (row.ratio < 1.0 || row.verdict.find("no crack could start") == std::string::npos) continue;
    const world::ImpactRow*& hardest = held[origin->second.entry];
    if (hardest == nullptr || row.ratio > hardest->ratio) hardest = &row;
  }
  for (const world::BreakRow& row : report.breaks)
    if (const auto origin = built.origins.find(row.id); origin != built.origins.end())
      held.erase(origin->second.entry);
  for (const auto& [entry, row] : held) {
    if (cracked.count(entry) > 0) continue;
    const auto number = static_cast<std::size_t>(entry);
    const auto* solid = std::get_if<world::SolidDescription>(&built.plan.bodies[number].description.form);
    if (solid == nullptr) continue;
    const double size = world::element_size_of(*solid);
    const scene::BodyEntry& body = scene.bodies[number];
    const material::Material& material = scene.materials[static_cast<std::size_t>(body.material)].material;
    const double length = crack_length(material, row->stress);
    if (length > size) {
      scene::book(
          doubts, body.place,
          fmt::format(
              "\"{}\" held, stressed to {:.2g} of its strength: {} is so tough that a crack needs {:.2g} m "
              "of such stress to start",
              row->body, row->ratio, material.name, length),
          "it takes more load, or a material of less fracture_energy");
      continue;
    }
    scene::book(
        doubts, body.place,
        fmt::format("\"{}\" held, stressed to {:.2g} of its strength: in elements of {:.2g} m no crack "
                    "could start",
                    row->body, row->ratio, size),
        fmt::format("--set {}.element_size={:.2g} looks closer, and takes longer", body.name, 0.5 * size));
  }
}

/// Nothing stands, and nobody met anybody on the way down.
void doubt_bottomless(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                      scene::Problems& doubts) {
  constexpr double kFast = 3.0;  // m/s: after half a metre
  const std::span<const Body> bodies = built.world.bodies();
  if (built.world.report().contact.most_contacts > 0 || scene.world.gravity.isZero(0.0) || bodies.empty() ||
      !std::all_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.is_dynamic(); }))
    return;
  const Body& first = bodies.front();
  const double speed = first.velocity.dot(scene.world.gravity.normalized());
  const auto origin = built.origins.find(first.id);
  if (speed < kFast || origin == built.origins.end()) return;
  scene::book(
      doubts, scene.bodies[static_cast<std::size_t>(origin->second.entry)].place,
      fmt::format("nothing met anything: \"{}\" falls at {:.2g} m/s at the end, and there is no floor",
                  first.name, speed),
      "[[body]] with kind = \"plane\" is one; where nothing is to fall, [scene] has gravity = [0, 0, 0]");
}

}  // namespace

scene::Problems find_afterthoughts(const scene::SceneDescription& scene, const scene::BuiltScene& built) {
  scene::Problems doubts;
  doubt_coarse_solids(scene, built, doubts);
  doubt_bottomless(scene, built, doubts);
  return doubts;
}

}  // namespace shatterbox::sandbox::run
