// Principal stresses, faces, averaging over folds and cracks.
#include "engine/stress/shell_stress.h"

#include <catch2/catch.hpp>

#include "tests/engine/stress/meshes.h"

using namespace shatterbox;
using namespace shatterbox::stress;
using namespace shatterbox::stress::testing;

using std::size_t;

TEST_CASE("principal stresses and their direction") {
  const PrincipalStress diagonal = principal_stress({3.0, -1.0, 0.0});
  REQUIRE(diagonal.first == 3.0);
  REQUIRE(diagonal.second == -1.0);
  REQUIRE(diagonal.direction == Vec2(1.0, 0.0));
  REQUIRE(std::abs(principal_stress({-1.0, 3.0, 0.0}).direction.y()) == 1.0);
  const PrincipalStress shear = principal_stress({0.0, 0.0, 2.0});
  REQUIRE(shear.first == Approx(2.0));
  REQUIRE(std::abs(shear.direction.dot(Vec2(1.0, 1.0).normalized())) == Approx(1.0));
  REQUIRE(principal_stress({5.0, 5.0, 0.0}).direction.norm() == Approx(1.0));
  REQUIRE(principal_stress(PlaneStress::Zero()).first == 0.0);
  core::Random random(11, 0);
  for (int i = 0; i < 200; ++i) {
    const double xx = random.uniform(-1e8, 1e8);
    const double yy = random.uniform(-1e8, 1e8);
    const double xy = random.uniform(-1e8, 1e8);
    const PrincipalStress p = principal_stress({xx, yy, xy});
    Mat2 tensor;
    tensor << xx, xy, xy, yy;
    REQUIRE((tensor * p.direction - p.first * p.direction).norm() < 1e-7);
    REQUIRE(p.first + p.second == Approx(xx + yy).margin(1e-6));
  }
  REQUIRE(von_mises({4.0, 0.0, 0.0}) == 4.0);
  REQUIRE(von_mises({0.0, 0.0, 1.0}) == Approx(core::sqrt(3.0)));
}

TEST_CASE("bending stretches one face and presses the other") {
  const CellStress bent{PlaneStress(1.0, 0.0, 0.0), PlaneStress(5.0, 0.0, 0.0)};
  REQUIRE(worst_stress(bent).face == ShellFace::outer);
  REQUIRE(worst_stress(bent).principal.first == 6.0);
  const CellStress other{PlaneStress(1.0, 0.0, 0.0), PlaneStress(-5.0, 0.0, 0.0)};
  REQUIRE(worst_stress(other).face == ShellFace::inner);
  REQUIRE(other.at(ShellFace::outer)(0) == -4.0);
}

TEST_CASE("averaging keeps a uniform stress, whatever the axes of the facets") {
  const Elements elements = grid(8, 8, 1.0, 1.0, 0.3);
  const geometry::ShellMesh whole = geometry::make_shell_mesh(elements);
  Mat2 tensor;
  tensor << 3.0, 1.5, 1.5, -2.0;
  for (const geometry::ShellMesh& mesh : {whole, cut_between(whole, 0.37)}) {
    std::vector<CellStress> stresses;
    for (const geometry::ShellCell& cell : mesh.cells) {
      const Mat2 turn = geometry::facet_frame(*elements, cell.element).topLeftCorner<2, 2>();
      const Mat2 local = turn.transpose() * tensor * turn;
      const PlaneStress s(local(0, 0), local(1, 1), local(0, 1));
      stresses.push_back({s, -2.0 * s});
    }
    const auto averaged = average_stresses(mesh, geometry::find_cell_contacts(mesh), stresses);
    for (size_t c = 0; c < averaged.size(); ++c) {
      REQUIRE((averaged[c].membrane - stresses[c].membrane).norm() < 1e-12);
      REQUIRE((averaged[c].bending - stresses[c].bending).norm() < 1e-12);
    }
  }
}

TEST_CASE(
    "averaging carries the parts along and across the edge over a fold, and heeds a flipped neighbour") {
  for (const bool is_flipped : {false, true}) {
    geometry::TriangleMesh mesh;
    mesh.positions = {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0.3, 0), Vec3(0, 0.4, 1)};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
    if (is_flipped) mesh.triangles[1] = {0, 1, 3};
    const Elements elements = make_elements(std::move(mesh));
    const geometry::ShellMesh shell = geometry::make_shell_mesh(elements);
    // Pure tension along the common edge (y) in the second; nothing in the first.
    const Mat3 frame = geometry::facet_frame(*elements, 1);
    const Vec2 along(frame.col(0).y(), frame.col(1).y());
    const PlaneStress s(along.x() * along.x(), along.y() * along.y(), along.x() * along.y());
    const auto averaged =
        average_stresses(shell, geometry::find_cell_contacts(shell), {CellStress{}, CellStress{s, s}});
    const double share = shell.cells[1].area / (shell.cells[0].area + shell.cells[1].area);
    const Mat3 first = geometry::facet_frame(*elements, 0);
    const PrincipalStress p = principal_stress(averaged[0].membrane);
    REQUIRE(p.first == Approx(share));
    REQUIRE(p.second == Approx(0.0).margin(1e-12));
    REQUIRE(std::abs(direction_in_space(*elements, 0, p.direction).y()) == Approx(1.0));
    REQUIRE((averaged[0].bending - (is_flipped ? -1.0 : 1.0) * averaged[0].membrane).norm() < 1e-12);
    REQUIRE(first.col(2).norm() == Approx(1.0));
  }
}

TEST_CASE("a stress that varies linearly is fitted exactly, on flat meshes, over folds and beside cuts") {
  // The same sheet flat, and folded by a right angle along a line of its edges.
  for (const bool is_folded : {false, true}) {
    geometry::TriangleMesh mesh = grid(8, 8, 1.0, 1.0, 0.0)->mesh;
    const std::vector<Vec3> flat = mesh.positions;
    for (Vec3& p : mesh.positions)
      if (is_folded && p.x() > 0.5) p = Vec3(0.5, p.y(), p.x() - 0.5);
    const Elements elements = make_elements(mesh);
    const geometry::ShellMesh whole = geometry::make_shell_mesh(elements);
    for (const geometry::ShellMesh& shell : {whole, cut_between(whole, 0.37)}) {
      // In the flat sheet's axes: s = (x, 2 y, x - y), bending -3 s.
      const auto stress_at = [](const Vec2& p) { return PlaneStress(p.x(), 2.0 * p.y(), p.x() - p.y()); };
      const auto local = [&](int element, const PlaneStress& s) {
        const auto& t = elements->mesh.triangles[static_cast<size_t>(element)];
        const Vec3 edge = (flat[static_cast<size_t>(t[1])] - flat[static_cast<size_t>(t[0])]).normalized();
        Mat2 axes, tensor;
        axes << edge.x(), -edge.y(), edge.y(), edge.x();
        tensor << s(0), s(2), s(2), s(1);
        const Mat2 turned = axes.transpose() * tensor * axes;
        return PlaneStress(turned(0, 0), turned(1, 1), turned(0, 1));
      };
      const auto flat_place = [&](int element, const Vec3& weights) {
        Vec3 p = Vec3::Zero();
        for (size_t i = 0; i < 3; ++i)
          p += weights(static_cast<int>(i)) *
               flat[static_cast<size_t>(elements->mesh.triangles[static_cast<size_t>(element)][i])];
        return Vec2(p.x(), p.y());
      };
      std::vector<CellStress> stresses;
      for (const geometry::ShellCell& cell : shell.cells) {
        const PlaneStress s =
            local(cell.element, stress_at(flat_place(cell.element, centroid_weights(shell, cell))));
        stresses.push_back({s, -3.0 * s});
      }
      const auto fits = fit_stresses(shell, geometry::find_cell_contacts(shell), stresses);
      int sloped = 0;
      for (size_t c = 0; c < fits.size(); ++c) {
        const geometry::ShellCell& cell = shell.cells[c];
        const double slope = fits[c].slope[0].membrane.norm() + fits[c].slope[1].membrane.norm();
        if (slope == 0.0) continue;  // in a corner
        ++sloped;
        const auto& t = elements->mesh.triangles[static_cast<size_t>(cell.element)];
        const Mat3 frame = geometry::facet_frame(*elements, cell.element);
        const Vec3 weights(0.2, 0.5, 0.3);
        const Vec3& origin = elements->mesh.positions[static_cast<size_t>(t[0])];
        Vec3 way = Vec3::Zero();
        for (size_t i = 1; i < 3; ++i)
          way +=
              weights(static_cast<int>(i)) * (elements->mesh.positions[static_cast<size_t>(t[i])] - origin);
        const CellStress found = fits[c].at({frame.col(0).dot(way), frame.col(1).dot(way)});
        const PlaneStress expected = local(cell.element, stress_at(flat_place(cell.element, weights)));
        REQUIRE((found.membrane - expected).norm() < 1e-9);
        REQUIRE((found.bending + 3.0 * expected).norm() < 1e-9);
      }
      CHECK(sloped > static_cast<int>(0.8 * static_cast<double>(fits.size())));
    }
  }
}

TEST_CASE("averaging never crosses a crack") {
  const Elements elements = grid(6, 6, 1.0, 1.0);
  const geometry::ShellMesh mesh = cut_between(geometry::make_shell_mesh(elements), 0.45);
  std::vector<CellStress> stresses(mesh.cells.size());
  std::vector<char> is_left(mesh.cells.size(), 0);
  for (size_t c = 0; c < mesh.cells.size(); ++c) {
    double x = 0.0;
    for (int i = 0; i < mesh.cells[c].corner_count; ++i)
      x += geometry::position_in_element(
               *elements, mesh.cells[c].element,
               mesh.corners[static_cast<size_t>(mesh.cells[c].first_corner + i)].barycentric)
               .x() /
           mesh.cells[c].corner_count;
    is_left[c] = x < 0.45 ? 1 : 0;
    if (is_left[c] != 0) stresses[c].membrane = PlaneStress(1.0, 1.0, 0.0);
  }
  const auto averaged = average_stresses(mesh, geometry::find_cell_contacts(mesh), stresses);
  for (size_t c = 0; c < mesh.cells.size(); ++c)
    REQUIRE(averaged[c].membrane(0) == Approx(is_left[c] != 0 ? 1.0 : 0.0).margin(1e-14));
}
