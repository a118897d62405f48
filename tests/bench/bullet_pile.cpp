// The pile in Bullet: GImpact meshes (its way for moving triangle meshes), its usual solver settings.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolverMt.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <LinearMath/btThreads.h>
#include <btBulletDynamicsCommon.h>
#pragma GCC diagnostic pop

#include "engine/core/elementary.h"
#include "tests/bench/peer_pile.h"

namespace shatterbox::bench {

namespace {

btVector3 to_bullet(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

btITaskScheduler* find_scheduler() {
  static btITaskScheduler* const scheduler = btCreateDefaultTaskScheduler();
  return scheduler;
}

class BulletPile : public PeerPile {
 public:
  BulletPile(const PeerScene& scene, int threads) : time_step_(scene.time_step), threads_(threads) {
    configuration_ = std::make_unique<btDefaultCollisionConfiguration>();
    broad_phase_ = std::make_unique<btDbvtBroadphase>();
    if (threads > 1) {
      dispatcher_ = std::make_unique<btCollisionDispatcherMt>(configuration_.get());
      pool_ = std::make_unique<btConstraintSolverPoolMt>(threads);
      solver_ = std::make_unique<btSequentialImpulseConstraintSolverMt>();
      world_ = std::make_unique<btDiscreteDynamicsWorldMt>(
          dispatcher_.get(), broad_phase_.get(), pool_.get(),
          static_cast<btSequentialImpulseConstraintSolverMt*>(solver_.get()), configuration_.get());
    } else {
      dispatcher_ = std::make_unique<btCollisionDispatcher>(configuration_.get());
      solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
      world_ = std::make_unique<btDiscreteDynamicsWorld>(dispatcher_.get(), broad_phase_.get(), solver_.get(),
                                                         configuration_.get());
    }
    btGImpactCollisionAlgorithm::registerAlgorithm(dispatcher_.get());
    world_->setGravity(to_bullet(scene.gravity));
    for (const PeerBody& body : scene.bodies) add(body, scene.kept_gap);
  }
  ~BulletPile() override {
    for (const auto& body : bodies_) world_->removeRigidBody(body.get());
  }

  std::string engine() const override { return "bullet gimpact"; }
  void step() override {
    if (threads_ > 1) {
      btSetTaskScheduler(find_scheduler());
      find_scheduler()->setNumThreads(threads_);
    } else {
      btSetTaskScheduler(btGetSequentialTaskScheduler());
    }
    world_->stepSimulation(time_step_, 0);
  }
  int contacts() const override {
    int count = 0;
    for (int i = 0; i < dispatcher_->getNumManifolds(); ++i)
      count += dispatcher_->getManifoldByIndexInternal(i)->getNumContacts();
    return count;
  }
  Pose pose(std::size_t body) const override {
    const btTransform& t = bodies_[body]->getWorldTransform();
    const btQuaternion q = t.getRotation();
    const btVector3& p = t.getOrigin();
    return {Quat(q.w(), q.x(), q.y(), q.z()), Vec3(p.x(), p.y(), p.z())};
  }

 private:
  std::unique_ptr<btCollisionShape> make_shape(const PeerBody& body, double margin) {
    if (body.kind == body::ShapeKind::plane)
      return std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), 0.0);
    if (body.kind == body::ShapeKind::box) return std::make_unique<btBoxShape>(to_bullet(body.half_extent));
    if (body.kind == body::ShapeKind::sphere) return std::make_unique<btSphereShape>(body.radius);
    auto mesh = std::make_unique<btTriangleMesh>();
    for (const geometry::Triangle& t : body.mesh.triangles) {
      const auto corner = [&](int i) {
        return to_bullet(body.mesh.positions[static_cast<std::size_t>(t[static_cast<std::size_t>(i)])]);
      };
      mesh->addTriangle(corner(0), corner(1), corner(2));
    }
    auto shape = std::make_unique<btGImpactMeshShape>(mesh.get());
    shape->setMargin(margin);
    shape->updateBound();
    meshes_.push_back(std::move(mesh));
    return shape;
  }

  void add(const PeerBody& body, double margin) {
    shapes_.push_back(make_shape(body, margin));
    btRigidBody::btRigidBodyConstructionInfo info(
        body.is_dynamic ? body.mass : 0.0, nullptr, shapes_.back().get(),
        body.is_dynamic ? to_bullet(body.inertia) : btVector3(0, 0, 0));
    const Quat& q = body.pose.rotation;
    info.m_startWorldTransform =
        btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), to_bullet(body.pose.translation));
    info.m_friction = core::sqrt(body.friction);  // Bullet multiplies those of a pair
    info.m_restitution = body.restitution;
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    if (body.is_dynamic) {
      bodies_.back()->setLinearVelocity(to_bullet(body.velocity));
      bodies_.back()->setAngularVelocity(to_bullet(body.spin));
    }
    world_->addRigidBody(bodies_.back().get());
  }

  double time_step_;
  int threads_;
  std::unique_ptr<btDefaultCollisionConfiguration> configuration_;
  std::unique_ptr<btBroadphaseInterface> broad_phase_;
  std::unique_ptr<btCollisionDispatcher> dispatcher_;
  std::unique_ptr<btConstraintSolverPoolMt> pool_;
  std::unique_ptr<btSequentialImpulseConstraintSolver> solver_;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  std::vector<std::unique_ptr<btTriangleMesh>> meshes_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

}  // namespace

std::unique_ptr<PeerPile> make_bullet_pile(const PeerScene& scene, int threads) {
  if (threads > 1 && find_scheduler() == nullptr) return nullptr;  // built without threads
  return std::make_unique<BulletPile>(scene, threads);
}

}  // namespace shatterbox::bench
