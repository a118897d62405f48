#include <algorithm>
#include <queue>
#include <utility>

#include "engine/core/buckets.h"
#include "engine/core/index.h"
#include "engine/fracture/torn_solid.h"
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

/// In which of the elements with cells a place is. Those beyond a tear may be there too, and are asked last.
class ElementFinder {
 public:
  explicit ElementFinder(const geometry::SolidComplex& piece)
      : mesh_(piece.elements->mesh), asked_(mesh_.tetrahedra.size(), 0) {
    std::vector<char> has_cells(mesh_.tetrahedra.size(), 0);
    for (const geometry::SolidPart& cell : piece.cells) has_cells[at(cell.element)] = 1;
    at_node_ = core::Buckets(mesh_.positions.size(), 4 * mesh_.tetrahedra.size(), [&](std::size_t k) {
      return has_cells[k / 4] != 0 ? mesh_.tetrahedra[k / 4][k % 4] : -1;
    });
  }

  /// From `guess` over common nodes, towards the place: the first element that it is in; or, if it is in none
  /// of them, the one in which it is least outside.
  int find(const Vec3& place, int guess) {
    if (depth(guess, place) > -kInside) return guess;
    ++stamp_;
    std::priority_queue<std::pair<double, int>> next;  // the nearest first
    const auto reach = [&](int element) {
      if (asked_[at(element)] == stamp_) return;
      asked_[at(element)] = stamp_;
      next.emplace(-(middle(element) - place).squaredNorm(), element);
    };
    reach(guess);
    double deepest = -1e300;
    while (!next.empty()) {
      const int element = next.top().second;
      next.pop();
      const double d = depth(element, place);
      if (d > deepest) {
        deepest = d;
        guess = element;
      }
      if (d > -kInside) break;
      for (const int node : mesh_.tetrahedra[at(element)])
        for (const int k : at_node_.of(at(node))) reach(k / 4);
    }
    return guess;
  }

 private:
  static constexpr double kInside = 1e-9;

  Vec3 middle(int element) const {
    Vec3 sum = Vec3::Zero();
    for (const int node : mesh_.tetrahedra[at(element)]) sum += 0.25 * mesh_.positions[at(node)];
    return sum;
  }
  /// The least barycentric coordinate.
  double depth(int element, const Vec3& place) const {
    const Vec3 b = edge_matrix(mesh_, element).inverse() *
                   (place - mesh_.positions[at(mesh_.tetrahedra[at(element)][0])]);
    return std::min(b.minCoeff(), 1.0 - b.sum());
  }

  const geometry::TetMesh& mesh_;
  core::Buckets at_node_;   // corners of elements with cells (4 element + corner) by node
  std::vector<int> asked_;  // by element: the last search that came to it
  int stamp_ = 0;
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

Dented make_dented(const body::Body& body, const Fragile& fragile, const fracture::SolidDent& dent,
                   const fracture::LeftDents& left, double share) {
  Fragile whole = fragile;
  auto& subject = std::get<fracture::SolidSubject>(whole.subject);
  Dented dented;
  dented.share = share;
  dented.moves = moves_of_share(dent, share, left);
  if (dent.torn && dent.torn->source == subject.complex) {
    dented.torn = dent.torn;
    subject = on_copies(subject, dent.torn);
  } else {
    // It has more cracks by now, or gaped before.
    if (dent.torn) dented.moves = as_of_sources(*dent.torn, dented.moves);
    if (left.torn) dented.moves = as_of_copies(*left.torn, dented.moves);
  }
  const geometry::SolidComplex& before = *subject.complex;
  std::shared_ptr<geometry::SolidComplex> complex;
  dented.fragile = dent_fragile(whole, body.shape->mass,
                                deform(before, dented.moves, kDentFlatness * kKerf * whole.size), complex);
  dented.shape = make_solid_shape(*complex, *dented.fragile);
  dented.pose = dented_pose(body, *dented.shape);
  dented.volume_change = total_volume(*complex) / total_volume(before) - 1.0;
  const Carrier back(complex->elements->mesh, before.elements->mesh);
  // A triangle reaches over several elements where these have stayed flat, and tells one of them.
  ElementFinder finder(*complex);
  set_way(
      body, [&](int element, const Vec3& place) { return back.carry(finder.find(place, element), place); },
      dented);
  return dented;
}

}  // namespace shatterbox::world
