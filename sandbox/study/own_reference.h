// Any scene against itself at a finer step: trajectories until something breaks, pieces after it.
#pragma once

#include "sandbox/scene/scene_description.h"
#include "sandbox/study/study.h"

namespace shatterbox::sandbox::study {

/// The study of one scene: half, once, twice and four times its steps a second (quick: half and once), beside
/// eight times as many (quick: twice).
Study scene_study(const scene::SceneDescription& description);

}  // namespace shatterbox::sandbox::study
