// tests/bench/peers/bullet.cpp -- a soft body of Bullet, where its headers are installed.
#include "tests/bench/peers/peer.h"

#ifdef CORDIS_HAS_BULLET

#include <memory>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include "sim_node/plan/reference/thread_time.h"

namespace cordis::bench {
namespace {

/// The net of square_net() as nodes and links, whose solver corrects positions.
class SoftNet {
 public:
  SoftNet() {
    world_.setGravity(btVector3(0, 0, 0));
    std::vector<btVector3> places;
    for (int i = 0; i < kNetSide * kNetSide; ++i)
      places.emplace_back(btScalar(0.01 * (i % kNetSide)), btScalar(0.01 * (i / kNetSide)), 0);
    const std::vector<btScalar> masses(places.size(), btScalar(0.01));
    auto* body = new btSoftBody(&world_.getWorldInfo(), static_cast<int>(places.size()),
                                places.data(), masses.data());
    for (int i = 0; i < kNetSide * kNetSide; ++i) {
      if (i % kNetSide + 1 < kNetSide) body->appendLink(i, i + 1);
    }
    for (int i = 0; i + kNetSide < kNetSide * kNetSide; ++i) body->appendLink(i, i + kNetSide);
    body->m_cfg.piterations = 1;
    body->m_cfg.collisions = 0;
    body->setVelocity(btVector3(0, 0, btScalar(0.1)));
    body_.reset(body);
    world_.addSoftBody(body);
  }
  ~SoftNet() { world_.removeSoftBody(body_.get()); }
  SoftNet(const SoftNet&) = delete;
  SoftNet& operator=(const SoftNet&) = delete;

  void step() { world_.stepSimulation(btScalar(1e-3), 0); }

 private:
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btSoftRigidDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::unique_ptr<btSoftBody> body_;
};

}  // namespace

std::vector<Peer> bullet_on_a_net() {
  constexpr int kSteps = 300;
  const auto net = std::make_shared<SoftNet>();
  const int version = btGetVersion();
  return {{"Bullet " + std::to_string(version / 100) + "." + std::to_string(version % 100) +
               ", soft body, 1 iteration",
           [net] {
             const double begin = plan::thread_nsec();
             for (int n = 0; n < kSteps; ++n) net->step();
             return 1e-9 * (plan::thread_nsec() - begin) / kSteps / kNetLinks;
           }}};
}

}  // namespace cordis::bench

#else

namespace cordis::bench {

std::vector<Peer> bullet_on_a_net() {
  return {};
}

}  // namespace cordis::bench

#endif
