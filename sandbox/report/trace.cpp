#include "sandbox/report/trace.h"

#include <fmt/format.h>

namespace shatterbox::sandbox::report {

namespace {

void add_quantity(std::string& text, std::size_t place, std::uint64_t hash) {
  text += fmt::format(" {}:{:08x}", place, hash >> 32);
}

void begin_body(std::string& text, body::BodyId id) {
  if (!text.empty()) text += ';';
  text += fmt::format("{}", id);
}

}  // namespace

std::vector<std::string> trace_quantities() {
  std::vector<std::string> names(world::kBodyQuantities.begin(), world::kBodyQuantities.end());
  names.emplace_back("contacts");
  return names;
}

void Tracer::note(const world::Moment& moment) {
  TraceRow row{moment.step, moment.part, moment.parts, moment.pass, moment.stage, {}};
  if (moment.contacts != last_contacts_) {
    begin_body(row.changed, 0);
    add_quantity(row.changed, world::kBodyQuantities.size(), moment.contacts);
    last_contacts_ = moment.contacts;
  }
  for (std::size_t i = 0; i < moment.bits.size(); ++i) {
    const world::BodyBits& now = moment.bits[i];
    const auto [was, is_new] = last_.try_emplace(now.id);
    if (is_new) trace.names[now.id] = moment.bodies[i].name;
    if (was->second == now) continue;
    begin_body(row.changed, now.id);
    for (std::size_t q = 0; q < now.quantities.size(); ++q)
      if (is_new || now.quantities[q] != was->second.quantities[q])
        add_quantity(row.changed, q, now.quantities[q]);
    was->second = now;
  }
  trace.rows.push_back(std::move(row));
}

void Tracer::drop_step(long step) {
  while (!trace.rows.empty() && trace.rows.back().step == step) trace.rows.pop_back();
}

}  // namespace shatterbox::sandbox::report
