// Study "step-size": the verdict on an impact, and on what rests, must not depend on the step ([BHTF07] Figs.
// 9, 10).
#pragma once

#include "sandbox/study/study.h"

namespace shatterbox::sandbox::study {

Study step_size_study();

}  // namespace shatterbox::sandbox::study
