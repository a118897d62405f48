// The second level of the solids' solves: clusters hold together, and their motions are answered exactly.
#include "engine/stress/coarse_modes.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "engine/core/disjoint_sets.h"
#include "engine/core/index.h"
#include "engine/core/random.h"
#include "engine/stress/vertex_clusters.h"
#include "tests/engine/stress/solid_meshes.h"

using namespace shatterbox;
using namespace shatterbox::stress;
using namespace shatterbox::stress::testing;
using core::at;
using std::size_t;

namespace {

struct CoarseCase {
  BlockRows rows;
  std::vector<Vec3> positions;
  std::vector<Mat3> allowed;
  std::vector<double> mass;

  CoarseCase() {
    const auto solids = lattice_box(Vec3(1.0, 0.4, 0.2), 0.05);
    const auto stiffness = make_solid_stiffness(solids, solid_properties());
    rows = assemble_stiffness(*stiffness, geometry::make_solid_mesh(solids));
    positions = solids->mesh.positions;
    allowed.assign(positions.size(), Mat3::Identity());
    // A few are held, one of them along an axis.
    allowed[3].setZero();
    allowed[7].setZero();
    allowed[11] = Vec3(1.0, 0.0, 1.0).asDiagonal();
    mass.assign(positions.size(), 0.01);
  }
};

}  // namespace

TEST_CASE("clusters of a solid's vertices hang together, and none is much larger than others") {
  const CoarseCase box;
  const int count = 24;
  const std::vector<int> cluster = cluster_vertices(box.rows, count);
  const int found = *std::max_element(cluster.begin(), cluster.end()) + 1;
  CHECK(found >= count / 2);
  CHECK(found <= 3 * count);
  std::vector<int> size(at(found), 0);
  core::DisjointSets sets(cluster.size());
  for (size_t v = 0; v < cluster.size(); ++v) {
    REQUIRE(cluster[v] >= 0);
    ++size[at(cluster[v])];
    for (int b = box.rows.first[v]; b < box.rows.first[v + 1]; ++b)
      if (const int w = box.rows.column[at(b)]; cluster[at(w)] == cluster[v])
        sets.unite(static_cast<int>(v), w);
  }
  const int average = static_cast<int>(cluster.size()) / count;
  for (const int s : size) {
    CHECK(s >= 4);
    CHECK(s <= 4 * average);
  }
  std::vector<int> root(at(found), -1);
  for (size_t v = 0; v < cluster.size(); ++v) {
    int& known = root[at(cluster[v])];
    if (known < 0) known = sets.find(static_cast<int>(v));
    CHECK(sets.find(static_cast<int>(v)) == known);
  }
}

TEST_CASE("the clusters' motions of a solid are answered exactly, for one load and for several") {
  const CoarseCase box;
  const CoarseModes coarse(box.rows, box.positions, box.allowed, box.mass);
  const double shift = 0.3;
  const auto factor = coarse.factor(shift);
  REQUIRE(factor);
  const size_t count = box.positions.size();
  // What `answer` gives is a motion that clusters can make: asked for what moves them so, it gives it again.
  core::Random random(3, 1);
  std::vector<double> r(3 * count);
  for (double& value : r) value = random.uniform(-1.0, 1.0);
  const auto motion_of = [&](const std::vector<double>& load) {
    std::vector<double> z(3 * count, 0.0);
    const std::vector<double> amounts = coarse.answer(*factor, load, 1);
    for (size_t v = 0; v < count; ++v) coarse.add<1>(amounts, v, &z[3 * v]);
    return z;
  };
  const std::vector<double> x = motion_of(r);
  std::vector<double> image(3 * count);
  multiply_rows<1>(box.rows, box.rows.entries.data(), 0, count, x.data(), image.data());
  for (size_t i = 0; i < image.size(); ++i) image[i] += shift * box.mass[i / 3] * x[i];
  const std::vector<double> again = motion_of(image);
  double error = 0.0, whole = 0.0;
  for (size_t i = 0; i < x.size(); ++i) {
    error = std::max(error, std::abs(again[i] - x[i]));
    whole = std::max(whole, std::abs(x[i]));
  }
  CHECK(whole > 0.0);
  CHECK(error < 1e-6 * whole);
  for (int axis = 0; axis < 3; ++axis) CHECK(x[at(3 * 3 + axis)] == 0.0);
  CHECK(x[3 * 11 + 1] == 0.0);

  // Four side by side: the same bits as each alone.
  std::vector<double> four(12 * count), z(12 * count, 0.0);
  for (size_t i = 0; i < r.size(); ++i)
    for (size_t l = 0; l < 4; ++l) four[4 * i + l] = l == 2 ? r[i] : static_cast<double>(l) - 0.5 * r[i];
  const std::vector<double> amounts = coarse.answer(*factor, four, 4);
  for (size_t v = 0; v < count; ++v) coarse.add<4>(amounts, v, &z[12 * v]);
  for (size_t i = 0; i < r.size(); ++i) CHECK(z[4 * i + 2] == x[i]);
}
