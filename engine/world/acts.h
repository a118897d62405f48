// What the script does to bodies within a step: explosions, and hands that hold. Taken again with the step if
// something breaks, so that pieces get their own share.
#pragma once

#include <vector>

#include "engine/body/impulse_log.h"
#include "engine/dynamics/blast.h"
#include "engine/dynamics/hand.h"

namespace shatterbox::world {

/// Gives every dynamic body what it takes of a blast, all of it at once; what is held takes it standing.
/// Logged as collisions of that duration, over their patches. Wakes bodies.
void apply_blast(std::vector<body::Body>& bodies, const dynamics::Blast& blast, body::ImpulseLog& log);

/// Gives bodies the pushes of their hands for `time_step` seconds, after which `time_left` seconds of the
/// step are left; logged as contact. Hands whose body is not there do nothing.
void apply_hands(std::vector<body::Body>& bodies, const std::vector<dynamics::Hand>& hands,
                 const Vec3& gravity, double time_step, double time_left, body::ImpulseLog& log);

/// Of the bodies `ids` the one whose surface is nearest to a point (m, world), by its vertices; null if none
/// is there.
const body::Body* find_nearest(const std::vector<body::BodyId>& ids, const std::vector<body::Body>& bodies,
                               const Vec3& point);

/// Hands that held a body that broke, as it was in `parent`, go on with the piece of `born` (ids) that is
/// nearest to their grip.
void regrip(std::vector<dynamics::Hand>& hands, const body::Body& parent,
            const std::vector<body::BodyId>& born, const std::vector<body::Body>& bodies);

}  // namespace shatterbox::world
