#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/core/elementary.h"
#include "engine/geometry/closest_points.h"
#include "engine/geometry/edge_topology.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/mesh_diagnosis.h"
#include "engine/geometry/tetrahedralise.h"
#include "tests/engine/geometry/closed_surfaces.h"

using namespace shatterbox;
using namespace shatterbox::geometry;

namespace {

/// pi times the integral of r^2 dy along a parabola (or, with the control in the middle, a line): a
/// polynomial of degree 5, by Gauss' rule of three points.
double swept(const Vec2& a, const Vec2& control, const Vec2& b) {
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double t = 0.5 + 0.5 * (k - 1) * core::sqrt(0.6);
    const Vec2 p = (1 - t) * (1 - t) * a + 2 * t * (1 - t) * control + t * t * b;
    const Vec2 d = 2 * (1 - t) * (control - a) + 2 * t * (b - control);
    sum += (k == 1 ? 8.0 : 5.0) / 18.0 * p.x() * p.x() * d.y();
  }
  return core::kPi * sum;
}

double swept_line(const Vec2& a, const Vec2& b) {
  return swept(a, 0.5 * (a + b), b);
}

/// Upright at both ends, as vases and bottles have it.
double swept_shoulder(const Vec2& a, const Vec2& b) {
  const Vec2 middle = 0.5 * (a + b);
  return swept(a, {a.x(), 0.75 * a.y() + 0.25 * b.y()}, middle) +
         swept(middle, {b.x(), 0.25 * a.y() + 0.75 * b.y()}, b);
}

/// Half a torus' section above the rim, by Pappus.
double lip(double radius, double wall) {
  return 2.0 * core::kPi * (radius - 0.5 * wall) * 0.5 * core::kPi * 0.25 * wall * wall;
}

double vase_volume(const VaseSizes& s) {
  const double top = s.height - 0.5 * s.wall;
  const auto side = [&](double low, double inset) {
    const Vec2 foot(s.foot_radius - inset, low), belly(s.belly_radius - inset, 0.33 * top),
        neck(s.neck_radius - inset, 0.8 * top), rim(s.rim_radius - inset, top);
    return swept(foot, {belly.x(), 0.15 * top}, belly) + swept_shoulder(belly, neck) +
           swept(neck, {neck.x(), 0.92 * top}, rim);
  };
  return side(0.0, 0.0) - side(s.wall, s.wall) + lip(s.rim_radius, s.wall);
}

double bottle_volume(const BottleSizes& s) {
  const double top = s.height - 0.5 * s.wall, end = s.height - s.neck_length,
               begin = end - 1.5 * (s.radius - s.neck_radius), edge = 1.5 * s.wall;
  const auto side = [&](double low, double inset) {
    const double r = s.radius - inset, n = s.neck_radius - inset;
    return swept_line({r, low}, {r, begin}) + swept_shoulder({r, begin}, {n, end}) +
           swept_line({n, end}, {n, top});
  };
  // The rounded edge: a cylinder, and a quarter of a disc about it, by Pappus.
  const double inner = s.radius - edge;
  const double bottom = core::kPi * inner * inner * edge + 2.0 * core::kPi *
                                                               (inner + 4.0 * edge / (3.0 * core::kPi)) *
                                                               0.25 * core::kPi * edge * edge;
  return bottom + side(edge, 0.0) - side(2.0 * s.wall, s.wall) + lip(s.neck_radius, s.wall);
}

/// Sound, and its volume tends to the exact one like the square of the edge length.
template <class Make>
void check(const Make& make, double volume, double edge_length) {
  double coarse_error = 0.0;
  for (const double h : {edge_length, 0.5 * edge_length}) {
    const TriangleMesh mesh = make(h);
    const MendedMesh mended = mend_solid(mesh);
    INFO(mended.diagnosis.sentences(Severity::refused) + mended.diagnosis.sentences(Severity::mended));
    CHECK(mended.diagnosis.findings.empty());
    CHECK(mended.diagnosis.is_closed);
    const double error = std::abs(enclosed_volume(mesh) / volume - 1.0);
    CHECK(error < (h == edge_length ? 0.02 : 0.4 * coarse_error));
    coarse_error = error;
  }
}

}  // namespace

TEST_CASE("vase, bottle and egg: closed, facing outwards, of the exact volume") {
  check([](double h) { return make_vase({}, fine(h)).value(); }, vase_volume({}), 0.006);
  check([](double h) { return make_bottle({}, fine(h)).value(); }, bottle_volume({}), 0.004);
  const EggSizes egg;
  check([&](double h) { return make_egg(egg, fine(h)).value(); },
        2.0 / 3.0 * core::kPi * egg.radius * egg.radius * (egg.blunt_height + egg.pointed_height), 0.004);
}

TEST_CASE("vase and bottle: too coarse an edge length does not push the wall through itself") {
  CHECK(mend_solid(make_vase({}, fine(0.1)).value()).diagnosis.findings.empty());
  CHECK(mend_solid(make_bottle({}, fine(0.1)).value()).diagnosis.findings.empty());
}

TEST_CASE("lathe: closed, facing outwards, of the exact volume, whichever way the profile goes") {
  LatheSizes column;
  column.is_closed = true;
  column.profile = {{0.05, 0.0}, {0.05, 0.03}, {0.035, 0.04}, {0.028, 0.3}, {0.045, 0.34}};
  double volume = 0.0;
  for (std::size_t i = 1; i < column.profile.size(); ++i)
    volume += swept_line(column.profile[i - 1], column.profile[i]);
  check([&](double h) { return make_lathe(column, fine(h)).value(); }, volume, 0.01);
  std::reverse(column.profile.begin(), column.profile.end());
  check([&](double h) { return make_lathe(column, fine(h)).value(); }, volume, 0.01);

  // By Pappus; and the same with its corners rounded, each by a parabola that cuts off a 24th of the square.
  LatheSizes ring;
  ring.is_closed = true;
  ring.profile = {{0.06, 0.0}, {0.1, 0.0}, {0.1, 0.04}, {0.06, 0.04}, {0.06, 0.0}};
  const double around = 2.0 * core::kPi * 0.08, side = 0.04;
  check([&](double h) { return make_lathe(ring, fine(h)).value(); }, around * side * side, 0.006);
  ring.is_smooth = true;
  check([&](double h) { return make_lathe(ring, fine(h)).value(); },
        around * side * side * (1.0 - 4.0 / 24.0), 0.006);

  // From the axis and to it, smooth: its ends are where the points are, along the lines there.
  LatheSizes drop;
  drop.is_closed = drop.is_smooth = true;
  drop.profile = {{0.0, 0.0}, {0.05, 0.0}, {0.05, 0.08}, {0.0, 0.12}};
  check([&](double h) { return make_lathe(drop, fine(h)).value(); },
        swept({0.0, 0.0}, {0.05, 0.0}, {0.05, 0.04}) + swept({0.05, 0.04}, {0.05, 0.08}, {0.0, 0.12}), 0.01);
}

TEST_CASE("lathe: a thin wall is not pushed through itself, and a sheet stays open") {
  LatheSizes pipe;
  pipe.is_closed = true;
  pipe.profile = {{0.047, 0.0}, {0.05, 0.0}, {0.05, 0.2}, {0.047, 0.2}, {0.047, 0.0}};
  const TriangleMesh wall = make_lathe(pipe, fine(0.1)).value();
  CHECK(mend_solid(wall).diagnosis.findings.empty());
  LatheSizes cup;
  cup.profile = {{0.0, 0.0}, {0.03, 0.0}, {0.04, 0.1}};
  const TriangleMesh sheet = make_lathe(cup, fine(0.005)).value();
  const EdgeTopology topology = build_edge_topology(sheet.triangles);
  double border = 0.0;
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    if (!topology.is_boundary(static_cast<int>(e))) continue;
    for (const int v : topology.edges[e])
      CHECK(sheet.positions[static_cast<std::size_t>(v)].y() == Approx(0.1).epsilon(1e-12));
    border += 1.0;
  }
  CHECK(border > 20.0);
}

TEST_CASE("lathe: profiles that make no sense are refused with a sentence") {
  const auto fault = [](std::vector<Vec2> points) {
    LatheSizes sizes;
    sizes.profile = std::move(points);
    sizes.is_closed = true;
    const auto made = make_lathe(sizes, fine(0.01));
    return made ? std::string() : made.error();
  };
  CHECK(fault({{0.1, 0.0}}) == "a lathe's profile needs at least two points");
  CHECK(fault({{0.1, 0.0}, {-0.1, 0.1}}).find("point 2 of a lathe's profile is on the other side") == 0);
  CHECK(fault({{0.1, 0.0}, {0.0, 0.1}, {0.1, 0.2}}).find("point 2 of a lathe's profile is on the axis") == 0);
  CHECK(fault({{0.1, 0.0}, {0.1, 0.0}}) == "point 2 of a lathe's profile is where the one before it is");
  CHECK(fault({{0.0, 0.0}, {0.0, 1.0}}).find("no radius") != std::string::npos);
  CHECK(fault({{0.0, 0.0}, {0.1, 0.0}}).find("nothing inside") != std::string::npos);
  CHECK(fault({{0.1, 0.0}, {0.2, 0.1}, {0.1, 0.1}, {0.2, 0.0}}) ==
        "a lathe's profile meets itself: its lines from point 1 and from point 3");
  CHECK(fault({{0.1, 0.0}, {0.1, 0.2}, {0.1, 0.1}}).find("meets itself") != std::string::npos);
  CHECK(fault({{0.1, 0.0}, {0.1, 0.1}, {0.2, 0.2}}).empty());
  CHECK(fault({{0.1, 0.0}, {0.10001, 0.0}, {0.10001, 1.0}, {0.1, 1.0}, {0.1, 0.0}})
            .find("a lathe's wall of 1e-05 m would need more than 4000000 triangles: make it thicker") == 0);
}

TEST_CASE("vase, bottle and egg: sizes that make no sense are refused with a sentence") {
  VaseSizes vase;
  vase.wall = 0.03;
  CHECK(make_vase(vase, fine(0.01)).error().find("must be greater") != std::string::npos);
  BottleSizes bottle;
  bottle.height = 0.1;
  CHECK(make_bottle(bottle, fine(0.01)).error().find("height") != std::string::npos);
  EggSizes egg;
  egg.radius = -1.0;
  CHECK_FALSE(make_egg(egg, fine(0.01)));
}

TEST_CASE("vase and bottle: walls thinner than the elements are solids too") {
  TetrahedraOptions options;
  options.element_size = 0.008;
  for (const TriangleMesh& mesh :
       {make_vase({}, fine(0.008)).value(), make_bottle({}, fine(0.006)).value()}) {
    const EmbeddedSolid solid = tetrahedralise(mesh, options).value();
    double sum = 0.0;
    for (const double v : solid.embedded.volumes) sum += v;
    CHECK(sum == Approx(enclosed_volume(mesh)).epsilon(1e-12));
  }
}

TEST_CASE("solid diagnosis: what is open, inside out or passes through itself, with the place") {
  const TriangleMesh box = make_box_surface({1.0, 0.5, 0.25});
  CHECK(mend_solid(box).diagnosis.findings.empty());

  TriangleMesh open = box;
  open.triangles.erase(open.triangles.begin() + 3);
  const MendedMesh refused = mend_solid(open);
  CHECK(refused.mesh.triangles.empty());
  REQUIRE(refused.diagnosis.find(MeshFault::open_border));
  CHECK(refused.diagnosis.find(MeshFault::open_border)->count == 3);
  CHECK(refused.diagnosis.refused());

  TriangleMesh turned = box;
  for (Triangle& t : turned.triangles) std::swap(t[1], t[2]);
  CHECK(enclosed_volume(mend_solid(turned).mesh) == Approx(1.0));

  // Two that pass through each other, by a corner.
  TriangleMesh crossing = box;
  TriangleMesh other = box;
  for (Vec3& p : other.positions) p += Vec3(1.9, 0.93, 0.41);
  append(crossing, other);
  const MendedMesh crossed = mend_solid(crossing);
  const MeshFinding* finding = crossed.diagnosis.find(MeshFault::self_crossing);
  REQUIRE(finding);
  CHECK(crossed.mesh.triangles.empty());
  // The place is on both boxes' surfaces, within their common corner.
  CHECK((finding->place - Vec3(0.95, 0.465, 0.205)).cwiseAbs().maxCoeff() < 0.06);
  CHECK(finding->sentence.find("triangle") != std::string::npos);

  // A vertex pushed through the opposite side.
  TriangleMesh pushed = make_sphere(1.0, fine(0.3)).value();
  pushed.positions[5] *= -1.5;
  CHECK(mend_solid(pushed).diagnosis.find(MeshFault::self_crossing));
}

TEST_CASE("solid diagnosis: hollows face into themselves, what is in them faces out again") {
  TriangleMesh onion;
  for (const double size : {1.0, 0.7, 0.4}) {
    append(onion, make_box_surface(Vec3::Constant(size)));
    if (size == 0.4)  // inside out
      for (std::size_t t = onion.triangles.size() - 12; t < onion.triangles.size(); ++t)
        std::swap(onion.triangles[t][1], onion.triangles[t][2]);
  }
  const MendedMesh mended = mend_solid(onion);
  REQUIRE(mended.diagnosis.find(MeshFault::mixed_winding));
  CHECK(mended.diagnosis.find(MeshFault::mixed_winding)->count == 2);
  CHECK(enclosed_volume(mended.mesh) == Approx(8.0 - 8.0 * 0.343 + 8.0 * 0.064));
  // Side by side, both face out.
  TriangleMesh two = make_box_surface(Vec3::Ones());
  TriangleMesh other = two;
  for (Vec3& p : other.positions) p.x() += 3.0;
  for (Triangle& t : other.triangles) std::swap(t[1], t[2]);
  append(two, other);
  CHECK(enclosed_volume(mend_solid(two).mesh) == Approx(16.0));
}
TEST_CASE("the figure is one closed surface of the height and about the edges asked for") {
  for (const double edge : {0.0125, 0.01}) {
    const TriangleMesh figure = make_figure(1.0, fine(edge)).value();
    const EdgeTopology topology = build_edge_topology(figure.triangles);
    double mean = 0.0;
    for (const auto& [a, b] : topology.edges)
      mean += (figure.positions[static_cast<std::size_t>(a)] - figure.positions[static_cast<std::size_t>(b)])
                  .norm() /
              static_cast<double>(topology.edges.size());
    CAPTURE(edge, mean, figure.triangles.size(), least_angle(figure));
    CHECK(mean == Approx(edge).epsilon(0.15));
    CHECK(least_angle(figure) > 0.1);
    CHECK(static_cast<int>(figure.positions.size()) - static_cast<int>(topology.edges.size()) +
              static_cast<int>(figure.triangles.size()) ==
          2);
    CHECK(mend_solid(figure).diagnosis.findings.empty());
    double low = 1.0, high = 0.0;
    for (const Vec3& p : figure.positions) {
      low = std::min(low, p.y());
      high = std::max(high, p.y());
    }
    CHECK(low == Approx(0.0).margin(1e-12));
    CHECK(high == Approx(1.0));
  }
  CHECK_FALSE(make_figure(0.0, fine(0.1)));
  CHECK_FALSE(make_figure(1.0, fine(1e-4)));
}

TEST_CASE("sheets of bottles and vases are open at their mouths only") {
  struct Vessel {
    TriangleMesh sheet;
    double height, mouth_radius;
  };
  for (const Vessel& vessel :
       {Vessel{make_bottle_sheet({}, fine(0.006)).value(), BottleSizes{}.height - 0.5 * BottleSizes{}.wall,
               BottleSizes{}.neck_radius},
        Vessel{make_vase_sheet({}, fine(0.008)).value(), VaseSizes{}.height, VaseSizes{}.rim_radius}}) {
    const EdgeTopology topology = build_edge_topology(vessel.sheet.triangles);
    int border = 0;
    double mouth = 0.0;
    for (std::size_t e = 0; e < topology.edges.size(); ++e) {
      if (!topology.is_boundary(static_cast<int>(e))) continue;
      const auto [a, b] = topology.edges[e];
      const Vec3 &p = vessel.sheet.positions[static_cast<std::size_t>(a)],
                 &q = vessel.sheet.positions[static_cast<std::size_t>(b)];
      mouth += (p - q).norm();
      CHECK(p.y() == Approx(vessel.height));
      ++border;
    }
    CHECK(border > 5);
    CHECK(mouth == Approx(2.0 * core::kPi * vessel.mouth_radius).epsilon(0.05));
  }
}

TEST_CASE("a vase's sheet lies on the outside of the solid's wall") {
  const TriangleMesh sheet = make_vase_sheet({}, fine(0.02)).value(),
                     solid = make_vase({}, fine(0.01)).value();
  for (const Vec3& p : sheet.positions) {
    double nearest = 1e300;
    for (const Triangle& t : solid.triangles)
      nearest = std::min(nearest, closest_on_triangle(p, solid.positions[static_cast<std::size_t>(t[0])],
                                                      solid.positions[static_cast<std::size_t>(t[1])],
                                                      solid.positions[static_cast<std::size_t>(t[2])])
                                      .distance);
    CHECK(nearest < 0.6 * VaseSizes{}.wall);  // which is round at the rim
  }
  VaseSizes thin;
  thin.belly_radius = 0.01;
  CHECK_FALSE(make_vase_sheet(thin, fine(0.02)));
}
