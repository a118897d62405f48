#include "engine/fracture/solid_tracer.h"

#include <algorithm>
#include <cmath>

#include "engine/core/elementary.h"
#include "engine/core/index.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

double tension(const stress::SolidStress& stress, const Vec3& normal) {
  return normal.dot(stress::stress_tensor(stress) * normal);
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
      field_(complex, *setup_.around),
      origin_(complex.cells.size()),
      entered_(complex.cells.size(), 0) {
  for (Size c = 0; c < origin_.size(); ++c) origin_[c] = static_cast<int>(c);
  toughness_ = core::sqrt(setup_.material->young * setup_.material->fracture_energy);
}

bool SolidTracer::pay(double area) {
  const double cost = setup_.material->fracture_energy * area;
  if (setup_.energy_budget >= 0.0 && energy_ + cost > setup_.energy_budget) {
    is_out_of_energy_ = true;
    return false;
  }
  energy_ += cost;
  return true;
}

/// Across the first principal stress of the element's material; where the two greatest are alike, and over
/// less than the length in which it turns, a crack goes straight on.
Vec3 SolidTracer::wanted_normal(int element, const Vec3& present) const {
  const std::vector<int> cells = cutter_.cells_of(element);
  if (cells.empty()) return present;
  const stress::PrincipalAxes axes =
      stress::principal_axes((*setup_.stresses)[at(origin_[at(cells.front())])]);
  if (!(axes.values(0) > 0.0)) return present;
  Vec3 across = axes.directions.col(0);
  if (across.dot(present) < 0.0) across = -across;
  const double anisotropy = std::clamp((axes.values(0) - axes.values(1)) / axes.values(0), 0.0, 1.0);
  const geometry::TetMesh& mesh = complex_.elements->mesh;
  const geometry::Tetrahedron& t = mesh.tetrahedra[at(element)];
  const Vec3 middle = 0.25 * (mesh.positions[at(t[0])] + mesh.positions[at(t[1])] + mesh.positions[at(t[2])] +
                              mesh.positions[at(t[3])]);
  const double way = (mesh.positions[at(t[0])] - mesh.positions[at(t[1])]).norm();
  int least = 0;
  across.cwiseAbs().minCoeff(&least);
  const Vec3 u = across.cross(Vec3::Unit(least)).normalized();
  const Vec3 wavy = across + setup_.noise_a->at(middle) * u + setup_.noise_b->at(middle) * across.cross(u);
  // Where little pulls, as in the pressed half of a bent bar, what drives the crack is elsewhere.
  const double mean = new_area_ > 0.0 ? crack_force_ / new_area_ : 0.0;
  const double pull = mean > 0.0 ? std::min(1.0, axes.values(0) / mean) : 1.0;
  const double share = 1.0 - core::exp(-pull * anisotropy * anisotropy * way / setup_.turn_length);
  return ((1.0 - share) * present + share * wavy.normalized()).normalized();
}

double SolidTracer::tension_across(int cell, const Vec3& gradient) const {
  const double steep = gradient.norm();
  if (!(steep > 0.0)) return 0.0;
  return tension((*setup_.stresses)[at(origin_[at(cell)])], gradient / steep);
}

/// Takes a cell into the crack; its crossed facets become fronts.
void SolidTracer::enter(int cell, const CrackCap& cap) {
  entered_[at(cell)] = present_id_ + 1;
  active_.push_back(cell);
  crack_area_ += cap.area;
  new_area_ += cap.area;
  CrackStretch stretch;
  stretch.begin = stretch.end = cap.middle;
  stretch.crack = present_id_;
  stretch.piece = (*setup_.pieces)[at(origin_[at(cell)])];
  present_.add(stretch);
  const Vec3 gradient = field_.gradient(complex_.cells[at(cell)].element);
  crack_force_ += cap.area * tension_across(cell, gradient);
  const geometry::SolidPart part = complex_.cells[at(cell)];
  for (int f = 0; f < part.facet_count; ++f) {
    const geometry::SolidFacet& facet =
        complex_.facets[at(complex_.cell_facets[at(part.first_facet + f)] / 2)];
    const int next = facet.cells[0] == cell ? facet.cells[1] : facet.cells[0];
    if (next < 0 || facet.kind == geometry::FacetKind::crack || entered_[at(next)] == present_id_ + 1 ||
        !field_.crosses(facet))
      continue;
    fronts_.push_back({tension_across(next, gradient), next_order_++, next});
    std::push_heap(fronts_.begin(), fronts_.end());
  }
}

/// From front to front, the most driven first. What drives a crack is the force across all of it: K = mean
/// tension sqrt(pi / 2 length), which of a force at the crack's middle falls as its radius^-3/2, as it
/// should, and takes the crack of a bent bar on into the half that is pressed.
void SolidTracer::grow() {
  while (!fronts_.empty()) {
    std::pop_heap(fronts_.begin(), fronts_.end());
    const int cell = fronts_.back().cell;
    fronts_.pop_back();
    if (entered_[at(cell)] == present_id_ + 1) continue;
    const int element = complex_.cells[at(cell)].element;
    if (!field_.has_all(element))
      field_.reach(element, [this](int e, const Vec3& normal) { return wanted_normal(e, normal); });
    if (!field_.has_all(element)) continue;
    settle_cell(complex_, cell);
    const CrackCap cap = field_.cap(cell);
    if (!(cap.area > 0.0)) continue;
    const double force = crack_force_ + cap.area * tension_across(cell, field_.gradient(element));
    const double intensity = std::max(0.0, force / (new_area_ + cap.area)) *
                             core::sqrt(0.5 * core::kPi * core::sqrt(crack_area_ + cap.area));
    if (intensity < toughness_ || !pay(cap.area)) {
      rests_.push_back(element);
      if (is_out_of_energy_) return;
      continue;
    }
    enter(cell, cap);
  }
}

void SolidTracer::begin(int id, double area) {
  active_.clear();
  fronts_.clear();
  rests_.clear();
  next_order_ = 0;
  present_id_ = id;
  crack_area_ = area;
  new_area_ = crack_force_ = 0.0;
  if (lengths_.size() <= at(id)) lengths_.resize(at(id) + 1, 0.0);
}

/// Whether a settled cell has a neighbour that the present crack has cut, or is going to.
bool SolidTracer::touches_present(int cell) {
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
      if (face.kind == geometry::FacetKind::crack && face.tag == present_id_) return true;
    }
  }
  return false;
}

void SolidTracer::resume(std::vector<OpenCrack>& cracks) {
  for (OpenCrack& crack : cracks) {
    if (is_out_of_energy_) return;
    std::sort(crack.rests.begin(), crack.rests.end());
    crack.rests.erase(std::unique(crack.rests.begin(), crack.rests.end()), crack.rests.end());
    begin(crack.id, crack.area);
    lengths_[at(crack.id)] = core::sqrt(crack.area);
    field_.restore(crack.values);
    for (const int element : crack.rests)
      for (const int cell : cutter_.cells_of(element)) {
        settle_cell(complex_, cell);
        if (!field_.has_all(element) || !(field_.cap(cell).area > 0.0) || !touches_present(cell)) continue;
        fronts_.push_back({tension_across(cell, field_.gradient(element)), next_order_++, cell});
        std::push_heap(fronts_.begin(), fronts_.end());
      }
    grow();
    if (!active_.empty()) cut();
    crack.area = crack_area_;
    crack.values = field_.known();
    crack.rests = rests_;
  }
}

bool SolidTracer::start(const SolidCandidate& candidate, std::vector<OpenCrack>& cracks) {
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
  const stress::PrincipalAxes axes = stress::principal_axes((*setup_.stresses)[at(origin_[at(cell)])]);
  begin(setup_.first_id + crack_count_, 0.0);
  field_.start(element, candidate.place, axes.directions.col(0));
  const CrackCap cap = field_.cap(cell);
  if (!(cap.area > 0.0) || !pay(cap.area)) return false;
  enter(cell, cap);
  grow();
  cut();
  ++crack_count_;
  cracks.push_back({present_id_, crack_area_, field_.known(), rests_});
  return true;
}

void SolidTracer::cut() {
  geometry::SolidCut cut;
  cut.node_values = field_.values();
  cut.cells = active_;
  cut.id = present_id_;
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
  lengths_[at(present_id_)] = core::sqrt(crack_area_);
}

bool SolidTracer::is_shielded(const SolidCandidate& candidate) const {
  double nearest = 1e300;
  for (const SolidLoadCentre& centre : setup_.centres)
    nearest = std::min(nearest, std::max((candidate.place - centre.point).norm(), centre.radius));
  const double reach = nearest / core::sqrt(candidate.overload);
  const double spacing = setup_.material->crack_spacing;
  const int piece = (*setup_.pieces)[at(candidate.cell)];
  bool is_near = false;
  present_.visit_near(candidate.place, spacing * reach,
                      [&](const CrackStretch& s, const Vec3&, double distance) {
                        // A crack unloads nothing beyond another one.
                        if (s.piece != piece) return true;
                        is_near = distance < spacing * std::min(lengths_[at(s.crack)], reach);
                        return !is_near;
                      });
  return is_near;
}

void SolidTracer::nucleate(std::vector<SolidCandidate> candidates, std::vector<OpenCrack>& cracks) {
  std::sort(candidates.begin(), candidates.end(), [](const SolidCandidate& a, const SolidCandidate& b) {
    return a.overload != b.overload ? a.overload > b.overload : a.number < b.number;
  });
  for (const SolidCandidate& candidate : candidates) {
    if (is_out_of_energy_) return;
    if (!is_shielded(candidate)) start(candidate, cracks);
  }
}

}  // namespace shatterbox::fracture
