// An independent check of the promise that nothing crosses: after each step, which triangles of different
// bodies cross, and what passed through what on the straight vertex paths of the step. Reads poses and
// surfaces only and shares no code with the contact path.
//
// Counted are pairs of bodies with a dynamic one in them. Shells and boxes are triangles; a
// sphere is a ball, a plane the half space below it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "engine/audit/surface.h"
#include "engine/body/body.h"
#include "engine/body/way.h"

namespace shatterbox::audit {

enum class FindingKind : std::uint8_t {
  crossing,          // two triangles cross at the end of the step
  vertex_passage,    // a vertex of a passed through a triangle of b
  triangle_passage,  // a triangle of a was passed through by a vertex of b
  edge_passage,      // an edge of a passed through an edge of b
  sunk_in_plane,     // a vertex of a (or the sphere a) is below the plane b at the end of the step
  sunk_in_sphere,    // a triangle of a (or the sphere a) reaches into the sphere b at the end of the step
  sphere_passage     // a triangle of a, or the sphere a, was inside of the sphere b within the step, or a
                     // triangle let its centre through
};

const char* name_of(FindingKind kind);

struct Finding {
  long step = 0;      // number of the step, from 1
  double time = 0.0;  // s, at its end
  FindingKind kind = FindingKind::crossing;
  body::BodyId a = 0, b = 0;
  int feature_a = 0, feature_b = 0;  // triangle, vertex or edge of the surface; 0 for spheres and planes
  bool is_exempt = false;            // the pair crossed from the start, or from a birth on
};

struct AuditReport {
  long steps = 0;
  long crossings = 0;        // pairs of features at the ends of steps, summed over steps
  long passages = 0;         // pairs of features, summed over steps
  double first_time = -1.0;  // s, of the first crossing or passage; negative if there is none
  // Apart: of pairs that crossed when the audit first saw them (at the start, or at the birth of one), until
  // they have come apart.
  long exempt_pairs = 0, exempt_crossings = 0, exempt_passages = 0;
  long group_pairs = 0;  // apart: pairs of one group, meant to pass each other, that cross: most at once
  long unsettled = 0;    // touched, or missed each other, by no more than rounding: not counted above
  std::vector<Finding> findings;  // the first kMostFindings, exempt ones included
};

inline constexpr std::size_t kMostFindings = 10000;

/// A body that appeared during a step as a part of another.
struct Birth {
  body::BodyId child = 0, parent = 0;
};

class Audit {
 public:
  /// Tells the poses from which the step that follows begins. `bodies` ascend by id.
  void begin_step(std::span<const body::Body> bodies);

  /// Checks the step that has ended at `time` (s). Bodies that were not there when it began start where their
  /// parents in `births` did, or else where they are now. `ways` tell who did not go straight, came to be in
  /// the midst of the step, or (behind the others, which ascend by id) broke there: each is looked at with
  /// the surface that it had at the time.
  void end_step(std::span<const body::Body> bodies, std::span<const Birth> births,
                std::span<const body::Way> ways, double time);

  const AuditReport& report() const { return report_; }

 private:
  struct Actor;
  struct PairResult;
  struct Start {
    std::shared_ptr<const body::Shape> shape;
    Pose pose;
  };

  std::vector<Actor> make_actors(std::span<const body::Body> bodies, std::span<const Birth> births,
                                 std::span<const body::Way> ways);
  Start start_of(const body::Body& body, std::span<const Birth> births) const;
  Actor make_actor(const body::Body& body, const body::Way* way, std::span<const Birth> births);
  std::shared_ptr<const Surface> surface_of(const std::shared_ptr<const body::Shape>& shape);
  std::vector<std::pair<int, int>> find_pairs(const std::vector<Actor>& actors) const;
  /// The one of lesser id first.
  static PairResult audit_pair(const Actor& one, const Actor& other);
  void book(std::vector<Finding>& found, bool is_exempt, double time);

  std::map<body::BodyId, Start> starts_;
  std::map<body::BodyId, std::shared_ptr<const body::Shape>> known_;  // seen at the end of the last step
  std::map<const body::Shape*, std::shared_ptr<const Surface>> surfaces_;
  std::map<std::pair<body::BodyId, body::BodyId>, bool> crossing_;  // pairs that cross now; true: exempt
  AuditReport report_;
};

}  // namespace shatterbox::audit
