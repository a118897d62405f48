// The audit's own audit: 100 seeded scenes with planted crossings, passages, touches and near misses of known
// count.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "engine/audit/audit.h"
#include "engine/core/random.h"
#include "tests/engine/audit/plates.h"

using namespace shatterbox;
using namespace shatterbox::audit;
using core::Random;

namespace {

/// Two bodies, each of a few triangles, and what they do in a step; in a place of their own.
struct Plan {
  long crossings = 0, passages = 0, exempt_pairs = 0;
};

class Scene {
 public:
  explicit Scene(std::uint64_t seed) : random_(seed) {}

  /// Adds body a with `a_start` -> `a_end` and a resting body b, turned and put into the next place together.
  /// On the lattice they are not turned, so that what touches touches to the bit.
  void plant(const std::vector<Vec3>& a, const Vec3& a_start, const Vec3& a_end, const std::vector<Vec3>& b,
             bool is_on_lattice, const Plan& plan) {
    Pose place;
    place.translation = Vec3(64.0 * static_cast<double>(++places_), 0.0, 0.0);
    if (!is_on_lattice) {
      const double x = random_.normal(), y = random_.normal(), z = random_.normal();
      place.rotation = Quat(random_.normal(), x, y, z).normalized();
      place.translation += Vec3(random_.uniform(), random_.uniform(-9.0, 9.0), 0.0);
    }
    add(a, place, a_start, a_end);
    add(b, place, Vec3::Zero(), Vec3::Zero());
    sum_.crossings += plan.crossings;
    sum_.passages += plan.passages;
    sum_.exempt_pairs += plan.exempt_pairs;
  }

  AuditReport run() const {
    Audit audit;
    std::vector<body::Body> bodies = start_;
    audit.begin_step(bodies);
    audit.end_step(bodies, {}, {}, 0.0);  // a step in which nothing moves: sees who crosses from the start
    audit.begin_step(bodies);
    audit.end_step(end_, {}, {}, 0.1);
    return audit.report();
  }

  Random& random() { return random_; }
  const Plan& sum() const { return sum_; }

 private:
  void add(const std::vector<Vec3>& corners, const Pose& place, const Vec3& from, const Vec3& to) {
    body::Body body = test::make_plate(static_cast<body::BodyId>(start_.size() + 1), corners);
    body.pose.rotation = place.rotation;
    body.pose.translation = place.apply(from);
    start_.push_back(body);
    body.pose.translation = place.apply(to);
    end_.push_back(body);
  }

  Random random_;
  std::vector<body::Body> start_, end_;
  Plan sum_;
  int places_ = 0;
};

const std::vector<Vec3> kFloor{Vec3(-8, 0, -8), Vec3(8, 0, -8), Vec3(0, 0, 8)};  // one triangle
const std::vector<Vec3> kUpright{Vec3(-1, -1, 0.25), Vec3(1, -1, 0), Vec3(0, 1, -0.25)};
const std::vector<Vec3> kLying{Vec3(-1, 0, -1), Vec3(1, 0, -1), Vec3(0, 0, 1)};
const Vec3 kHere = Vec3::Zero();

void plant_one(Scene& scene, std::uint64_t kind) {
  Random& random = scene.random();
  const double x = random.uniform(-1.0, 1.0), z = random.uniform(-1.0, 1.0);
  const double depth = std::pow(10.0, -static_cast<double>(random.index(12)));
  switch (kind) {
    case 0:  // two corners end below the floor: they passed, and one pair of triangles crosses
      return scene.plant(kUpright, Vec3(x, 3, z), Vec3(x, 1 - depth, z), kFloor, false, {1, 2, 0});
    case 1:  // ends in the floor's plane, over it
      return scene.plant(kLying, Vec3(0.25, 1, 0.5), Vec3(0.25, 0, 0.5), kFloor, true, {1, 0, 0});
    case 2:  // all three corners pass through in one step
      return scene.plant(kUpright, Vec3(x, 3, z), Vec3(x, -1 - depth, z), kFloor, false, {0, 3, 0});
    case 3:  // a tip reaches over the floor's rim (at z = -8) and passes: the tip and two edges
      return scene.plant({Vec3(0, 0, 0.5), Vec3(-1, 0, -1), Vec3(1, 0, -1)}, Vec3(x, depth, -8),
                         Vec3(x + 0.1, -depth, -8), kFloor, false, {0, 3, 0});
    case 4:  // rim comes into rim from below; then they cross
      return scene.plant({Vec3(0, -1, 0), Vec3(0, 1, 0), Vec3(0, 0, -3)}, Vec3(x, 0.125, -8 - depth),
                         Vec3(x, 0.125, -8 + 0.5 * depth), kFloor, false, {1, 1, 0});
    case 5:  // crossed from the start
      return scene.plant(kUpright, Vec3(x, 0.5, z), Vec3(x, 0.25, z), kFloor, false, {0, 0, 1});
    case 6:  // control: slides along the floor, two corners on it to the bit
      return scene.plant(kUpright, Vec3(-1, 1, 0), Vec3(2, 1, 0.5), kFloor, true, {});
    case 7:  // control: arrives and touches with one corner
      return scene.plant({Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(-1, 2, 1)}, Vec3(0, 2, 0), Vec3(1, 0, 1), kFloor,
                         true, {});
    case 8:  // control: in the floor's plane, moves up to its rim and touches all along
      return scene.plant({Vec3(-1, 0, -2), Vec3(1, 0, -2), Vec3(0, 0, -4)}, Vec3(0, 0, -7), Vec3(0, 0, -6),
                         kFloor, true, {});
    case 9:  // control: passes the floor's plane close outside its rim
      return scene.plant({Vec3(0, 0, 0), Vec3(-1, 0, -1), Vec3(1, 0, -1)}, Vec3(x, 1, -8 - depth),
                         Vec3(x, -1, -8 - depth), kFloor, false, {});
    case 10:  // control: comes as near as `depth`
      return scene.plant(kUpright, Vec3(x, 3, z), Vec3(x, 1 + depth, z), kFloor, false, {});
    default:  // a ridge pierces the floor along its fold alone: both faces of the fold count
      return scene.plant({Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, -1, 0.5), Vec3(0, 1, -0.5)}, Vec3(0, 0, 0.5),
                         Vec3(0, 0, 0.25), kFloor, true, {0, 0, 1});
  }
}

}  // namespace

TEST_CASE("audit: 100 seeded scenes, planted crossings and passages are counted, touches are not") {
  long crossings = 0, passages = 0, exempt = 0, unsettled = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Scene scene(seed);
    for (int i = 0; i < 24; ++i) plant_one(scene, scene.random().index(12));
    const AuditReport report = scene.run();
    INFO("seed " << seed);
    for (const Finding& f : report.findings)
      UNSCOPED_INFO(name_of(f.kind) << " of " << f.a << " and " << f.b << (f.is_exempt ? ", exempt" : ""));
    CHECK(report.crossings == scene.sum().crossings);
    CHECK(report.passages == scene.sum().passages);
    CHECK(report.exempt_pairs == scene.sum().exempt_pairs);
    crossings += report.crossings;
    passages += report.passages;
    exempt += report.exempt_pairs;
    unsettled += report.unsettled;
  }
  std::printf("100 scenes of 24 plans: %ld crossings, %ld passages, %ld pairs exempt, %ld touches left out\n",
              crossings, passages, exempt, unsettled);
  CHECK(crossings > 300);
  CHECK(passages > 1000);
}
