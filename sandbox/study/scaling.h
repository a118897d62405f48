// Study "scaling": cost against bodies, triangles, tetrahedra and threads, with fitted exponents.
#pragma once

#include "sandbox/study/study.h"

namespace shatterbox::sandbox::study {

Study scaling_study();

}  // namespace shatterbox::sandbox::study
