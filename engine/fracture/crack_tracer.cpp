#include "engine/fracture/crack_tracer.h"

#include <algorithm>
#include <cmath>

#include "engine/core/elementary.h"

namespace shatterbox::fracture {
namespace {

using geometry::SideKind;
using Size = std::size_t;
Size at(int i) {
  return static_cast<Size>(i);
}

constexpr double kRestLength = 4.0;  // thicknesses: length that drives a crack on after a rest
constexpr double kLeastEntry =
    0.156;                         // sine of the least angle at which a crack leaves an edge, about 9 degrees
constexpr double kMostTurn = 1.2;  // rad, in one element
constexpr double kParallel = 0.9;  // cosine above which two cracks count as side by side
constexpr double kJoinPull = 0.8;  // how hard a crack turns to one beside it

Vec2 left_of(const Vec2& d) {
  return {-d.y(), d.x()};
}

Vec2 turned(const Vec2& d, double angle) {
  const double c = core::cos(angle);
  const double s = core::sin(angle);
  return {c * d.x() - s * d.y(), s * d.x() + c * d.y()};
}

/// Normal stress on a plane stress's cut along a unit direction.
double stress_across(const stress::PlaneStress& s, const Vec2& along) {
  const Vec2 n = left_of(along);
  return s.x() * n.x() * n.x() + s.y() * n.y() * n.y() + 2.0 * s.z() * n.x() * n.y();
}

}  // namespace

CrackTracer::CrackTracer(ShellCutter& cutter, TracerSetup setup)
    : cutter_(cutter),
      setup_(std::move(setup)),
      elements_(cutter.elements()),
      exits_(cutter, *setup_.planes, setup_.thickness),
      next_crack_(setup_.first_crack) {
  toughness_ = core::sqrt(setup_.material->young * setup_.material->fracture_energy);
}

double CrackTracer::distance_to_load(const Vec3& p) const {
  double nearest = 1e300;
  for (const LoadCentre& centre : setup_.centres)
    nearest = std::min(nearest, std::max((p - centre.point).norm(), centre.radius));
  return nearest;
}

double CrackTracer::stress_intensity(const stress::PlaneStress& tensor, const Vec2& along,
                                     double length) const {
  return std::max(0.0, stress_across(tensor, along)) * core::sqrt(0.5 * core::kPi * length);
}

bool CrackTracer::pay(double length, double toughness_share) {
  const double cost =
      setup_.material->fracture_energy * toughness_share * toughness_share * setup_.thickness * length;
  if (setup_.energy_budget >= 0.0 && energy_ + cost > setup_.energy_budget) {
    is_out_of_energy_ = true;
    return false;
  }
  energy_ += cost;
  return true;
}

void CrackTracer::record(const LiveTip& tip, const ElementPlane& plane, const Vec2& from, const Vec2& to,
                         int side_id, bool is_on_grain) {
  const Vec3 begin = plane.space(from);
  const Vec3 end = plane.space(to);
  segments_.push_back({tip.tip.crack, side_id, setup_.generation, is_on_grain, {begin, end}});
  const double length = (end - begin).norm();
  present_.add({begin, end, tip.tip.crack, tip.branch, tip.branch_length + 0.5 * length});
}

Vec2 CrackTracer::steer_to_neighbour(const LiveTip& tip, const ElementPlane& plane, const Vec2& start,
                                     const Vec2& heading, double crack_length) const {
  const Vec3 p = plane.space(start);
  const Vec3 forward = plane.direction(heading);
  const double reach = std::min(0.25 * crack_length, 0.3 * distance_to_load(p));
  double nearest = reach;
  Vec2 towards = Vec2::Zero();
  present_.visit_near(p, reach, [&](const CrackStretch& s, const Vec3& near, double distance) {
    if (distance >= nearest || !(distance > 0.0)) return true;
    if (s.crack == tip.tip.crack) {
      const double apart =
          s.branch == tip.branch ? tip.branch_length - s.branch_length : tip.branch_length + s.branch_length;
      if (apart < 3.0 * reach) return true;
    }
    const Vec3 along = s.end - s.begin;
    const double length = along.norm();
    if (!(length > 0.0) || std::abs(along.dot(forward)) < kParallel * length) return true;
    if ((near - p).dot(forward) < -0.3 * distance) return true;
    const Vec2 flat = plane.flat_direction(near - p);
    if (!(flat.squaredNorm() > 0.0)) return true;
    nearest = distance;
    towards = flat.normalized();
    return true;
  });
  return (heading + kJoinPull * towards).normalized();
}

void CrackTracer::follow_grains(const LiveTip& tip, const EdgeStretch& entry, const Vec2& start,
                                Course& course) const {
  const CutCell& cell = cutter_.cell(entry.cell);
  const ElementPlane& plane = (*setup_.planes)[at(cell.element)];
  // A crack that could run straight on with the energy release G turns by an angle into a weaker plane, where
  // it finds about G cos^4(angle / 2), if that is more of the plane's toughness (share^2 of the material's)
  // than G is of its own (M.-Y. He, J. W. Hutchinson, J. Appl. Mech. 56, 1989).
  const double share = setup_.material->grain_strength;
  const double weak = share * share;
  double best = 1.0;
  for (const GrainCrossing& crossing : find_grain_crossings(*setup_.grains, elements_, cell.element)) {
    if (crossing.edge == tip.tip.edge) continue;
    const auto stretch = cutter_.find_stretch(cell.element, crossing.edge, crossing.parameter);
    if (!stretch || stretch->cell != entry.cell) continue;
    const CrackExit exit = exits_.settle_on_edge(stretch->cell, stretch->side, crossing.parameter);
    const Vec2 along = plane.flat(exit.place.barycentric) - start;
    if (!(along.squaredNorm() > 0.0)) continue;
    const Vec2 direction = along.normalized();
    const double forward = direction.dot(course.heading);
    if (forward <= 0.0) continue;
    // On a boundary already: the chord lies on it if one of its two grains is at the other end too.
    const bool is_on_grain =
        tip.grain_a >= 0 && (crossing.grain_a == tip.grain_a || crossing.grain_a == tip.grain_b ||
                             crossing.grain_b == tip.grain_a || crossing.grain_b == tip.grain_b);
    const double release = 0.5 * (1.0 + forward);  // cos^2 of half the angle
    const double drive = release * release / (is_on_grain ? weak : 0.5 * (1.0 + weak));
    if (drive <= best) continue;
    best = drive;
    course.exit = exit;
    course.is_on_grain = is_on_grain;
    course.grain_a = crossing.grain_a;
    course.grain_b = crossing.grain_b;
    course.toughness_share = is_on_grain ? share : 1.0;
    course.release_share = release;
  }
}

CrackTracer::Course CrackTracer::choose_course(const LiveTip& tip, const EdgeStretch& entry,
                                               const Vec2& start, Vec2 heading,
                                               const stress::PlaneStress& tensor, double crack_length) const {
  const CutCell& cell = cutter_.cell(entry.cell);
  const ElementPlane& plane = (*setup_.planes)[at(cell.element)];
  const stress::PrincipalStress principal = stress::principal_stress(tensor);
  Vec2 target = left_of(principal.direction);
  if (target.dot(heading) < 0.0) target = -target;
  const double anisotropy =
      std::min(1.0, std::max(0.0, (principal.first - principal.second) / principal.first));
  double angle = core::atan2(cross(heading, target), heading.dot(target));
  angle = std::min(kMostTurn, std::max(-kMostTurn, angle + setup_.noise->at(plane.space(start))));
  // Where both principal stresses are alike, and over less than a thickness, a crack goes straight on.
  angle *= 1.0 - core::exp(-anisotropy * anisotropy * plane.scale / (2.0 * setup_.thickness));
  Course course;
  course.heading = steer_to_neighbour(tip, plane, start, turned(heading, angle), crack_length);
  if (setup_.grains && !setup_.grains->is_empty()) follow_grains(tip, entry, start, course);
  return course;
}

void CrackTracer::arrest(LiveTip& tip) {
  tip.is_running = false;
  open_tips_.push_back(tip.tip);
}

void CrackTracer::advance(LiveTip& tip, stress::ShellFace face, double& crack_length) {
  const auto entry = cutter_.find_stretch(tip.tip.element, tip.tip.edge, tip.tip.parameter);
  if (!entry) {
    tip.is_running = false;  // a free edge, or another cut was met
    return;
  }
  const CutCell& cell = cutter_.cell(entry->cell);
  const int element = cell.element;
  const ElementPlane& plane = (*setup_.planes)[at(element)];
  if (!(plane.scale > 0.0)) return arrest(tip);
  const Size n = cell.polygon.size();
  const int local_edge = cell.polygon[at(entry->side)].side_id;
  const BorderPlace start{entry->side, false,
                          barycentric_on_edge(elements_, element, local_edge, tip.tip.parameter)};
  const Vec2 from = plane.flat(start.barycentric);
  const Vec2 side = plane
                        .flat(cell.polygon[(at(entry->side) + 1) % n].barycentric -
                              cell.polygon[at(entry->side)].barycentric)
                        .normalized();
  const Vec2 inward = left_of(side);
  // Over a fold the heading keeps its parts along and across the edge; it always leads inwards.
  const auto inwards = [&](const Vec2& d) {
    const double across = std::max(kLeastEntry, d.dot(inward));
    const double along = std::min(1.0, std::max(-1.0, d.dot(side)));
    return Vec2(inward * across + side * along).normalized();
  };
  const double along = std::min(1.0, std::max(-1.0, tip.tip.heading.dot(plane.direction(side))));
  const Vec2 heading = inwards(along * side + core::sqrt(1.0 - along * along) * inward);

  const stress::PlaneStress tensor = (*setup_.stresses)[at(cell.origin)].at(face);
  if (!(stress::principal_stress(tensor).first > 0.0)) return arrest(tip);
  Course course = choose_course(tip, *entry, from, heading, tensor, crack_length);
  course.heading = inwards(course.heading);
  tip.intensity = course.release_share * stress_intensity(tensor, course.heading, tip.driven_length);
  if (tip.intensity < toughness_ * course.toughness_share) return arrest(tip);

  // If the chord would leave a part without area, one that leads more to the middle of the cell is tried.
  Vec2 middle = Vec2::Zero();
  for (const geometry::ShellCorner& corner : cell.polygon) middle += plane.flat(corner.barycentric);
  const Vec2 to_middle = (middle / static_cast<double>(n) - from).normalized();
  const int side_id = cutter_.new_side_id();
  for (int attempt = 0; attempt < 5; ++attempt) {
    const double bend = 0.25 * attempt;
    const Vec2 direction = ((1.0 - bend) * course.heading + bend * to_middle).normalized();
    const auto exit = course.exit && attempt == 0
                          ? course.exit
                          : exits_.find_exit(entry->cell, entry->side, from, direction);
    if (!exit) continue;
    const Vec2 to = plane.flat(exit->place.barycentric);
    const double length = (to - from).norm();
    if (!(length > 0.0)) continue;
    const bool is_on_grain = attempt == 0 && course.is_on_grain;
    const double energy_before = energy_;
    if (!pay(length, is_on_grain ? course.toughness_share : 1.0)) return arrest(tip);
    if (!cutter_.cut(entry->cell, start, exit->place, SideKind::crack, side_id)) {
      energy_ = energy_before;
      continue;
    }
    record(tip, plane, from, to, side_id, is_on_grain);
    crack_length += length;
    tip.branch_length += length;
    tip.driven_length += length;
    tip.tip.length += length;
    tip.tip.heading = plane.direction((to - from) / length);
    const bool goes_on_grain = course.exit && attempt == 0;
    tip.grain_a = goes_on_grain ? course.grain_a : -1;
    tip.grain_b = goes_on_grain ? course.grain_b : -1;
    if (exit->has_met_cut || !exit->is_on_edge || elements_.topology.triangle_count(exit->edge) != 2) {
      tip.is_running = false;
      return;
    }
    const int first = elements_.topology.first_triangle[at(exit->edge)];
    const int a = elements_.topology.edge_triangles[at(first)];
    const int b = elements_.topology.edge_triangles[at(first) + 1];
    tip.tip.element = a == element ? b : a;
    tip.tip.edge = exit->edge;
    tip.tip.parameter = exit->parameter;
    return;
  }
  arrest(tip);
}

void CrackTracer::run(std::array<LiveTip, 2>& tips, int count, stress::ShellFace face) {
  double crack_length = 0.0;
  for (int i = 0; i < count; ++i) crack_length += tips[at(i)].tip.length;
  // A crack cannot visit more cells than there are; what runs on longer has lost its way.
  const int most_steps = 4 * static_cast<int>(elements_.mesh.triangles.size()) + 100;
  for (int step = 0; step < most_steps; ++step) {
    LiveTip* next = nullptr;
    for (int i = 0; i < count; ++i)
      if (tips[at(i)].is_running && (!next || tips[at(i)].intensity > next->intensity)) next = &tips[at(i)];
    if (!next) return;
    const double before = crack_length;
    advance(*next, face, crack_length);
    for (int i = 0; i < count; ++i)
      if (&tips[at(i)] != next) tips[at(i)].driven_length += crack_length - before;
    const int own = next->tip.crack - setup_.first_crack;
    if (own >= 0) crack_lengths_[at(own)] = crack_length;
  }
  for (int i = 0; i < count; ++i)
    if (tips[at(i)].is_running) arrest(tips[at(i)]);
}

void CrackTracer::resume(const std::vector<CrackTip>& tips) {
  for (const CrackTip& old : tips) {
    const auto entry = cutter_.find_stretch(old.element, old.edge, old.parameter);
    if (!entry) continue;  // another crack has met it, or it belongs to another piece
    std::array<LiveTip, 2> live;
    live[0].tip = old;
    live[0].driven_length = kRestLength * setup_.thickness;
    const auto& stress_here = (*setup_.stresses)[at(cutter_.cell(entry->cell).origin)];
    const Size before = segments_.size();
    run(live, 1, stress::worst_stress(stress_here).face);
    if (segments_.size() > before) ++resumed_count_;
  }
}

bool CrackTracer::is_shielded(const Candidate& candidate) const {
  const Vec3 p = position_in_element(elements_, candidate.element, candidate.barycentric);
  const double reach = distance_to_load(p) / core::sqrt(candidate.overload);
  const double spacing = setup_.material->crack_spacing;
  bool is_near = false;
  present_.visit_near(p, spacing * reach, [&](const CrackStretch& s, const Vec3&, double distance) {
    const int own = s.crack - setup_.first_crack;
    const double length = own >= 0 ? crack_lengths_[at(own)] : reach;
    is_near = distance < spacing * std::min(length, reach);
    return !is_near;
  });
  return is_near;
}

bool CrackTracer::try_start(const Candidate& candidate) {
  const int number = cutter_.find_cell(candidate.element, candidate.barycentric);
  if (number < 0) return false;
  const ElementPlane& plane = (*setup_.planes)[at(candidate.element)];
  if (!(plane.scale > 0.0)) return false;
  const auto& stress_here = (*setup_.stresses)[at(cutter_.cell(number).origin)];
  const stress::WorstStress worst = stress::worst_stress(stress_here);
  const Vec2 along = left_of(worst.principal.direction);
  const Vec2 start = plane.flat(candidate.barycentric);
  const auto forth = exits_.find_exit(number, -1, start, along);
  const auto back = exits_.find_exit(number, -1, start, -along);
  if (!forth || !back) return false;
  const Vec2 to = plane.flat(forth->place.barycentric);
  const Vec2 from = plane.flat(back->place.barycentric);
  const double length = (to - from).norm();
  if (!(length > 0.0)) return false;
  const double energy_before = energy_;
  if (!pay(length, 1.0)) return false;
  const int side_id = cutter_.new_side_id();
  if (!cutter_.cut(number, back->place, forth->place, SideKind::crack, side_id)) {
    energy_ = energy_before;
    return false;
  }
  const int crack = next_crack_++;
  crack_lengths_.push_back(length);
  std::array<LiveTip, 2> tips;
  int count = 0;
  for (const CrackExit* exit : {&*forth, &*back}) {
    LiveTip tip;
    tip.tip.crack = crack;
    tip.branch = exit == &*forth ? 0 : 1;
    tip.tip.length = tip.branch_length = 0.5 * length;
    tip.driven_length = length;
    tip.intensity = 1e300;
    if (exit == &*forth) record(tip, plane, from, to, side_id, false);
    if (exit->has_met_cut || !exit->is_on_edge || elements_.topology.triangle_count(exit->edge) != 2)
      continue;
    const int first = elements_.topology.first_triangle[at(exit->edge)];
    const int a = elements_.topology.edge_triangles[at(first)];
    const int b = elements_.topology.edge_triangles[at(first) + 1];
    tip.tip.element = a == candidate.element ? b : a;
    tip.tip.edge = exit->edge;
    tip.tip.parameter = exit->parameter;
    tip.tip.heading = plane.direction((exit == &*forth ? to - from : Vec2(from - to)) / length);
    tips[at(count++)] = tip;
  }
  run(tips, count, worst.face);
  return true;
}

void CrackTracer::nucleate(std::vector<Candidate> candidates) {
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.overload != b.overload ? a.overload > b.overload : a.number < b.number;
  });
  for (const Candidate& candidate : candidates) {
    if (is_out_of_energy_) return;
    if (!is_shielded(candidate)) try_start(candidate);
  }
}

}  // namespace shatterbox::fracture
