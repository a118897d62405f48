#include "engine/fracture/impact.h"

#include <Eigen/Eigenvalues>

namespace shatterbox::fracture {

double rigid_mobility(const geometry::MassProperties& mass, const ImpactLoad& load) {
  const Vec3 arm = (load.point_material - mass.centre).cross(load.direction);
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(mass.inertia);
  double turning = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double moment = axes.eigenvalues()[i];
    const double a = axes.eigenvectors().col(i).dot(arm);
    if (moment > 1e-12 * mass.mass * axes.eigenvalues()[2]) turning += a * a / moment;
  }
  return 1.0 / mass.mass + turning;
}

}  // namespace shatterbox::fracture
