#include "engine/world/forms.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/core/elementary.h"
#include "engine/core/parallel.h"
#include "engine/fracture/shell_subject.h"
#include "engine/fracture/space_grains.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/mesh_diagnosis.h"
#include "engine/geometry/shell_surface.h"
#include "engine/geometry/solid_kerf.h"
#include "engine/geometry/solid_surface.h"
#include "engine/geometry/tetrahedralise.h"
#include "engine/world/limits.h"

namespace shatterbox::world {
namespace {

using Size = std::size_t;

constexpr double kMostSheetGrains = 20000.0;  // of which making takes a second

/// Of a breakable solid whose element size is not given.
constexpr int kUsualTetrahedra = 10000;
/// Share of the body's size within which pieces of a solid still sit beside each other.
constexpr double kSolidSeat = 0.01;

/// Of the mesh, its looks and density.
core::Hash hash_mesh(const geometry::TriangleMesh& mesh, const std::vector<std::uint8_t>& parts,
                     double density) {
  core::Hash hash;
  for (const Vec3& p : mesh.positions) hash.add(p);
  for (const geometry::Triangle& t : mesh.triangles)
    for (const int v : t) hash.add(static_cast<std::uint64_t>(v));
  for (const std::uint8_t part : parts) hash.add(std::uint64_t{part});
  return hash.add(density);
}

fracture::ShellSubject make_subject(const ShellDescription& shell, const material::Material& material,
                                    std::shared_ptr<const geometry::ShellMesh> mesh) {
  fracture::ShellSubject subject;
  subject.mesh = std::move(mesh);
  subject.material = material;
  subject.thickness = shell.thickness;
  subject.clamped_vertices = shell.clamped;
  std::sort(subject.clamped_vertices.begin(), subject.clamped_vertices.end());
  return subject;
}

std::string find_mesh_fault(const geometry::TriangleMesh& mesh, const std::vector<std::uint8_t>& parts,
                            const std::string& what) {
  if (mesh.triangles.empty()) return "the mesh has no triangles";
  if (!parts.empty() && parts.size() != mesh.triangles.size())
    return "a " + what + "'s parts must be one number a triangle";
  const int count = static_cast<int>(mesh.positions.size());
  for (const geometry::Triangle& t : mesh.triangles)
    for (const int v : t)
      if (v < 0 || v >= count) return "a triangle names a vertex that is not there; mend the mesh first";
  for (const Vec3& p : mesh.positions)
    if (!is_within(p, kMostLength)) return "a vertex of the mesh is at no finite place within 1e6 m";
  return {};
}

/// A sentence, or nothing, if mending would leave the mesh as it is.
std::string find_unmended(const geometry::TriangleMesh& mesh) {
  geometry::MendOptions options;
  options.allow_loose_parts = true;
  for (const geometry::MeshFinding& finding : geometry::diagnose(mesh, options).findings)
    if (finding.severity != geometry::Severity::noted)
      return "the mesh was not mended (geometry::mend does that): " + finding.sentence;
  return {};
}

std::string find_solid_fault(const SolidDescription& solid) {
  std::string fault = find_mesh_fault(solid.mesh, solid.parts, "solid");
  if (!fault.empty()) return fault;
  const geometry::EdgeTopology topology = geometry::build_edge_topology(solid.mesh.triangles);
  for (int e = 0; e < static_cast<int>(topology.edges.size()); ++e)
    if (topology.triangle_count(e) != 2) return "a solid's mesh must be closed: each edge of two triangles";
  if (!(geometry::enclosed_volume(solid.mesh) > 0.0)) return "the mesh is inside out, or flat";
  return {};
}

/// Moves a mesh's centre of mass into the origin; returns the distance of the farthest vertex from there, m.
double centre_mesh(geometry::TriangleMesh& mesh, const Vec3& centre) {
  double radius = 0.0;
  for (Vec3& p : mesh.positions) {
    p -= centre;
    radius = std::max(radius, p.norm());
  }
  return radius;
}

geometry::TetrahedraOptions options_of(const SolidDescription& solid) {
  geometry::TetrahedraOptions options;
  options.element_size = solid.element_size;
  options.count = kUsualTetrahedra;
  options.grading = solid.grading;
  return options;
}

/// m: a volume over the two greatest sides of the box about some points.
double width_of(const std::vector<Vec3>& points, double volume) {
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Vec3 box = high - low;
  std::sort(box.data(), box.data() + 3);
  return volume / (box(1) * box(2));
}

std::string too_many_grains(const material::Material& material, double count, double most, double dimension) {
  char text[256];
  std::snprintf(text, sizeof text,
                "a grain_size of %.3g m makes some %.3g grains of it, and a body has %.0f at most: give its "
                "material %.2g m or more, or 0 for none",
                material.grain_size, count, most,
                1.05 * material.grain_size * core::pow(count / most, 1.0 / dimension));
  return text;
}

/// A sentence, or nothing, if the material divides the body into no more grains than it may have.
std::string find_grain_fault(const material::Material& material, const geometry::TriangleMesh& surface,
                             bool is_solid) {
  if (!(material.grain_size > 0.0)) return {};
  if (!is_solid) {
    const double count = geometry::surface_area(surface) / (material.grain_size * material.grain_size);
    return count > kMostSheetGrains ? too_many_grains(material, count, kMostSheetGrains, 2.0) : std::string();
  }
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const Vec3& p : surface.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double count = fracture::expected_grains(high - low, material);
  return count > fracture::kMostSpaceGrains
             ? too_many_grains(material, count, fracture::kMostSpaceGrains, 3.0)
             : std::string();
}

/// What a solid's verdict needs; `surface` has its centre of mass in the origin.
core::Result<fracture::SolidSubject> make_subject(const SolidDescription& solid,
                                                  const material::Material& material,
                                                  const geometry::TriangleMesh& surface, const Vec3& centre) {
  if (const std::string fault = find_grain_fault(material, surface, true); !fault.empty())
    return core::Error{fault};
  auto embedded = geometry::tetrahedralise(surface, options_of(solid));
  if (!embedded) return core::Error{"it cannot be divided into tetrahedra: " + embedded.error()};
  const auto& elements = embedded.value().elements;
  auto complex = geometry::build_solid_complex(elements, embedded.value().embedded.material);
  geometry::settle(complex);
  fracture::SolidSubject subject;
  subject.complex = std::make_shared<const geometry::SolidComplex>(std::move(complex));
  subject.material = material;
  // Vertices of the elements lie a little beyond the surface.
  const double slack = 0.5 * embedded.value().element_size;
  const std::vector<Vec3>& positions = elements->mesh.positions;
  for (Size v = 0; v < positions.size() && !solid.held.empty(); ++v)
    if (std::all_of(solid.held.begin(), solid.held.end(), [&](const HalfSpace& half) {
          return half.normal.dot(positions[v] + centre) <= half.offset + slack;
        }))
      subject.clamped_vertices.push_back(static_cast<int>(v));
  if (!solid.held.empty() && subject.clamped_vertices.empty())
    return core::Error{"its support holds none of it"};
  subject.stiffness =
      stress::make_solid_stiffness(elements, {material.young, material.poisson, material.density});
  subject.model = fracture::make_solid_model(subject.complex, subject.stiffness, subject.clamped_vertices);
  if (!subject.model->system) return core::Error{"its stress cannot be told: " + subject.model->fault};
  return subject;
}

}  // namespace

double element_size_of(const SolidDescription& solid) {
  return geometry::element_size_for(solid.mesh, options_of(solid));
}

std::string find_form_fault(const BodyDescription& description) {
  if (const auto* box = std::get_if<BoxDescription>(&description.form))
    if (!(box->half_extent.minCoeff() > 0.0) || !is_within(box->half_extent, kMostLength))
      return "a box needs an extent above zero along every axis, and no more than 1e6 m";
  if (const auto* sphere = std::get_if<SphereDescription>(&description.form))
    if (!is_positive(sphere->radius, kMostLength))
      return "a sphere needs a radius above zero, and no more than 1e6 m";
  if (const auto* capsule = std::get_if<CapsuleDescription>(&description.form)) {
    if (!(capsule->radius > 0.0)) return "a capsule needs a radius above zero";
    if (!(capsule->length > 2.0 * capsule->radius) || !(capsule->length <= kMostLength))
      return "a capsule is longer than twice its radius, and no longer than 1e6 m";
  }
  if (const auto* shell = std::get_if<ShellDescription>(&description.form)) {
    std::string fault = find_mesh_fault(shell->mesh, shell->parts, "shell");
    if (!fault.empty()) return fault;
    if (!is_positive(shell->thickness, kMostLength)) return "a shell needs a thickness above zero";
    const int count = static_cast<int>(shell->mesh.positions.size());
    for (const int v : shell->clamped)
      if (v < 0 || v >= count) return "the support names a vertex that is not there";
  }
  if (const auto* solid = std::get_if<SolidDescription>(&description.form)) return find_solid_fault(*solid);
  return {};
}

std::uint64_t form_key(const ShellDescription& shell, const Substance& substance) {
  core::Hash hash = hash_mesh(shell.mesh, shell.parts, substance.density);
  for (const int vertex : shell.clamped) hash.add(static_cast<std::uint64_t>(vertex) + 1);
  hash.add(shell.thickness).add(substance.material.young);
  return hash.add(static_cast<std::uint64_t>(substance.number)).add(std::uint64_t{substance.breaks}).value();
}

std::uint64_t form_key(const SolidDescription& solid, const Substance& substance) {
  core::Hash hash = hash_mesh(solid.mesh, solid.parts, substance.density);
  hash.add(std::uint64_t{substance.breaks});
  if (!substance.breaks) return hash.value();
  for (const HalfSpace& half : solid.held) hash.add(half.normal).add(half.offset);
  hash.add(solid.element_size).add(static_cast<std::uint64_t>(solid.grading)).add(substance.material.young);
  return hash.add(static_cast<std::uint64_t>(substance.number)).value();
}

std::shared_ptr<const body::Shape> make_analytic_shape(const BodyDescription& description, double density) {
  auto shape = std::make_shared<body::Shape>();
  geometry::MassProperties mass;
  if (const auto* box = std::get_if<BoxDescription>(&description.form)) {
    shape->kind = body::ShapeKind::box;
    shape->half_extent = box->half_extent;
    shape->bounding_radius = box->half_extent.norm();
    mass = geometry::box_mass_properties(box->half_extent, density);
  } else if (const auto* sphere = std::get_if<SphereDescription>(&description.form)) {
    shape->kind = body::ShapeKind::sphere;
    shape->radius = shape->bounding_radius = sphere->radius;
    mass = geometry::sphere_mass_properties(sphere->radius, density);
  } else if (const auto* capsule = std::get_if<CapsuleDescription>(&description.form)) {
    shape->kind = body::ShapeKind::capsule;
    shape->radius = capsule->radius;
    shape->half_length = 0.5 * capsule->length - capsule->radius;
    shape->bounding_radius = 0.5 * capsule->length;
    mass = geometry::capsule_mass_properties(capsule->radius, shape->half_length, density);
  } else {
    shape->kind = body::ShapeKind::plane;
  }
  shape->mass = mass.mass;
  shape->inertia = mass.inertia;
  return shape;
}

core::Result<SharedForm> make_form(const ShellDescription& shell, const Substance& substance) {
  if (const std::string fault = find_unmended(shell.mesh); !fault.empty()) return core::Error{fault};
  const double density = substance.density;
  auto elements = std::make_shared<geometry::ShellElements>();
  const geometry::MassProperties mass = geometry::shell_mass_properties(shell.mesh, shell.thickness, density);
  elements->mesh = shell.mesh;
  const double radius = centre_mesh(elements->mesh, mass.centre);
  elements->topology = geometry::build_edge_topology(elements->mesh.triangles);
  auto mesh = std::make_shared<const geometry::ShellMesh>(geometry::make_shell_mesh(elements));
  Fragile fragile;
  fragile.size = 2.0 * radius;
  fragile.density = density;
  fragile.parts = shell.parts;
  SharedForm form;
  form.shape = make_shell_shape(*mesh, fragile, shell.thickness);
  form.centre = mass.centre;
  if (!substance.breaks) return form;
  if (const std::string fault = find_grain_fault(substance.material, shell.mesh, false); !fault.empty())
    return core::Error{fault};
  fracture::ShellSubject subject = make_subject(shell, substance.material, mesh);
  subject.material.density = density;
  subject.systems =
      make_systems(subject, stress::make_shell_stiffness(elements, fracture::properties_of(subject)));
  fragile.subject = std::move(subject);
  form.fragile = std::make_shared<const Fragile>(std::move(fragile));
  return form;
}

core::Result<SharedForm> make_form(const SolidDescription& solid, const Substance& substance) {
  if (const std::string fault = find_unmended(solid.mesh); !fault.empty()) return core::Error{fault};
  const double density = substance.density;
  auto shape = std::make_shared<body::Shape>();
  const geometry::MassProperties mass = geometry::solid_mass_properties(solid.mesh, density);
  shape->kind = body::ShapeKind::solid;
  shape->surface = solid.mesh;
  shape->bounding_radius = centre_mesh(shape->surface, mass.centre);
  shape->topology = geometry::build_edge_topology(shape->surface.triangles);
  shape->triangle_parts = solid.parts;
  shape->width = width_of(shape->surface.positions, mass.mass / density);
  shape->mass = mass.mass;
  shape->inertia = mass.inertia;
  SharedForm form;
  form.centre = mass.centre;
  if (substance.breaks) {
    material::Material own = substance.material;
    own.density = density;
    auto subject = make_subject(solid, own, shape->surface, mass.centre);
    if (!subject) return core::Error{subject.error()};
    Fragile fragile;
    fragile.size = 2.0 * shape->bounding_radius;
    fragile.density = density;
    fragile.parts = solid.parts;
    fragile.subject = std::move(subject.value());
    form.fragile = std::make_shared<const Fragile>(std::move(fragile));
    shape->seat = kSolidSeat * form.fragile->size;
  }
  form.shape = std::move(shape);
  return form;
}

std::shared_ptr<stress::ShellSystemCache> make_systems(
    const fracture::ShellSubject& subject, std::shared_ptr<const stress::ShellStiffness> stiffness) {
  return std::make_shared<stress::ShellSystemCache>(std::move(stiffness), subject.mesh,
                                                    fracture::support_of(subject, *subject.mesh));
}

std::shared_ptr<const body::Shape> make_shell_shape(const geometry::ShellMesh& mesh, const Fragile& fragile,
                                                    double thickness,
                                                    const geometry::StandingSurface* whole) {
  auto shape = std::make_shared<body::Shape>();
  const double kerf = kKerf * fragile.size;
  geometry::ShellSurface surface = geometry::extract_surface(mesh, kerf, whole);
  const geometry::MassProperties mass = geometry::shell_mass_properties(mesh, thickness, fragile.density);
  shape->kind = body::ShapeKind::shell;
  shape->surface = std::move(surface.mesh);
  shape->bounding_radius = centre_mesh(shape->surface, mass.centre);
  shape->topology = geometry::build_edge_topology(shape->surface.triangles);
  shape->crack_edges.assign(shape->topology.edges.size(), 0);
  for (std::size_t t = 0; t < shape->surface.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      if (surface.is_crack_side[3 * t + i])
        shape->crack_edges[static_cast<std::size_t>(shape->topology.triangle_edges[t][i])] = 1;
  for (const int cell : surface.triangle_cells) {
    const int element = mesh.cells[static_cast<Size>(cell)].element;
    shape->triangle_elements.push_back(element);
    if (!fragile.parts.empty()) shape->triangle_parts.push_back(fragile.parts[static_cast<Size>(element)]);
  }
  shape->triangle_grains = std::move(surface.triangle_grains);
  shape->thickness = shape->seat = thickness;
  shape->material_from_body = mass.centre;
  shape->mass = mass.mass;
  shape->inertia = mass.inertia;
  shape->least_gap = surface.least_kerf;
  return shape;
}

std::shared_ptr<const body::Shape> make_solid_shape(geometry::SolidComplex& piece, const Fragile& fragile,
                                                    const geometry::SurfaceDistance* whole) {
  auto shape = std::make_shared<body::Shape>();
  geometry::MassProperties mass;
  geometry::SolidSurface surface;
  core::parallel_for(2, 1, [&](Size part) {
    if (part == 1) {
      mass = geometry::solid_mass_properties(piece, fragile.density);
      return;
    }
    surface = geometry::extract_surface(piece);
    shape->least_gap = geometry::stand_back(surface, kKerf * fragile.size, whole);
  });
  geometry::keep_kerf(piece, surface);
  shape->kind = body::ShapeKind::solid;
  shape->surface = std::move(surface.mesh);
  shape->bounding_radius = centre_mesh(shape->surface, mass.centre);
  shape->topology = geometry::build_edge_topology(shape->surface.triangles);
  shape->crack_faces = std::move(surface.is_crack_face);
  shape->triangle_grains = std::move(surface.triangle_grains);
  for (const int cell : surface.triangle_cells)
    shape->triangle_elements.push_back(piece.cells[static_cast<Size>(cell)].element);
  if (!fragile.parts.empty())
    for (const int source : surface.triangle_sources)
      shape->triangle_parts.push_back(source < 0 ? std::uint8_t{0}
                                                 : fragile.parts[static_cast<Size>(source)]);
  shape->width = width_of(shape->surface.positions, mass.mass / fragile.density);
  shape->seat = kSolidSeat * fragile.size;
  shape->material_from_body = mass.centre;
  shape->mass = mass.mass;
  shape->inertia = mass.inertia;
  return shape;
}

}  // namespace shatterbox::world
