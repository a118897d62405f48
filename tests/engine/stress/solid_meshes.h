// Small solids with closed-form answers for the tests of stress.
#pragma once

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/random.h"
#include "engine/geometry/solid_mesh.h"
#include "engine/stress/solid_load.h"
#include "engine/stress/solid_stress.h"
#include "engine/stress/solid_system.h"
#include "sandbox/study/solid_models.h"

namespace shatterbox::stress::testing {

using namespace sandbox::study::model;

/// Volume and first moment of the part of a tetrahedron where `value` (linear, at its corners) is positive.
inline std::pair<double, Vec3> clip_tetrahedron(const std::array<Vec3, 4>& p,
                                                const std::array<double, 4>& value) {
  std::vector<int> in, out;
  for (int i = 0; i < 4; ++i) (value[core::at(i)] > 0.0 ? in : out).push_back(i);
  const auto whole = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const double volume = std::abs((b - a).cross(c - a).dot(d - a)) / 6.0;
    return std::pair<double, Vec3>(volume, volume / 4.0 * (a + b + c + d));
  };
  const auto all = whole(p[0], p[1], p[2], p[3]);
  const auto crossing = [&](int i, int j) -> Vec3 {
    const double vi = value[core::at(i)], vj = value[core::at(j)];
    return p[core::at(i)] + vi / (vi - vj) * (p[core::at(j)] - p[core::at(i)]);
  };
  if (in.empty()) return {0.0, Vec3::Zero()};
  if (out.empty()) return all;
  const auto tip = [&](int apex, const std::vector<int>& others) {
    return whole(p[core::at(apex)], crossing(apex, others[0]), crossing(apex, others[1]),
                 crossing(apex, others[2]));
  };
  if (in.size() == 1) return tip(in[0], out);
  if (out.size() == 1) {
    const auto rest = tip(out[0], in);
    return {all.first - rest.first, all.second - rest.second};
  }
  // A wedge: three tetrahedra.
  const Vec3 a = p[core::at(in[0])], b = p[core::at(in[1])];
  const Vec3 ac = crossing(in[0], out[0]), ad = crossing(in[0], out[1]), bc = crossing(in[1], out[0]),
             bd = crossing(in[1], out[1]);
  std::pair<double, Vec3> sum(0.0, Vec3::Zero());
  for (const auto& [volume, moment] : {whole(a, ac, ad, bd), whole(a, ac, bc, bd), whole(a, b, bc, bd)}) {
    sum.first += volume;
    sum.second += moment;
  }
  return sum;
}

/// An uncut mesh cut right through by the plane normal . x = offset, which passes no vertex: virtual nodes on
/// both sides. Contacts: all but those across it.
struct CutSolid {
  geometry::SolidMesh mesh;
  std::vector<geometry::SolidContact> contacts;
};
inline CutSolid cut_by_plane(const geometry::SolidMesh& whole, const Vec3& normal, double offset) {
  const geometry::TetMesh& tets = whole.elements->mesh;
  CutSolid cut;
  cut.mesh.elements = whole.elements;
  std::vector<std::array<int, 2>> cells(tets.tetrahedra.size(), {-1, -1});
  std::map<std::pair<int, int>, int> copies;
  for (int side = 0; side < 2; ++side)
    for (std::size_t t = 0; t < tets.tetrahedra.size(); ++t) {
      std::array<Vec3, 4> p;
      std::array<double, 4> value{};
      for (std::size_t i = 0; i < 4; ++i) {
        p[i] = tets.positions[core::at(tets.tetrahedra[t][i])];
        value[i] = (side == 0 ? 1.0 : -1.0) * (normal.dot(p[i]) - offset);
      }
      const auto [volume, moment] = clip_tetrahedron(p, value);
      if (!(volume > 0.0)) continue;
      geometry::SolidCell cell;
      cell.element = static_cast<int>(t);
      cell.volume = volume;
      Mat3 edges;
      for (int i = 0; i < 3; ++i) edges.col(i) = p[core::at(i + 1)] - p[0];
      cell.centroid = edges.inverse() * (moment / volume - p[0]);
      for (std::size_t i = 0; i < 4; ++i) {
        const auto [found, is_new] = copies.try_emplace({side, tets.tetrahedra[t][i]},
                                                        static_cast<int>(cut.mesh.vertex_source.size()));
        if (is_new) cut.mesh.vertex_source.push_back(tets.tetrahedra[t][i]);
        cell.vertices[i] = found->second;
      }
      cells[t][core::at(side)] = static_cast<int>(cut.mesh.cells.size());
      cut.mesh.cells.push_back(cell);
    }
  for (const auto& [a, b] : whole.elements->topology.face_tetrahedra)
    for (std::size_t side = 0; side < 2 && b >= 0; ++side)
      if (cells[core::at(a)][side] >= 0 && cells[core::at(b)][side] >= 0)
        cut.contacts.push_back({cells[core::at(a)][side], cells[core::at(b)][side], 1.0});
  return cut;
}

}  // namespace shatterbox::stress::testing
