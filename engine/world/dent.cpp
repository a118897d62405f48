// Dents: a body whose impact is over gets the shape that it leaves. Its surface goes straight from what it
// was to what it will be, under the promise of every motion: it meets nobody on its way, or goes as far as is
// free. The body keeps its mass and momenta; copies that shared its shape keep theirs.
#include <algorithm>
#include <optional>

#include "engine/core/index.h"
#include "engine/geometry/solid_deform.h"
#include "engine/world/acts.h"
#include "engine/world/dent_room.h"
#include "engine/world/forms.h"
#include "engine/world/state.h"

namespace shatterbox::world {
namespace {

using core::at;

constexpr double kDentFlatness = 0.25;  // of a kerf: what of a given triangle bends by less stays one
constexpr double kRoomShare = 0.5;      // of the gap that contact keeps, that a dent leaves to others
constexpr int kMostRooms = 4;           // times that a dent is cut to what is free
constexpr double kRoomSlack = 0.9;      // of what was found free, then: the cut dent goes slightly elsewhere
constexpr double kLeastDentShare = 0.01;  // of a dent; less is none

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

/// A body as a dent leaves it.
struct Dented {
  std::shared_ptr<const Fragile> fragile;
  std::shared_ptr<const body::Shape> shape;
  Pose pose;
  std::vector<Vec3> moves;     // |vertices of the element mesh|, m
  double share = 0.0;          // of the whole dent
  double depth = 0.0;          // m, of the surface
  double volume_change = 0.0;  // relative
};

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

/// Where the vertices of the dented surface come from and go to, in the world.
MovingSurface find_way(const body::Body& body, const geometry::SolidComplex& before, const Dented& dented,
                       const geometry::SolidComplex& after) {
  MovingSurface way;
  const body::Shape& shape = *dented.shape;
  way.triangles = shape.surface.triangles;
  const Carrier back(after.elements->mesh, before.elements->mesh);
  // A triangle reaches over several elements where these have stayed flat, and tells one of them.
  std::vector<int> element_of(shape.surface.positions.size(), -1);
  for (std::size_t t = way.triangles.size(); t-- > 0;)
    for (const int v : way.triangles[t]) element_of[at(v)] = shape.triangle_elements[t];
  const ElementFinder finder(after);
  for (std::size_t v = 0; v < element_of.size(); ++v) {
    const Vec3& here = shape.surface.positions[v];
    const Vec3 place = here + shape.material_from_body;
    const Vec3 was = back.carry(finder.find(place, element_of[v]), place);
    way.start.push_back(body.pose.apply(was - body.shape->material_from_body));
    way.end.push_back(dented.pose.apply(here));
  }
  return way;
}

/// Share of its way that a dent can go before it meets anybody.
double find_free_share(const MovingState& moving, const dynamics::ContactSettings& contact,
                       const body::Body& body, const MovingSurface& way) {
  double share = 1.0;
  for (const body::Body& other : moving.bodies) {
    if (other.id == body.id || !body.collides_with(other)) continue;
    if (!body.is_dynamic() && !other.is_dynamic()) continue;
    const auto* pair = moving.contact.find_pair(std::min(body.id, other.id), std::max(body.id, other.id));
    if (pair && pair->is_exempt) continue;
    double radius = 1e300;
    for (const body::Body* one : {&body, &other})
      if (one->is_dynamic()) radius = std::min(radius, one->shape->bounding_radius);
    share = std::min(share, free_share(way, other, kRoomShare * contact.kept_gap * 2.0 * radius));
  }
  return share;
}

void replace_by(MovingState& moving, const body::Body& body, body::Body born, const Dented& dented,
                std::map<body::BodyId, Ancestry>& ancestry) {
  ImpactMemory memory = moving.memories[body.id];
  memory.dents.clear();
  memory.has_open_dent = false;
  moving.memories.erase(body.id);
  moving.memories[born.id] = std::move(memory);
  moving.fragiles.erase(body.id);
  moving.fragiles[born.id] = dented.fragile;
  ancestry[born.id] = ancestry.at(body.id);
  const body::BodyId gone = body.id;
  std::erase_if(moving.bodies, [&](const body::Body& b) { return b.id == gone; });
  moving.bodies.push_back(std::move(born));
}

/// Nothing if there is no room at all.
std::optional<Dented> find_dented(const MovingState& moving, const dynamics::ContactSettings& contact,
                                  const body::Body& body, const fracture::SolidDent& dent,
                                  const fracture::LeftDents& left) {
  const Fragile& whole = *moving.fragiles.at(body.id);
  const geometry::SolidComplex& before = *std::get<fracture::SolidSubject>(whole.subject).complex;
  const double volume = total_volume(before);
  double share = 1.0;
  for (int room = 0; room < kMostRooms && share > kLeastDentShare; ++room) {
    Dented dented;
    dented.share = share;
    dented.moves = moves_of_share(dent, share, left);
    std::shared_ptr<geometry::SolidComplex> complex;
    dented.fragile = dent_fragile(whole, body.shape->mass,
                                  deform(before, dented.moves, kDentFlatness * kKerf * whole.size), complex);
    dented.shape = make_solid_shape(*complex, *dented.fragile);
    dented.pose = body.pose;
    // A free body's centre of mass stays where it is; what is held stays in its place.
    if (!body.is_dynamic())
      dented.pose.translation =
          body.pose.apply(dented.shape->material_from_body - body.shape->material_from_body);
    dented.volume_change = total_volume(*complex) / volume - 1.0;
    const MovingSurface way = find_way(body, before, dented, *complex);
    for (std::size_t v = 0; v < way.start.size(); ++v)
      dented.depth = std::max(dented.depth, (way.end[v] - way.start[v]).norm());
    const double free = find_free_share(moving, contact, body, way);
    if (free >= 1.0) return dented;
    share *= kRoomSlack * free;
  }
  return std::nullopt;
}

/// The body with its new shape and place, of the same momenta.
body::Body as_dented(const body::Body& body, const Dented& dented) {
  body::Body changed = body;
  changed.shape = dented.shape;
  changed.pose = dented.pose;
  if (!body.is_dynamic()) return changed;
  const Mat3 turn = body.pose.rotation.toRotationMatrix();
  const Vec3 spin = turn * (body.shape->inertia * (turn.transpose() * body.angular_velocity));
  changed.inverse_mass = 1.0 / dented.shape->mass;
  changed.inverse_inertia = dented.shape->inertia.inverse();
  changed.angular_velocity = changed.inverse_inertia_world() * spin;
  return changed;
}

/// Puts `dented` in the place of a body, which gets a new id.
body::BodyId put_dented(MovingState& moving, const body::Body& body, const Dented& dented,
                        std::map<body::BodyId, Ancestry>& ancestry) {
  body::Body born = as_dented(body, dented);
  born.id = moving.next_id++;
  born.wake();
  const body::BodyId id = born.id;
  replace_by(moving, body, std::move(born), dented, ancestry);
  return id;
}

DentRow describe_dent(const body::Body& body, const fracture::SolidDent& dent, const Dented* dented,
                      const Vec3& place_material, double von_mises, double yield, double time) {
  DentRow row;
  row.time = time;
  row.body = body.name;
  row.id = body.id;
  row.von_mises = von_mises;
  row.yield = yield;
  row.flowed_volume = dent.flowed;
  row.is_cut = dent.is_cut;
  row.share = 0.0;
  row.place = body.pose.apply(place_material - body.shape->material_from_body);
  if (!dented) return row;
  row.share = dented->share;
  row.depth = dented->depth;
  row.energy = dent.work;
  row.volume_change = dented->volume_change;
  row.mass_error = std::abs(dented->shape->mass / body.shape->mass - 1.0);
  return row;
}

}  // namespace

void World::dent_bodies(const MovingState& snapshot) {
  State& s = *state_;
  const double end_time = static_cast<double>(s.steps + 1) / s.settings.steps_per_second;
  std::vector<body::BodyId> due;
  for (const auto& [id, memory] : s.moving.memories) {
    if (memory.dents.empty()) continue;
    if (std::any_of(memory.dents.begin(), memory.dents.end(),
                    [&](const ComingDent& coming) { return coming.not_before > time(); }))
      continue;
    double last = -1e9;
    for (const Load& load : memory.event) last = std::max(last, load.time);
    if (!memory.has_open_dent || end_time - last > 2.0 * memory.event_duration) due.push_back(id);
  }
  for (body::BodyId id : due) {
    keep_begin(snapshot);
    std::vector<ComingDent> dents = std::move(s.moving.memories[id].dents);
    s.moving.memories[id].dents.clear();
    s.moving.memories[id].has_open_dent = false;
    fracture::LeftDents left;
    for (const ComingDent& coming : dents) {
      const body::Body body = *body::find_body(s.moving.bodies, id);
      const std::optional<Dented> dented =
          find_dented(s.moving, s.contact_settings, body, *coming.dent, left);
      DentRow row = describe_dent(body, *coming.dent, dented ? &*dented : nullptr, coming.place,
                                  coming.von_mises, coming.yield, end_time);
      if (dented) {
        leave(*coming.dent, dented->share, dented->moves, left);
        row.born = put_dented(s.moving, body, *dented, s.ancestry);
        regrip(s.hands, body, {row.born}, s.moving.bodies);
        rehang(s.moving.contact.joints, body, {row.born}, s.moving.bodies);
        inherit_stress(id, {row.born});
        s.is_disturbed = true;
        id = row.born;
      }
      s.report.dents.push_back(std::move(row));
    }
  }
}

}  // namespace shatterbox::world
