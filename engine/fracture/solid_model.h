// What every impact on one piece of a solid asks of it, whatever the load: made once a piece, shared by its
// copies.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/geometry/mass_properties.h"
#include "engine/geometry/solid_complex.h"
#include "engine/geometry/solid_contacts.h"
#include "engine/stress/solid_load.h"
#include "engine/stress/solid_stiffness.h"
#include "engine/stress/solid_system.h"

namespace shatterbox::fracture {

struct SolidModel {
  std::shared_ptr<const geometry::SolidComplex> complex;  // settled
  std::shared_ptr<const stress::SolidStiffness> stiffness;
  std::vector<geometry::SolidContact> contacts;
  geometry::SolidMesh mesh;
  stress::SolidSkin skin;
  std::shared_ptr<const stress::SolidSystem> system;  // null: `fault` says why
  std::string fault;
  geometry::MassProperties mass;         // kg, m
  double size = 0.0;                     // m, greatest side of the bounding box of the uncut elements
  double reach = 0.0;                    // m, diagonal of the box of the elements with cells
  double width = 0.0;                    // m: its volume over the two greatest sides of that box
  double mean_edge_length = 0.0;         // m, of the elements with cells
  std::vector<double> stressed_volumes;  // |cells|, m3: see stress/stress_bound.h

  /// Whether a cell fills its element.
  bool is_full(const geometry::SolidPart& cell) const;
};

/// The model of one piece, made at the first impact that asks for it and kept for the next.
class KeptSolidModel {
 public:
  /// Null: not made yet. Any thread.
  std::shared_ptr<const SolidModel> find() const;
  /// Any thread; the first one stays.
  void keep(std::shared_ptr<const SolidModel> model);

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const SolidModel> model_;
};

/// The skin of a settled complex: what is left of the outer surface, and crack faces behind which nothing is.
stress::SolidSkin make_skin(const geometry::SolidComplex& complex);

/// What a settled complex is to the stress.
struct SolidForm {
  std::vector<geometry::SolidContact> contacts;
  geometry::SolidMesh mesh;
  stress::SolidSkin skin;
};
SolidForm find_form(const geometry::SolidComplex& complex);

/// `clamped`: vertices of the element mesh that are held.
std::shared_ptr<const SolidModel> make_solid_model(std::shared_ptr<const geometry::SolidComplex> complex,
                                                   std::shared_ptr<const stress::SolidStiffness> stiffness,
                                                   const std::vector<int>& clamped);

/// The support of a mesh by clamped vertices of the element mesh.
stress::SolidSupport support_of(const geometry::SolidMesh& mesh, const std::vector<int>& clamped);

}  // namespace shatterbox::fracture
