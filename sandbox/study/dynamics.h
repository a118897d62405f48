// Study "dynamics": the solves of stress beside the waves that they stand for, and what each costs.
#pragma once

#include "sandbox/study/study.h"

namespace shatterbox::sandbox::study {

Study dynamics_study();

}  // namespace shatterbox::sandbox::study
