#include "engine/world/replace.h"

#include <algorithm>

#include "engine/geometry/crossings.h"
#include "engine/world/clashes.h"
#include "engine/world/perforation.h"
#include "engine/world/pieces.h"

namespace shatterbox::world {
namespace {

constexpr double kLeftOver = 0.5;  // of the mass: a piece with more is what is left, others broke off

body::Body make_body(const body::Body& parent, const Piece& piece, int number) {
  body::Body born = parent;
  // A crack that sets nothing free leaves the body what it was; pieces are numbered behind a slash.
  if (number >= 0) born.name = parent.name + "/" + std::to_string(number);
  born.shape = piece.shape;
  const Vec3 centre_in_parent = piece.shape->material_from_body - parent.shape->material_from_body;
  born.pose.translation = parent.pose.apply(centre_in_parent);
  born.velocity = parent.velocity_at(born.pose.translation);
  born.motion = piece.is_held ? body::Motion::fixed : body::Motion::dynamic;
  born.inverse_mass = piece.is_held ? 0.0 : 1.0 / piece.shape->mass;
  born.inverse_inertia = piece.is_held ? Mat3::Zero() : Mat3(piece.shape->inertia.inverse());
  if (number >= 0) {
    born.force *= piece.shape->mass / parent.shape->mass;
    born.torque.setZero();
    // Who holds it holds what is left of it.
    if (piece.shape->mass <= kLeftOver * parent.shape->mass) born.locked = {};
  }
  born.wake();
  return born;
}

std::vector<body::Body> make_bodies(const body::Body& parent, const std::vector<Piece>& pieces) {
  std::vector<body::Body> born;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    born.push_back(make_body(parent, pieces[i], pieces.size() == 1 ? -1 : static_cast<int>(i)));
  return born;
}

/// Mass, momentum and angular momentum about the parent's centre, recomputed from the pieces, whether held or
/// not.
void measure_errors(const body::Body& parent, const std::vector<body::Body>& pieces, BreakRow& row) {
  const auto momentum = [](const body::Body& b) { return Vec3(b.shape->mass * b.velocity); };
  const auto angular_momentum_of = [](const body::Body& b) {
    return Vec3(b.pose.rotation * (b.shape->inertia * (b.pose.rotation.conjugate() * b.angular_velocity)));
  };
  const auto energy = [&](const body::Body& b) {
    return 0.5 * b.shape->mass * b.velocity.squaredNorm() +
           0.5 * b.angular_velocity.dot(angular_momentum_of(b));
  };
  double mass = 0.0, kinetic = 0.0;
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  for (const body::Body& piece : pieces) {
    mass += piece.shape->mass;
    linear += momentum(piece);
    angular += (piece.pose.translation - parent.pose.translation).cross(momentum(piece)) +
               angular_momentum_of(piece);
    kinetic += energy(piece);
  }
  // Relative to the greatest value the motion could give, so that a body without spin has a scale too.
  const double speed =
      parent.velocity.norm() + parent.angular_velocity.norm() * parent.shape->bounding_radius;
  const double scale = parent.shape->mass * speed;
  const double arm = parent.shape->bounding_radius;
  row.mass_error = std::abs(mass / parent.shape->mass - 1.0);
  if (scale > 0.0) {
    row.momentum_error = (linear - momentum(parent)).norm() / scale;
    row.angular_momentum_error = (angular - angular_momentum_of(parent)).norm() / (scale * arm);
  }
  const double before = energy(parent);
  if (before > 0.0) row.energy_gain = kinetic / before - 1.0;
}

BreakRow describe(const body::Body& parent, const EvaluatedImpact& impact, double thickness) {
  const fracture::DecisionFigures& decision = impact.figures();
  BreakRow row;
  row.body = parent.name;
  row.id = parent.id;
  row.new_area = decision.new_area;
  row.grain_share = decision.new_area > 0.0 ? decision.grain_area / decision.new_area : 0.0;
  row.fracture_energy = decision.fracture_energy;
  row.elastic_energy = decision.elastic_energy;
  row.crack_generations = decision.generations;
  row.energy_guard_active = decision.energy_guard_active;
  row.generation_bound_active = decision.generation_bound_active;
  row.place_material = impact.hardest.point_body + parent.shape->material_from_body;
  row.thickness = thickness;
  if (const auto* shell = std::get_if<fracture::Decision>(&impact.decision))
    for (const fracture::CrackSegment& segment : shell->segments) row.cracks.push_back(segment.ends);
  return row;
}

void insert_pieces(MovingState& moving, const body::Body& parent, const ImpactMemory& memory,
                   const std::vector<Piece>& pieces, std::vector<body::Body> born, double time,
                   double charged_until, const EvaluatedImpact& impact,
                   std::map<body::BodyId, Ancestry>& ancestry, BreakRow& row) {
  const Ancestry before = ancestry.at(parent.id);
  for (std::size_t i = 0; i < born.size(); ++i) {
    born[i].id = moving.next_id++;
    ImpactMemory own;
    own.generation = memory.generation + 1;
    own.keeps_dents = false;
    own.born = time;
    own.charged_until = charged_until;
    own.charged_left = impact.charged;
    own.charged_other = impact.hardest.other;
    own.charged_event = parent.id;
    moving.memories[born[i].id] = own;
    moving.fragiles[born[i].id] = pieces[i].fragile;
    ancestry[born[i].id] = born.size() == 1 ? before : Ancestry{parent.id, before.original, time};
    row.born.push_back(born[i].id);
  }
  const body::BodyId gone = parent.id;
  std::erase_if(moving.bodies, [&](const body::Body& b) { return b.id == gone; });
  moving.memories.erase(gone);
  moving.fragiles.erase(gone);
  moving.bodies.insert(moving.bodies.end(), std::make_move_iterator(born.begin()),
                       std::make_move_iterator(born.end()));
}

/// Who pressed: if that has broken since, the piece of it that is nearest. Null: nobody is left, or none was
/// there (a blast).
body::Body* find_partner(MovingState& moving, body::BodyId id, const Vec3& point) {
  if (body::Body* other = body::find_body(moving.bodies, id)) return other;
  body::Body* nearest = nullptr;
  double least = 0.0;
  for (const auto& [heir, memory] : moving.memories) {
    if (id == 0 || memory.charged_event != id) continue;
    body::Body* piece = body::find_body(moving.bodies, heir);
    if (!piece) continue;
    const double apart = (piece->pose.translation - point).squaredNorm();
    if (nearest && apart >= least) continue;
    nearest = piece;
    least = apart;
  }
  return nearest;
}

}  // namespace

double pay_for_cracks(MovingState& moving, const EvaluatedImpact& impact, double energy,
                      body::ImpulseLog& log) {
  body::Body* struck = body::find_body(moving.bodies, impact.id);
  if (!struck || energy <= 0.0 || impact.hardest.impulse_body.squaredNorm() == 0.0) return 0.0;
  const Vec3 point = struck->pose.apply(impact.hardest.point_body);
  body::Body* other = find_partner(moving, impact.hardest.other, point);
  // A blast has no partner; from one that is gone nothing can be taken.
  if (!other && impact.hardest.other != 0) return 0.0;
  const Vec3 direction = struck->pose.rotation * impact.hardest.impulse_body.normalized();
  const double mass = effective_mass(*struck, other, point, direction);
  const Vec3 other_velocity = other ? other->velocity_at(point) : Vec3::Zero();
  const double closing = -(struck->velocity_at(point) - other_velocity).dot(direction);
  if (!(mass > 0.0) || closing <= 0.0) return 0.0;
  const double paid = std::min(energy, 0.5 * mass * closing * closing);
  const double left = std::sqrt(std::max(0.0, closing * closing - 2.0 * paid / mass));
  const Vec3 impulse = mass * (closing - left) * direction;
  struck->push(impulse, point);
  if (other) {
    if (other->sleeps()) other->wake();
    other->push(-impulse, point);
  }
  body::LoggedImpulse entry =
      body::log_impulse(body::ImpulseKind::fracture, struck->id, struck->pose, other ? other->id : 0,
                        other ? other->pose : Pose{}, point, direction, impulse);
  entry.closing_speed = closing;
  entry.effective_mass = mass;
  log.push_back(entry);
  return paid;
}

BreakRow replace_body(MovingState& moving, const EvaluatedImpact& impact, double time,
                      std::map<body::BodyId, Ancestry>& ancestry) {
  const body::Body parent = *body::find_body(moving.bodies, impact.id);
  const std::shared_ptr<const Fragile> fragile = moving.fragiles.at(impact.id);
  const double thickness = parent.shape->thickness;
  const ImpactMemory memory = moving.memories[impact.id];
  BreakRow row = describe(parent, impact, thickness);
  row.generation = memory.generation;
  row.place = impact.hardest.point_world;

  Splitter splitter(*fragile, parent.shape, impact);
  Pieces split = splitter.split();
  std::vector<body::Body> born = make_bodies(parent, split.pieces);
  while (splitter.may_clash() && splitter.join(find_clashes(parent, born, moving.bodies, moving.contact))) {
    split = splitter.split();
    born = make_bodies(parent, split.pieces);
  }
  row.merged = split.merged_count;
  row.mass = parent.shape->mass;
  row.merged_mass = split.merged_share * parent.shape->mass;
  const std::vector<Piece>& pieces = split.pieces;
  row.pieces = static_cast<int>(pieces.size());
  for (const Piece& piece : pieces) row.shapes.push_back(piece.shape);
  measure_errors(parent, born, row);
  for (body::Body& body : born) body.velocity = body.locked.let_move(body.velocity);
  // Who went through meets what is behind as if for the first time.
  double charged_until = impact.first_time + 2.0 * impact.figures().verdict.duration;
  if (const fracture::Perforation* hole = find_hole(impact))
    charged_until = std::min(charged_until, time_behind(*hole));
  insert_pieces(moving, parent, memory, pieces, std::move(born), time, charged_until, impact, ancestry, row);
  return row;
}

long count_overlaps(const BreakRow& row) {
  std::vector<geometry::TriangleMesh> meshes;
  for (const auto& shape : row.shapes) {
    meshes.push_back(shape->surface);
    for (Vec3& p : meshes.back().positions) p += shape->material_from_body;
  }
  return geometry::count_crossing_pairs(meshes);
}

void divide_ways(const std::vector<body::Body>& before, std::span<const BreakRow> breaks,
                 const std::vector<body::Body>& bodies, double time, std::vector<body::Way>& ways,
                 std::vector<body::Way>& ended) {
  if (time <= 0.0) return;
  for (const BreakRow& row : breaks) {
    const body::Body* broken = body::find_body(before, row.id);
    if (!broken) continue;
    const auto known =
        std::find_if(ways.begin(), ways.end(), [&](const body::Way& way) { return way.id == row.id; });
    body::Way way{row.id, {{time, broken->pose}}, 0.0, time, nullptr};
    if (known != ways.end()) {
      way.begin = known->begin;
      way.points = std::move(known->points);
      ways.erase(known);
    }
    way.former = std::make_shared<body::Body>(*broken);
    if (way.begin < time) ended.push_back(std::move(way));
    for (const body::BodyId id : row.born) {
      const body::Body* piece = body::find_body(bodies, id);
      if (!piece) continue;
      const auto place = std::lower_bound(ways.begin(), ways.end(), id,
                                          [](const body::Way& w, body::BodyId i) { return w.id < i; });
      ways.insert(place, {id, {{time, piece->pose}}, time, 1.0, nullptr});
    }
  }
}

}  // namespace shatterbox::world
