#include "engine/audit/audit.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "engine/audit/pair_audit.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"

namespace shatterbox::audit {
namespace {

using body::BodyId;
using body::ShapeKind;
using core::at;

bool is_same(const Pose& a, const Pose& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs();
}

}  // namespace

const char* name_of(FindingKind kind) {
  switch (kind) {
    case FindingKind::crossing:
      return "triangles cross";
    case FindingKind::vertex_passage:
      return "vertex passed through triangle";
    case FindingKind::triangle_passage:
      return "triangle passed through by vertex";
    case FindingKind::edge_passage:
      return "edge passed through edge";
    case FindingKind::sunk_in_plane:
      return "vertex below plane";
    case FindingKind::sunk_in_sphere:
      return "triangle in sphere";
    case FindingKind::sphere_passage:
      return "triangle passed through sphere";
  }
  return "";
}

struct Audit::Actor {
  BodyId id = 0;
  bool is_dynamic = false, is_moving = false, is_new = false;
  bool is_scripted = false, may_break = false;
  int group = -1;
  body::BodyId family = 0;
  ShapeKind kind = ShapeKind::shell;
  double radius = 0.0;  // of a sphere, m
  Pose start, end;
  std::shared_ptr<const Surface> surface;
  std::vector<double> times;                // shares of the step, from 0 to 1 unless it came to be or broke
  std::vector<Pose> poses;                  // at these times
  std::vector<std::vector<Vec3>> stations;  // vertices, or the sphere's centre, at these times
  std::vector<MovingSurface> legs;          // between them; none if it goes straight, which `moving` tells
  MovingSurface moving;                     // the whole way
  Bounds bounds;                            // of the way; without end for planes

  std::vector<Vec3> points_at(double time) const {
    const auto next =
        static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), time) - times.begin());
    if (times[next] == time) return stations[next];
    const double share = (time - times[next - 1]) / (times[next] - times[next - 1]);
    std::vector<Vec3> points = stations[next - 1];
    for (std::size_t v = 0; v < points.size(); ++v) points[v] += share * (stations[next][v] - points[v]);
    return points;
  }

  /// Its straight way from one time to another between which it has no station.
  const MovingSurface& leg(double from, double to, MovingSurface& scratch) const {
    if (from == times.front() && to == times.back()) return moving;
    const auto place =
        static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), from) - times.begin());
    if (times[place] == from && place + 1 < times.size() && times[place + 1] == to) return legs[place];
    scratch = surface ? move_surface(*surface, points_at(from), points_at(to))
                      : MovingSurface{points_at(from), points_at(to), {}, {}};
    return scratch;
  }
};

/// Calls visit(leg of a, leg of b, whether it is the step's last) for the straight legs that both go together
/// while both are there.
template <class Actor, class Visit>
void follow(const Actor& a, const Actor& b, const Visit& visit) {
  std::vector<double> times;
  std::set_union(a.times.begin(), a.times.end(), b.times.begin(), b.times.end(), std::back_inserter(times));
  const double begin = std::max(a.times.front(), b.times.front());
  const double end = std::min(a.times.back(), b.times.back());
  std::erase_if(times, [&](double time) { return time < begin || time > end; });
  MovingSurface scratch_a, scratch_b;
  for (std::size_t k = 0; k + 1 < times.size(); ++k)
    visit(a.leg(times[k], times[k + 1], scratch_a), b.leg(times[k], times[k + 1], scratch_b),
          times[k + 1] == 1.0);
}

struct Audit::PairResult {
  PairFindings findings;
  bool crossed_at_start = false;
  bool is_one_group = false;
};

void Audit::begin_step(std::span<const body::Body> bodies) {
  starts_.clear();
  for (const body::Body& b : bodies) starts_.emplace_hint(starts_.end(), b.id, Start{b.shape, b.pose});
}

/// A piece starts where the body started that it is, or was, a part of: their material points are the same.
Audit::Start Audit::start_of(const body::Body& body, std::span<const Birth> births) const {
  BodyId id = body.id;
  for (std::size_t i = 0; i <= births.size(); ++i) {
    const auto found = starts_.find(id);
    if (found != starts_.end()) {
      const Start& start = found->second;
      if (id == body.id) return start;
      Pose pose = start.pose;
      pose.translation = start.pose.apply(body.shape->material_from_body - start.shape->material_from_body);
      return {body.shape, pose};
    }
    const auto birth =
        std::find_if(births.begin(), births.end(), [id](const Birth& b) { return b.child == id; });
    if (birth == births.end()) break;
    id = birth->parent;
  }
  return {body.shape, body.pose};
}

std::shared_ptr<const Surface> Audit::surface_of(const std::shared_ptr<const body::Shape>& shape) {
  auto& surface = surfaces_[shape.get()];  // the surface keeps its shape: no other can get this address
  if (!surface) surface = make_surface(shape);
  return surface;
}

Audit::Actor Audit::make_actor(const body::Body& body, const body::Way* way, std::span<const Birth> births) {
  Actor actor;
  actor.id = body.id;
  actor.is_dynamic = body.is_dynamic();
  actor.is_scripted = body.motion == body::Motion::scripted;
  actor.may_break = body.may_break;
  actor.group = body.group;
  actor.family = body.family;
  actor.kind = body.shape->kind;
  actor.radius = actor.kind == ShapeKind::sphere ? body.shape->radius : 0.0;
  if (!way || way->begin <= 0.0) {
    actor.times.push_back(0.0);
    actor.poses.push_back(start_of(body, births).pose);
  }
  for (const body::Waypoint& point : way ? way->points : std::vector<body::Waypoint>{}) {
    actor.times.push_back(point.time);
    actor.poses.push_back(point.pose);
  }
  if (!way || way->end >= 1.0) {
    actor.times.push_back(1.0);
    actor.poses.push_back(body.pose);
  }
  actor.start = actor.poses.front();
  actor.end = actor.poses.back();
  actor.is_moving = actor.times.size() > 2 || !is_same(actor.start, actor.end);
  const auto known = known_.find(body.id);
  actor.is_new = known == known_.end() || known->second != body.shape;
  actor.surface = surface_of(body.shape);
  return actor;
}

std::vector<Audit::Actor> Audit::make_actors(std::span<const body::Body> bodies,
                                             std::span<const Birth> births, std::span<const body::Way> ways) {
  std::vector<Actor> actors;
  const auto ended = std::find_if(ways.begin(), ways.end(), [](const body::Way& w) { return w.end < 1.0; });
  for (const body::Body& body : bodies) {
    const auto way = std::lower_bound(ways.begin(), ended, body.id,
                                      [](const body::Way& w, BodyId id) { return w.id < id; });
    actors.push_back(make_actor(body, way != ended && way->id == body.id ? &*way : nullptr, births));
  }
  for (auto way = ended; way != ways.end(); ++way) actors.push_back(make_actor(*way->former, &*way, births));
  std::stable_sort(actors.begin(), actors.end(), [](const Actor& x, const Actor& y) { return x.id < y.id; });
  core::parallel_for(actors.size(), 4, [&](std::size_t i) {
    Actor& actor = actors[i];
    if (actor.kind == ShapeKind::plane) return;
    if (actor.kind == ShapeKind::sphere) {
      for (const Pose& pose : actor.poses) {
        actor.stations.push_back({pose.translation});
        actor.bounds.include(pose.translation);
      }
      for (std::size_t k = 0; actor.stations.size() > 2 && k + 1 < actor.stations.size(); ++k)
        actor.legs.push_back({actor.stations[k], actor.stations[k + 1], {}, {}});
      actor.moving = {actor.stations.front(), actor.stations.back(), {}, {}};
      actor.bounds.low.array() -= actor.radius;
      actor.bounds.high.array() += actor.radius;
      return;
    }
    for (const Pose& pose : actor.poses) actor.stations.push_back(place_surface(*actor.surface, pose));
    actor.moving = move_surface(*actor.surface, actor.stations.front(), actor.stations.back());
    for (std::size_t k = 0; actor.stations.size() > 2 && k + 1 < actor.stations.size(); ++k) {
      actor.legs.push_back(move_surface(*actor.surface, actor.stations[k], actor.stations[k + 1]));
      include_way(actor.legs.back(), actor.moving);
    }
    if (!actor.moving.nodes.empty()) actor.bounds = actor.moving.nodes.front();
  });
  return actors;
}

/// Pairs with a dynamic body, and of scripted ones with what can break, whose ways' boxes meet, in ascending
/// order. Pairs in which nothing moved and nothing is new stand as they stood.
std::vector<std::pair<int, int>> Audit::find_pairs(const std::vector<Actor>& actors) const {
  std::vector<std::pair<int, int>> pairs;
  const auto is_wanted = [&](const Actor& a, const Actor& b) {
    const bool strikes = (a.is_scripted && b.may_break) || (b.is_scripted && a.may_break);
    if (!a.is_dynamic && !b.is_dynamic && !strikes) return false;
    if (!a.is_moving && !b.is_moving && !a.is_new && !b.is_new) return crossing_.count({a.id, b.id}) > 0;
    return a.kind != ShapeKind::plane || b.kind != ShapeKind::plane;
  };
  std::vector<int> order;
  for (int i = 0; i < static_cast<int>(actors.size()); ++i) {
    if (actors[at(i)].kind != ShapeKind::plane) {
      order.push_back(i);
      continue;
    }
    for (int j = 0; j < static_cast<int>(actors.size()); ++j)
      if (j != i && is_wanted(actors[at(std::min(i, j))], actors[at(std::max(i, j))]))
        pairs.emplace_back(std::min(i, j), std::max(i, j));
  }
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const double x = actors[at(a)].bounds.low.x(), y = actors[at(b)].bounds.low.x();
    return x < y || (x == y && a < b);
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Actor& a = actors[at(order[i])];
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const Actor& b = actors[at(order[j])];
      if (b.bounds.low.x() > a.bounds.high.x()) break;
      if (!a.bounds.meets(b.bounds)) continue;
      const auto [low, high] = std::minmax(order[i], order[j]);
      if (is_wanted(actors[at(low)], actors[at(high)])) pairs.emplace_back(low, high);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

Audit::PairResult Audit::audit_pair(const Actor& one, const Actor& other) {
  const auto rank = [](const Actor& x) {
    return x.kind == ShapeKind::plane ? 2 : x.kind == ShapeKind::sphere ? 1 : 0;
  };
  const bool is_flipped = rank(one) > rank(other);
  const Actor &a = is_flipped ? other : one, &b = is_flipped ? one : other;
  bool is_new = a.is_new || b.is_new;
  PairResult result;
  if (a.group >= 0 && a.group == b.group && (a.family == 0 || a.family != b.family)) {
    result.is_one_group = true;
    result.findings.has_crossing = b.surface->triangles.size() > 0 &&
                                   do_cross(*a.surface, a.moving, *b.surface, b.moving, &MovingSurface::end);
    return result;
  }
  if (b.kind == ShapeKind::plane) {
    if (is_new) result.crossed_at_start = is_below_plane(a.moving.start, a.radius, b.end);
    audit_plane(a.moving, a.radius, b.end, result.findings);
  } else if (a.kind == ShapeKind::sphere) {
    const auto ball = [](const Actor& actor, const MovingSurface& leg) {
      return MovingBall{{leg.start.front(), leg.end.front()}, actor.radius};
    };
    follow(a, b, [&](const MovingSurface& leg_a, const MovingSurface& leg_b, bool is_end) {
      if (std::exchange(is_new, false))
        result.crossed_at_start = do_balls_cross_at_start(ball(a, leg_a), ball(b, leg_b));
      audit_balls(ball(a, leg_a), ball(b, leg_b), is_end, result.findings);
    });
  } else if (b.kind == ShapeKind::sphere) {
    follow(a, b, [&](const MovingSurface& leg_a, const MovingSurface& leg_b, bool is_end) {
      if (std::exchange(is_new, false))
        result.crossed_at_start = crosses_sphere_at_start(*a.surface, leg_a, leg_b.start.front(), b.radius);
      audit_sphere(*a.surface, leg_a, leg_b.start.front(), leg_b.end.front(), b.radius, is_end,
                   result.findings);
    });
  } else {
    follow(a, b, [&](const MovingSurface& leg_a, const MovingSurface& leg_b, bool is_end) {
      if (std::exchange(is_new, false))
        result.crossed_at_start = do_cross(*a.surface, leg_a, *b.surface, leg_b, &MovingSurface::start);
      audit_surfaces(*a.surface, leg_a, *b.surface, leg_b, is_end, result.findings);
    });
  }
  for (Finding& finding : result.findings.list) {
    finding.a = a.id;
    finding.b = b.id;
  }
  return result;
}

void Audit::end_step(std::span<const body::Body> bodies, std::span<const Birth> births,
                     std::span<const body::Way> ways, double time) {
  ++report_.steps;
  const std::vector<Actor> actors = make_actors(bodies, births, ways);
  const auto pairs = find_pairs(actors);
  std::vector<PairResult> results(pairs.size());
  core::parallel_for(pairs.size(), 4, [&](std::size_t i) {
    results[i] = audit_pair(actors[at(pairs[i].first)], actors[at(pairs[i].second)]);
  });
  long group_pairs = 0;
  const auto crossing_before = std::exchange(crossing_, {});
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    PairResult& result = results[i];
    const std::pair<BodyId, BodyId> ids{actors[at(pairs[i].first)].id, actors[at(pairs[i].second)].id};
    const auto before = crossing_before.find(ids);
    const bool was_exempt = before != crossing_before.end() && before->second;
    const bool is_exempt = was_exempt || result.crossed_at_start;
    if (is_exempt && !was_exempt) ++report_.exempt_pairs;
    if (result.findings.has_crossing) crossing_[ids] = is_exempt;
    if (result.is_one_group && result.findings.has_crossing) ++group_pairs;
    report_.unsettled += result.findings.unsettled;
    book(result.findings.list, is_exempt, time);
  }
  report_.group_pairs = std::max(report_.group_pairs, group_pairs);
  known_.clear();
  for (const body::Body& b : bodies) known_.emplace_hint(known_.end(), b.id, b.shape);
  std::erase_if(surfaces_, [](const auto& entry) { return entry.second->shape.use_count() == 1; });
}

void Audit::book(std::vector<Finding>& found, bool is_exempt, double time) {
  for (Finding& finding : found) {
    finding.step = report_.steps;
    finding.time = time;
    finding.is_exempt = is_exempt;
    if (report_.findings.size() < kMostFindings) report_.findings.push_back(finding);
    const bool is_passage =
        finding.kind == FindingKind::vertex_passage || finding.kind == FindingKind::triangle_passage ||
        finding.kind == FindingKind::edge_passage || finding.kind == FindingKind::sphere_passage;
    if (is_exempt) {
      ++(is_passage ? report_.exempt_passages : report_.exempt_crossings);
      continue;
    }
    ++(is_passage ? report_.passages : report_.crossings);
    if (report_.first_time < 0.0) report_.first_time = time;
  }
}

}  // namespace shatterbox::audit
