#include "tests/bench/our_pile.h"

#include "engine/core/parallel.h"
#include "sandbox/scene/build_world.h"
#include "sandbox/scene/find_scene.h"
#include "sandbox/scene/read_scene.h"

namespace shatterbox::bench {

namespace {

class WorldPile : public PeerPile {
 public:
  WorldPile(sandbox::scene::BuiltScene built, const PeerScene& scene, int threads)
      : built_(std::move(built)), threads_(threads) {
    for (const PeerBody& body : scene.bodies) turns_.push_back(body.body_from_principal);
  }
  std::string engine() const override { return "shatterbox"; }
  void step() override {
    core::set_thread_count(threads_);
    built_.world.step();
  }
  int contacts() const override { return built_.world.report().contact.contacts; }
  Pose pose(std::size_t body) const override {
    const Pose& pose = built_.world.bodies()[body].pose;
    return {pose.rotation * turns_[body], pose.translation};
  }

 private:
  sandbox::scene::BuiltScene built_;
  std::vector<Quat> turns_;
  int threads_;
};

}  // namespace

OurPile make_our_pile(const std::string& scene, const std::vector<std::string>& changes, int threads,
                      std::string& fault) {
  sandbox::scene::Problems problems;
  const std::string file = sandbox::scene::find_scene(scene, problems);
  sandbox::scene::SceneChanges all{changes, ""};
  all.overrides.emplace_back("scene.sleep=false");
  std::optional<sandbox::scene::BuiltScene> built;
  if (!file.empty()) {
    if (const auto description = sandbox::scene::read_scene_file(file, all, problems))
      built = sandbox::scene::build_world(*description, problems);
  }
  if (!built) {
    fault = sandbox::scene::describe(problems);
    return {};
  }
  OurPile ours;
  const world::WorldSettings& settings = built->world.settings();
  ours.scene = make_peer_scene(built->world.bodies(), settings.gravity, 1.0 / settings.steps_per_second);
  ours.pile = std::make_unique<WorldPile>(std::move(*built), ours.scene, threads);
  return ours;
}

}  // namespace shatterbox::bench
