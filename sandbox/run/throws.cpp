#include "sandbox/run/throws.h"

#include <fmt/format.h>

namespace shatterbox::sandbox::run {

void Throws::add(const std::vector<script::Throw>& thrown) {
  for (const script::Throw& one : thrown) flights_.push_back({one});
}

void Throws::look(const world::World& world) {
  std::erase_if(flights_, [&world](Flight& flight) {
    // Of what broke, each piece.
    const auto is_of = [&](body::BodyId id) { return world.ancestry(id).original == flight.thrown.body; };
    for (const body::LoggedImpulse& hit : world.impulse_log()) {
      const bool is_a = is_of(hit.body_a), is_b = is_of(hit.body_b);
      if (is_a == is_b) continue;
      const body::Body* other = body::find_body(world.bodies(), is_a ? hit.body_b : hit.body_a);
      // What is gone was dented or broken by it.
      if (other == nullptr || other->shape->kind != body::ShapeKind::plane) return true;
      flight.has_hit_floor = true;
    }
    return false;
  });
}

std::vector<std::string> Throws::missed(double time) const {
  std::vector<std::string> sentences;
  for (const Flight& flight : flights_) {
    const scene::EventEntry& event = *flight.thrown.event;
    if (time < flight.thrown.arrival && !flight.has_hit_floor) {
      sentences.push_back(scene::describe(scene::Problem{
          event.place, fmt::format("what event \"{}\" threw is still on its way at the end", event.name),
          fmt::format(
              "it is at its target after {:.3g} s: let the scene run on, or throw it earlier or faster",
              flight.thrown.arrival)}));
      continue;
    }
    const bool is_at_body =
        std::holds_alternative<scene::BodyRef>(std::get<scene::Projectile>(event.action).target);
    sentences.push_back(scene::describe(scene::Problem{
        event.place,
        fmt::format("what event \"{}\" threw hit nothing{}", event.name,
                    flight.has_hit_floor ? " but the floor" : ""),
        is_at_body
            ? "it is aimed at where its target would be if it went on as it did: throw it faster, from "
              "nearer, or later"
            : "look where its target is by then: at_body = \"name\" aims at a body wherever that is"}));
  }
  return sentences;
}

}  // namespace shatterbox::sandbox::run
