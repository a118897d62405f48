// Descriptions become bodies: mass properties, shapes, and what a breakable shell needs. Forms that are equal
// to the bit are shared, and with them their factors.
#include <algorithm>

#include "engine/core/hash.h"
#include "engine/fracture/shell_subject.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/shell_surface.h"
#include "engine/world/state.h"

namespace shatterbox::world {
namespace {

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

std::uint64_t form_key(const ShellDescription& shell, const material::Material& material, int number,
                       double density) {
  core::Hash hash = hash_mesh(shell.mesh, shell.parts, density);
  for (const int vertex : shell.clamped) hash.add(static_cast<std::uint64_t>(vertex) + 1);
  hash.add(shell.thickness).add(material.young).add(static_cast<std::uint64_t>(number));
  return hash.add(std::uint64_t{shell.is_breakable}).value();
}

fracture::ShellSubject make_subject(const ShellDescription& shell, const material::Material& material,
                                    std::shared_ptr<const geometry::ShellMesh> mesh) {
  fracture::ShellSubject subject;
  subject.mesh = std::move(mesh);
  subject.material = material;
  subject.thickness = shell.thickness;
  subject.clamped_vertices = shell.clamped;
  std::sort(subject.clamped_vertices.begin(), subject.clamped_vertices.end());
  if (material.grain_size > 0.0)
    subject.grains = std::make_shared<const fracture::GrainField>(fracture::make_grain_field(
        *subject.mesh->elements,
        fracture::scatter_grain_seeds(*subject.mesh->elements, material.grain_size, subject.seed)));
  return subject;
}

std::shared_ptr<body::Shape> make_analytic_shape(const BodyDescription& description, double density) {
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
  } else {
    shape->kind = body::ShapeKind::plane;
  }
  shape->mass = mass.mass;
  shape->inertia = mass.inertia;
  return shape;
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

std::string find_form_fault(const BodyDescription& description) {
  if (const auto* box = std::get_if<BoxDescription>(&description.form))
    if (!(box->half_extent.minCoeff() > 0.0)) return "a box needs an extent above zero along every axis";
  if (const auto* sphere = std::get_if<SphereDescription>(&description.form))
    if (!(sphere->radius > 0.0)) return "a sphere needs a radius above zero";
  if (const auto* shell = std::get_if<ShellDescription>(&description.form)) {
    std::string fault = find_mesh_fault(shell->mesh, shell->parts, "shell");
    if (!fault.empty()) return fault;
    if (!(shell->thickness > 0.0)) return "a shell needs a thickness above zero";
    const int count = static_cast<int>(shell->mesh.positions.size());
    for (const int v : shell->clamped)
      if (v < 0 || v >= count) return "the support names a vertex that is not there";
  }
  if (const auto* solid = std::get_if<SolidDescription>(&description.form)) return find_solid_fault(*solid);
  return {};
}

std::string find_path_fault(const BodyDescription& description) {
  if (!description.path) return {};
  const auto& keys = description.path->keys;
  if (description.motion != body::Motion::scripted) return "only a scripted body has a path";
  if (keys.empty()) return "a path needs a key";
  const bool is_plane = std::holds_alternative<PlaneDescription>(description.form);
  for (std::size_t k = 1; k < keys.size(); ++k) {
    if (!(keys[k].time > keys[k - 1].time)) return "the keys of a path must go forward in time";
    if (is_plane && keys[k].angles != keys[0].angles) return "a plane cannot turn";
  }
  return {};
}

SharedForm make_shell_form(const ShellDescription& shell, const material::Material& material, double density,
                           std::uint64_t key) {
  auto elements = std::make_shared<geometry::ShellElements>();
  const geometry::MassProperties mass = geometry::shell_mass_properties(shell.mesh, shell.thickness, density);
  elements->mesh = shell.mesh;
  double radius = 0.0;
  for (Vec3& p : elements->mesh.positions) {
    p -= mass.centre;
    radius = std::max(radius, p.norm());
  }
  elements->topology = geometry::build_edge_topology(elements->mesh.triangles);
  auto mesh = std::make_shared<const geometry::ShellMesh>(geometry::make_shell_mesh(elements));
  auto fragile = std::make_shared<Fragile>();
  fragile->size = 2.0 * radius;
  fragile->density = density;
  fragile->element_parts = shell.parts;
  fragile->subject.mesh = mesh;
  if (shell.is_breakable) {
    fragile->subject = make_subject(shell, material, mesh);
    fragile->subject.material.density = density;
    fragile->subject.systems = make_systems(
        fragile->subject, stress::make_shell_stiffness(elements, fracture::properties_of(fragile->subject)));
  }
  return {key, make_shell_shape(mesh, *fragile, shell.thickness), fragile};
}

SharedForm make_solid_form(const SolidDescription& solid, double density, std::uint64_t key) {
  auto shape = std::make_shared<body::Shape>();
  const geometry::MassProperties mass = geometry::solid_mass_properties(solid.mesh, density);
  shape->kind = body::ShapeKind::solid;
  shape->surface = solid.mesh;
  for (Vec3& p : shape->surface.positions) {
    p -= mass.centre;
    shape->bounding_radius = std::max(shape->bounding_radius, p.norm());
  }
  shape->topology = geometry::build_edge_topology(shape->surface.triangles);
  shape->triangle_parts = solid.parts;
  shape->mass = mass.mass;
  shape->inertia = mass.inertia;
  return {key, shape, nullptr};
}

/// The form of that key among `forms`; what `make` makes if there is none yet.
template <class Make>
const SharedForm& share_form(std::vector<SharedForm>& forms, std::uint64_t key, const Make& make) {
  const auto form =
      std::find_if(forms.begin(), forms.end(), [&](const SharedForm& f) { return f.key == key; });
  return form != forms.end() ? *form : forms.emplace_back(make());
}

}  // namespace

std::shared_ptr<stress::ShellSystemCache> make_systems(
    const fracture::ShellSubject& subject, std::shared_ptr<const stress::ShellStiffness> stiffness) {
  return std::make_shared<stress::ShellSystemCache>(std::move(stiffness), subject.mesh,
                                                    fracture::support_of(subject, *subject.mesh));
}

std::shared_ptr<const body::Shape> make_shell_shape(std::shared_ptr<const geometry::ShellMesh> mesh,
                                                    const Fragile& fragile, double thickness) {
  auto shape = std::make_shared<body::Shape>();
  const double kerf = kKerf * fragile.size;
  geometry::ShellSurface surface = geometry::extract_surface(*mesh, kerf);
  const geometry::MassProperties mass = geometry::shell_mass_properties(*mesh, thickness, fragile.density);
  shape->kind = body::ShapeKind::shell;
  shape->surface = std::move(surface.mesh);
  for (Vec3& p : shape->surface.positions) {
    p -= mass.centre;
    shape->bounding_radius = std::max(shape->bounding_radius, p.norm());
  }
  shape->topology = geometry::build_edge_topology(shape->surface.triangles);
  shape->crack_edges.assign(shape->topology.edges.size(), 0);
  for (std::size_t t = 0; t < shape->surface.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      if (surface.is_crack_side[3 * t + i])
        shape->crack_edges[static_cast<std::size_t>(shape->topology.triangle_edges[t][i])] = 1;
  if (!fragile.element_parts.empty())
    for (const int cell : surface.triangle_cells)
      shape->triangle_parts.push_back(
          fragile
              .element_parts[static_cast<std::size_t>(mesh->cells[static_cast<std::size_t>(cell)].element)]);
  shape->triangle_cells = std::move(surface.triangle_cells);
  shape->triangle_grains = std::move(surface.triangle_grains);
  shape->thickness = thickness;
  shape->shell = std::move(mesh);
  shape->material_from_body = mass.centre;
  shape->mass = mass.mass;
  shape->inertia = mass.inertia;
  shape->least_gap = surface.least_kerf;
  return shape;
}

core::Result<body::BodyId> World::add_body(const BodyDescription& description) {
  State& s = *state_;
  const auto refuse = [&](const std::string& why) {
    return core::Error{"body '" + description.name + "': " + why};
  };
  if (description.material < 0 || description.material >= static_cast<int>(s.materials.size()))
    return refuse("there is no such material");
  for (const std::string& fault : {find_form_fault(description), find_path_fault(description)})
    if (!fault.empty()) return refuse(fault);

  const material::Material& material = s.materials[static_cast<std::size_t>(description.material)];
  const double density = description.density.value_or(material.density);
  body::Body born;
  born.name = description.name;
  born.motion = description.motion;
  born.pose = description.pose;
  born.pose.rotation.normalize();
  std::shared_ptr<const Fragile> fragile;
  Vec3 centre = Vec3::Zero();
  if (const auto* given = std::get_if<ShellDescription>(&description.form)) {
    std::optional<ShellDescription> whole;  // what goes its own way does not break
    if (born.motion == body::Motion::scripted && given->is_breakable) {
      whole = *given;
      whole->is_breakable = false;
    }
    const ShellDescription* shell = whole ? &*whole : given;
    const std::uint64_t key = form_key(*shell, material, description.material, density);
    const SharedForm& form =
        share_form(s.forms, key, [&] { return make_shell_form(*shell, material, density, key); });
    born.shape = form.shape;
    // The mesh's own frame is that of the description; material space has its origin at the centre of mass.
    const geometry::MassProperties mass =
        geometry::shell_mass_properties(shell->mesh, shell->thickness, density);
    centre = mass.centre;
    born.pose.translation = born.pose.apply(centre);
    if (!shell->clamped.empty()) born.motion = body::Motion::fixed;
    if (shell->is_breakable) {
      auto own = std::make_shared<Fragile>(*form.fragile);
      own->subject.seed = core::Hash(s.settings.seed).add(std::uint64_t{s.moving.next_id}).value();
      own->subject.flaws = std::make_shared<const fracture::FlawField>(
          fracture::draw_flaws(*own->subject.mesh->elements, material, own->subject.seed));
      own->contact_duration = description.contact_duration;
      fragile = std::move(own);
    }
  } else if (const auto* solid = std::get_if<SolidDescription>(&description.form)) {
    const std::uint64_t key = hash_mesh(solid->mesh, solid->parts, density).value();
    born.shape = share_form(s.forms, key, [&] { return make_solid_form(*solid, density, key); }).shape;
    centre = geometry::solid_mass_properties(solid->mesh, density).centre;
    born.pose.translation = born.pose.apply(centre);
  } else {
    born.shape = make_analytic_shape(description, density);
    if (born.shape->kind == body::ShapeKind::plane && born.motion == body::Motion::dynamic)
      born.motion = body::Motion::fixed;
  }
  if (born.motion == body::Motion::dynamic) {
    born.inverse_mass = 1.0 / born.shape->mass;
    born.inverse_inertia = born.shape->inertia.inverse();
  }
  if (born.motion != body::Motion::fixed) {
    born.velocity = description.velocity;
    born.angular_velocity = description.angular_velocity;
  }
  if (description.path && born.motion == body::Motion::scripted) {
    const PathDescription& path = *description.path;
    born.script.path =
        std::make_shared<const body::ScriptedPath>(path.keys, path.between, path.turn, centre - path.pivot);
    born.pose = born.script.path->pose_at(0.0);
  }
  born.friction = material.friction;
  born.rolling_friction = material.rolling_friction;
  born.restitution = material.restitution;
  born.young = material.young;
  born.poisson = material.poisson;
  born.group = description.group;
  born.material = description.material;
  born.id = s.moving.next_id++;
  born.family = born.id;
  if (fragile) {
    s.moving.fragiles[born.id] = fragile;
    s.moving.memories[born.id] = {};
  }
  s.ancestry[born.id] = {0, born.id, time()};
  const body::BodyId id = born.id;
  s.moving.bodies.push_back(std::move(born));
  s.is_disturbed = true;
  return id;
}

}  // namespace shatterbox::world
