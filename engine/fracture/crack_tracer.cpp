#include "engine/fracture/crack_tracer.h"

#include <algorithm>
#include <cmath>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/stop.h"

namespace shatterbox::fracture {
namespace {

using geometry::SideKind;
using Size = std::size_t;
using core::at;

// A crack right across a strip that the first cracks left unloads it that many of its lengths far.
constexpr double kStripRelief = 1.5;

}  // namespace

CrackTracer::CrackTracer(ShellCutter& cutter, TracerSetup setup)
    : cutter_(cutter),
      setup_(std::move(setup)),
      elements_(cutter.elements()),
      exits_(cutter, *setup_.planes, setup_.thickness),
      courses_(cutter, exits_, setup_, present_),
      next_crack_(setup_.first_crack) {}

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
  present_.add({begin, end, tip.tip.crack, tip.branch, tip.piece, tip.branch_length + 0.5 * length});
}

void CrackTracer::arrest(LiveTip& tip) {
  tip.is_running = false;
  open_tips_.push_back(tip.tip);
}

void CrackTracer::advance(LiveTip& tip, double& crack_length) {
  const auto entry = courses_.enter(tip.tip);
  if (!entry) {
    tip.is_running = false;  // a free edge, or another cut was met
    return;
  }
  const auto course = courses_.find(tip, *entry, crack_length);
  if (!course) return arrest(tip);
  tip.intensity = course->intensity;
  if (!cut_along(tip, *entry, *course, crack_length)) arrest(tip);
}

/// Cuts the cell; if the chord would leave a part without area, one that leads more to the middle of the cell
/// is tried. False if none is possible, or paid for.
bool CrackTracer::cut_along(LiveTip& tip, const TipEntry& entry, const Course& course, double& crack_length) {
  const ElementPlane& plane = *entry.plane;
  const CutCell& cell = cutter_.cell(entry.stretch.cell);
  const int element = cell.element;
  Vec2 middle = Vec2::Zero();
  for (const geometry::ShellCorner& corner : cell.polygon) middle += plane.flat(corner.barycentric);
  const Vec2 to_middle = (middle / static_cast<double>(cell.polygon.size()) - entry.from).normalized();
  const int side_id = cutter_.new_side_id();
  for (int attempt = 0; attempt < 5; ++attempt) {
    const double bend = 0.25 * attempt;
    const Vec2 direction = ((1.0 - bend) * course.heading + bend * to_middle).normalized();
    const bool is_to_grain = course.exit && attempt == 0;
    const auto exit = is_to_grain
                          ? course.exit
                          : exits_.find_exit(entry.stretch.cell, entry.stretch.side, entry.from, direction);
    if (!exit) continue;
    const Vec2 to = plane.flat(exit->place.barycentric);
    const double length = (to - entry.from).norm();
    if (!(length > 0.0)) continue;
    const bool is_on_grain = is_to_grain && course.is_on_grain;
    const double energy_before = energy_;
    if (!pay(length, is_on_grain ? course.toughness_share : 1.0)) return false;
    if (!cutter_.cut(entry.stretch.cell, entry.start, exit->place, SideKind::crack, side_id)) {
      energy_ = energy_before;
      continue;
    }
    record(tip, plane, entry.from, to, side_id, is_on_grain);
    crack_length += length;
    tip.branch_length += length;
    tip.driven_length += length;
    tip.tip.length += length;
    tip.tip.heading = plane.direction((to - entry.from) / length);
    tip.grain_a = is_to_grain ? course.grain_a : -1;
    tip.grain_b = is_to_grain ? course.grain_b : -1;
    tip.is_running = go_over(*exit, element, tip.tip);
    return true;
  }
  return false;
}

/// To the element behind an exit. False where there is none.
bool CrackTracer::go_over(const CrackExit& exit, int element, CrackTip& tip) const {
  if (exit.has_met_cut || !exit.is_on_edge || elements_.topology.triangle_count(exit.edge) != 2) return false;
  const int first = elements_.topology.first_triangle[at(exit.edge)];
  const int a = elements_.topology.edge_triangles[at(first)];
  const int b = elements_.topology.edge_triangles[at(first) + 1];
  tip.element = a == element ? b : a;
  tip.edge = exit.edge;
  tip.parameter = exit.parameter;
  return true;
}

void CrackTracer::run(std::array<LiveTip, 2>& tips, int count) {
  double crack_length = 0.0;
  for (int i = 0; i < count; ++i) crack_length += tips[at(i)].tip.length;
  // A crack cannot visit more cells than there are; what runs on longer has lost its way.
  const int most_steps = 4 * static_cast<int>(elements_.mesh.triangles.size()) + 100;
  for (int step = 0; step < most_steps; ++step) {
    core::stop_if_asked();
    LiveTip* next = nullptr;
    for (int i = 0; i < count; ++i)
      if (tips[at(i)].is_running && (!next || tips[at(i)].intensity > next->intensity)) next = &tips[at(i)];
    if (!next) return;
    const double before = crack_length;
    advance(*next, crack_length);
    for (int i = 0; i < count; ++i)
      if (&tips[at(i)] != next) tips[at(i)].driven_length += crack_length - before;
    const int own = next->tip.crack - setup_.first_crack;
    if (own >= 0) crack_lengths_[at(own)] = crack_length;
  }
  for (int i = 0; i < count; ++i)
    if (tips[at(i)].is_running) arrest(tips[at(i)]);
}

void CrackTracer::resume(const std::vector<CrackTip>& tips, const std::vector<int>& pieces) {
  for (const CrackTip& old : tips) {
    const auto entry = cutter_.find_stretch(old.element, old.edge, old.parameter);
    if (!entry) continue;  // another crack has met it, or it belongs to another piece
    std::array<LiveTip, 2> live;
    live[0].tip = old;
    live[0].piece = pieces[at(cutter_.cell(entry->cell).origin)];
    live[0].driven_length = kRestLength * setup_.thickness;
    const auto& stress_here = (*setup_.stresses)[at(cutter_.cell(entry->cell).origin)];
    live[0].face = stress::worst_stress(stress_here).face;
    run(live, 1);
  }
}

bool CrackTracer::is_shielded(const Candidate& candidate) const {
  const Vec3 p = position_in_element(elements_, candidate.element, candidate.barycentric);
  const NearestLoad nearest = find_nearest_load(setup_, p);
  const double reach = nearest.distance / core::sqrt(candidate.overload);
  const double spacing = setup_.material->crack_spacing;
  // Rings, which open by bending, unload what bending reaches: strips of a flat pane bend as a whole, in a
  // curved shell bending dies out.
  const double relief =
      setup_.generation > 0 ? std::min(nearest.distance, nearest.load->bending_length) : 0.0;
  const double farthest = std::max(spacing * reach, relief);
  bool is_near = false;
  present_.visit_near(p, farthest, [&](const CrackStretch& s, const Vec3&, double distance) {
    if (s.piece != candidate.piece) return true;  // a crack unloads nothing beyond another one
    const int own = s.crack - setup_.first_crack;
    const double length = own >= 0 ? crack_lengths_[at(own)] : reach;
    is_near = distance < std::max(spacing * std::min(length, reach), std::min(kStripRelief * length, relief));
    return !is_near;
  });
  return is_near;
}

bool CrackTracer::try_start(const Candidate& candidate) {
  const int number = cutter_.find_cell(candidate.element, candidate.barycentric);
  if (number < 0) return false;
  const ElementPlane& plane = setup_.planes->of(candidate.element);
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
    tip.piece = candidate.piece;
    tip.intensity = 1e300;
    tip.face = worst.face;
    if (exit == &*forth) record(tip, plane, from, to, side_id, false);
    if (!go_over(*exit, candidate.element, tip.tip)) continue;
    tip.tip.heading = plane.direction((exit == &*forth ? to - from : Vec2(from - to)) / length);
    tips[at(count++)] = tip;
  }
  run(tips, count);
  return true;
}

void CrackTracer::nucleate(std::vector<Candidate> candidates) {
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.overload != b.overload ? a.overload > b.overload : a.number < b.number;
  });
  for (const Candidate& candidate : candidates) {
    core::stop_if_asked();
    if (is_out_of_energy_) return;
    if (!is_shielded(candidate)) try_start(candidate);
  }
}

}  // namespace shatterbox::fracture
