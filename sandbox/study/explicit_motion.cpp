#include "sandbox/study/explicit_motion.h"

#include "engine/core/elementary.h"

namespace shatterbox::sandbox::study::model {

using namespace stress;

VecX integrate_motion(const Beam& beam, const SolidSystem& system, const VecX& impulse, double damping,
                      double screening, double seconds, double step) {
  const VecX mass = lumped_mass(*beam.stiffness, beam.mesh);
  VecX u = VecX::Zero(mass.size()), v = impulse.cwiseQuotient(mass), integral = u;
  const double decay = core::exp(-screening * step);
  double weight = 1.0;
  const int steps = static_cast<int>(seconds / step);
  for (int i = 0; i < steps; ++i) {
    integral += 0.5 * step * weight * u;
    u += step * v;
    weight *= decay;
    integral += 0.5 * step * weight * u;
    VecX force = -apply_stiffness(*beam.stiffness, beam.mesh, u);
    if (damping > 0.0) force -= damping * system.balance(mass.cwiseProduct(v));
    v += step * force.cwiseQuotient(mass);
  }
  return integral;
}

}  // namespace shatterbox::sandbox::study::model
