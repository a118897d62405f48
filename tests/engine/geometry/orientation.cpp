#include "engine/geometry/orientation.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/core/random.h"

using namespace shatterbox;
using namespace shatterbox::geometry;

namespace {

using Corners = std::array<Vec3, 3>;

Vec3 draw(core::Random& random) {
  const double x = random.uniform();
  const double y = random.uniform();
  const double z = random.uniform();
  return {x, y, z};
}

}  // namespace

TEST_CASE("expansion: sums and products lose nothing") {
  const Expansion tiny(1e-30), large(1e30), one(1.0);
  const Expansion sum = (large + one) + tiny;
  CHECK((sum - large - one).estimate() == 1e-30);
  CHECK((sum - large - one - tiny).sign() == 0);
  // (a + b)(a - b) = a a - b b, for numbers whose products do not fit a double.
  const double a = 1.0 / 3.0, b = 1e-9 / 7.0;
  const Expansion left = (Expansion(a) + Expansion(b)) * (Expansion(a) - Expansion(b));
  const Expansion right = Expansion::product(a, a) - Expansion::product(b, b);
  CHECK((left - right).sign() == 0);
  CHECK((left - right - Expansion(1e-300)).sign() == -1);
  CHECK(Expansion::difference(1.0, 1e-40).sign() == 1);
  CHECK((Expansion::difference(1.0, 1e-40) - one).estimate() == -1e-40);
  CHECK(Expansion().sign() == 0);
}

TEST_CASE("orientation: points in a plane but for the last bit are told apart") {
  // Multiples of 2^-20 in the plane x + y + z = 3: exactly in it, however they are combined.
  core::Random random(1, 2);
  const auto point = [&] {
    const double x = std::floor(random.uniform() * 1048576.0) / 1048576.0;
    const double y = std::floor(random.uniform() * 1048576.0) / 1048576.0;
    return Vec3(x, y, 3.0 - x - y);
  };
  for (int i = 0; i < 1000; ++i) {
    const Vec3 a = point(), b = point(), c = point(), d = point();
    CHECK(orientation(a, b, c, d) == 0);
    const double turn = (b - a).cross(c - a).sum();
    if (turn == 0.0) continue;
    const int up = turn > 0.0 ? 1 : -1;
    CHECK(orientation(a, b, c, Vec3(d.x(), d.y(), std::nextafter(d.z(), 10.0))) == up);
    CHECK(orientation(a, b, c, Vec3(d.x(), d.y(), std::nextafter(d.z(), -10.0))) == -up);
    const Vec3 e(d.x(), d.y(), d.z() + 4.440892098500626e-16 * 4.0);
    CHECK(oriented_volume(a, b, c, e) ==
          Approx(turn / 3.0 * 1.7763568394002505e-15).epsilon(1e-9).margin(1e-30));
  }
}

TEST_CASE("orientation: an edge through a vertex of a closed surface passes exactly one of its triangles") {
  // An octahedron about the origin; edges from its middle out, through its vertices, sides and faces.
  std::vector<Corners> octahedron;
  for (int i = 0; i < 8; ++i) {
    const Vec3 x(i & 1 ? -1 : 1, 0, 0), y(0, i & 2 ? -1 : 1, 0), z(0, 0, i & 4 ? -1 : 1);
    const bool is_odd = ((i & 1) + ((i >> 1) & 1) + ((i >> 2) & 1)) % 2 == 1;
    octahedron.push_back(is_odd ? Corners{x, z, y} : Corners{x, y, z});
  }
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z) {
        if (std::abs(x) + std::abs(y) + std::abs(z) < 2) continue;
        int out = 0, in = 0, there_and_back = 0;
        const Vec3 end(x, y, z);
        for (const Corners& t : octahedron) {
          const int passage = passage_of_edge(Vec3::Zero(), end, t);
          out += passage > 0;
          in += passage < 0;
          there_and_back += passage + passage_of_edge(end, Vec3::Zero(), t);
        }
        CHECK(out == 1);
        CHECK(in == 0);
        CHECK(there_and_back == 0);
      }
}

TEST_CASE("orientation: an edge of the surface and the face it passes agree with random points") {
  core::Random random(3, 4);
  int count = 0;
  for (int i = 0; i < 2000; ++i) {
    const Corners face{draw(random), draw(random), draw(random)};
    const Vec3 p = draw(random), q = draw(random);
    const int passage = passage_of_surface_edge(p, q, face);
    CHECK(passage == -passage_of_surface_edge(q, p, face));
    CHECK(passage == passage_of_edge(p, q, face));  // nothing touches: the rule does not matter
    count += passage != 0;
    const Vec3 n = (face[1] - face[0]).cross(face[2] - face[0]);
    if (passage != 0) CHECK(n.dot(q - p) * passage > 0.0);
  }
  CHECK(count > 50);
}

TEST_CASE("orientation: which triangle is passed first, even in one place") {
  const Vec3 a(0, 0, -1), b(0, 0, 1);
  const auto wedge = [](double height, double slope) {  // z = height + slope (x - y)
    return Corners{Vec3(1, 0, height + slope), Vec3(0, 1, height - slope), Vec3(-1, -1, height)};
  };
  CHECK(is_passed_before(a, b, wedge(0.0, 0.3), wedge(1e-3, -0.2)));
  CHECK_FALSE(is_passed_before(b, a, wedge(0.0, 0.3), wedge(1e-3, -0.2)));
  CHECK(is_passed_before(a, b, wedge(1e-19, 0.0), wedge(2e-19, 0.0)));
  // In one place: the surface moved by (e, e^2, e^3) has z = slope (x - y - e ...) there.
  CHECK(is_passed_before(a, b, wedge(0.0, 0.5), wedge(0.0, 0.25)));
  CHECK_FALSE(is_passed_before(a, b, wedge(0.0, 0.25), wedge(0.0, 0.5)));
  CHECK(is_passed_before(b, a, wedge(0.0, 0.25), wedge(0.0, 0.5)));
  CHECK_FALSE(is_passed_before(a, b, wedge(0.0, 0.5), wedge(0.0, 0.5)));
}
