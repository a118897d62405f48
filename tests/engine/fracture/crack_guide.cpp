// The potential that guides a crack, against a factor of the same matrix by another hand.
#include "engine/fracture/crack_guide.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/core/index.h"
#include "engine/core/random.h"
#include "engine/geometry/box_tets.h"
#include "engine/stress/elimination_order.h"

using namespace shatterbox;
using namespace shatterbox::fracture;
using core::at;
using std::size_t;

TEST_CASE("a crack guide's potential is the one of sources and sinks about its start") {
  auto made = geometry::make_box_tets(Vec3(0.5, 0.4, 0.3), 0.1);
  REQUIRE(made.ok());
  auto whole = std::make_shared<geometry::SolidElements>();
  whole->mesh = std::move(made.value());
  const geometry::TetMesh& mesh = whole->mesh;
  const auto count = static_cast<Eigen::Index>(mesh.positions.size());
  // Planes that turn from place to place, as sure as chance has it, and one corner of the box left out.
  core::Random random(5, 2);
  std::vector<GuideElement> elements;
  std::vector<char> is_in(mesh.positions.size(), 0);
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
    Vec3 middle = Vec3::Zero();
    for (const int v : mesh.tetrahedra[at(e)]) middle += 0.25 * mesh.positions[at(v)];
    if (middle.x() > 0.2 && middle.y() > 0.1) continue;
    const Vec3 across = Vec3(middle.y(), 0.3, 1.0 + middle.x()).normalized();
    elements.push_back(
        {e, geometry::tetrahedron_volume(mesh, e), guide_conduction(across, random.uniform(0.0, 1.0))});
    for (const int v : mesh.tetrahedra[at(e)]) is_in[at(v)] = 1;
  }
  const int start = elements[elements.size() / 2].element;
  const Vec3 normal = Vec3(0.2, 0.1, 1.0).normalized();
  Vec3 place = Vec3::Zero();
  for (const int v : mesh.tetrahedra[at(start)]) place += 0.25 * mesh.positions[at(v)];

  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd source = Eigen::VectorXd::Zero(count);
  const geometry::Tetrahedron& first = mesh.tetrahedra[at(start)];
  double trace = 0.0;
  for (const GuideElement& e : elements) {
    const geometry::Tetrahedron& t = mesh.tetrahedra[at(e.element)];
    Eigen::Matrix4d corners;
    for (int i = 0; i < 4; ++i) corners.row(i) << 1.0, mesh.positions[at(t[at(i)])].transpose();
    const Eigen::Matrix4d inverse = corners.inverse();  // column i: 1 at corner i, its gradient below
    const bool is_near = std::any_of(
        t.begin(), t.end(), [&](int v) { return std::find(first.begin(), first.end(), v) != first.end(); });
    for (int i = 0; i < 4; ++i) {
      const Vec3 g = inverse.col(i).tail<3>();
      if (is_near) source(t[at(i)]) += e.volume * g.dot(normal);
      trace += e.volume * g.dot(e.conduction * g);
      for (int j = 0; j < 4; ++j) {
        const Vec3 h = inverse.col(j).tail<3>();
        entries.emplace_back(t[at(i)], t[at(j)], e.volume * g.dot(e.conduction * h));
      }
    }
  }
  for (Eigen::Index v = 0; v < count; ++v)
    entries.emplace_back(
        v, v, is_in[static_cast<size_t>(v)] != 0 ? 1e-9 * trace / static_cast<double>(count) : 1.0);
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  const Eigen::VectorXd flow = solver.solve(source);
  double here = 0.0;
  for (const int v : first) here += 0.25 * flow(v);
  const double greatest = flow.cwiseAbs().maxCoeff();

  const stress::SolidVertexRank rank;
  GuideTrees trees(rank.of(*whole));
  const CrackGuide guide(mesh, elements, trees);
  const std::vector<double> found = guide.potentials(std::vector<GuideStart>{{start, place, normal}}).front();
  REQUIRE(found.size() == mesh.positions.size());
  int near = 0, known = 0;
  for (size_t v = 0; v < found.size(); ++v) {
    const double expected = flow(static_cast<Eigen::Index>(v)) - here;
    if (is_in[v] == 0) {
      CHECK(found[v] == 0.0);
    } else if (std::abs(found[v] - expected) > 1e-6 * greatest) {
      // On the surface: next to nothing, and positive.
      ++near;
      CHECK(found[v] > 0.0);
      CHECK(found[v] < 1e-5 * greatest);
    } else {
      ++known;
      CHECK((found[v] > 0.0) == (expected > 0.0));
    }
  }
  // Others beside it change nothing, to the last bit.
  std::vector<GuideStart> starts;
  for (const GuideElement& e : elements) {
    if (starts.size() == 7) break;
    starts.push_back({e.element, place, Vec3::Unit(static_cast<int>(starts.size()) % 3)});
  }
  starts[5] = {start, place, normal};
  CHECK(guide.potentials(starts)[5] == found);
  CHECK(guide.potentials({}).empty());
  CHECK(known > 10 * near);
  CHECK(std::count_if(found.begin(), found.end(), [](double f) { return f < 0.0; }) > known / 5);
}
