// A window pane in its frame and a steel ball that hits it.
#pragma once

#include "engine/fracture/decide_shell.h"
#include "tests/engine/fracture/shapes.h"

namespace shatterbox::test {

/// A glass pane of 1 m, 4 mm thick, held all round by its border; no grains.
inline fracture::ShellSubject make_window(std::uint64_t seed, double edge = 0.034) {
  const auto elements = make_pane(1.0, edge);
  fracture::ShellSubject subject;
  subject.mesh = std::make_shared<const geometry::ShellMesh>(geometry::make_shell_mesh(elements));
  subject.thickness = 4e-3;
  subject.seed = seed;
  for (std::size_t v = 0; v < elements->mesh.positions.size(); ++v)
    if (elements->mesh.positions[v].cwiseAbs().maxCoeff() > 0.5 - 1e-9)
      subject.clamped_vertices.push_back(static_cast<int>(v));
  fracture::prepare_subject(subject);
  return subject;
}

/// A ball of 1 kg that comes along -z.
inline fracture::ShellImpact steel_ball(double speed, const Vec3& place = Vec3(-0.05, 0.05, 0.0)) {
  fracture::ShellLoad load;
  load.point_material = place;
  load.direction = -Vec3::UnitZ();
  load.closing_speed = speed;
  load.effective_mass = 1.0;
  load.impulse = 1.3 * speed;
  load.other_inverse_mass = 1.0;
  load.hertz_compliance = 1e-8;
  load.hertz_radius = 5e-3;
  fracture::ShellImpact impact;
  impact.loads = {load};
  return impact;
}

}  // namespace shatterbox::test
