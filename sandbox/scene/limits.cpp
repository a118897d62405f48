#include "sandbox/scene/limits.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/stress/solid_stiffness.h"

namespace shatterbox::sandbox::scene {

std::vector<std::string> find_limits(const world::WorldSettings& settings,
                                     std::span<const body::Body> bodies) {
  const body::Body *smallest = nullptr, *lightest = nullptr, *heaviest = nullptr;
  for (const body::Body& body : bodies) {
    if (!body.is_dynamic()) continue;
    if (!smallest || body.shape->bounding_radius < smallest->shape->bounding_radius) smallest = &body;
    if (!lightest || body.shape->mass < lightest->shape->mass) lightest = &body;
    if (!heaviest || body.shape->mass > heaviest->shape->mass) heaviest = &body;
  }
  std::vector<std::string> sentences;
  const auto is_rubber = [](const body::Body& body) {
    return body.shape->kind == body::ShapeKind::solid && body.poisson > stress::kMostPoissonRatio;
  };
  if (const auto rubber = std::find_if(bodies.begin(), bodies.end(), is_rubber); rubber != bodies.end())
    sentences.push_back(fmt::format(
        "\"{}\" has Poisson's ratio {:g}: its stress is solved with {:g}, for tetrahedra lock above",
        rubber->name, rubber->poisson, stress::kMostPoissonRatio));
  if (!smallest) return sentences;
  const auto elastic = std::count_if(bodies.begin(), bodies.end(), [](const body::Body& body) {
    return body.is_dynamic() && body::is_mesh(body.shape->kind) && body.restitution >= kElastic;
  });
  if (elastic > 2 && settings.steps_per_second < kElasticRate)
    sentences.push_back(
        fmt::format("{} shells and solids bounce with a restitution of {:g} or more: where several meet in "
                    "one step energy is "
                    "lost; at {} steps a second and more it is little",
                    elastic, kElastic, kElasticRate));
  const double size = 2.0 * smallest->shape->bounding_radius, rate = settings.steps_per_second;
  const double fall = 0.5 * settings.gravity.norm() / (rate * rate);
  if (fall > kMostFall * size)
    sentences.push_back(fmt::format(
        "\"{}\", {:.2g} m in size, falls by {:.2g} m in a step: where it rests it creeps and sinks; at least "
        "{:.0f} steps a second are needed",
        smallest->name, size, fall, std::ceil(rate * std::sqrt(fall / (kMostFall * size)))));
  const double ratio = heaviest->shape->mass / lightest->shape->mass;
  if (ratio > kMostMassRatio)
    sentences.push_back(fmt::format(
        "\"{}\" has {:.1g} times the mass of \"{}\": it may fly into it, but one that rests on the other is "
        "borne up to {:.0g} times",
        heaviest->name, ratio, lightest->name, kMostMassRatio));
  return sentences;
}

}  // namespace shatterbox::sandbox::scene
