// How a body is held, by the deflections of plates and beams under a force, which an impact's duration shows:
// T = pi sqrt(m C).
#include "engine/fracture/shell_subject.h"

#include <catch2/catch.hpp>
#include <functional>

#include "engine/core/elementary.h"
#include "tests/engine/fracture/window.h"

using namespace shatterbox;

namespace {

/// A glass pane of `width` x `height` that is held where `is_held` says; so light that nothing of it swings.
fracture::ShellSubject hold_pane(double width, double height, double edge,
                                 const std::function<bool(const Vec3&)>& is_held) {
  const auto elements = test::make_elements(geometry::make_pane(width, height, {edge, 0.3, 1}).value());
  fracture::ShellSubject subject;
  subject.mesh = std::make_shared<const geometry::ShellMesh>(geometry::make_shell_mesh(elements));
  subject.thickness = 4e-3;
  subject.material.density = 1.0;
  subject.material.strength = 1e9;
  for (std::size_t v = 0; v < elements->mesh.positions.size(); ++v)
    if (is_held(elements->mesh.positions[v])) subject.clamped_vertices.push_back(static_cast<int>(v));
  fracture::prepare_subject(subject);
  return subject;
}

/// m/N, felt by a ball at `place`, from the duration of its impact.
double find_compliance(const fracture::ShellSubject& subject, const Vec3& place) {
  fracture::ShellImpact impact = test::steel_ball(30.0, place);
  impact.loads.front().hertz_compliance = 0.0;
  fracture::FractureSettings settings;
  settings.patch_radius = 0.02;
  const auto decision = fracture::decide_shell(subject, impact, settings);
  REQUIRE(decision.generations > 0);
  const double share = decision.verdict.duration / core::kPi;
  return share * share / impact.loads.front().effective_mass;
}

constexpr double kStiffness = 70e9 * 64e-9 / (12.0 * (1.0 - 0.22 * 0.22));  // of the plate, N m

}  // namespace

TEST_CASE("a border that is held turns freely: a pane in its frame gives way as a simply supported plate") {
  const auto pane =
      hold_pane(1.0, 1.0, 0.034, [](const Vec3& p) { return p.cwiseAbs().maxCoeff() > 0.5 - 1e-9; });
  // Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells, sec. 34: 0.0116 F a^2 / D
  // (a clamped one, sec. 44: 0.0056).
  CHECK(find_compliance(pane, Vec3::Zero()) == Approx(0.0116 / kStiffness).epsilon(0.03));
}

TEST_CASE("where whole elements are held the rest is clamped") {
  const auto pane = hold_pane(1.2, 1.2, 0.034, [](const Vec3& p) { return p.cwiseAbs().maxCoeff() > 0.5; });
  const double compliance = find_compliance(pane, Vec3::Zero());
  CHECK(compliance > 0.0056 / kStiffness);  // the free part is up to an element wider than 1 m
  CHECK(compliance < 0.0056 * 1.068 * 1.068 / kStiffness);
}

TEST_CASE("a strip that is held by nothing but one straight side stands out as a cantilever") {
  const auto strip = hold_pane(0.6, 0.06, 0.01, [](const Vec3& p) { return p.x() < -0.3 + 1e-9; });
  // L^3 / (3 E I), at 0.5 m; the load's patch and the clamped width make it a little stiffer or softer.
  const double inertia = 0.06 * 64e-9 / 12.0;
  CHECK(find_compliance(strip, Vec3(0.2, 0.0, 0.0)) == Approx(0.125 / (3.0 * 70e9 * inertia)).epsilon(0.03));
}
