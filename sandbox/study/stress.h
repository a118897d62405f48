// Study "stress": closed forms against element size, solver tolerance, averaging, null space and Poisson's
// ratio.
#pragma once

#include "sandbox/study/study.h"

namespace shatterbox::sandbox::study {

Study stress_study();

}  // namespace shatterbox::sandbox::study
