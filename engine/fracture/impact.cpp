#include "engine/fracture/impact.h"

#include <Eigen/Eigenvalues>

namespace shatterbox::fracture {

LoadBound::LoadBound(const Impact& impact) : borne_ratio_(impact.resting_ratio.value_or(0.0)) {
  for (const ImpactLoad& load : impact.loads) {
    if (is_collision(load)) {
      root_energy_ += core::sqrt(collision_energy(load));
      hit_force_ += load.hertz_compliance > 0.0 ? collision_force(load, load.hertz_compliance) : kBoundless;
    } else if (!load.is_resting || !impact.resting_ratio) {
      contact_force_ += load.impulse / impact.contact_average;
    }
  }
}

double LoadBound::stress_at(double strength, double per_newton, double per_root_joule) const {
  const double hits = std::min(per_newton * hit_force_, per_root_joule * root_energy_);
  return borne_ratio_ * strength + per_newton * contact_force_ + hits;
}

Vec3 arm_of(const geometry::MassProperties& mass, const ImpactLoad& load) {
  return (load.point_material - mass.centre).cross(load.direction);
}

double rigid_mobility(const geometry::MassProperties& mass, const Vec3& impulse, const Vec3& moment_about) {
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(mass.inertia);
  double turning = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double moment = axes.eigenvalues()[i];
    const double a = axes.eigenvectors().col(i).dot(moment_about);
    if (moment > 1e-12 * mass.mass * axes.eigenvalues()[2]) turning += a * a / moment;
  }
  return impulse.squaredNorm() / mass.mass + turning;
}

double rigid_mobility(const geometry::MassProperties& mass, const ImpactLoad& load) {
  return rigid_mobility(mass, load.direction, arm_of(mass, load));
}

}  // namespace shatterbox::fracture
