#include <algorithm>
#include <utility>

#include "engine/core/index.h"
#include "engine/geometry/solid_deform.h"
#include "engine/world/dented.h"
#include "engine/world/forms.h"

namespace shatterbox::world {
namespace {

using core::at;

constexpr double kDentFlatness = 0.25;  // of a kerf: what of a given triangle bends by less stays one

/// Places in elements, after these have moved.
class Carrier {
 public:
  Carrier(const geometry::TetMesh& from, const geometry::TetMesh& to) : from_(from), to_(to) {}

  Vec3 carry(int element, const Vec3& place) const {
    const Vec3 local = edge_matrix(from_, element).inverse() * (place - first(from_, element));
    return first(to_, element) + edge_matrix(to_, element) * local;
  }

 private:
  static const Vec3& first(const geometry::TetMesh& mesh, int element) {
    return mesh.positions[at(mesh.tetrahedra[at(element)][0])];
  }
  const geometry::TetMesh& from_;
  const geometry::TetMesh& to_;
};

/// In which of the elements with cells a place is.
class ElementFinder {
 public:
  explicit ElementFinder(const geometry::SolidComplex& piece) : mesh_(piece.elements->mesh) {
    for (const geometry::SolidPart& cell : piece.cells) elements_.push_back(cell.element);
    std::sort(elements_.begin(), elements_.end());
    elements_.erase(std::unique(elements_.begin(), elements_.end()), elements_.end());
    inverses_.resize(mesh_.tetrahedra.size());
    for (const int e : elements_) inverses_[at(e)] = edge_matrix(mesh_, e).inverse();
  }

  /// `guess`, if the place is in it, or else the one in which it is most, or least outside.
  int find(const Vec3& place, int guess) const {
    if (depth(guess, place) > -kInside) return guess;
    double deepest = -1e300;
    for (const int e : elements_) {
      const double d = depth(e, place);
      if (d <= deepest) continue;
      deepest = d;
      guess = e;
    }
    return guess;
  }

 private:
  static constexpr double kInside = 1e-9;

  /// The least barycentric coordinate.
  double depth(int element, const Vec3& place) const {
    const Vec3 b = inverses_[at(element)] * (place - mesh_.positions[at(mesh_.tetrahedra[at(element)][0])]);
    return std::min(b.minCoeff(), 1.0 - b.sum());
  }

  const geometry::TetMesh& mesh_;
  std::vector<int> elements_;
  std::vector<Mat3> inverses_;  // of their edges, by element
};

std::shared_ptr<const fracture::SolidFlawField> carry_flaws(const fracture::SolidFlawField& flaws,
                                                            const geometry::SolidComplex& piece,
                                                            const Carrier& carrier) {
  std::vector<char> has_cells(piece.elements->mesh.tetrahedra.size(), 0);
  for (const geometry::SolidPart& cell : piece.cells) has_cells[at(cell.element)] = 1;
  auto carried = std::make_shared<fracture::SolidFlawField>(flaws);
  for (fracture::SolidFlaw& flaw : carried->flaws)
    if (has_cells[at(flaw.element)] != 0) flaw.place = carrier.carry(flaw.element, flaw.place);
  return carried;
}

std::vector<std::uint8_t> parts_of_tags(const std::vector<std::uint8_t>& parts,
                                        const std::vector<int>& tag_sources) {
  if (parts.empty()) return {};
  std::vector<std::uint8_t> out;
  for (const int source : tag_sources) out.push_back(parts[at(source)]);
  return out;
}

/// The solid in its new shape; the mass is what it was.
std::shared_ptr<Fragile> dent_fragile(const Fragile& whole, double mass, geometry::DeformedSolid deformed,
                                      std::shared_ptr<geometry::SolidComplex>& complex) {
  auto fragile = std::make_shared<Fragile>(whole);
  auto& subject = std::get<fracture::SolidSubject>(fragile->subject);
  const geometry::SolidComplex& before = *subject.complex;
  complex = std::make_shared<geometry::SolidComplex>(std::move(deformed.complex));
  const Carrier carrier(before.elements->mesh, complex->elements->mesh);
  fragile->density = mass / total_volume(*complex);
  fragile->parts = parts_of_tags(whole.parts, deformed.tag_sources);
  subject.material.density = fragile->density;
  subject.flaws = carry_flaws(*subject.flaws, before, carrier);
  const material::Material& material = subject.material;
  subject.stiffness =
      stress::make_solid_stiffness(complex->elements, {material.young, material.poisson, material.density});
  subject.complex = complex;
  subject.model = nullptr;
  subject.kept_model = std::make_shared<fracture::KeptSolidModel>();
  return fragile;
}

}  // namespace

Dented make_dented(const body::Body& body, const Fragile& whole, const fracture::SolidDent& dent,
                   const fracture::LeftDents& left, double share) {
  const geometry::SolidComplex& before = *std::get<fracture::SolidSubject>(whole.subject).complex;
  Dented dented;
  dented.share = share;
  dented.moves = moves_of_share(dent, share, left);
  std::shared_ptr<geometry::SolidComplex> complex;
  dented.fragile = dent_fragile(whole, body.shape->mass,
                                deform(before, dented.moves, kDentFlatness * kKerf * whole.size), complex);
  dented.shape = make_solid_shape(*complex, *dented.fragile);
  dented.pose = dented_pose(body, *dented.shape);
  dented.volume_change = total_volume(*complex) / total_volume(before) - 1.0;
  const Carrier back(complex->elements->mesh, before.elements->mesh);
  // A triangle reaches over several elements where these have stayed flat, and tells one of them.
  const ElementFinder finder(*complex);
  set_way(
      body, [&](int element, const Vec3& place) { return back.carry(finder.find(place, element), place); },
      dented);
  return dented;
}

}  // namespace shatterbox::world
