#include <algorithm>
#include <utility>

#include "engine/core/index.h"
#include "engine/fracture/shell_subject.h"
#include "engine/world/dented.h"
#include "engine/world/forms.h"

namespace shatterbox::world {
namespace {

using core::at;

/// Directions of an element: two sides and its normal.
Mat3 directions_of(const geometry::ShellElements& elements, int element) {
  const geometry::Triangle& t = elements.mesh.triangles[at(element)];
  const Vec3& origin = elements.mesh.positions[at(t[0])];
  Mat3 directions;
  directions << elements.mesh.positions[at(t[1])] - origin, elements.mesh.positions[at(t[2])] - origin,
      geometry::facet_frame(elements, element).col(2);
  return directions;
}

/// A direction, or a place from corner 0, of one element as it lies in another.
Vec3 carry(const geometry::ShellElements& from, const geometry::ShellElements& to, int element,
           const Vec3& v) {
  return directions_of(to, element) * (directions_of(from, element).inverse() * v);
}

std::shared_ptr<const geometry::ShellMesh> deform(const geometry::ShellMesh& before,
                                                  const std::vector<Vec3>& moves) {
  auto elements = std::make_shared<geometry::ShellElements>(*before.elements);
  for (std::size_t v = 0; v < moves.size(); ++v) elements->mesh.positions[v] += moves[v];
  return std::make_shared<const geometry::ShellMesh>(on_elements(before, std::move(elements)));
}

/// The shell in its new shape. Flaws and grains lie in elements, and go along.
std::shared_ptr<Fragile> dent_fragile(const Fragile& whole, double mass,
                                      std::shared_ptr<const geometry::ShellMesh> mesh) {
  auto fragile = std::make_shared<Fragile>(whole);
  auto& subject = std::get<fracture::ShellSubject>(fragile->subject);
  const geometry::ShellElements& before = *subject.mesh->elements;
  fragile->density = mass / (total_area(*mesh) * subject.thickness);
  subject.mesh = std::move(mesh);
  subject.material.density = fragile->density;
  for (fracture::CrackTip& tip : subject.tips)
    tip.heading = carry(before, *subject.mesh->elements, tip.element, tip.heading).normalized();
  subject.systems = make_systems(
      subject, stress::make_shell_stiffness(subject.mesh->elements, fracture::properties_of(subject),
                                            subject.systems->stiffness().vertex_rank));
  return fragile;
}

}  // namespace

Dented make_dented(const body::Body& body, const Fragile& whole, const std::vector<Vec3>& moves,
                   double share) {
  const auto& subject = std::get<fracture::ShellSubject>(whole.subject);
  const auto mesh = deform(*subject.mesh, moves);
  Dented dented;
  dented.share = share;
  dented.fragile = dent_fragile(whole, body.shape->mass, mesh);
  dented.shape = make_shell_shape(*mesh, *dented.fragile, subject.thickness);
  dented.pose = dented_pose(body, *dented.shape);
  dented.volume_change = total_area(*mesh) / total_area(*subject.mesh) - 1.0;
  const geometry::ShellElements &before = *subject.mesh->elements, &after = *mesh->elements;
  set_way(
      body,
      [&](int element, const Vec3& place) {
        const std::size_t corner = at(before.mesh.triangles[at(element)][0]);
        return Vec3(before.mesh.positions[corner] +
                    carry(after, before, element, place - after.mesh.positions[corner]));
      },
      dented);
  return dented;
}

}  // namespace shatterbox::world
