#include "engine/fracture/solid_model.h"

#include <algorithm>
#include <utility>

#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/geometry/solid_surface.h"
#include "engine/stress/stress_bound.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

}  // namespace

std::shared_ptr<const SolidModel> KeptSolidModel::find() const {
  const std::lock_guard lock(mutex_);
  return model_;
}

void KeptSolidModel::keep(std::shared_ptr<const SolidModel> model) {
  const std::lock_guard lock(mutex_);
  if (!model_) model_ = std::move(model);
}

stress::SolidSkin make_skin(const geometry::SolidComplex& complex) {
  stress::SolidSkin skin;
  std::vector<int> number(complex.vertices.size(), -1);
  std::vector<int> corners;
  for (const int f : find_border_facets(complex)) {
    const geometry::SolidFacet& facet = complex.facets[at(f)];
    const bool is_backwards = facet.cells[0] < 0;
    corners.clear();
    for (int i = 0; i < facet.side_count; ++i) {
      const int vertex = complex.side_begin(complex.sides_of(facet)[i]);
      if (number[at(vertex)] < 0) {
        number[at(vertex)] = static_cast<int>(skin.mesh.positions.size());
        skin.mesh.positions.push_back(complex.position(vertex));
      }
      corners.push_back(number[at(vertex)]);
    }
    if (is_backwards) std::reverse(corners.begin(), corners.end());
    for (Size i = 1; i + 1 < corners.size(); ++i)
      skin.add({corners[0], corners[i], corners[i + 1]}, is_backwards ? facet.cells[1] : facet.cells[0]);
  }
  return skin;
}

SolidForm find_form(const geometry::SolidComplex& complex) {
  SolidForm form;
  core::parallel_for(2, 1, [&](Size part) {
    if (part == 1) {
      form.skin = make_skin(complex);
      return;
    }
    form.contacts = find_solid_contacts(complex);
    form.mesh = make_solid_mesh(complex, form.contacts);
  });
  return form;
}

stress::SolidSupport support_of(const geometry::SolidMesh& mesh, const std::vector<int>& clamped) {
  if (clamped.empty()) return {};
  std::vector<char> is_clamped(mesh.elements->mesh.positions.size(), 0);
  for (const int v : clamped) is_clamped[at(v)] = 1;
  return stress::find_solid_support(mesh, is_clamped);
}

bool SolidModel::is_full(const geometry::SolidPart& cell) const {
  constexpr double kFull = 1.0 - 1e-9;
  return cell.volume > kFull * geometry::tetrahedron_volume(complex->elements->mesh, cell.element);
}

std::shared_ptr<const SolidModel> make_solid_model(std::shared_ptr<const geometry::SolidComplex> complex,
                                                   std::shared_ptr<const stress::SolidStiffness> stiffness,
                                                   const std::vector<int>& clamped) {
  auto model = std::make_shared<SolidModel>();
  model->complex = std::move(complex);
  model->stiffness = std::move(stiffness);
  SolidForm form = find_form(*model->complex);
  model->contacts = std::move(form.contacts);
  model->mesh = std::move(form.mesh);
  model->skin = std::move(form.skin);
  stress::SolidSystemOptions options;
  options.support = support_of(model->mesh, clamped);
  auto system = stress::SolidSystem::make(model->stiffness, model->mesh, options);
  if (system)
    model->system = system.value();
  else
    model->fault = system.error();
  model->mass = geometry::solid_mass_properties(*model->complex, model->stiffness->properties.density);
  const geometry::TetMesh& tets = model->complex->elements->mesh;
  const auto box_of = [&](const auto& visit_vertices) {
    Vec3 low = Vec3::Constant(1e300), high = -low;
    visit_vertices([&](int v) {
      low = low.cwiseMin(tets.positions[at(v)]);
      high = high.cwiseMax(tets.positions[at(v)]);
    });
    return high.x() < low.x() ? Vec3(Vec3::Zero()) : Vec3(high - low);
  };
  model->size = box_of([&](const auto& add) {
                  for (const auto& t : tets.tetrahedra)
                    for (const int v : t) add(v);
                }).maxCoeff();
  Vec3 box = box_of([&](const auto& add) {
    for (const geometry::SolidCell& cell : model->mesh.cells)
      for (const int v : tets.tetrahedra[at(cell.element)]) add(v);
  });
  model->reach = box.norm();
  std::sort(box.data(), box.data() + 3);
  if (box(1) > 0.0)
    model->width = model->mass.mass / model->stiffness->properties.density / (box(1) * box(2));
  model->mean_edge_length = stress::mean_edge_length(model->mesh);
  model->stressed_volumes = stress::stressed_volumes(*model->stiffness, model->mesh, model->contacts);
  return model;
}

}  // namespace shatterbox::fracture
