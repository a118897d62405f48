#include "engine/fracture/dent_shape.h"

#include <algorithm>
#include <vector>

#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/core/stop.h"
#include "engine/stress/solid_stress.h"
#include "engine/stress/solid_yield.h"

namespace shatterbox::fracture {
namespace {

using core::at;
using stress::SolidStress;

constexpr double kMendTolerance = 1e-3;  // of a round's solve: the next one mends what it leaves
constexpr double kMended = 0.01;         // of the greatest displacement: a round that moves less is the last
constexpr int kMostRounds = 12;
constexpr int kPolarSteps = 12;
constexpr double kInsideOut = 1e-3;  // of its volume: what is as flat has no rotation

/// How a displacement maps the directions of a cell (deformation gradient).
Mat3 gradient_of(const SolidModel& model, std::size_t cell, const VecX& displacement) {
  const geometry::SolidCell& part = model.mesh.cells[cell];
  const stress::SolidElement& element = model.stiffness->solids[at(part.element)];
  Mat3 gradient = Mat3::Zero();
  for (std::size_t i = 0; i < 4; ++i)
    gradient += displacement.segment<3>(3 * part.vertices[i]) * element.gradients[i].transpose();
  return Mat3::Identity() + gradient / model.stiffness->length;
}

/// The nearest rotation, by Newton's iteration [Hig86].
Mat3 rotation_of(const Mat3& gradient) {
  if (!(gradient.determinant() > kInsideOut)) return Mat3::Identity();
  Mat3 turn = gradient;
  for (int step = 0; step < kPolarSteps; ++step) turn = (0.5 * (turn + turn.inverse().transpose())).eval();
  return turn;
}

SolidStress as_strain(const Mat3& m) {
  SolidStress s;
  s << m(0, 0), m(1, 1), m(2, 2), 0.5 * (m(1, 2) + m(2, 1)), 0.5 * (m(2, 0) + m(0, 2)),
      0.5 * (m(0, 1) + m(1, 0));
  return s;
}

}  // namespace

VecX turn_dent_shape(const SolidModel& model, const VecX& displacement) {
  const std::size_t count = model.mesh.cells.size();
  std::vector<Mat3> stretches(count);
  for (std::size_t c = 0; c < count; ++c) {
    const Mat3 gradient = gradient_of(model, c, displacement);
    stretches[c] = 0.5 * (gradient + gradient.transpose());
  }
  stress::SolidSolveSettings settings;
  settings.tolerance = kMendTolerance;
  VecX shape = displacement;
  std::vector<SolidStress> missing(count);
  for (int round = 0; round < kMostRounds; ++round) {
    core::stop_if_asked();
    core::parallel_for(count, 1024, [&](std::size_t c) {
      const Mat3 gradient = gradient_of(model, c, shape);
      missing[c] = as_strain(rotation_of(gradient) * stretches[c] - gradient);
    });
    const stress::SolidSolution step =
        model.system->solve(stress::eigenstrain_load(*model.stiffness, model.mesh, missing), settings);
    if (!step.is_evaluated()) break;
    shape += step.displacement;
    if (step.displacement.cwiseAbs().maxCoeff() <= kMended * shape.cwiseAbs().maxCoeff()) break;
  }
  return shape;
}

}  // namespace shatterbox::fracture
