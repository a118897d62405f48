// Where a scene goes beyond what the engine bears: told at load, before anybody trusts the film.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/body/body.h"
#include "engine/world/settings.h"

namespace shatterbox::sandbox::scene {

/// A body that falls by more than this share of its size in one step creeps and sinks where it rests.
inline constexpr double kMostFall = 0.02;
/// What rests on a body that it outweighs more often than this is not borne.
inline constexpr double kMostMassRatio = 1e4;
/// Bounces of surfaces as elastic as this keep their energy only at so many steps a second: hits of one step
/// are taken together where something may break.
inline constexpr double kElastic = 0.9;
inline constexpr int kElasticRate = 120;

/// Sentences about gravity too strong for the step, and about masses too far apart, of the bodies that can
/// move, bounces too elastic for the step, and solids that resist a change of volume more than their stress
/// is told by.
std::vector<std::string> find_limits(const world::WorldSettings& settings,
                                     std::span<const body::Body> bodies);

}  // namespace shatterbox::sandbox::scene
