#include "sandbox/scene/build_joints.h"

#include <algorithm>

#include <fmt/format.h>

namespace shatterbox::sandbox::scene {

namespace {

struct Partner {
  body::BodyId id = 0;
  Vec3 place = Vec3::Zero();
  double reach = 0.0;  // m; 0: without end
};

std::vector<Partner> find_partners(const JointEntry& joint, const BuiltScene& built) {
  std::vector<Partner> partners;
  for (const body::Body& body : built.world.bodies()) {
    const auto origin = built.origins.find(body.id);
    if (origin == built.origins.end()) continue;
    const Origin& who = origin->second;
    if (std::none_of(joint.partners.begin(), joint.partners.end(),
                     [&](const BodyRef& partner) { return partner.includes(who.entry, who.copy); }))
      continue;
    partners.push_back({body.id, body.pose.translation, body.shape->bounding_radius});
  }
  return partners;
}

}  // namespace

void add_joints(const SceneDescription& scene, BuiltScene& built, Problems& problems) {
  for (const JointEntry& entry : scene.joints) {
    world::JointDescription joint;
    joint.name = entry.name;
    joint.form = entry.form;
    joint.strength = entry.strength;
    joint.shear_strength = entry.shear_strength;
    const auto* mortar = std::get_if<world::MortarDescription>(&entry.form);
    const std::vector<Partner> partners = find_partners(entry, built);
    int made = 0;
    for (std::size_t i = 0; i < partners.size(); ++i) {
      const std::size_t last = entry.is_chain ? std::min(i + 2, partners.size()) : partners.size();
      for (std::size_t k = i + 1; k < last; ++k) {
        const Partner &a = partners[i], &b = partners[k];
        const double reach = a.reach + b.reach + (mortar != nullptr ? mortar->gap : 0.0);
        const bool is_far = a.reach > 0.0 && b.reach > 0.0 && (a.place - b.place).norm() > reach;
        if (mortar != nullptr && is_far) continue;
        if (entry.is_chain) std::get<world::PivotDescription>(joint.form).point = 0.5 * (a.place + b.place);
        joint.body_a = a.id;
        joint.body_b = b.id;
        const auto number = built.world.add_joint(joint);
        if (!number) return book(problems, entry.place, number.error(), "");
        made += number.value() > 0 ? 1 : 0;
      }
    }
    const bool is_somebody_away =
        std::any_of(entry.partners.begin(), entry.partners.end(), [&](const BodyRef& partner) {
          return scene.bodies[static_cast<std::size_t>(partner.body)].is_held_back;
        });
    if (made > 0 || is_somebody_away) continue;
    book(problems, entry.place,
         mortar == nullptr
             ? fmt::format("joint \"{}\": neither of its bodies can move", entry.name)
             : fmt::format("joint \"{}\": no faces of its bodies look against each other within {:g} mm",
                           entry.name, 1e3 * mortar->gap),
         mortar == nullptr ? "give one of them motion = \"dynamic\""
                           : "move the bodies together, or give the joint a wider gap");
  }
}

}  // namespace shatterbox::sandbox::scene
