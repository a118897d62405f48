#include "engine/fracture/solid_tracer.h"

#include <algorithm>
#include <numeric>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/core/stop.h"
#include "engine/fracture/grain_surface.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kLeastArea = 0.25;  // of a crack, in squares of the least size

constexpr Size kMostAhead = 8;  // fields that are found at once

constexpr double kMostlyResting = 0.5;     // of the forces: what else there is does not hold the crack back
constexpr double kNeedsToughness = 1e300;  // Pa: no stress lets a crack run below K_Ic

constexpr double kBesideCosine = 0.7;  // between two cracks that run beside each other
constexpr double kBesideShare = 0.4;   // of the least size, at most, are they then apart

double tension_of(const stress::SolidStress& stress, const Vec3& normal) {
  return normal.dot(stress::stress_tensor(stress) * normal);
}

/// How the intensity falls as a crack grows that a force holds open in its middle: as its size to the power
/// -3/2. `share`: of the area that was solved in what it is now.
double falling(double share) {
  const double root = core::sqrt(core::sqrt(share));
  return root * root * root;
}

}  // namespace

bool cell_holds(const geometry::SolidComplex& complex, int cell, const Vec3& point) {
  const geometry::SolidPart& part = complex.cells[at(cell)];
  for (int f = 0; f < part.facet_count; ++f) {
    const int facet_side = complex.cell_facets[at(part.first_facet + f)];
    const geometry::SolidFacet& facet = complex.facets[at(facet_side / 2)];
    const Vec3 outwards = (facet_side % 2 == 0 ? 1.0 : -1.0) * facet_area_vector(complex, facet);
    const Vec3& corner = complex.position(complex.side_begin(complex.sides_of(facet)[0]));
    if (outwards.dot(point - corner) > 0.0) return false;
  }
  return true;
}

SolidTracer::SolidTracer(geometry::SolidComplex& complex, SolidTracerSetup setup)
    : complex_(complex),
      setup_(std::move(setup)),
      cutter_(complex),
      field_(complex),
      guides_(complex, setup_.guides),
      origin_(complex.cells.size()),
      entered_(complex.cells.size(), 0) {
  std::iota(origin_.begin(), origin_.end(), 0);
  toughness_ = core::sqrt(setup_.material->young * setup_.fracture_energy);
}

/// Whether an older crack is so near beside the present one in a settled cell that nothing could be told of
/// what is between: along a boundary between grains only the first one runs.
bool SolidTracer::runs_beside_crack(int cell, const CrackCap& cap) const {
  const geometry::SolidPart& part = complex_.cells[at(cell)];
  const Vec3 across = field_.gradient(part.element).normalized();
  for (int f = 0; f < part.facet_count; ++f) {
    const geometry::SolidFacet& facet =
        complex_.facets[at(complex_.cell_facets[at(part.first_facet + f)] / 2)];
    if (facet.kind != geometry::FacetKind::crack && facet.kind != geometry::FacetKind::old_crack) continue;
    const Vec3 normal = facet_area_vector(complex_, facet).normalized();
    const Vec3& corner = complex_.position(complex_.side_begin(complex_.sides_of(facet)[0]));
    if (std::abs(normal.dot(across)) > kBesideCosine &&
        std::abs(normal.dot(cap.middle - corner)) < kBesideShare * setup_.least_size)
      return true;
  }
  return false;
}

/// Fracture energy of a boundary between grains, share of their own: K_Ic falls as the strength does.
double SolidTracer::boundary_weakness() const {
  return setup_.material->grain_strength * setup_.material->grain_strength;
}

/// The same of what the present crack goes through in an element.
double SolidTracer::weakness_at(int element) const {
  const bool is_weak =
      setup_.grains != nullptr &&
      is_on_boundary(*setup_.grains, complex_.elements->mesh.tetrahedra[at(element)], *field_.values());
  return is_weak ? boundary_weakness() : 1.0;
}

/// J.
double SolidTracer::cost_of(double area, double weakness) const {
  return weakness * setup_.fracture_energy * area;
}

bool SolidTracer::pay(double area, double weakness) {
  if (setup_.energy_budget >= 0.0 && energy_ + cost_of(area, weakness) > setup_.energy_budget + given_) {
    is_out_of_energy_ = true;
    return false;
  }
  charge(area, weakness);
  return true;
}

void SolidTracer::charge(double area, double weakness) {
  energy_ += cost_of(area, weakness);
  new_energy_ += cost_of(area, weakness);
  if (weakness < 1.0) new_grain_area_ += area;
}

double SolidTracer::tension_across(int cell, const Vec3& gradient) const {
  const double steep = gradient.norm();
  if (!(steep > 0.0)) return 0.0;
  return tension_of((*setup_.guides.stresses)[at(origin_[at(cell)])], gradient / steep);
}

/// Takes a cell into the crack; its crossed facets become fronts.
void SolidTracer::enter(const Step& step) {
  const int cell = step.cell;
  entered_[at(cell)] = present_id_ + 1;
  active_.push_back(cell);
  middles_.push_back(step.cap.middle);
  crack_area_ += step.cap.area;
  new_area_ += step.cap.area;
  crack_force_ += step.cap.area * step.tension;
  crack_drive_ += step.cap.area * step.intensity * step.intensity;
  crack_pull_ += step.cap.area * std::max(0.0, step.tension);
  const Vec3 gradient = field_.gradient(complex_.cells[at(cell)].element);
  const geometry::SolidPart part = complex_.cells[at(cell)];
  for (int f = 0; f < part.facet_count; ++f) {
    const geometry::SolidFacet& facet =
        complex_.facets[at(complex_.cell_facets[at(part.first_facet + f)] / 2)];
    const int next = facet.cells[0] == cell ? facet.cells[1] : facet.cells[0];
    if (next < 0 || facet.kind == geometry::FacetKind::crack || entered_[at(next)] == present_id_ + 1 ||
        !field_.crosses(facet))
      continue;
    fronts_.push_back({tension_across(next, gradient), step.solved, next_order_++, next});
    std::push_heap(fronts_.begin(), fronts_.end());
  }
}

/// Over the most driven front, if the crack has not come there by now and its surface goes on there.
std::optional<SolidTracer::Step> SolidTracer::next_step() {
  std::pop_heap(fronts_.begin(), fronts_.end());
  Step step;
  step.cell = fronts_.back().cell;
  step.solved = fronts_.back().intensity;
  fronts_.pop_back();
  if (entered_[at(step.cell)] == present_id_ + 1) return std::nullopt;
  const int element = complex_.cells[at(step.cell)].element;
  if (!field_.has_all(element)) return std::nullopt;
  settle_cell(complex_, step.cell);
  step.cap = field_.cap(step.cell);
  if (!(step.cap.area > 0.0)) return std::nullopt;
  if (setup_.grains != nullptr && runs_beside_crack(step.cell, step.cap)) return std::nullopt;
  step.tension = tension_across(step.cell, field_.gradient(element));
  const double mean = (crack_force_ + step.cap.area * step.tension) / (new_area_ + step.cap.area);
  const double area = crack_area_ + step.cap.area;
  step.intensity =
      std::max(std::max({0.0, mean, step.tension}) * core::sqrt(0.5 * core::kPi * core::sqrt(area)),
               step.solved * falling(solved_area_ / area));
  return step;
}

/// From front to front, the most driven first. What drives a crack is K = tension sqrt(pi / 2 length), of the
/// tension at its front or of the mean across all of it, whichever is more: the mean takes the crack of a
/// bent bar on into the half that is pressed, and falls, as it should, as the radius^-3/2 of a crack that a
/// force opens in its middle. A crack that starts may run through what is pulled by more than its flaw bears
/// while it is too small for K to reach K_Ic, if what drives it has paid for all of it at last: the coupled
/// criterion of strength and toughness [Leg02]. Else what a crack needs to start would be told by the size of
/// the element that it starts in.
void SolidTracer::grow() {
  halted_.clear();
  while (!fronts_.empty()) {
    core::stop_if_asked();
    const std::optional<Step> step = next_step();
    if (!step) continue;
    const int element = complex_.cells[at(step->cell)].element;
    const double weakness = weakness_at(element);
    const double excess = step->intensity * step->intensity - weakness * toughness_ * toughness_;
    if ((excess < 0.0 && !(step->tension > strength_)) || !pay(step->cap.area, weakness)) {
      rests_.push_back(element);
      if (is_out_of_energy_) break;
      halted_.push_back({step->tension, step->solved, next_order_++, step->cell});
      continue;
    }
    enter(*step);
    balance_ += step->cap.area * excess;
    if (balance_ >= 0.0) bear_out();
  }
  if (!is_out_of_energy_ && (!halted_.empty() || active_.size() > borne_out_.cells)) tear();
  fall_back();
}

/// What is smaller than the zone in which a crack of its material comes to be has no room for one that K_Ic
/// could tell of: it tears as a whole, where what drives the crack right across has come to what the flaw's
/// strength all over it would be. What is pulled tears at its strength so, whatever its size, and a bent bar
/// when its side bears 2.1 times that (by the code for concrete 1.7 at 10 cm and 3.1 at 2 cm [MC2010]
/// 5.1.5.1). Only under what rests on it: a hit's force falls away before so long a zone has opened.
void SolidTracer::tear() {
  if (strength_ == kNeedsToughness || !(setup_.resting_share > kMostlyResting)) return;
  // Of the mean of K^2 over a crack that has grown under an even pull.
  const auto needed = [&] { return core::kPi / 3.0 * core::sqrt(crack_area_) * strength_ * strength_; };
  const auto has_room = [&] { return needed() >= toughness_ * toughness_; };
  const Extent before = extent();
  fronts_ = halted_;
  std::make_heap(fronts_.begin(), fronts_.end());
  while (!fronts_.empty() && !has_room()) {
    core::stop_if_asked();
    const std::optional<Step> step = next_step();
    if (!step) continue;
    charge(step->cap.area, weakness_at(complex_.cells[at(step->cell)].element));
    enter(*step);
  }
  // The stress does the same work on its opening as the forces outside, which holds up to 2 G / strength; of
  // a hinge two thirds of that in the middle of what is pulled.
  const double work = setup_.resting_share * 4.0 / 3.0 * setup_.fracture_energy / strength_ * crack_pull_;
  const double lacking =
      setup_.energy_budget >= 0.0 ? std::max(0.0, energy_ - setup_.energy_budget - given_) : 0.0;
  if (fronts_.empty() && !has_room() && crack_drive_ >= needed() * new_area_ && lacking <= work) {
    given_ += lacking;
    bear_out();
    rests_.clear();
    return;
  }
  take_back(before);
}

SolidTracer::Extent SolidTracer::extent() const {
  return {active_.size(), crack_area_,  new_area_,    new_grain_area_,
          new_energy_,    crack_force_, crack_drive_, crack_pull_};
}

void SolidTracer::bear_out() {
  balance_ = 0.0;
  borne_out_ = extent();
}

void SolidTracer::take_back(const Extent& extent) {
  for (Size i = extent.cells; i < active_.size(); ++i) entered_[at(active_[i])] = 0;
  active_.resize(extent.cells);
  middles_.resize(extent.cells);
  energy_ += extent.new_energy - new_energy_;
  crack_area_ = extent.area;
  new_area_ = extent.new_area;
  new_grain_area_ = extent.new_grain_area;
  new_energy_ = extent.new_energy;
  crack_force_ = extent.force;
  crack_drive_ = extent.drive;
  crack_pull_ = extent.pull;
}

/// To where the present crack was paid for.
void SolidTracer::fall_back() {
  if (active_.size() > borne_out_.cells) is_out_of_energy_ = false;  // what is given back others may spend
  for (Size i = borne_out_.cells; i < active_.size(); ++i)
    rests_.push_back(complex_.cells[at(active_[i])].element);
  take_back(borne_out_);
}

/// After it has grown: cuts along the present crack, unless it is so small that the elements cannot tell of
/// it.
bool SolidTracer::take() {
  if (active_.empty()) return false;
  if (crack_area_ < kLeastArea * setup_.least_size * setup_.least_size) {
    for (const int cell : active_) entered_[at(cell)] = 0;
    energy_ -= new_energy_;
    return false;
  }
  for (Size i = 0; i < active_.size(); ++i) {
    CrackStretch stretch;
    stretch.begin = stretch.end = middles_[i];
    stretch.crack = present_id_;
    stretch.piece = (*setup_.guides.pieces)[at(origin_[at(active_[i])])];
    present_.add(stretch);
  }
  cut();
  return true;
}

void SolidTracer::begin(int id, double area, double strength) {
  active_.clear();
  middles_.clear();
  fronts_.clear();
  rests_.clear();
  next_order_ = 0;
  present_id_ = id;
  crack_area_ = solved_area_ = area;
  new_area_ = new_grain_area_ = new_energy_ = crack_force_ = crack_drive_ = crack_pull_ = 0.0;
  strength_ = strength;
  bear_out();
  if (lengths_.size() <= at(id)) lengths_.resize(at(id) + 1, 0.0);
}

/// m, of the solved crack: how far its faces have come apart in the middle of a facet; below zero where they
/// are pressed together.
double SolidTracer::opening_of(const geometry::SolidFacet& facet) const {
  const geometry::SolidMesh& mesh = *setup_.solved.mesh;
  Vec3 apart = Vec3::Zero();
  for (int i = 0; i < facet.side_count; ++i) {
    const geometry::SolidVertex& corner =
        complex_.vertices[at(complex_.side_begin(complex_.sides_of(facet)[i]))];
    for (Size side = 0; side < 2; ++side) {
      const geometry::SolidCell& cell = mesh.cells[at(origin_[at(facet.cells[side])])];
      const geometry::Tetrahedron& t = mesh.elements->mesh.tetrahedra[at(cell.element)];
      for (Size k = 0; k < 4; ++k) {
        const auto node = std::find(corner.nodes.begin(), corner.nodes.end(), t[k]);
        if (node == corner.nodes.end()) continue;
        const double weight = corner.weights[static_cast<Size>(node - corner.nodes.begin())];
        const Vec3 moved = setup_.solved.displacement->segment<3>(3 * cell.vertices[k]);
        apart += (side == 0 ? -weight : weight) * moved;
      }
    }
  }
  const Vec3 area = facet_area_vector(complex_, facet);
  const double size = area.norm();
  return size > 0.0 ? apart.dot(area) / (size * facet.side_count) : 0.0;
}

/// Of a settled cell that the present crack stopped at: the stress intensity by which it stands open beside
/// the cell, K = E' / 8 sqrt(2 pi / r) opening, r behind the front ([Law93] ch. 2); nothing if it is not
/// beside. A thin remainder that is pressed while the crack is bent open shows it here, and not in its
/// stress.
std::optional<double> SolidTracer::intensity_beside(int cell) {
  std::optional<double> greatest;
  const Vec3 here = field_.cap(cell).middle;
  const material::Material& material = *setup_.material;
  const double modulus = material.young / (1.0 - material.poisson * material.poisson);
  const geometry::SolidPart part = complex_.cells[at(cell)];
  for (int f = 0; f < part.facet_count; ++f) {
    const geometry::SolidFacet& facet =
        complex_.facets[at(complex_.cell_facets[at(part.first_facet + f)] / 2)];
    const int next = facet.cells[0] == cell ? facet.cells[1] : facet.cells[0];
    if (next < 0 || facet.kind == geometry::FacetKind::crack) continue;
    settle_cell(complex_, next);
    const geometry::SolidPart& neighbour = complex_.cells[at(next)];
    for (int k = 0; k < neighbour.facet_count; ++k) {
      const geometry::SolidFacet& face =
          complex_.facets[at(complex_.cell_facets[at(neighbour.first_facet + k)] / 2)];
      if (face.kind != geometry::FacetKind::crack || face.tag != present_id_ || face.cells[0] < 0 ||
          face.cells[1] < 0)
        continue;
      Vec3 middle = Vec3::Zero();
      for (int i = 0; i < face.side_count; ++i)
        middle += complex_.position(complex_.side_begin(complex_.sides_of(face)[i])) / face.side_count;
      const double behind = std::max((middle - here).norm(), 1e-6 * setup_.least_size);
      const double intensity =
          0.125 * modulus * core::sqrt(2.0 * core::kPi / behind) * std::max(0.0, opening_of(face));
      greatest = std::max(greatest.value_or(0.0), intensity);
    }
  }
  return greatest;
}

void SolidTracer::resume(std::vector<OpenCrack>& cracks) {
  for (OpenCrack& crack : cracks) {
    if (is_out_of_energy_) return;
    std::sort(crack.rests.begin(), crack.rests.end());
    crack.rests.erase(std::unique(crack.rests.begin(), crack.rests.end()), crack.rests.end());
    begin(crack.id, crack.area, kNeedsToughness);
    lengths_[at(crack.id)] = core::sqrt(crack.area);
    field_.take(crack.values);
    for (const int element : crack.rests)
      for (const int cell : cutter_.cells_of(element)) {
        settle_cell(complex_, cell);
        if (!field_.has_all(element) || !(field_.cap(cell).area > 0.0)) continue;
        const std::optional<double> intensity = intensity_beside(cell);
        if (!intensity) continue;
        fronts_.push_back({tension_across(cell, field_.gradient(element)), *intensity, next_order_++, cell});
        std::push_heap(fronts_.begin(), fronts_.end());
      }
    grow();
    take();
    crack.area = crack_area_;
    crack.rests = rests_;
  }
}

/// The fields of `most` candidates that are not shielded by now, of the piece of the first one: they are
/// those of the generation's beginning, and most cracks come to nothing, so they seldom shield the next.
void SolidTracer::look_ahead(const std::vector<SolidCandidate>& candidates, Size first, Size most,
                             std::vector<CrackValues>& fields) {
  const auto piece_of = [&](Size i) { return (*setup_.guides.pieces)[at(candidates[i].cell)]; };
  const int piece = piece_of(first);
  std::vector<Size> wanted;
  std::vector<GuideStart> starts;
  for (Size i = first; i < candidates.size() && wanted.size() < most; ++i) {
    if (piece_of(i) != piece || is_shielded(candidates[i])) continue;
    const stress::PrincipalAxes axes =
        stress::principal_axes((*setup_.guides.stresses)[at(candidates[i].cell)]);
    wanted.push_back(i);
    starts.push_back(
        {complex_.cells[at(candidates[i].cell)].element, candidates[i].place, axes.directions.col(0)});
  }
  std::vector<std::vector<double>> values = guides_.of(piece).potentials(starts);
  core::parallel_for(wanted.size(), 1, [&](Size k) {
    if (setup_.grains != nullptr)
      values[k] = follow_grains(*setup_.grains, complex_.elements->mesh, values[k], starts[k].element,
                                boundary_weakness());
    fields[wanted[k]] = std::make_shared<const std::vector<double>>(std::move(values[k]));
  });
}

bool SolidTracer::start(const SolidCandidate& candidate, CrackValues field, std::vector<OpenCrack>& cracks) {
  int cell = candidate.cell;
  const int element = complex_.cells[at(cell)].element;
  // Earlier cracks of this generation may have divided it.
  const std::vector<int> cells = cutter_.cells_of(element);
  if (cells.size() > 1) {
    const auto holder = std::find_if(cells.begin(), cells.end(), [&](int c) {
      settle_cell(complex_, c);
      return origin_[at(c)] == candidate.cell && cell_holds(complex_, c, candidate.place);
    });
    if (holder == cells.end()) return false;
    cell = *holder;
  }
  settle_cell(complex_, cell);
  // Where it yields, an elastic stress above the strength is none that is there.
  begin(setup_.first_id + crack_count_, 0.0,
        setup_.material->yield > 0.0 ? kNeedsToughness : candidate.strength);
  field_.take(std::move(field));
  const CrackCap cap = field_.cap(cell);
  if (!(cap.area > 0.0)) {
    stillborn_.push_back(candidate);
    return false;
  }
  if (!pay(cap.area, weakness_at(element))) return false;
  const double tension = tension_across(cell, field_.gradient(element));
  enter(
      {cell, cap, tension, 0.0, std::max(0.0, tension) * core::sqrt(0.5 * core::kPi * core::sqrt(cap.area))});
  bear_out();
  grow();
  if (!take()) {
    stillborn_.push_back(candidate);
    return false;
  }
  ++crack_count_;
  cracks.push_back({present_id_, crack_area_, field_.values(), rests_});
  return true;
}

/// A facet that lies in the crack opens between active cells only. The one beyond it is on the positive side
/// with all its nodes, so that the crack does not enter it, and yet takes part.
void SolidTracer::add_cells_beyond(std::vector<int>& cells) {
  for (const int cell : active_) {
    settle_cell(complex_, cell);
    const geometry::SolidPart& part = complex_.cells[at(cell)];
    for (int f = 0; f < part.facet_count; ++f) {
      const geometry::SolidFacet& facet =
          complex_.facets[at(complex_.cell_facets[at(part.first_facet + f)] / 2)];
      const int next = facet.cells[0] == cell ? facet.cells[1] : facet.cells[0];
      if (next >= 0 && entered_[at(next)] != present_id_ + 1 && field_.holds(facet, part.element))
        cells.push_back(next);
    }
  }
}

void SolidTracer::cut() {
  geometry::SolidCut cut;
  cut.node_values = *field_.values();
  cut.cells = active_;
  cut.id = present_id_;
  add_cells_beyond(cut.cells);
  const Size before = complex_.cells.size();
  cutter_.cut(cut);
  // A new part lies behind a face of this crack; beyond it, or beyond further new parts, is the old cell.
  origin_.resize(complex_.cells.size(), -1);
  entered_.resize(complex_.cells.size(), 0);
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (Size c = before; c < complex_.cells.size(); ++c) {
      if (origin_[c] >= 0) continue;
      settle_cell(complex_, static_cast<int>(c));
      const geometry::SolidPart& part = complex_.cells[c];
      for (int f = 0; f < part.facet_count && origin_[c] < 0; ++f) {
        const geometry::SolidFacet& facet =
            complex_.facets[at(complex_.cell_facets[at(part.first_facet + f)] / 2)];
        if (facet.kind != cut.kind || facet.tag != cut.id) continue;
        for (const int other : facet.cells)
          if (other >= 0 && complex_.cells[at(other)].element == part.element && origin_[at(other)] >= 0)
            origin_[c] = origin_[at(other)];
      }
      has_changed = has_changed || origin_[c] >= 0;
    }
  }
  for (Size c = before; c < complex_.cells.size(); ++c)
    if (origin_[c] < 0) origin_[c] = origin_[at(cutter_.cells_of(complex_.cells[c].element).front())];
  area_ += new_area_;
  grain_area_ += new_grain_area_;
  lengths_[at(present_id_)] = core::sqrt(crack_area_);
}

bool SolidTracer::is_shielded(const SolidCandidate& candidate) const {
  double nearest = 1e300;
  for (const SolidLoadCentre& centre : setup_.centres)
    nearest = std::min(nearest, std::max((candidate.place - centre.point).norm(), centre.radius));
  const double reach = nearest / core::sqrt(candidate.overload);
  const double spacing = setup_.material->crack_spacing;
  const int piece = (*setup_.guides.pieces)[at(candidate.cell)];
  bool is_near = false;
  present_.visit_near(candidate.place, std::max(spacing * reach, setup_.least_size),
                      [&](const CrackStretch& s, const Vec3&, double distance) {
                        // A crack unloads nothing beyond another one.
                        if (s.piece != piece) return true;
                        is_near = distance < std::max(spacing * std::min(lengths_[at(s.crack)], reach),
                                                      setup_.least_size);
                        return !is_near;
                      });
  return is_near;
}

void SolidTracer::nucleate(std::vector<SolidCandidate> candidates, std::vector<OpenCrack>& cracks) {
  std::sort(candidates.begin(), candidates.end(), [](const SolidCandidate& a, const SolidCandidate& b) {
    return a.overload != b.overload ? a.overload > b.overload : a.number < b.number;
  });
  std::vector<CrackValues> fields(candidates.size());  // null: not found yet, or not needed any more
  Size ahead = 1;
  for (Size i = 0; i < candidates.size(); ++i) {
    core::stop_if_asked();
    if (is_out_of_energy_) return;
    CrackValues field = std::move(fields[i]);
    if (is_shielded(candidates[i])) continue;
    if (!field) {
      look_ahead(candidates, i, ahead, fields);
      field = std::move(fields[i]);
    }
    ahead = start(candidates[i], std::move(field), cracks) ? 1 : std::min(2 * ahead, kMostAhead);
  }
}

}  // namespace shatterbox::fracture
