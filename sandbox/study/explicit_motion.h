// A hit body's waves, step by step: what the solves of stress are the time integral of.
#pragma once

#include "sandbox/study/solid_models.h"

namespace shatterbox::sandbox::study::model {

/// A beam at rest that gets an impulse J (N s) at once, by central differences of `step` s: M a + C (v -
/// rigid) + K u = 0, C = `damping` (1/s) M. Returns the integral of exp(-`screening` t) u over `seconds`.
VecX integrate_motion(const Beam& beam, const stress::SolidSystem& system, const VecX& impulse,
                      double damping, double screening, double seconds, double step);

}  // namespace shatterbox::sandbox::study::model
