// Study "motion": bodies whose motion is known in closed form, against the step.
#pragma once

#include "sandbox/study/study.h"

namespace shatterbox::sandbox::study {

Study motion_study();

}  // namespace shatterbox::sandbox::study
