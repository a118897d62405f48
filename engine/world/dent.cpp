// Dents: a body whose impact is over gets the shape that it leaves. Its surface goes straight from what it
// was to what it will be, under the promise of every motion: it meets nobody on its way, or goes as far as is
// free. The body keeps its mass and momenta; copies that shared its shape keep theirs.
#include <algorithm>
#include <optional>
#include <utility>

#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/fracture/torn_solid.h"
#include "engine/geometry/self_crossings.h"
#include "engine/world/acts.h"
#include "engine/world/dented.h"
#include "engine/world/state.h"

namespace shatterbox::world {
namespace {

using core::at;

constexpr double kRoomShare = 0.5;   // of the gap that contact keeps, that a dent leaves to others
constexpr int kMostRooms = 4;        // times that a dent is cut to what is free
constexpr int kMostPushes = 4;       // by others, that set a dented body aside
constexpr double kPushSlack = 1.05;  // times as far as it takes
constexpr double kRoomSlack = 0.9;   // of what was found free, then: the cut dent goes slightly elsewhere
// Durations of a hit after its last impulse, until its dent is there. A sheet's hit lasts for several
// pictures, and its dent is made in the first half; what comes later in it is a hit of its own then.
constexpr double kSolidWait = 2.0, kSheetWait = 0.5;
constexpr double kLongestHit = 8.0;  // durations: who is hit time and again for longer is dented on the way
constexpr double kFewCrossings = 0.01;  // of a surface's triangles: so many more may pass through each other
constexpr double kLipShare = 0.5;       // of a dent that would close lips beyond each other
constexpr double kLeastDentShare = 0.01;  // of a dent; less is none

/// How far a dent can go before it meets anybody, or a sheet itself.
Room find_least_room(const MovingState& moving, const dynamics::ContactSettings& contact,
                     const body::Body& body, const MovingSurface& way) {
  Room least;
  for (const body::Body& other : moving.bodies) {
    if (other.id == body.id || !body.collides_with(other)) continue;
    const bool are_held = !body.is_dynamic() && !other.is_dynamic();
    const auto* pair = moving.contact.find_pair(std::min(body.id, other.id), std::max(body.id, other.id));
    if (pair && pair->is_exempt) continue;
    double radius = 1e300;
    for (const body::Body* one : {&body, &other})
      if (one->is_dynamic()) radius = std::min(radius, one->shape->bounding_radius);
    if (are_held) radius = body.shape->bounding_radius;
    const Room room = find_room(way, other, kRoomShare * contact.kept_gap * 2.0 * radius);
    if (are_held && !(room.share > 0.0)) continue;  // it is in what holds it
    if (room.share < least.share) least = room;
  }
  if (body.shape->kind == body::ShapeKind::shell) {
    const double own = own_free_share(way, kRoomShare * contact.kept_gap * 2.0 * body.shape->bounding_radius);
    if (own < least.share) least = {own, Vec3::Zero(), 0.0};
  }
  return least;
}

void replace_by(MovingState& moving, const body::Body& body, body::Body born, const Dented& dented,
                std::map<body::BodyId, Ancestry>& ancestry) {
  ImpactMemory memory = moving.memories[body.id];
  memory.dents.clear();
  memory.has_open_dent = false;
  // What comes later in a hit that goes on is a hit of its own.
  memory.event.clear();
  memory.event_duration = 0.0;
  moving.memories.erase(body.id);
  moving.memories[born.id] = std::move(memory);
  moving.fragiles.erase(body.id);
  moving.fragiles[born.id] = dented.fragile;
  ancestry[born.id] = ancestry.at(body.id);
  const body::BodyId gone = body.id;
  std::erase_if(moving.bodies, [&](const body::Body& b) { return b.id == gone; });
  moving.bodies.push_back(std::move(born));
}

/// m, of the surface.
double depth_of(const MovingSurface& way) {
  double depth = 0.0;
  for (std::size_t v = 0; v < way.start.size(); ++v)
    depth = std::max(depth, (way.end[v] - way.start[v]).norm());
  return depth;
}

void set_aside(const Vec3& shift, Dented& dented) {
  dented.pose.translation += shift;
  for (Vec3& end : dented.way.end) end += shift;
}

/// A free body that is dented where it lies is pushed aside by whom it would meet: what is squeezed flat
/// comes down on its top, and not half through the floor. Nothing if it fits nowhere so; `free`: the share of
/// the dent that there is room for where the body lies.
template <class Make>
std::optional<Dented> find_aside(const MovingState& moving, const dynamics::ContactSettings& contact,
                                 const body::Body& body, const Make& make, double& free) {
  Vec3 shift = Vec3::Zero();
  for (int push = 0; push <= kMostPushes; ++push) {
    Dented dented = make(1.0);
    set_aside(shift, dented);
    const Room room = find_least_room(moving, contact, body, dented.way);
    if (push == 0) free = room.share;
    if (room.share >= 1.0) return dented;
    if (!body.is_dynamic() || !(room.approach > 0.0)) break;
    shift += kPushSlack * (1.0 - room.share) * room.approach * room.normal;
  }
  return std::nullopt;
}

/// Whether tears of earlier hits stand open in it.
bool gapes(const Fragile& fragile) {
  const auto* solid = std::get_if<fracture::SolidSubject>(&fragile.subject);
  return solid && fracture::is_torn(*solid);
}

/// A dent with the whole share that there is room for; nothing if there is none at all. `make` of a share.
///
/// Of what gapes already none that would press its lips far into each other: no continuous test tells them
/// from neighbours where they meet.
template <class Make>
std::optional<Dented> find_dented(const MovingState& moving, const dynamics::ContactSettings& contact,
                                  const body::Body& body, bool gapes, const Make& make) {
  const auto own_crossings = [gapes](const body::Shape& shape) {
    return gapes ? geometry::find_self_crossings(shape.surface).count : 0;
  };
  const auto size = static_cast<double>(body.shape->surface.triangles.size());
  const int crossings = own_crossings(*body.shape) + static_cast<int>(kFewCrossings * size);
  double free = 0.0;  // of it, where it lies
  if (std::optional<Dented> aside = find_aside(moving, contact, body, make, free))
    if (own_crossings(*aside->shape) <= crossings) return aside;
  double share = free < 1.0 ? kRoomSlack * free : kLipShare;
  for (int number = 1; number < kMostRooms && share > kLeastDentShare; ++number) {
    Dented dented = make(share);
    free = find_least_room(moving, contact, body, dented.way).share;
    if (free >= 1.0 && own_crossings(*dented.shape) <= crossings) return dented;
    share *= free < 1.0 ? kRoomSlack * free : kLipShare;
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
  const Vec3 angular_momentum = turn * (body.shape->inertia * (turn.transpose() * body.angular_velocity));
  changed.inverse_mass = 1.0 / dented.shape->mass;
  changed.inverse_inertia = dented.shape->inertia.inverse();
  changed.angular_velocity = changed.inverse_inertia_world() * angular_momentum;
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

DentRow describe_dent(const body::Body& body, const ComingDent& coming, const fracture::DentFigures& figures,
                      const Dented* dented, double time) {
  DentRow row;
  row.time = time;
  row.body = body.name;
  row.id = body.id;
  row.von_mises = coming.von_mises;
  row.yield = coming.yield;
  row.flowed_volume = figures.flowed;
  row.is_cut = figures.is_cut;
  row.share = 0.0;
  row.place = body.pose.apply(coming.place - body.shape->material_from_body);
  if (!dented) return row;
  row.share = dented->share;
  row.depth = depth_of(dented->way);
  row.energy = figures.work;
  row.torn_area = figures.torn_area;
  row.volume_change = dented->volume_change;
  row.mass_error = std::abs(dented->shape->mass / body.shape->mass - 1.0);
  return row;
}

/// What is told of elements, of their copies.
std::shared_ptr<const std::vector<double>> of_copies(const geometry::CopiedSolid& copied,
                                                     const std::vector<double>& told) {
  std::vector<double> own;
  for (const int source : copied.element_sources) own.push_back(told[core::at(source)]);
  return std::make_shared<const std::vector<double>>(std::move(own));
}

/// The dents of one body, and the shapes of those that are of a sheet.
struct ShapedDents {
  std::vector<ComingDent> dents;
  std::vector<fracture::ShellShape> shapes;
};

std::vector<ShapedDents> find_shapes(const std::map<body::BodyId, ImpactMemory>& memories,
                                     const std::vector<body::BodyId>& due) {
  std::vector<ShapedDents> all(due.size());
  std::vector<std::pair<std::size_t, std::size_t>> sheets;
  for (std::size_t i = 0; i < due.size(); ++i) {
    all[i].dents = memories.at(due[i]).dents;
    all[i].shapes.resize(all[i].dents.size());
    for (std::size_t k = 0; k < all[i].dents.size(); ++k)
      if (all[i].dents[k].shell()) sheets.emplace_back(i, k);
  }
  core::parallel_for(sheets.size(), 1, [&](std::size_t n) {
    const auto [i, k] = sheets[n];
    all[i].shapes[k] = find_dent_shape(*all[i].dents[k].shell());
  });
  return all;
}

}  // namespace

Pose dented_pose(const body::Body& body, const body::Shape& shape) {
  Pose pose = body.pose;
  if (!body.is_dynamic())
    pose.translation = body.pose.apply(shape.material_from_body - body.shape->material_from_body);
  return pose;
}

void set_way(const body::Body& body, const std::function<Vec3(int, const Vec3&)>& was_at, Dented& dented) {
  const body::Shape& shape = *dented.shape;
  dented.way.triangles = shape.surface.triangles;
  std::vector<int> element_of(shape.surface.positions.size(), -1);
  for (std::size_t t = shape.surface.triangles.size(); t-- > 0;)
    for (const int v : shape.surface.triangles[t]) element_of[at(v)] = shape.triangle_elements[t];
  for (std::size_t v = 0; v < element_of.size(); ++v) {
    const Vec3& here = shape.surface.positions[v];
    const Vec3 was = was_at(element_of[v], here + shape.material_from_body);
    dented.way.start.push_back(body.pose.apply(was - body.shape->material_from_body));
    dented.way.end.push_back(dented.pose.apply(here));
  }
}

std::vector<BreakRow> World::dent_bodies(const MovingState& snapshot) {
  State& s = *state_;
  const double end_time = static_cast<double>(s.steps + 1) / s.settings.steps_per_second;
  std::vector<body::BodyId> due;
  for (const auto& [id, memory] : s.moving.memories) {
    if (memory.dents.empty()) continue;
    if (std::any_of(memory.dents.begin(), memory.dents.end(),
                    [&](const ComingDent& coming) { return coming.not_before > time(); }))
      continue;
    double last = -1e9, first = 1e9;
    for (const Load& load : memory.event) {
      first = std::min(first, load.first_time);
      last = std::max(last, load.time);
    }
    const bool is_sheet = memory.dents.back().shell() != nullptr;
    const double wait = is_sheet ? kSheetWait : kSolidWait;
    const double longest = is_sheet ? 1.0 : kLongestHit;
    if (!memory.has_open_dent || end_time - last > wait * memory.event_duration ||
        end_time - first > longest * memory.event_duration)
      due.push_back(id);
  }
  const std::vector<ShapedDents> all = find_shapes(s.moving.memories, due);
  std::vector<BreakRow> reshaped;
  for (std::size_t i = 0; i < due.size(); ++i) {
    body::BodyId id = due[i];
    keep_begin(snapshot);
    BreakRow change;
    change.id = id;
    s.moving.memories[id].dents.clear();
    s.moving.memories[id].has_open_dent = false;
    fracture::LeftDents left;
    for (std::size_t k = 0; k < all[i].dents.size(); ++k) {
      const ComingDent& coming = all[i].dents[k];
      const fracture::ShellShape& shape = all[i].shapes[k];
      const body::Body body = *body::find_body(s.moving.bodies, id);
      const Fragile& whole = *s.moving.fragiles.at(id);
      const auto* solid = coming.solid();
      fracture::DentFigures figures = coming.figures();
      if (!solid) {
        figures.work = shape.work;
        figures.is_cut = shape.is_cut;
        if (shape.way.empty()) continue;
      }
      const std::optional<Dented> dented =
          find_dented(s.moving, s.contact_settings, body, gapes(whole), [&](double share) {
            return solid ? make_dented(body, whole, *solid, left, share)
                         : make_dented(body, whole, moves_at(shape, share), share);
          });
      DentRow row = describe_dent(body, coming, figures, dented ? &*dented : nullptr, end_time);
      if (dented) {
        if (solid) leave(*solid, dented->share, dented->moves, left);
        if (dented->torn) left.torn = dented->torn;
        row.born = put_dented(s.moving, body, *dented, s.ancestry);
        hang_on(body, {row.born}, end_time);
        inherit_stress(id, {row.born});
        const auto known = s.element_stress.find(row.born);
        if (dented->torn && known != s.element_stress.end())
          known->second = of_copies(dented->torn->copied, *known->second);
        s.is_disturbed = true;
        id = row.born;
      }
      s.report.dents.push_back(std::move(row));
    }
    if (id == change.id) continue;
    change.born = {id};
    reshaped.push_back(std::move(change));
  }
  return reshaped;
}

}  // namespace shatterbox::world
