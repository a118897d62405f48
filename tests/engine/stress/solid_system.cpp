// Solves of solids: balance, the paper's null space, supports, screening, cuts, periods, threads.
#include "engine/stress/solid_system.h"

#include <ctime>
#include <iostream>
#include <limits>

#include "engine/core/parallel.h"
#include "sandbox/study/explicit_motion.h"
#include "tests/engine/stress/solid_meshes.h"

using namespace shatterbox;
using namespace shatterbox::stress;
using namespace shatterbox::stress::testing;

using core::at;
using std::size_t;

TEST_CASE("a solid's balanced load gives one stress, however its null space is removed") {
  const Beam beam(0.05);
  const auto free = make_solid_system(beam.stiffness, beam.mesh);
  const VecX load = beam.hit(0.4, Vec3(0.3, -0.2, -1.0));
  const VecX balanced = free->balance(load);
  Vec3 resultant = Vec3::Zero(), moment = Vec3::Zero();
  for (size_t v = 0; v < beam.mesh.vertex_source.size(); ++v) {
    const Vec3 force = balanced.segment<3>(static_cast<Eigen::Index>(3 * v));
    resultant += force;
    moment += beam.solids->mesh.positions[v].cross(force);
  }
  CHECK(resultant.norm() < 1e-13);
  CHECK(moment.norm() < 1e-13);
  const SolidSolution solution = free->solve(load, fine());
  const auto stress = beam.stress_of(solution);
  CHECK(solution.residual < 1e-11);

  // The paper's X1, X2, X3 at three random triples and at the first three vertices.
  core::Random random(5, 0);
  std::vector<std::array<int, 3>> triples{{-1, -1, -1}};
  const auto vertex = [&] { return static_cast<int>(random.index(beam.mesh.vertex_source.size())); };
  for (int i = 0; i < 3; ++i) {
    std::array<int, 3> triple{};
    for (int& v : triple) v = vertex();
    triples.push_back(triple);
  }
  double worst_false = 0.0;
  for (const auto& triple : triples) {
    SolidSystemOptions options;
    options.null_space = NullSpace::paper;
    if (triple[0] >= 0) options.anchors = {triple};
    const auto paper = make_solid_system(beam.stiffness, beam.mesh, options);
    const SolidSolution held = paper->solve(balanced, fine());
    REQUIRE(held.is_evaluated());
    CHECK(stress_difference(beam.mesh, beam.stress_of(held), stress) < 1e-9);
    // The load that is not in balance pulls at the three points: a false stress there.
    const SolidSolution wrong = paper->solve(load, fine());
    REQUIRE(wrong.is_evaluated());
    const double difference = stress_difference(beam.mesh, beam.stress_of(wrong), stress);
    CHECK(difference > 0.3);
    worst_false = std::max(worst_false, difference);
  }
  CHECK(worst_false > 2.0);

  // Clamped points: the same.
  SolidSystemOptions clamped;
  clamped.support.dofs = {0, 1, 2, 3 * 200, 3 * 200 + 1, 3 * 300 + 2};
  const auto pinned = make_solid_system(beam.stiffness, beam.mesh, clamped);
  if (pinned->rigid_mode_count() == 0)
    CHECK(stress_difference(beam.mesh, beam.stress_of(pinned->solve(balanced, fine())), stress) < 1e-9);
}

TEST_CASE(
    "a solid rod pulled at its ends is in tension, pushed in compression, pulled at one end N = F x / L") {
  const Beam beam(0.05, solid_properties(0.0));
  const auto system = make_solid_system(beam.stiffness, beam.mesh);
  for (const bool is_both : {true, false})
    for (const double sign : {1.0, -1.0}) {
      const double traction = sign * 100.0;
      const VecX load = traction_load(beam.mesh, [&](const Vec3& x, const Vec3& normal) -> Vec3 {
        if (std::abs(normal.x()) < 0.5 || (!is_both && x.x() < 0.0)) return Vec3::Zero();
        return traction * normal;
      });
      const SolidSolution solution = system->solve(load, fine(1e-9));
      const auto stresses = beam.stress_of(solution);
      for (size_t c = 0; c < stresses.size(); ++c) {
        const double x = cell_centroid(beam.mesh, beam.mesh.cells[c]).x();
        const double expected = is_both ? traction : traction * (x + 1.0) / 2.0;
        if (!is_both && std::abs(x) > 0.8) continue;  // the spread of the lumped inertia
        CHECK(stresses[c](0) == Approx(expected).epsilon(is_both ? 1e-7 : 0.03).margin(2.0));
        const PrincipalAxes axes = principal_axes(stresses[c]);
        if (sign < 0.0) CHECK(axes.values(0) < 3.0);
        if (sign > 0.0 && is_both) CHECK(std::abs(axes.directions(0, 0)) == Approx(1.0));
      }
    }
}

TEST_CASE("gravity and any other common acceleration leave a free solid without stress") {
  const Beam beam(0.1);
  const auto system = make_solid_system(beam.stiffness, beam.mesh);
  VecX weight = lumped_mass(*beam.stiffness, beam.mesh);
  for (Eigen::Index i = 0; i < weight.size(); ++i) weight(i) *= i % 3 == 1 ? -9.81 : 0.0;
  const SolidSolution solution = system->solve(weight);
  CHECK(solution.is_evaluated());
  CHECK(solution.displacement.isZero(0.0));
  // On top of a hit it changes nothing.
  const VecX load = beam.hit(0.3);
  CHECK(stress_difference(beam.mesh, beam.stress_of(system->solve(load + weight, fine())),
                          beam.stress_of(system->solve(load, fine()))) < 1e-8);
}

TEST_CASE("a solid's stress does not know Young's modulus, nor the size of things") {
  const Beam beam(0.1);
  const auto reference_system = make_solid_system(beam.stiffness, beam.mesh);
  const SolidSolution reference = reference_system->solve(beam.hit(0.3));
  const auto stress = beam.stress_of(reference);
  for (const double modulus : {1e3, 1e12}) {
    SolidProperties properties = solid_properties(0.22);
    properties.youngs_modulus = modulus;
    const auto stiffness = make_solid_stiffness(beam.solids, properties);
    const SolidSolution other = make_solid_system(stiffness, beam.mesh)->solve(beam.hit(0.3));
    CHECK(other.iterations == reference.iterations);
    CHECK(stress_difference(beam.mesh, cell_stresses(*stiffness, beam.mesh, other.displacement), stress) <
          1e-9);
    // Energy does.
    CHECK(other.elastic_compliance * modulus == Approx(reference.elastic_compliance * 2e9).epsilon(1e-9));
  }
  for (const double scale : {1e-4, 1e4}) {
    geometry::TetMesh mesh = beam.solids->mesh;
    for (Vec3& x : mesh.positions) x *= scale;
    const geometry::SolidMesh scaled = make_solid_mesh(make_solids(mesh));
    const auto stiffness = make_solid_stiffness(scaled.elements, solid_properties(0.22));
    const auto system = make_solid_system(stiffness, scaled);
    // The same pressure: forces as the square of the size.
    const SolidSolution other = system->solve(scale * scale * beam.hit(0.3));
    CHECK(other.iterations == reference.iterations);
    CHECK(stress_difference(scaled, cell_stresses(*stiffness, scaled, other.displacement), stress) < 1e-9);
    CHECK(system->first_period() == Approx(scale * reference_system->first_period()).epsilon(1e-6));
  }
}

TEST_CASE("the tolerance that a strength asks for: a thousandth of the stress, few iterations") {
  const Beam beam(0.05);
  const auto system = make_solid_system(beam.stiffness, beam.mesh);
  const auto exact = beam.stress_of(system->solve(beam.hit(0.0), fine()));
  const SolidSolution solution = system->solve(beam.hit(0.0));
  CHECK(solution.residual < 2.5e-3);
  CHECK(solution.iterations < 200);
  CHECK(stress_difference(beam.mesh, beam.stress_of(solution), exact) < 4e-3);
}

TEST_CASE("a solid's answers are the same bits for any number of threads and any company of loads") {
  const Solids solids = lattice_box(Vec3(0.5, 0.5, 0.5), 0.1);
  const geometry::SolidMesh mesh = make_solid_mesh(solids);
  const SolidSkin skin = make_border_skin(mesh);
  std::vector<VecX> loads;
  for (int i = 0; i < 6; ++i)
    loads.push_back(patch_load(mesh, find_load_patch(mesh, skin, Vec3(0.1 * i - 0.3, 0.2, 0.5), 0.12),
                               Vec3(0.1 * i, 0.3, -1.0)));
  for (const double screening : {0.0, 3000.0}) {
    SolidSolveSettings settings;
    settings.screening = screening;
    std::vector<std::vector<SolidSolution>> answers;
    std::vector<double> periods;
    for (const int threads : {1, 2, 5}) {
      core::set_thread_count(threads);
      const auto stiffness = make_solid_stiffness(solids, solid_properties());
      const auto system = make_solid_system(stiffness, mesh);
      answers.push_back(system->solve(loads, settings));
      answers.emplace_back();
      for (const VecX& load : loads) answers.back().push_back(system->solve(load, settings));
      periods.push_back(system->first_period());
    }
    core::set_thread_count(0);
    for (const auto& answer : answers)
      for (size_t l = 0; l < loads.size(); ++l) {
        CHECK(answer[l].displacement == answers[0][l].displacement);
        CHECK(answer[l].iterations == answers[0][l].iterations);
        CHECK(answer[l].elastic_compliance == answers[0][l].elastic_compliance);
      }
    for (const double period : periods) CHECK(period == periods[0]);
  }
}

TEST_CASE("a solid cut in two: each part is balanced by itself, and only the loaded one bends") {
  const Solids solids = lattice_box(Vec3(1.0, 0.1, 0.1), 0.05);
  const CutSolid cut = cut_by_plane(make_solid_mesh(solids), Vec3(1.0, 0.2, 0.1), 0.2013);
  const auto stiffness = make_solid_stiffness(solids, solid_properties());
  const auto system = make_solid_system(stiffness, cut.mesh);
  CHECK(system->part_count() == 2);
  // A pull at the end of the first part (x > 0.2).
  VecX load = VecX::Zero(cut.mesh.degree_of_freedom_count());
  for (const geometry::SolidCell& cell : cut.mesh.cells) {
    if (cell_centroid(cut.mesh, cell).x() < 0.95) continue;
    for (const int v : cell.vertices) load(3 * v) += cell.volume;
  }
  load /= load.sum();
  const SolidSolution solution = system->solve(load, fine());
  REQUIRE(solution.is_evaluated());
  const auto stresses = cell_stresses(*stiffness, cut.mesh, solution.displacement);
  double found = 0.0, expected = 0.0;
  for (size_t c = 0; c < stresses.size(); ++c) {
    const geometry::SolidCell& cell = cut.mesh.cells[c];
    const double x = cell_centroid(cut.mesh, cell).x();
    if (x < 0.15) {
      CHECK(stress_norm(stresses[c]) == 0.0);
    } else if (x > 0.35 && x < 0.8) {
      found += cell.volume * stresses[c](0);
      expected += cell.volume * (x - 0.2013) / 0.7987 / 0.04;
    }
  }
  CHECK(found == Approx(expected).epsilon(0.01));
}

TEST_CASE("a part of a solid that fell apart has the bits of a solid that is that part alone") {
  const Solids solids = lattice_box(Vec3(1.0, 0.4, 0.4), 0.1);
  const CutSolid cut = cut_by_plane(make_solid_mesh(solids), Vec3(1.0, 0.2, 0.1), 0.2013);
  const auto stiffness = make_solid_stiffness(solids, solid_properties());
  const auto system = make_solid_system(stiffness, cut.mesh);
  const std::vector<int>& part_of = system->part_of_vertex();
  geometry::SolidMesh alone;
  alone.elements = cut.mesh.elements;
  std::vector<int> number(part_of.size(), -1), vertices;
  for (size_t v = 0; v < part_of.size(); ++v)
    if (part_of[v] == 1) {
      number[v] = static_cast<int>(vertices.size());
      vertices.push_back(static_cast<int>(v));
      alone.vertex_source.push_back(cut.mesh.vertex_source[v]);
    }
  for (geometry::SolidCell cell : cut.mesh.cells) {
    if (part_of[at(cell.vertices[0])] != 1) continue;
    for (int& v : cell.vertices) v = number[at(v)];
    alone.cells.push_back(cell);
  }
  const auto other = make_solid_system(stiffness, alone);
  REQUIRE(other->part_count() == 1);
  // One load on each part and one on both.
  std::vector<VecX> loads(3, VecX::Zero(cut.mesh.degree_of_freedom_count()));
  std::vector<VecX> own(3, VecX::Zero(alone.degree_of_freedom_count()));
  for (size_t v = 0; v < part_of.size(); ++v)
    for (int axis = 0; axis < 3; ++axis) {
      const double force = static_cast<double>((7 * v + 3 * static_cast<size_t>(axis)) % 11) - 5.0;
      for (int l = 0; l < 3; ++l)
        if (l == 2 || part_of[v] == l) loads[at(l)](3 * static_cast<int>(v) + axis) = force;
      if (part_of[v] == 1) own[1](3 * number[v] + axis) = own[2](3 * number[v] + axis) = force;
    }
  for (const double screening : {0.0, 3e3}) {
    SolidSolveSettings settings;
    settings.screening = screening;
    const auto both = system->solve(loads, settings);
    const auto single = other->solve(std::vector<VecX>{own[1], own[2]}, settings);
    for (const int l : {1, 2}) {
      REQUIRE(both[at(l)].is_evaluated());
      for (size_t k = 0; k < vertices.size(); ++k)
        CHECK(both[at(l)].displacement.segment<3>(3 * vertices[k]) ==
              single[at(l - 1)].displacement.segment<3>(3 * static_cast<int>(k)));
    }
    CHECK(both[1].compliance == single[0].compliance);
    CHECK(both[2].compliance == Approx(both[0].compliance + both[1].compliance).epsilon(1e-12));
    for (size_t v = 0; v < part_of.size(); ++v)
      if (part_of[v] == 1)
        CHECK(both[0].displacement.segment<3>(3 * static_cast<int>(v)) == Vec3(Vec3::Zero()));
  }
}

TEST_CASE("a half cut of a solid is a hinge: softer, and still an answer") {
  // Cells on both sides of the plane x = 0.0123, joined below z = 0: virtual nodes of the copies are merged
  // there.
  const Solids solids = lattice_box(Vec3(1.0, 0.1, 0.1), 0.05);
  const geometry::SolidMesh whole = make_solid_mesh(solids);
  CutSolid cut = cut_by_plane(whole, Vec3(1.0, 0.0, 0.0), 0.0123);
  std::vector<int> merged(cut.mesh.vertex_source.size());
  std::map<int, int> first_copy;
  for (size_t v = 0; v < merged.size(); ++v) {
    merged[v] = static_cast<int>(v);
    const int source = cut.mesh.vertex_source[v];
    if (solids->mesh.positions[at(source)].z() < -0.01)
      merged[v] = first_copy.try_emplace(source, static_cast<int>(v)).first->second;
  }
  for (geometry::SolidCell& cell : cut.mesh.cells)
    for (int& v : cell.vertices) v = merged[at(v)];
  const auto stiffness = make_solid_stiffness(solids, solid_properties());
  const auto intact = make_solid_system(stiffness, whole), cracked = make_solid_system(stiffness, cut.mesh);
  CHECK(cracked->part_count() == 1);
  CHECK(cracked->rigid_mode_count() == 6);
  const auto load_of = [&](const geometry::SolidMesh& mesh) {  // bends: the top is pulled open
    VecX load = VecX::Zero(mesh.degree_of_freedom_count());
    for (const geometry::SolidCell& cell : mesh.cells) {
      const double x = cell_centroid(mesh, cell).x();
      for (const int v : cell.vertices)
        if (std::abs(x) > 0.9) load(3 * v + 2) -= cell.volume;
    }
    return VecX(load / 0.008);
  };
  const SolidSolution a = intact->solve(load_of(whole)), b = cracked->solve(load_of(cut.mesh));
  REQUIRE(a.is_evaluated());
  REQUIRE(b.is_evaluated());
  CHECK(b.elastic_compliance > 1.3 * a.elastic_compliance);
  CHECK(cracked->first_period() > 1.1 * intact->first_period());
}

TEST_CASE("screening: towards no window the balanced stress, in a short one only what waves can reach") {
  const Beam beam(0.05);
  const auto system = make_solid_system(beam.stiffness, beam.mesh);
  const double first = 2.0 * core::kPi / system->first_period();
  const VecX load = beam.hit(0.0);
  const SolidSolution balanced = system->solve(load, fine());
  const auto stress = beam.stress_of(balanced);
  // U_s is the window's integral: s U_s F is the mean; as s falls its stress becomes the balanced one.
  std::vector<double> differences;
  for (const double s : {1.0, 1e-1, 1e-2, 1e-4}) {
    SolidSolveSettings settings = fine();
    settings.screening = s * first;
    const SolidSolution screened = system->solve(load, settings);
    REQUIRE(screened.is_evaluated());
    differences.push_back(stress_difference(beam.mesh, beam.stress_of(screened), stress));
    CHECK(screened.elastic_compliance <= balanced.elastic_compliance);
    // The rigid motion: J / (m s^2) at the centre of mass, as every free body's.
    const double mass = 1200.0 * 0.08, rigid = 1.0 / (mass * settings.screening * settings.screening);
    CHECK(screened.compliance > rigid);
    const double turning =
        screened.rigid_displacement.dot(load) - rigid;  // the force's arm is the beam's axis
    CHECK(std::abs(turning) < 1e-9 * rigid);
  }
  CAPTURE(differences);
  CHECK(differences[1] < 1e-2);
  CHECK(differences[2] < 1e-4);
  CHECK(differences[3] < 1e-7);
  SolidSolveSettings shortly = fine();
  shortly.screening = 100.0 * first;
  const auto local = beam.stress_of(system->solve(load, shortly));
  double near = 0.0, far = 0.0;
  for (size_t c = 0; c < local.size(); ++c) {
    const double x = std::abs(cell_centroid(beam.mesh, beam.mesh.cells[c]).x());
    if (x < 0.1) near = std::max(near, stress_norm(local[c]));
    if (x > 0.5) far = std::max(far, stress_norm(local[c]));
  }
  CHECK(far < 1e-3 * near);
}

TEST_CASE(
    "what a damped free solid feels over time is the balanced solve, through a window, the screened one") {
  const Beam beam(0.1);
  const auto system = make_solid_system(beam.stiffness, beam.mesh);
  const double period = system->first_period(), first = 2.0 * core::kPi / period;
  const VecX impulse = beam.hit(0.2, Vec3(0.2, 0.0, -1.0));
  const auto balanced = beam.stress_of(system->solve(impulse, fine()));
  // A tenth of critical damping of the first mode: exp(-0.2 pi n) is left after n periods.
  std::vector<double> errors;
  for (const double periods : {2.0, 12.0}) {
    const VecX integral =
        integrate_motion(beam, *system, impulse, 0.2 * first, 0.0, periods * period, period / 1500.0);
    errors.push_back(
        stress_difference(beam.mesh, cell_stresses(*beam.stiffness, beam.mesh, integral), balanced));
  }
  CAPTURE(errors);
  CHECK(errors[0] > 0.01);
  CHECK(errors[1] < 1e-3);
  for (const double s : {0.3, 1.0, 3.0}) {
    SolidSolveSettings settings = fine();
    settings.screening = s * first;
    const auto screened = beam.stress_of(system->solve(impulse, settings));
    const VecX window =
        integrate_motion(beam, *system, impulse, 0.0, s * first, 2.2 / s * period, period / 3000.0);
    CAPTURE(s);
    CHECK(stress_difference(beam.mesh, cell_stresses(*beam.stiffness, beam.mesh, window), screened) <
          3e-3 * std::max(1.0, s));
  }
}

TEST_CASE("first periods of solids: a free beam bends, a clamped one longer, a rod alone stretches") {
  // Free-free and clamped: 22.373 and 3.516 over L^2, sqrt(E I / rho A), less Timoshenko's 3 and 1 %.
  const Beam fine_beam(0.025), beam(0.05);
  const double unit = core::sqrt(2e9 / 1200.0) * 0.2 / core::sqrt(12.0) / 4.0;
  const double free_period = make_solid_system(fine_beam.stiffness, fine_beam.mesh)->first_period();
  CHECK(free_period == Approx(2.0 * core::kPi / (22.373 * unit) * 1.026).epsilon(0.02));
  SolidSystemOptions options;
  options.support = clamp_where(beam.mesh, [](const Vec3& x) { return x.x() == -1.0 ? 7 : 0; });
  const auto clamped = make_solid_system(beam.stiffness, beam.mesh, options);
  CHECK(clamped->rigid_mode_count() == 0);
  CHECK(clamped->first_period() == Approx(2.0 * core::kPi / (3.516 * unit) * 1.008).epsilon(0.04));
  // Guided along x: only stretching is left, 2 L / c.
  options.support = clamp_where(beam.mesh, [](const Vec3&) { return 6; });
  const auto guided =
      make_solid_system(make_solid_stiffness(beam.solids, solid_properties(0.0)), beam.mesh, options);
  CHECK(guided->rigid_mode_count() == 1);
  CHECK(guided->first_period() == Approx(2.0 * 2.0 / core::sqrt(2e9 / 1200.0)).epsilon(0.005));
}

TEST_CASE("the period of a solid's trial motion is never above the first one") {
  const Beam beam(0.05);
  const auto system = make_solid_system(beam.stiffness, beam.mesh);
  for (const double x : {0.0, 0.3, 1.0})
    for (const double s : {0.0, 1e3, 1e4}) {
      SolidSolveSettings settings;
      settings.screening = s;
      const double period = system->trial_period(system->solve(beam.hit(x), settings));
      CHECK(period > 0.0);
      CHECK(period < 1.01 * system->first_period());
    }
}

TEST_CASE("a solid's support: stress of a bar that hangs from its top") {
  const Beam beam(0.05, solid_properties(0.0));
  SolidSystemOptions options;
  std::vector<char> is_clamped(beam.solids->mesh.positions.size(), 0);
  for (size_t v = 0; v < is_clamped.size(); ++v) is_clamped[v] = beam.solids->mesh.positions[v].x() == 1.0;
  options.support = find_solid_support(beam.mesh, is_clamped);
  CHECK(options.support.dofs.size() == 3 * (5 * 5 + 4 * 4));
  const auto system = make_solid_system(beam.stiffness, beam.mesh, options);
  VecX weight = lumped_mass(*beam.stiffness, beam.mesh);
  for (Eigen::Index i = 0; i < weight.size(); ++i) weight(i) *= i % 3 == 0 ? -9.81 : 0.0;
  const auto stresses = beam.stress_of(system->solve(weight, fine()));
  for (size_t c = 0; c < stresses.size(); ++c) {
    const double x = cell_centroid(beam.mesh, beam.mesh.cells[c]).x();
    if (x > -0.8) CHECK(stresses[c](0) == Approx(1200.0 * 9.81 * (x + 1.0)).epsilon(0.04));
  }
  // Cut through: what was cut off from the support is free.
  const CutSolid cut = cut_by_plane(beam.mesh, Vec3(1.0, 0.0, 0.0), 0.9871);
  options.support = find_solid_support(cut.mesh, is_clamped);
  CHECK(options.support.dofs.size() == 3 * (5 * 5 + 4 * 4));
  const auto parts = make_solid_system(beam.stiffness, cut.mesh, options);
  CHECK(parts->part_count() == 2);
  CHECK(parts->rigid_mode_count() == 6);
}

TEST_CASE("what a solid's solve cannot answer it says, and never as a NaN") {
  const Beam beam(0.1);
  const auto system = make_solid_system(beam.stiffness, beam.mesh);
  SolidSolveSettings hurried;
  hurried.most_iterations = 2;
  const SolidSolution unsettled = system->solve(beam.hit(0.0), hurried);
  CHECK_FALSE(unsettled.is_evaluated());
  CHECK(unsettled.fault.find("did not settle in 2") != std::string::npos);
  CHECK(std::isfinite(unsettled.displacement.squaredNorm()));
  CHECK(system->solve(VecX(VecX::Zero(system->dof_count()))).is_evaluated());

  geometry::SolidMesh empty;
  empty.elements = beam.solids;
  CHECK_FALSE(SolidSystem::make(beam.stiffness, empty).ok());
  SolidSystemOptions all;
  all.support = clamp_where(beam.mesh, [](const Vec3&) { return 7; });
  CHECK_FALSE(SolidSystem::make(beam.stiffness, beam.mesh, all).ok());
  geometry::TetMesh flat = beam.solids->mesh;
  flat.positions[at(flat.tetrahedra[3][0])] = flat.positions[at(flat.tetrahedra[3][1])];
  const Solids flattened = make_solids(flat);
  CHECK_FALSE(
      SolidSystem::make(make_solid_stiffness(flattened, solid_properties()), make_solid_mesh(flattened))
          .ok());
  // A cell narrower than the cutter's rounding is one all the same.
  geometry::SolidMesh narrow = beam.mesh;
  narrow.cells[3].volume = -1e-20;
  const SolidSolution held = make_solid_system(beam.stiffness, narrow)->solve(beam.hit(0.3));
  CHECK(held.is_evaluated());
  CHECK(stress_norm(average_stresses(narrow, whole_contacts(narrow), beam.stress_of(held))[3]) < 1e3);
}

TEST_CASE("slivers of a solid cost iterations, not the answer") {
  // Every fourth inner vertex is pushed almost onto a neighbouring face.
  const Solids regular =
      mapped({8, 4, 4}, [](const Vec3& x) -> Vec3 { return x.cwiseProduct(Vec3(2.0, 1.0, 1.0)); });
  const auto solve = [&](double height) {
    geometry::TetMesh mesh = regular->mesh;
    for (size_t t = 0; t < mesh.tetrahedra.size(); t += 61) {
      const auto& v = mesh.tetrahedra[t];
      Vec3& tip = mesh.positions[at(v[0])];
      if ((tip.array() < 0.05).any() || tip.x() > 1.95 || tip.y() > 0.95 || tip.z() > 0.95) continue;
      const Vec3 a = mesh.positions[at(v[1])], b = mesh.positions[at(v[2])], c = mesh.positions[at(v[3])];
      const Vec3 normal = (b - a).cross(c - a).normalized();
      const Vec3 moved = tip - (1.0 - height) * normal.dot(tip - a) * normal;
      const Vec3 kept = tip;
      tip = moved;
      for (size_t other = 0; other < mesh.tetrahedra.size(); ++other)
        if (!(geometry::tetrahedron_volume(mesh, static_cast<int>(other)) > 0.0)) tip = kept;
    }
    const geometry::SolidMesh solid = make_solid_mesh(make_solids(mesh));
    const auto stiffness = make_solid_stiffness(solid.elements, solid_properties());
    int slivers = 0;
    for (const SolidElement& element : stiffness->solids)
      slivers += element.gradients[0].norm() > 30.0 ? 1 : 0;
    CHECK((slivers > 5) == (height < 0.1));
    const VecX load = traction_load(solid, [](const Vec3& x, const Vec3& normal) -> Vec3 {
      return std::abs(normal.x()) > 0.5 ? Vec3((x.y() - 0.5) * normal) : Vec3(Vec3::Zero());
    });
    return make_solid_system(stiffness, solid)->solve(load);
  };
  const SolidSolution good = solve(1.0);
  for (const double height : {1e-2, 1e-4, 1e-6}) {
    const SolidSolution bad = solve(height);
    CAPTURE(height, good.iterations, bad.iterations);
    CHECK(bad.is_evaluated());
    CHECK(bad.iterations < 40 * good.iterations);
    CHECK(bad.elastic_compliance == Approx(good.elastic_compliance).epsilon(0.2));
  }
}

TEST_CASE("solve of a solid of a hundred thousand tetrahedra", "[solid_cost]") {
  const auto now = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  const Solids cube = lattice_box(Vec3(0.5, 0.5, 0.5), 0.05);
  const geometry::SolidMesh mesh = make_solid_mesh(cube);
  const double start = now();
  const auto stiffness = make_solid_stiffness(cube, solid_properties(0.22));
  const auto system = make_solid_system(stiffness, mesh);
  const double made = now();
  const VecX load = patch_load(mesh, find_load_patch(mesh, make_border_skin(mesh), Vec3(0.1, 0.05, 0.5), 0.1),
                               Vec3(0.3, 0.0, -1.0));
  const double loaded = now();
  const SolidSolution solution = system->solve(load);
  const double solved = now();
  const double period = system->first_period();
  std::cout << mesh.cells.size() << " tetrahedra, " << system->dof_count() << " unknowns: made in "
            << made - start << " s, solved in " << solved - loaded << " s (" << solution.iterations
            << " iterations to " << solution.residual << "), period in " << now() - solved
            << " s of processor time\n";
  CHECK(solution.is_evaluated());
  CHECK(solution.iterations < 150);
  CHECK(period > 0.0);
}
