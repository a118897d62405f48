// Descriptions become bodies. Forms that are equal to the bit are shared, and with them their factors.
#include <algorithm>
#include <cmath>

#include "engine/core/hash.h"
#include "engine/world/forms.h"
#include "engine/world/limits.h"
#include "engine/world/state.h"

namespace shatterbox::world {
namespace {

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
  for (const body::Keyframe& key : keys)
    if (!std::isfinite(key.time) || !is_within(key.position, kMostLength) ||
        !is_within(key.angles, kMostAngle))
      return "a key of its path is not finite, or not within 1e6 m and 1e6 rad";
  const body::ScriptedPath path(keys, description.path->between);
  if (!(path.top_speed() <= kMostSpeed) || !(path.top_spin() <= kMostSpin))
    return "its path is quicker than 1e9 m/s or 1e5 rad/s";
  return {};
}

std::string find_number_fault(const BodyDescription& description) {
  if (description.density && !(*description.density > 0.0 && std::isfinite(*description.density)))
    return "the density must be above zero";
  if (description.contact_duration && !is_positive(*description.contact_duration))
    return "its contact_duration must be above zero";
  const Quat& rotation = description.pose.rotation;
  if (!rotation.coeffs().allFinite() || !(rotation.norm() > 0.0)) return "its rotation is none";
  if (!is_within(description.pose.translation, kMostLength))
    return "its place is not finite, or not within 1e6 m";
  if (!is_within(description.velocity, kMostSpeed))
    return "its velocity is not finite, or not within 1e9 m/s";
  if (!is_within(description.angular_velocity, kMostSpin))
    return "its spin is not finite, or not within 1e5 rad/s";
  if (!is_within(description.force, kMostForce) || !is_within(description.torque, kMostForce))
    return "its force or torque is not finite, or not within 1e9 N, or N m";
  return {};
}

/// The form of a mesh among `forms`, made if there is none like it yet.
template <class Description>
core::Result<SharedForm> share_form(std::vector<SharedForm>& forms, const Description& description,
                                    const Substance& substance) {
  const std::uint64_t key = form_key(description, substance);
  const auto known =
      std::find_if(forms.begin(), forms.end(), [&](const SharedForm& f) { return f.key == key; });
  if (known != forms.end()) return *known;
  auto made = make_form(description, substance);
  if (!made) return made;
  made.value().key = key;
  return forms.emplace_back(std::move(made.value()));
}

/// The body's own flaws and grains: copies of one form break differently.
void draw_flaws(fracture::ShellSubject& shell, const material::Material& material, std::uint64_t seed) {
  const geometry::ShellElements& elements = *shell.mesh->elements;
  shell.seed = seed;
  shell.flaws = std::make_shared<const fracture::FlawField>(fracture::draw_flaws(elements, material, seed));
  if (!(material.grain_size > 0.0)) return;
  const Mat3 squeeze = fracture::grain_squeeze(material);
  shell.grains = std::make_shared<const fracture::GrainField>(fracture::make_grain_field(
      elements, fracture::scatter_grain_seeds(elements, material.grain_size, seed, squeeze), squeeze));
}

void draw_flaws(fracture::SolidSubject& solid, const material::Material& material, std::uint64_t seed) {
  solid.seed = seed;
  solid.flaws = std::make_shared<const fracture::SolidFlawField>(
      fracture::draw_solid_flaws(*solid.complex->elements, material, seed));
  solid.kept_turns = std::make_shared<fracture::KeptCrackTurns>();
  if (material.grain_size > 0.0)
    solid.grains = std::make_shared<const fracture::SpaceGrains>(
        fracture::make_space_grains(solid.complex->elements->mesh, material, seed));
}

/// Held somewhere, or without an end.
bool stays_in_place(const BodyDescription& description) {
  if (const auto* shell = std::get_if<ShellDescription>(&description.form)) return !shell->clamped.empty();
  if (const auto* solid = std::get_if<SolidDescription>(&description.form)) return !solid->held.empty();
  return std::holds_alternative<PlaneDescription>(description.form) &&
         description.motion == body::Motion::dynamic;
}

core::Result<SharedForm> find_form(std::vector<SharedForm>& forms, const BodyDescription& description,
                                   const material::Material& material) {
  const double density = description.density.value_or(material.density);
  const auto substance_of = [&](bool is_breakable) {
    return Substance{material, description.material, density,
                     is_breakable && description.motion != body::Motion::scripted};
  };
  if (const auto* shell = std::get_if<ShellDescription>(&description.form))
    return share_form(forms, *shell, substance_of(shell->is_breakable));
  if (const auto* solid = std::get_if<SolidDescription>(&description.form))
    return share_form(forms, *solid, substance_of(solid->is_breakable));
  SharedForm form;
  form.shape = make_analytic_shape(description, density);
  return form;
}

/// Where it is at the start, and how it moves.
void set_motion(const BodyDescription& description, const Vec3& centre, body::Body& born) {
  born.motion = stays_in_place(description) ? body::Motion::fixed : description.motion;
  born.pose = description.pose;
  born.pose.rotation.normalize();
  // The mesh's own frame is that of the description; material space has its origin at the centre of mass.
  born.pose.translation = born.pose.apply(centre);
  if (born.motion == body::Motion::dynamic) {
    born.inverse_mass = 1.0 / born.shape->mass;
    born.inverse_inertia = born.shape->inertia.inverse();
    born.force = description.force;
    born.torque = description.torque;
    born.locked = description.locked;
  }
  if (born.motion != body::Motion::fixed) {
    born.velocity = born.locked.let_move(description.velocity);
    born.angular_velocity = born.locked.let_turn(description.angular_velocity);
  }
  if (description.path && born.motion == body::Motion::scripted) {
    const PathDescription& path = *description.path;
    born.script.path =
        std::make_shared<const body::ScriptedPath>(path.keys, path.between, path.turn, centre - path.pivot);
    born.pose = born.script.path->pose_at(0.0);
  }
}

void set_material(const BodyDescription& description, const material::Material& material, body::Body& born) {
  born.friction = material.friction;
  born.rolling_friction = material.rolling_friction;
  born.restitution = material.restitution;
  born.young = material.young;
  born.poisson = material.poisson;
  born.material = description.material;
}

}  // namespace

core::Result<body::BodyId> World::add_body(const BodyDescription& description) {
  State& s = *state_;
  const auto refuse = [&](const std::string& why) {
    return core::Error{"body '" + description.name + "': " + why};
  };
  if (description.material < 0 || description.material >= static_cast<int>(s.materials.size()))
    return refuse("there is no such material");
  for (const std::string& fault :
       {find_form_fault(description), find_path_fault(description), find_number_fault(description)})
    if (!fault.empty()) return refuse(fault);

  const material::Material& material = s.materials[static_cast<std::size_t>(description.material)];
  if (material.surface_compression > 0.0 && std::holds_alternative<SolidDescription>(description.form))
    return refuse("surface_compression is of sheets, and this is a solid: make it a shell, or set it to 0");
  auto form = find_form(s.forms, description, material);
  if (!form) return refuse(form.error());

  body::Body born;
  born.name = description.name;
  born.shape = form.value().shape;
  born.group = description.group;
  set_motion(description, form.value().centre, born);
  set_material(description, material, born);
  born.id = s.moving.next_id++;
  born.family = born.id;
  if (form.value().fragile) {
    auto own = std::make_shared<Fragile>(*form.value().fragile);
    const std::uint64_t seed = core::Hash(s.settings.seed).add(std::uint64_t{born.id}).value();
    std::visit([&](auto& subject) { draw_flaws(subject, material, seed); }, own->subject);
    own->contact_duration = description.contact_duration;
    s.moving.fragiles[born.id] = std::move(own);
    s.moving.memories[born.id] = {};
    born.may_break = true;
  }
  s.ancestry[born.id] = {0, born.id, time()};
  const body::BodyId id = born.id;
  s.moving.bodies.push_back(std::move(born));
  s.is_disturbed = true;
  return id;
}

}  // namespace shatterbox::world
