#include "engine/fracture/torn_solid.h"

#include <algorithm>
#include <utility>

#include "engine/core/index.h"
#include "engine/fracture/copies.h"
#include "engine/fracture/solid_tracer.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

std::vector<int> clamped_copies(const geometry::CopiedSolid& copied, const std::vector<int>& clamped) {
  std::vector<int> copies;
  for (Size v = 0; v < copied.vertex_sources.size(); ++v)
    if (std::binary_search(clamped.begin(), clamped.end(), copied.vertex_sources[v]))
      copies.push_back(static_cast<int>(v));
  return copies;
}

/// Each flaw once: in the copy whose material has it.
std::shared_ptr<const SolidFlawField> copy_flaws(const geometry::CopiedSolid& copied,
                                                 const SolidFlawField& flaws) {
  const geometry::SolidComplex& complex = copied.complex;
  const Size count = copied.element_sources.size();
  std::vector<std::vector<int>> cells_of(count);
  for (Size c = 0; c < complex.cells.size(); ++c)
    cells_of[at(complex.cells[c].element)].push_back(static_cast<int>(c));
  std::vector<int> copy_count(flaws.first_of_element.size(), 0);
  for (const int source : copied.element_sources) ++copy_count[at(source)];
  SolidFlawField own;
  own.greatest_strength = flaws.greatest_strength;
  own.first_of_element.assign(count + 1, 0);
  for (Size e = 0; e < count; ++e) {
    const int source = copied.element_sources[e];
    for (SolidFlaw flaw : flaws.of_element(source)) {
      const bool is_here = copy_count[at(source)] == 1 ||
                           std::any_of(cells_of[e].begin(), cells_of[e].end(),
                                       [&](int c) { return cell_holds(complex, c, flaw.place); });
      if (!is_here) continue;
      flaw.element = static_cast<int>(e);
      own.flaws.push_back(flaw);
    }
    own.first_of_element[e + 1] = static_cast<int>(own.flaws.size());
  }
  return std::make_shared<const SolidFlawField>(std::move(own));
}

std::shared_ptr<const SpaceGrains> copy_grains(const geometry::CopiedSolid& copied,
                                               const SpaceGrains& grains) {
  SpaceGrains own;
  own.seeds = grains.seeds;
  own.first_of_node.push_back(0);
  for (const int source : copied.vertex_sources) {
    const auto near = grains.of_node(source);
    own.near.insert(own.near.end(), near.begin(), near.end());
    own.first_of_node.push_back(static_cast<int>(own.near.size()));
    own.reach.push_back(grains.reach[at(source)]);
  }
  return std::make_shared<const SpaceGrains>(std::move(own));
}

}  // namespace

bool has_open_cracks(const geometry::SolidComplex& complex) {
  return std::any_of(complex.facets.begin(), complex.facets.end(), geometry::is_open_crack);
}

bool is_torn(const SolidSubject& subject) {
  return subject.complex && subject.complex->elements->topology.faces.empty();
}

std::shared_ptr<const TornSolid> make_torn(std::shared_ptr<const geometry::SolidComplex> source,
                                           const geometry::SolidMesh& mesh,
                                           const stress::SolidProperties& properties,
                                           const std::vector<int>& clamped) {
  auto torn = std::make_shared<TornSolid>();
  torn->copied = geometry::copy_elements(*source, mesh);
  for (const geometry::SolidFacet& facet : source->facets)
    if (is_open_crack(facet)) torn->area += facet_area_vector(*source, facet).norm();
  torn->source = std::move(source);
  const auto& complex = torn->copied.complex;
  torn->model = make_solid_model(std::make_shared<const geometry::SolidComplex>(complex),
                                 stress::make_solid_stiffness(complex.elements, properties),
                                 clamped_copies(torn->copied, clamped));
  return torn;
}

VecX carry(const TornSolid& torn, const VecX& displacement) {
  const std::vector<int>& sources = torn.model->mesh.vertex_source;
  VecX own(static_cast<Eigen::Index>(3 * sources.size()));
  for (Size v = 0; v < sources.size(); ++v)
    own.segment<3>(static_cast<Eigen::Index>(3 * v)) = displacement.segment<3>(3 * sources[v]);
  return own;
}

std::vector<Vec3> as_of_sources(const TornSolid& torn, const std::vector<Vec3>& moves) {
  return mean_of_copies(torn.copied.vertex_sources, torn.source->elements->mesh.positions.size(),
                        Vec3(Vec3::Zero()), [&](int v) { return moves[at(v)]; });
}

std::vector<Vec3> as_of_copies(const TornSolid& torn, const std::vector<Vec3>& moves) {
  std::vector<Vec3> own;
  own.reserve(torn.copied.vertex_sources.size());
  for (const int source : torn.copied.vertex_sources) own.push_back(moves[at(source)]);
  return own;
}

SolidSubject on_copies(const SolidSubject& subject, const std::shared_ptr<const TornSolid>& torn) {
  SolidSubject own = subject;
  own.complex = torn->model->complex;
  own.stiffness = torn->model->stiffness;
  own.model = nullptr;
  own.kept_model = std::make_shared<KeptSolidModel>();
  own.kept_turns = std::make_shared<KeptCrackTurns>();
  if (subject.flaws) own.flaws = copy_flaws(torn->copied, *subject.flaws);
  if (subject.grains) own.grains = copy_grains(torn->copied, *subject.grains);
  own.clamped_vertices = clamped_copies(torn->copied, subject.clamped_vertices);
  return own;
}

}  // namespace shatterbox::fracture
