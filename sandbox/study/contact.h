// Study "contact": stacks, heaps, an elastic gas, an arch, and shells under either contact scheme.
#pragma once

#include "sandbox/study/study.h"

namespace shatterbox::sandbox::study {

Study contact_study();

}  // namespace shatterbox::sandbox::study
