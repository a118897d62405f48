// Study "refine": what breaks must not depend on the mesh: means over flaw seeds while elements get smaller.
#pragma once

#include "sandbox/study/study.h"

namespace shatterbox::sandbox::study {

Study refine_study();

}  // namespace shatterbox::sandbox::study
