// Forms: what a description of a body becomes, once for all bodies that are alike. Mass properties, the
// surface for contact, and what the breakable ones need for their verdicts.
#pragma once

#include "engine/core/hash.h"
#include "engine/core/result.h"
#include "engine/geometry/standing_surface.h"
#include "engine/geometry/surface_distance.h"
#include "engine/world/description.h"
#include "engine/world/fragile.h"

namespace shatterbox::world {

/// A form that several bodies share, found again by what it was made from.
struct SharedForm {
  std::uint64_t key = 0;
  std::shared_ptr<const body::Shape> shape;
  std::shared_ptr<const Fragile> fragile;  // without flaws: those are each body's own; null: does not break
  Vec3 centre = Vec3::Zero();              // m, of mass, in the description's frame
};

/// What a mesh's form is made of.
struct Substance {
  const material::Material& material;
  int number = 0;        // the material's
  double density = 0.0;  // kg/m3
  bool breaks = false;
};

/// Why a form cannot be made; empty if it can.
std::string find_form_fault(const BodyDescription& description);

/// m: of the elements into which a solid is divided if it may break.
double element_size_of(const SolidDescription& solid);

/// What a form is found again by.
std::uint64_t form_key(const ShellDescription& shell, const Substance& substance);
std::uint64_t form_key(const SolidDescription& solid, const Substance& substance);

/// Of what passed find_form_fault. A breakable solid is divided into tetrahedra, which may fail.
core::Result<SharedForm> make_form(const ShellDescription& shell, const Substance& substance);
core::Result<SharedForm> make_form(const SolidDescription& solid, const Substance& substance);

std::shared_ptr<const body::Shape> make_analytic_shape(const BodyDescription& description, double density);

/// The kept factors of a subject's mesh, for `stiffness`; the support is that of its clamped vertices, with
/// no turning about an edge between two of them.
std::shared_ptr<stress::ShellSystemCache> make_systems(
    const fracture::ShellSubject& subject, std::shared_ptr<const stress::ShellStiffness> stiffness);

/// The shape of a shell: the true cut gives mass, centre and inertia, the surface stands back from crack
/// faces and within that of the `whole` it was cut from, if that had been cut before.
std::shared_ptr<const body::Shape> make_shell_shape(const geometry::ShellMesh& mesh, const Fragile& fragile,
                                                    double thickness,
                                                    const geometry::StandingSurface* whole = nullptr);

/// Likewise of a piece of a solid (settled), which gets to know its surface.
std::shared_ptr<const body::Shape> make_solid_shape(geometry::SolidComplex& piece, const Fragile& fragile,
                                                    const geometry::SurfaceDistance* whole = nullptr);

}  // namespace shatterbox::world
