// Cutting and splitting lose nothing: areas, masses, centres, inertias and momenta of the pieces sum to the
// whole.
#include "engine/fracture/split_shell.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>

#include "engine/geometry/closest_points.h"
#include "engine/geometry/crossings.h"
#include "engine/geometry/shell_surface.h"
#include "engine/geometry/standing_surface.h"
#include "tests/engine/fracture/shapes.h"

using namespace shatterbox;
using geometry::SideKind;

namespace {

/// Cuts every element of a pane along the line x = place; the cells' cuts meet on the edges.
geometry::ShellMesh cut_straight(const std::shared_ptr<const geometry::ShellElements>& elements,
                                 double place) {
  fracture::ShellCutter cutter(geometry::make_shell_mesh(elements));
  const int count = cutter.cell_count();
  for (int c = 0; c < count; ++c) {
    const auto& triangle = elements->mesh.triangles[static_cast<std::size_t>(c)];
    std::vector<fracture::BorderPlace> places;
    for (int s = 0; s < 3; ++s) {
      const int a = triangle[static_cast<std::size_t>(s)];
      const int b = triangle[(static_cast<std::size_t>(s) + 1) % 3];
      const double low = elements->mesh.positions[static_cast<std::size_t>(std::min(a, b))].x() - place;
      const double high = elements->mesh.positions[static_cast<std::size_t>(std::max(a, b))].x() - place;
      if ((low < 0.0) == (high < 0.0)) continue;
      const double q = geometry::round_edge_parameter(low / (low - high));
      places.push_back({s, false, geometry::barycentric_on_edge(*elements, c, s, q)});
    }
    if (places.size() == 2) cutter.cut(c, places[0], places[1], SideKind::crack, cutter.new_side_id());
  }
  return cutter.mesh();
}

void check_sums(const geometry::ShellMesh& whole, const std::vector<geometry::ShellMesh>& pieces) {
  const auto all = geometry::shell_mass_properties(whole, 2e-3, 2500.0);
  std::vector<geometry::MassProperties> parts;
  double area = 0.0;
  const Vec3 velocity(1.0, -2.0, 0.5), spin(3.0, 1.0, -2.0);
  Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
  for (const auto& piece : pieces) {
    parts.push_back(geometry::shell_mass_properties(piece, 2e-3, 2500.0));
    const auto& p = parts.back();
    const Vec3 v = velocity + spin.cross(p.centre - all.centre);
    momentum += p.mass * v;
    angular += (p.centre - all.centre).cross(p.mass * v) + p.inertia * spin;
    area += total_area(piece);
  }
  const auto sum = geometry::combined(parts);
  CHECK(std::abs(area / total_area(whole) - 1.0) < 1e-12);
  CHECK(std::abs(sum.mass / all.mass - 1.0) < 1e-12);
  CHECK((sum.centre - all.centre).norm() < 1e-12);
  CHECK((sum.inertia - all.inertia).norm() < 1e-12 * all.inertia.norm());
  CHECK((momentum - all.mass * velocity).norm() < 1e-12 * all.mass * velocity.norm());
  CHECK((angular - all.inertia * spin).norm() < 1e-11 * (all.inertia * spin).norm());
}

/// Both faces of every cut have the same length.
void check_twins(const geometry::ShellMesh& mesh) {
  std::map<int, std::vector<Vec3>> faces;
  double longest = 0.0;
  for (const auto& cell : mesh.cells)
    for (int s = 0; s < cell.corner_count; ++s) {
      const auto& corner = mesh.corners[static_cast<std::size_t>(cell.first_corner + s)];
      if (corner.side != SideKind::crack) continue;
      const auto& next =
          mesh.corners[static_cast<std::size_t>(cell.first_corner + (s + 1) % cell.corner_count)];
      faces[corner.side_id].push_back(position_in_element(*mesh.elements, cell.element, next.barycentric) -
                                      position_in_element(*mesh.elements, cell.element, corner.barycentric));
      longest = std::max(longest, faces[corner.side_id].back().norm());
    }
  for (const auto& [id, sides] : faces) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& side : sides) sum += side;
    CHECK(sides.size() >= 2);
    CHECK(sum.norm() < 1e-12 * longest);
  }
}

/// How far a piece's surface leaves its elements: out of their planes, and (`beyond`) over their edges.
struct Stray {
  double out_of_plane = 0.0, beyond = 0.0;  // m; share of an element
};

Stray find_stray(const geometry::ShellMesh& piece, const geometry::ShellSurface& surface) {
  Stray worst;
  for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
    const int element = piece.cells[static_cast<std::size_t>(surface.triangle_cells[t])].element;
    const Vec3 corner = position_in_element(*piece.elements, element, Vec2::Zero());
    const Vec3 ab = position_in_element(*piece.elements, element, Vec2(1.0, 0.0)) - corner;
    const Vec3 ac = position_in_element(*piece.elements, element, Vec2(0.0, 1.0)) - corner;
    const Vec3 normal = ab.cross(ac);
    for (const int v : surface.mesh.triangles[t]) {
      const Vec3 p = surface.mesh.positions[static_cast<std::size_t>(v)] - corner;
      worst.out_of_plane = std::max(worst.out_of_plane, std::abs(normal.normalized().dot(p)));
      const double b = p.cross(ac).dot(normal) / normal.squaredNorm();
      const double c = ab.cross(p).dot(normal) / normal.squaredNorm();
      worst.beyond = std::max({worst.beyond, -b, -c, b + c - 1.0});
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("a straight cut over a plate gives two pieces of the right areas") {
  const auto elements = test::make_pane(1.0, 0.1);
  const geometry::ShellMesh mesh = cut_straight(elements, 0.1234);
  const auto split = fracture::split_shell(mesh);
  REQUIRE(split.pieces.size() == 2);
  CHECK(total_area(split.pieces[0]) == Approx(0.6234).epsilon(1e-10));
  CHECK(total_area(split.pieces[1]) == Approx(0.3766).epsilon(1e-10));
  check_sums(mesh, split.pieces);
  check_twins(mesh);

  // The surface is one welded sheet a piece, that stands back by the kerf: its border has one loop of edges.
  for (const auto& piece : split.pieces) {
    const auto surface = geometry::extract_surface(piece, 1e-3);
    double area = 0.0;
    for (const auto& t : surface.mesh.triangles) {
      const auto& x = surface.mesh.positions;
      area += 0.5 * (x[static_cast<std::size_t>(t[1])] - x[static_cast<std::size_t>(t[0])])
                        .cross(x[static_cast<std::size_t>(t[2])] - x[static_cast<std::size_t>(t[0])])
                        .z();
    }
    CHECK(area == Approx(total_area(piece) - 1e-3).epsilon(2e-4));
    const auto topology = geometry::build_edge_topology(surface.mesh.triangles);
    const auto v = static_cast<long>(surface.mesh.positions.size());
    const auto e = static_cast<long>(topology.edges.size());
    const auto f = static_cast<long>(surface.mesh.triangles.size());
    CHECK(v - e + f == 1);  // a disc
  }
}

TEST_CASE("nothing is lost over hundreds of random cuts") {
  for (const bool is_closed : {false, true}) {
    const auto elements = is_closed ? test::make_sphere(0.04, 0.012) : test::make_pane(0.1, 0.02);
    const geometry::ShellMesh whole = geometry::make_shell_mesh(elements);
    fracture::ShellCutter cutter(whole);
    core::Random random(17, is_closed);
    int cuts = 0;
    for (int i = 0; i < 1200; ++i) cuts += test::cut_at_random(cutter, random);
    REQUIRE(cuts > 400);
    const geometry::ShellMesh mesh = cutter.mesh();
    for (const auto& cell : mesh.cells) CHECK(area_fraction(mesh, cell) >= 1e-6);
    check_twins(mesh);
    const auto split = fracture::split_shell(mesh);
    CHECK(split.pieces.size() > 20);
    check_sums(whole, split.pieces);
    std::size_t cells = 0;
    std::vector<geometry::TriangleMesh> surfaces;
    for (const auto& piece : split.pieces) {
      cells += piece.cells.size();
      CHECK(fracture::split_shell(piece).pieces.size() == 1);
      const auto surface = geometry::extract_surface(piece, 1e-5);
      CHECK(surface.mesh.triangles.size() >= piece.cells.size());
      for (const Vec3& p : surface.mesh.positions) CHECK(p.allFinite());
      // What a piece meets at its birth, the whole had met: its surface is a part of the whole's.
      const Stray stray = find_stray(piece, surface);
      CHECK(stray.out_of_plane < 1e-12);
      if (is_closed) CHECK(stray.beyond < 1e-9);
      surfaces.push_back(surface.mesh);
    }
    CHECK(geometry::count_crossing_pairs(surfaces) == 0);
    CHECK(cells == mesh.cells.size());

    // Narrow pieces join a neighbour; all material stays.
    const auto merged = fracture::split_shell(mesh, {0.002});
    CHECK(merged.merged_count > 0);
    CHECK(merged.pieces.size() < split.pieces.size());
    check_sums(whole, merged.pieces);
  }
}

TEST_CASE("a surface without cuts is the mesh itself") {
  const auto elements = test::make_sphere(1.0, 0.3);
  const auto surface = geometry::extract_surface(geometry::make_shell_mesh(elements), 0.01);
  CHECK(surface.mesh.positions.size() == elements->mesh.positions.size());
  CHECK(surface.mesh.triangles.size() == elements->mesh.triangles.size());
  const auto topology = geometry::build_edge_topology(surface.mesh.triangles);
  CHECK(topology.edges.size() == elements->topology.edges.size());
  CHECK(surface.least_kerf == 0.01);
}

namespace {

/// One whole element in the middle of a pane is cut from edge to edge: two tips, one slit. Its number.
int cut_slit(fracture::ShellCutter& cutter) {
  const geometry::ShellElements& elements = cutter.elements();
  int middle = 0;
  for (int t = 0; t < cutter.cell_count(); ++t)
    if (position_in_element(elements, t, Vec2(0.3, 0.3)).norm() <
        position_in_element(elements, middle, Vec2(0.3, 0.3)).norm())
      middle = t;
  const fracture::BorderPlace a{0, false, geometry::barycentric_on_edge(elements, middle, 0, 0.5)};
  const fracture::BorderPlace b{1, false, geometry::barycentric_on_edge(elements, middle, 1, 0.25)};
  REQUIRE(cutter.cut(middle, a, b, SideKind::crack, cutter.new_side_id()));
  return middle;
}

}  // namespace

TEST_CASE("a crack that ends inside is a slit whose lips meet at the tip") {
  const auto elements = test::make_pane(1.0, 0.2);
  fracture::ShellCutter cutter(geometry::make_shell_mesh(elements));
  cut_slit(cutter);
  const auto split = fracture::split_shell(cutter.mesh());
  REQUIRE(split.pieces.size() == 1);
  const auto surface = geometry::extract_surface(split.pieces[0], 1e-3);
  const auto topology = geometry::build_edge_topology(surface.mesh.triangles);
  // Both lips share both tips, so the slit has no width; every edge that is not on the rim has two triangles.
  const auto v = static_cast<long>(surface.mesh.positions.size());
  const auto e = static_cast<long>(topology.edges.size());
  const auto f = static_cast<long>(surface.mesh.triangles.size());
  CHECK(v - e + f == 1);
  CHECK(v == static_cast<long>(elements->mesh.positions.size()) + 2);
}

namespace {

/// Where a surface is, in material space.
double distance_to(const geometry::TriangleMesh& mesh, const Vec3& point) {
  double nearest = 1e300;
  for (const auto& t : mesh.triangles) {
    const auto corner = [&](std::size_t i) -> const Vec3& {
      return mesh.positions[static_cast<std::size_t>(t[i])];
    };
    nearest =
        std::min(nearest, geometry::closest_on_triangle(point, corner(0), corner(1), corner(2)).distance);
  }
  return nearest;
}

}  // namespace

TEST_CASE("a piece of a piece stays within the surface of the piece and keeps its own kerf") {
  constexpr double kKerf = 1e-5, kStraight = 0.05 * kKerf;
  for (const bool is_closed : {false, true}) {
    const auto elements = is_closed ? test::make_sphere(0.04, 0.02) : test::make_pane(0.1, 0.03);
    core::Random random(29, is_closed);
    fracture::ShellCutter cutter(geometry::make_shell_mesh(elements));
    for (int i = 0; i < 300; ++i) test::cut_at_random(cutter, random);
    int children = 0, outside = 0, flipped = 0;
    long crossing = 0;
    for (const geometry::ShellMesh& piece : fracture::split_shell(cutter.mesh()).pieces) {
      const auto stood = geometry::extract_surface(piece, kKerf);
      const geometry::StandingSurface standing(piece, stood.mesh.positions);
      fracture::ShellCutter again(piece);
      for (int i = 0; i < 20; ++i) test::cut_at_random(again, random);
      std::vector<geometry::TriangleMesh> born;
      for (const geometry::ShellMesh& child : fracture::split_shell(again.mesh()).pieces) {
        const geometry::ShellMesh divided = geometry::divide_at_bends(child, standing, kStraight);
        const auto surface = geometry::extract_surface(divided, kKerf, &standing);
        for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
          std::array<Vec3, 3> x;
          for (std::size_t i = 0; i < 3; ++i)
            x[i] = surface.mesh.positions[static_cast<std::size_t>(surface.mesh.triangles[t][i])];
          const auto cell = static_cast<std::size_t>(surface.triangle_cells[t]);
          const Vec3 normal = facet_frame(*elements, child.cells[cell].element).col(2);
          flipped += (x[1] - x[0]).cross(x[2] - x[0]).dot(normal) <= 0.0;
          for (std::size_t i = 0; i < 3; ++i)
            for (const double share : {0.0, 0.5})
              outside += distance_to(stood.mesh, x[i] + share * (x[(i + 1) % 3] - x[i])) > 1e-6 * kKerf;
        }
        born.push_back(surface.mesh);
        ++children;
      }
      crossing += geometry::count_crossing_pairs(born);
    }
    CHECK(children > 150);
    CHECK(outside == 0);
    CHECK(flipped == 0);
    CHECK(crossing == 0);
  }
}

namespace {

/// m, between two surfaces that do not cross, or more than `reach`.
double gap_between(const geometry::TriangleMesh& a, const geometry::TriangleMesh& b, double reach) {
  const auto corner = [](const geometry::TriangleMesh& mesh, std::size_t t, std::size_t i) -> const Vec3& {
    return mesh.positions[static_cast<std::size_t>(mesh.triangles[t][i % 3])];
  };
  double least = 1e300;
  for (std::size_t t = 0; t < a.triangles.size(); ++t)
    for (std::size_t u = 0; u < b.triangles.size(); ++u) {
      Eigen::AlignedBox3d box_t, box_u;
      for (std::size_t i = 0; i < 3; ++i) {
        box_t.extend(corner(a, t, i));
        box_u.extend(corner(b, u, i));
      }
      if (box_t.squaredExteriorDistance(box_u) > reach * reach) continue;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
          const auto between = geometry::closest_between_segments(corner(a, t, i), corner(a, t, i + 1),
                                                                  corner(b, u, j), corner(b, u, j + 1));
          least = std::min(least, between.distance);
        }
    }
  return least;
}

/// An element of which all sides are rim, with corners (0, 0), (1, 0) and (0, 1) m.
std::shared_ptr<const geometry::ShellElements> make_single_element() {
  geometry::TriangleMesh mesh;
  mesh.positions = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  mesh.triangles = {{0, 1, 2}};
  return test::make_elements(std::move(mesh));
}

/// A place on a side of a cell, a share of it from its begin.
fracture::BorderPlace on_side(const fracture::ShellCutter& cutter, int cell, int side, double share) {
  const auto& polygon = cutter.cell(cell).polygon;
  const Vec2 from = polygon[static_cast<std::size_t>(side)].barycentric,
             to = polygon[(static_cast<std::size_t>(side) + 1) % polygon.size()].barycentric;
  return {side, false, from + share * (to - from)};
}

fracture::BorderPlace on_corner(const fracture::ShellCutter& cutter, int cell, int corner) {
  return {corner, true, cutter.cell(cell).polygon[static_cast<std::size_t>(corner)].barycentric};
}

Vec3 place_of_corner(const fracture::ShellCutter& cutter, int cell, std::size_t corner) {
  const auto& polygon = cutter.cell(cell).polygon;
  return position_in_element(cutter.elements(), cutter.cell(cell).element,
                             polygon[corner % polygon.size()].barycentric);
}

/// Of a flat mesh: the cell that holds a point, -1 if none does.
int cell_at(const fracture::ShellCutter& cutter, const Vec3& point) {
  for (int c = 0; c < cutter.cell_count(); ++c) {
    bool is_in = true;
    for (std::size_t i = 0; i < cutter.cell(c).polygon.size(); ++i) {
      const Vec3 from = place_of_corner(cutter, c, i);
      is_in = is_in && (place_of_corner(cutter, c, i + 1) - from).cross(point - from).z() > 0.0;
    }
    if (is_in) return c;
  }
  return -1;
}

/// The corner of a cell that is nearest to a point.
int corner_at(const fracture::ShellCutter& cutter, int cell, const Vec3& point) {
  std::size_t nearest = 0;
  const auto distance = [&](std::size_t k) { return (place_of_corner(cutter, cell, k) - point).norm(); };
  for (std::size_t k = 1; k < cutter.cell(cell).polygon.size(); ++k)
    if (distance(k) < distance(nearest)) nearest = k;
  return static_cast<int>(nearest);
}

}  // namespace

TEST_CASE("where a crack comes slantwise to the rim, its lips slide along the rim and not out over it") {
  constexpr double kKerf = 1e-3;
  fracture::ShellCutter cutter(geometry::make_shell_mesh(make_single_element()));
  REQUIRE(cutter.cut(0, on_side(cutter, 0, 0, 0.3), on_side(cutter, 0, 1, 0.3), SideKind::crack, 7));
  const auto pieces = fracture::split_shell(cutter.mesh()).pieces;
  REQUIRE(pieces.size() == 2);
  std::vector<geometry::TriangleMesh> born;
  for (const geometry::ShellMesh& piece : pieces) {
    born.push_back(geometry::extract_surface(piece, kKerf).mesh);
    for (const Vec3& p : born.back().positions) {
      CHECK(p.y() >= -1e-15);
      CHECK(p.x() >= -1e-15);
      CHECK(p.x() + p.y() <= 1.0 + 1e-15);
    }
  }
  const double gap = gap_between(born[0], born[1], 1.0);
  CHECK(gap > 1.8 * kKerf);
  CHECK(gap < 2.0 * kKerf);
}

TEST_CASE("a slit whose lips lie on each other stands back once something parts them") {
  constexpr double kKerf = 1e-3;
  const auto elements = test::make_pane(1.0, 0.2);
  fracture::ShellCutter cutter(geometry::make_shell_mesh(elements));
  const int middle = cut_slit(cutter);
  const geometry::ShellMesh whole = cutter.mesh();
  const geometry::StandingSurface standing(whole, geometry::extract_surface(whole, kKerf).mesh.positions);

  // From the middle of the slit through what lies between it and a corner of the element.
  fracture::ShellCutter again(whole);
  int beside = 0, slit = 0;
  for (int c = 0; c < again.cell_count(); ++c) {
    const auto& polygon = again.cell(c).polygon;
    for (std::size_t s = 0; s < polygon.size(); ++s)
      if (polygon.size() == 3 && polygon[s].side == SideKind::crack) {
        beside = c;
        slit = static_cast<int>(s);
      }
  }
  const fracture::BorderPlace start = on_side(again, beside, slit, 0.5);
  const Vec3 junction = position_in_element(*elements, middle, start.barycentric);
  const Vec3 tip = position_in_element(
      *elements, middle, again.cell(beside).polygon[static_cast<std::size_t>(slit)].barycentric);
  REQUIRE(again.cut(beside, start, on_corner(again, beside, (slit + 2) % 3), SideKind::crack,
                    again.new_side_id()));
  const auto surface = geometry::extract_surface(again.mesh(), kKerf, &standing);
  const Vec3 along = (junction - tip).normalized();
  int lips = 0;
  for (const Vec3& p : surface.mesh.positions) {
    if ((p - junction).norm() > 3.0 * kKerf) continue;
    ++lips;
    CHECK(along.cross(p - junction).norm() > 0.9 * kKerf);  // from the lip on the slit's other side
  }
  CHECK(lips == 2);
}

TEST_CASE("a narrow piece joins its neighbour over a new crack, not over one that stands open") {
  // An old crack along y = 0.5 to the diagonal of a square; new ones make a narrow piece above it, which has
  // two neighbours above, each with half of its border, and all of the old crack below.
  geometry::TriangleMesh square;
  square.positions = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {0.0, 1.0, 0.0}};
  square.triangles = {{0, 2, 3}, {0, 1, 2}};
  fracture::ShellCutter cutter(geometry::make_shell_mesh(test::make_elements(std::move(square))));
  constexpr int kOld = 100, kNew = 101, kAcross = 102;
  REQUIRE(cutter.cut(0, on_side(cutter, 0, 0, 0.5), on_side(cutter, 0, 2, 0.5), SideKind::crack, kOld));
  const geometry::ShellMesh whole = cutter.mesh();
  const Vec3 tip(0.5, 0.5, 0.0), rim(0.0, 0.5, 0.0);
  const int upper = cell_at(cutter, {0.1, 0.9, 0.0});
  REQUIRE(upper >= 0);
  // The rim's side begins above and ends at the old crack.
  const int last = corner_at(cutter, upper, rim);
  const int count = static_cast<int>(cutter.cell(upper).polygon.size());
  REQUIRE(cutter.cut(upper, on_side(cutter, upper, (last + count - 1) % count, 0.99),
                     on_corner(cutter, upper, corner_at(cutter, upper, tip)), SideKind::crack, kNew));
  const int above = cell_at(cutter, {0.1, 0.9, 0.0});
  const int face = corner_at(cutter, above, {0.0, 0.505, 0.0});
  REQUIRE(cutter.cell(above).polygon[static_cast<std::size_t>(face)].side == SideKind::crack);
  REQUIRE(cutter.cut(above, on_side(cutter, above, face, 0.5),
                     on_corner(cutter, above, corner_at(cutter, above, {0.0, 1.0, 0.0})), SideKind::crack,
                     kAcross));
  const geometry::ShellMesh mesh = cutter.mesh();
  const auto count_faces = [](const std::vector<geometry::ShellMesh>& pieces) {
    int faces = 0;
    for (const geometry::ShellMesh& piece : pieces)
      for (const auto& corner : piece.corners)
        faces += corner.side == SideKind::crack && corner.side_id == kOld;
    return faces;
  };
  const geometry::StandingSurface standing(whole, geometry::extract_surface(whole, 1e-3).mesh.positions);
  const auto split = fracture::split_shell(mesh, {0.01, &standing});
  CHECK(split.merged_count == 1);
  CHECK(count_faces(split.pieces) == 2);
  const auto unaware = fracture::split_shell(mesh, {0.01});
  CHECK(unaware.merged_count == 1);
  CHECK(count_faces(unaware.pieces) == 0);
}

TEST_CASE("a piece has its triangles where the whole stands folded over") {
  // A triangle less its tip; the surface of the whole stands so that the short side there runs backwards.
  geometry::TriangleMesh triangle;
  triangle.positions = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  triangle.triangles = {{0, 1, 2}};
  fracture::ShellCutter cutter(geometry::make_shell_mesh(test::make_elements(std::move(triangle))));
  REQUIRE(cutter.cut(0, on_side(cutter, 0, 0, 0.995), on_side(cutter, 0, 1, 0.005), SideKind::crack, 1));
  const geometry::ShellMesh piece = fracture::split_shell(cutter.mesh()).pieces.front();
  REQUIRE(piece.cells.size() == 1);
  REQUIRE(piece.cells.front().corner_count == 4);
  std::vector<Vec3> placed = geometry::extract_surface(piece, 0.0).mesh.positions;
  int moved = 0;
  for (Vec3& p : placed)
    if (p.x() > 0.9 && p.y() < 1e-9) {
      p.y() = 0.01;
      ++moved;
    }
  REQUIRE(moved == 1);
  const geometry::StandingSurface standing(piece, placed);
  const auto surface = geometry::extract_surface(piece, 1e-4, &standing);
  CHECK(surface.mesh.triangles.size() == 2);
  double area = 0.0;
  for (const auto& [a, b, c] : surface.mesh.triangles) {
    const auto& x = surface.mesh.positions;
    area += 0.5 * (x[static_cast<std::size_t>(b)] - x[static_cast<std::size_t>(a)])
                      .cross(x[static_cast<std::size_t>(c)] - x[static_cast<std::size_t>(a)])
                      .z();
  }
  CHECK(area == Approx(0.495).epsilon(0.01));
}

TEST_CASE("pieces of a piece that are wide enough are born apart") {
  constexpr double kKerf = 1e-5;
  int children = 0, touching = 0;
  for (const std::uint64_t seed : {13, 16, 29, 40})
    for (const bool is_closed : {false, true}) {
      core::Random random(seed, is_closed);
      fracture::ShellCutter cutter(
          geometry::make_shell_mesh(is_closed ? test::make_sphere(0.04, 0.02) : test::make_pane(0.1, 0.03)));
      for (int i = 0; i < 300; ++i) test::cut_at_random(cutter, random);
      for (const geometry::ShellMesh& piece : fracture::split_shell(cutter.mesh()).pieces) {
        const geometry::StandingSurface standing(piece,
                                                 geometry::extract_surface(piece, kKerf).mesh.positions);
        fracture::ShellCutter again(piece);
        for (int i = 0; i < 20; ++i) test::cut_at_random(again, random);
        std::vector<geometry::TriangleMesh> born;
        for (const auto& child : fracture::split_shell(again.mesh(), {10.0 * kKerf, &standing}).pieces) {
          const auto divided = geometry::divide_at_bends(child, standing, 0.05 * kKerf);
          const auto surface = geometry::extract_surface(divided, kKerf, &standing);
          for (const geometry::TriangleMesh& sibling : born)
            touching += gap_between(surface.mesh, sibling, kKerf) < 1e-6 * kKerf;
          born.push_back(surface.mesh);
          ++children;
        }
      }
    }
  CHECK(children > 500);
  CHECK(touching == 0);
}

TEST_CASE("a new crack in a piece is divided where the piece stands bent") {
  constexpr double kKerf = 1e-5, kStraight = 0.05 * kKerf;
  core::Random random(29, 0);
  fracture::ShellCutter cutter(geometry::make_shell_mesh(test::make_pane(0.1, 0.03)));
  for (int i = 0; i < 300; ++i) test::cut_at_random(cutter, random);
  int bends = 0;
  double worst = 0.0;
  for (const geometry::ShellMesh& piece : fracture::split_shell(cutter.mesh()).pieces) {
    const geometry::StandingSurface standing(piece, geometry::extract_surface(piece, kKerf).mesh.positions);
    fracture::ShellCutter again(piece);
    for (int i = 0; i < 20; ++i) test::cut_at_random(again, random);
    const geometry::ShellMesh divided = geometry::divide_at_bends(again.mesh(), standing, kStraight);
    bends += static_cast<int>(divided.corners.size() - again.mesh().corners.size());
    for (const geometry::ShellCell& cell : divided.cells) {
      const int stands = standing.cell_of(divided, cell);
      for (int s = 0; s < cell.corner_count; ++s) {
        const auto corner = [&](int i) -> const geometry::ShellCorner& {
          return divided.corners[static_cast<std::size_t>(cell.first_corner + i % cell.corner_count)];
        };
        const Vec2 from = corner(s).barycentric, to = corner(s + 1).barycentric;
        if (corner(s).side != SideKind::crack ||
            standing.is_on_crack(stands, corner(s).side_id, 0.5 * (from + to)))
          continue;
        const auto place = [&](double share) {
          return standing.place(
              stands, position_in_element(*divided.elements, cell.element, from + share * (to - from)));
        };
        for (const double share : {0.25, 0.5, 0.75})
          worst = std::max(worst, (place(share) - place(0.0) - share * (place(1.0) - place(0.0))).norm());
      }
    }
  }
  CHECK(bends > 50);
  CHECK(worst < 1.01 * kStraight);
}
