#include "engine/fracture/shell_shape.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/core/stop.h"
#include "engine/fracture/copies.h"
#include "engine/fracture/shell_subject.h"

namespace shatterbox::fracture {
namespace {

using core::at;
using Size = std::size_t;

constexpr double kTurn = 0.1;         // rad, of an edge in one step, about
constexpr double kFirstShare = 0.15;  // of the strains, at most, that come in the first step
constexpr int kMostSteps = 32;
constexpr double kOvershot = 1.2;  // times what energy is left: a step that takes more is taken again
constexpr double kSpent = 0.98;    // of the energy: that is all of it
constexpr int kMostCuts = 2;
constexpr double kLeastCut = 0.2;         // of a step, then
constexpr int kMostMends = 4;             // of a step
constexpr int kMostHalvings = 5;          // of one
constexpr double kMendIsDone = 0.1;       // of the step: a mend that is smaller is the last
constexpr double kShapeTolerance = 1e-4;  // of a solve: the next one mends what it leaves
constexpr int kMostTears = 5;             // that a step is made smaller for
constexpr double kTornCut = 0.3;          // of it, each time
constexpr double kLeastAreaShare = 0.3;   // of an element's, that a dent leaves it

using Angles = std::vector<std::array<double, 3>>;  // |T|, one for each edge of an element

/// The shell as it is by now.
struct ShellState {
  std::shared_ptr<const geometry::ShellElements> elements;
  std::vector<Vec3> normals;    // |E|, unit: the direction across the sheet at the middle of each edge
  std::vector<Vec3> stretched;  // |cells|, of the membrane, that stays besides the flow's own
  double stretch_work = 0.0;    // J
};

Vec3 edge_direction(const geometry::ShellElements& elements, Size edge) {
  const auto& ends = elements.topology.edges[edge];
  return (elements.mesh.positions[at(ends[1])] - elements.mesh.positions[at(ends[0])]).normalized();
}

/// By how much each edge's direction across leans, about the edge, against each element's normal, rad.
Angles find_angles(const ShellState& state) {
  const geometry::ShellElements& elements = *state.elements;
  Angles angles(elements.mesh.triangles.size());
  core::parallel_for(angles.size(), 512, [&](Size t) {
    const Vec3 normal = geometry::facet_frame(elements, static_cast<int>(t)).col(2);
    for (Size i = 0; i < 3; ++i) {
      const Size e = at(elements.topology.triangle_edges[t][i]);
      const Vec3& own = state.normals[e];
      angles[t][i] = core::atan2(edge_direction(elements, e).dot(normal.cross(own)), normal.dot(own));
    }
  });
  return angles;
}

/// Two sides of an element, in its frame.
Mat2 find_sides(const geometry::ShellElements& elements, int element) {
  const Mat3 frame = geometry::facet_frame(elements, element);
  const geometry::Triangle& t = elements.mesh.triangles[at(element)];
  Mat2 sides;
  for (int i = 0; i < 2; ++i)
    sides.col(i) = frame.leftCols<2>().transpose() *
                   (elements.mesh.positions[at(t[at(i + 1)])] - elements.mesh.positions[at(t[0])]);
  return sides;
}

class ShapeFinder {
 public:
  ShapeFinder(const ShellSubject& subject, const stress::SheetFlow& flow)
      : subject_(subject),
        flow_(flow),
        mesh_(*subject.mesh),
        rest_(*mesh_.elements),
        support_(support_of(subject, mesh_)) {
    now_.elements = mesh_.elements;
    now_.stretched.assign(mesh_.cells.size(), Vec3::Zero());
    now_.normals.assign(rest_.topology.edges.size(), Vec3::Zero());
    for (Size t = 0; t < rest_.mesh.triangles.size(); ++t)
      for (const int e : rest_.topology.triangle_edges[t])
        if (now_.normals[at(e)].isZero(0.0))
          now_.normals[at(e)] = geometry::facet_frame(rest_, static_cast<int>(t)).col(2);
    first_angles_ = find_angles(now_);
  }

  ShellShape find(double energy) {
    double share = 0.0, step = 0.0, work = 0.0;
    int cuts = 0, tears = 0;
    ShellShape shape;
    for (int number = 0; number < kMostSteps && work < kSpent * energy; ++number) {
      core::stop_if_asked();
      const ShellState before = now_;
      const double work_before = work;
      double turn = 0.0;
      if (!take_step(share, step, turn)) break;
      share += step;
      keep_stretch(share);
      if (is_torn()) {
        now_ = before;  // again, in a smaller step, or this is how far it goes
        share -= step;
        if (++tears == kMostTears) break;
        step *= kTornCut;
        continue;
      }
      work = find_work(share);
      if (const double left = energy - work_before;
          work - work_before > kOvershot * left && ++cuts < kMostCuts) {
        now_ = before;  // again, in a smaller step
        share -= step;
        step *= std::max(kLeastCut, left / (work - work_before));
        work = work_before;
        continue;
      }
      if (work > energy) {
        go_back(before, (energy - work_before) / (work - work_before));
        work = energy;
      }
      shape.way.push_back(moves());
      const double rate = (work - work_before) / step;
      step *= std::clamp(kTurn / std::max(turn, 1e-300), 0.5, 2.0);
      if (rate > 0.0) step = std::min(step, (energy - work) / rate);
    }
    shape.work = work;
    shape.is_cut = tears == kMostTears;
    return shape;
  }

 private:
  /// One more `step` of the strains, of which there is `share`; the first step is chosen here. `turn`: how
  /// far it went, rad. False where there is no answer.
  bool take_step(double share, double& step, double& turn) {
    VecX change;
    if (!solve(share + (step > 0.0 ? step : 1.0), change)) return false;
    if (!(step > 0.0)) {
      step = std::min(kFirstShare, kTurn / std::max(greatest_turn(change), 1e-300));
      change *= step;
    }
    turn = greatest_turn(change);
    move(change);
    for (int mend = 0; mend < kMostMends; ++mend) {
      if (!solve(share + step, change)) return false;
      const double length = go_downhill(share + step, change);
      if (length * greatest_turn(change) < kMendIsDone * turn) break;
    }
    return true;
  }

  /// Moves by as much of a change as takes strain energy away: what is pressed in its plane buckles, and
  /// would be thrown from side to side. Returns the share of it.
  double go_downhill(double share, const VecX& change) {
    const ShellState before = now_;
    const double energy = find_strain_energy(share);
    double length = 1.0;
    for (int halving = 0; halving < kMostHalvings; ++halving, length *= 0.5) {
      now_ = before;
      move(length * change);
      if (find_strain_energy(share) < energy) return length;
    }
    now_ = before;
    return 0.0;
  }

  /// What the shell has of curvature and stretch, of a cell.
  std::vector<stress::SheetStrain> measure() const {
    const Angles angles = find_angles(now_);
    const stress::ShellStiffness& stiffness = subject_.systems->stiffness();
    std::vector<stress::SheetStrain> strains(mesh_.cells.size());
    for (Size c = 0; c < strains.size(); ++c) {
      const Size element = at(mesh_.cells[c].element);
      const stress::ElementMatrices& matrices = stiffness.matrices[element];
      for (Size i = 0; i < 3; ++i) {
        const double turn = std::remainder(angles[element][i] - first_angles_[element][i], 2.0 * core::kPi);
        strains[c].curvature +=
            turn / stiffness.length * matrices.strain.block<3, 1>(3, 9 + static_cast<Eigen::Index>(i));
      }
      strains[c].curvature(2) *= 0.5;
      const int e = mesh_.cells[c].element;
      if (!(geometry::element_area(rest_, e) > 0.0)) continue;
      const Mat2 gradient = find_sides(*now_.elements, e) * find_sides(rest_, e).inverse();
      const Mat2 green = 0.5 * (gradient.transpose() * gradient - Mat2::Identity());
      strains[c].membrane = Vec3(green(0, 0), green(1, 1), green(0, 1));
    }
    return strains;
  }

  /// What of the strains the shell does not have, or has too much.
  std::vector<stress::SheetStrain> find_missing(double share) const {
    std::vector<stress::SheetStrain> strains = measure();
    for (Size c = 0; c < strains.size(); ++c) {
      const stress::SheetStrain& wanted = flow_.strains[c];
      strains[c].membrane = share * wanted.membrane + now_.stretched[c] - strains[c].membrane;
      strains[c].curvature = share * wanted.curvature - strains[c].curvature;
    }
    return strains;
  }

  /// J, elastic, that the strains lack: what every move makes less.
  double find_strain_energy(double share) const {
    const double nu = subject_.material.poisson;
    const double modulus = subject_.material.young / (1.0 - nu * nu);
    const double bending = subject_.thickness * subject_.thickness / 12.0;
    const auto square = [&](const Vec3& e) {
      return e(0) * e(0) + e(1) * e(1) + 2.0 * nu * e(0) * e(1) + 2.0 * (1.0 - nu) * e(2) * e(2);
    };
    const std::vector<stress::SheetStrain> missing = find_missing(share);
    double energy = 0.0;
    for (Size c = 0; c < missing.size(); ++c)
      energy += mesh_.cells[c].area * (square(missing[c].membrane) + bending * square(missing[c].curvature));
    return 0.5 * modulus * subject_.thickness * energy;
  }

  bool solve(double share, VecX& change) const {
    const geometry::ShellMesh mesh = geometry::on_elements(mesh_, now_.elements);
    const auto stiffness = stress::make_shell_stiffness(now_.elements, properties_of(subject_),
                                                        subject_.systems->stiffness().vertex_rank);
    const auto system = stress::ShellSystem::make(stiffness, mesh, 0.0, support_);
    if (!system) return false;
    stress::ShellSolution solution = system.value()->solve(
        stress::eigenstrain_load(*stiffness, mesh, find_missing(share)), kShapeTolerance);
    change = std::move(solution.displacement);
    return solution.is_evaluated();
  }

  double greatest_turn(const VecX& change) const {
    double most = 0.0;
    for (Size e = 0; e < mesh_.edge_source.size(); ++e)
      most = std::max(most, std::abs(change(stress::edge_dof(mesh_, static_cast<int>(e)))));
    return most;
  }

  /// Copies of one vertex or edge, on both sides of a standing crack, go together.
  void move(const VecX& change) {
    const std::vector<Vec3> steps =
        mean_of_copies(mesh_.vertex_source, rest_.mesh.positions.size(), Vec3(Vec3::Zero()),
                       [&](int v) { return Vec3(change.segment<3>(stress::vertex_dof(v))); });
    const std::vector<double> turns = mean_of_copies(mesh_.edge_source, now_.normals.size(), 0.0, [&](int e) {
      return change(stress::edge_dof(mesh_, e));
    });
    for (Size e = 0; e < turns.size(); ++e) {
      const core::SinCos turn = core::sin_cos(turns[e]);
      Vec3& normal = now_.normals[e];
      normal = turn.cos * normal + turn.sin * edge_direction(*now_.elements, e).cross(normal);
    }
    auto moved = std::make_shared<geometry::ShellElements>(*now_.elements);
    for (Size v = 0; v < steps.size(); ++v) moved->mesh.positions[v] += steps[v];
    now_.elements = std::move(moved);
    for (Size e = 0; e < turns.size(); ++e) {
      const Vec3 along = edge_direction(*now_.elements, e);
      now_.normals[e] = (now_.normals[e] - now_.normals[e].dot(along) * along).normalized();
    }
  }

  /// What is stretched beyond the yield strength stays so.
  void keep_stretch(double share) {
    const material::Material& material = subject_.material;
    const double nu = material.poisson;
    const double modulus = material.young / (1.0 - nu * nu);
    const std::vector<stress::SheetStrain> missing = find_missing(share);
    for (Size c = 0; c < missing.size(); ++c) {
      const Vec3 elastic = -missing[c].membrane;
      const stress::PlaneStress stress = stress::plane_stress(elastic, modulus, nu);
      const double linear = stress::von_mises(stress);
      if (!(linear > material.yield)) continue;
      const Vec3 stays = (1.0 - material.yield / linear) * elastic;
      now_.stretched[c] += stays;
      now_.stretch_work +=
          material.yield * stress::equivalent_strain(stays) * subject_.thickness * mesh_.cells[c].area;
    }
  }

  /// J, of stretch, and of the flow as far as the shell has taken it.
  double find_work(double share) const {
    const std::vector<stress::SheetStrain> strains = measure();
    const double bending = subject_.thickness * subject_.thickness / 12.0;
    double work = now_.stretch_work;
    for (Size c = 0; c < strains.size(); ++c) {
      const stress::SheetStrain& wanted = flow_.strains[c];
      const double whole = wanted.membrane.squaredNorm() + bending * wanted.curvature.squaredNorm();
      if (!(whole > 0.0)) continue;
      const double taken =
          wanted.membrane.dot(strains[c].membrane) + bending * wanted.curvature.dot(strains[c].curvature);
      work += flow_.works[c] * std::clamp(taken / whole, 0.0, share);
    }
    return work;
  }

  /// Whether an element is about to turn inside out, or stretched as far as it tears.
  bool is_torn() const {
    for (Size c = 0; c < mesh_.cells.size(); ++c) {
      const int e = mesh_.cells[c].element;
      if (geometry::element_area(*now_.elements, e) < kLeastAreaShare * geometry::element_area(rest_, e))
        return true;
      if (stress::equivalent_strain(now_.stretched[c]) > subject_.material.elongation) return true;
    }
    return false;
  }

  std::vector<Vec3> moves() const {
    std::vector<Vec3> moves = now_.elements->mesh.positions;
    for (Size v = 0; v < moves.size(); ++v) moves[v] -= rest_.mesh.positions[v];
    return moves;
  }

  /// To a share of the way from `before`.
  void go_back(const ShellState& before, double share) {
    auto moved = std::make_shared<geometry::ShellElements>(*now_.elements);
    for (Size v = 0; v < moved->mesh.positions.size(); ++v) {
      const Vec3& from = before.elements->mesh.positions[v];
      moved->mesh.positions[v] = from + share * (moved->mesh.positions[v] - from);
    }
    now_.elements = std::move(moved);
  }

  const ShellSubject& subject_;
  const stress::SheetFlow& flow_;
  const geometry::ShellMesh& mesh_;
  const geometry::ShellElements& rest_;
  stress::ShellSupport support_;
  Angles first_angles_;
  ShellState now_;
};

}  // namespace

std::vector<Vec3> moves_at(const ShellShape& shape, double share) {
  if (shape.way.empty()) return {};
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(shape.way.size());
  const Size before = std::min(static_cast<Size>(place), shape.way.size() - 1);
  const double further = place - static_cast<double>(before);
  std::vector<Vec3> moves = shape.way[before];
  for (Size v = 0; v < moves.size(); ++v) {
    const Vec3 from = before > 0 ? shape.way[before - 1][v] : Vec3(Vec3::Zero());
    moves[v] = from + further * (moves[v] - from);
  }
  return moves;
}

ShellShape find_shell_shape(const ShellSubject& subject, const stress::SheetFlow& flow, double energy) {
  return ShapeFinder(subject, flow).find(energy);
}

}  // namespace shatterbox::fracture
