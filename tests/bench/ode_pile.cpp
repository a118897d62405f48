// The pile in ODE: triangle meshes, quick step with its usual twenty iterations.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#include <ode/ode.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <array>

#include "engine/core/elementary.h"
#include "tests/bench/peer_pile.h"

namespace shatterbox::bench {

namespace {

constexpr int kMostContacts = 32;  // of a pair

struct OdeMesh {
  std::vector<double> vertices;
  std::vector<dTriIndex> indices;
  dTriMeshDataID data = nullptr;
};

class OdePile : public PeerPile {
 public:
  OdePile(const PeerScene& scene, int threads) : time_step_(scene.time_step) {
    static const bool is_ready = dInitODE2(0) != 0 && dAllocateODEDataForThread(dAllocateMaskAll) != 0;
    (void)is_ready;
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    group_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, scene.gravity.x(), scene.gravity.y(), scene.gravity.z());
    dWorldSetContactSurfaceLayer(world_, scene.kept_gap);
    dWorldSetContactMaxCorrectingVel(world_, 1.0);
    if (threads > 1) {
      threading_ = dThreadingAllocateMultiThreadedImplementation();
      if (threading_ != nullptr) {
        pool_ =
            dThreadingAllocateThreadPool(static_cast<unsigned>(threads), 0, dAllocateFlagBasicData, nullptr);
        dThreadingThreadPoolServeMultiThreadedImplementation(pool_, threading_);
        dWorldSetStepThreadingImplementation(world_, dThreadingImplementationGetFunctions(threading_),
                                             threading_);
      }
    }
    for (const PeerBody& body : scene.bodies) add(body);
  }
  ~OdePile() override {
    if (threading_ != nullptr) {
      dThreadingImplementationShutdownProcessing(threading_);
      dThreadingFreeThreadPool(pool_);
      dWorldSetStepThreadingImplementation(world_, nullptr, nullptr);
      dThreadingFreeImplementation(threading_);
    }
    dJointGroupDestroy(group_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
    for (const auto& mesh : meshes_) dGeomTriMeshDataDestroy(mesh->data);
  }
  bool has_threads() const { return threading_ != nullptr; }

  std::string engine() const override { return "ode trimesh"; }
  void step() override {
    contacts_ = 0;
    dSpaceCollide(space_, this,
                  [](void* self, dGeomID a, dGeomID b) { static_cast<OdePile*>(self)->meet(a, b); });
    dWorldQuickStep(world_, time_step_);
    dJointGroupEmpty(group_);
  }
  int contacts() const override { return contacts_; }
  Pose pose(std::size_t body) const override {
    if (bodies_[body] == nullptr) return fixed_poses_[body];
    const dReal* q = dBodyGetQuaternion(bodies_[body]);
    const dReal* p = dBodyGetPosition(bodies_[body]);
    return {Quat(q[0], q[1], q[2], q[3]), Vec3(p[0], p[1], p[2])};
  }

 private:
  dGeomID make_geometry(const PeerBody& body) {
    if (body.kind == body::ShapeKind::plane) {
      const Vec3 normal = body.pose.rotation * Vec3::UnitY();
      return dCreatePlane(space_, normal.x(), normal.y(), normal.z(), normal.dot(body.pose.translation));
    }
    if (body.kind == body::ShapeKind::box)
      return dCreateBox(space_, 2.0 * body.half_extent.x(), 2.0 * body.half_extent.y(),
                        2.0 * body.half_extent.z());
    if (body.kind == body::ShapeKind::sphere) return dCreateSphere(space_, body.radius);
    auto mesh = std::make_unique<OdeMesh>();
    for (const Vec3& p : body.mesh.positions)
      for (int axis = 0; axis < 3; ++axis) mesh->vertices.push_back(p[axis]);
    for (const geometry::Triangle& t : body.mesh.triangles)
      for (const int v : t) mesh->indices.push_back(static_cast<dTriIndex>(v));
    mesh->data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildDouble(mesh->data, mesh->vertices.data(), 3 * sizeof(double),
                                static_cast<int>(mesh->vertices.size() / 3), mesh->indices.data(),
                                static_cast<int>(mesh->indices.size()), 3 * sizeof(dTriIndex));
    meshes_.push_back(std::move(mesh));
    return dCreateTriMesh(space_, meshes_.back()->data, nullptr, nullptr, nullptr);
  }

  void add(const PeerBody& body) {
    const dGeomID geometry = make_geometry(body);
    dGeomSetData(geometry, reinterpret_cast<void*>(surfaces_.size()));
    surfaces_.push_back({body.friction, body.restitution});
    fixed_poses_.push_back(body.pose);
    bodies_.push_back(nullptr);
    const Quat& r = body.pose.rotation;
    const Vec3& p = body.pose.translation;
    const dQuaternion q = {r.w(), r.x(), r.y(), r.z()};
    if (!body.is_dynamic) {
      if (body.kind == body::ShapeKind::plane) return;
      dGeomSetPosition(geometry, p.x(), p.y(), p.z());
      dGeomSetQuaternion(geometry, q);
      return;
    }
    const dBodyID id = bodies_.back() = dBodyCreate(world_);
    dMass mass;
    dMassSetParameters(&mass, body.mass, 0, 0, 0, body.inertia.x(), body.inertia.y(), body.inertia.z(), 0, 0,
                       0);
    dBodySetMass(id, &mass);
    dBodySetPosition(id, p.x(), p.y(), p.z());
    dBodySetQuaternion(id, q);
    dBodySetLinearVel(id, body.velocity.x(), body.velocity.y(), body.velocity.z());
    dBodySetAngularVel(id, body.spin.x(), body.spin.y(), body.spin.z());
    dGeomSetBody(geometry, id);
  }

  void meet(dGeomID a, dGeomID b) {
    const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
    if (body_a == nullptr && body_b == nullptr) return;
    std::array<dContact, kMostContacts> found{};
    const int count = dCollide(a, b, kMostContacts, &found[0].geom, sizeof(dContact));
    const Surface& surface_a = surfaces_[reinterpret_cast<std::size_t>(dGeomGetData(a))];
    const Surface& surface_b = surfaces_[reinterpret_cast<std::size_t>(dGeomGetData(b))];
    for (int i = 0; i < count; ++i) {
      dContact& contact = found[static_cast<std::size_t>(i)];
      contact.surface.mode = dContactBounce | dContactApprox1;
      contact.surface.mu = core::sqrt(surface_a.friction * surface_b.friction);
      contact.surface.bounce = std::min(surface_a.restitution, surface_b.restitution);
      contact.surface.bounce_vel = 0.2;
      dJointAttach(dJointCreateContact(world_, group_, &contact), body_a, body_b);
    }
    contacts_ += count;
  }

  struct Surface {
    double friction = 0.5, restitution = 0.0;
  };

  double time_step_;
  dWorldID world_ = nullptr;
  dSpaceID space_ = nullptr;
  dJointGroupID group_ = nullptr;
  dThreadingImplementationID threading_ = nullptr;
  dThreadingThreadPoolID pool_ = nullptr;
  std::vector<dBodyID> bodies_;
  std::vector<Pose> fixed_poses_;
  std::vector<Surface> surfaces_;
  std::vector<std::unique_ptr<OdeMesh>> meshes_;
  int contacts_ = 0;
};

}  // namespace

std::unique_ptr<PeerPile> make_ode_pile(const PeerScene& scene, int threads) {
  auto pile = std::make_unique<OdePile>(scene, threads);
  if (threads > 1 && !pile->has_threads()) return nullptr;  // built without threads
  return pile;
}

}  // namespace shatterbox::bench
