#include "engine/world/impact_row.h"

#include <cstdio>

#include "engine/world/perforation.h"

namespace shatterbox::world {
namespace {

/// "60 MPa of 235": of the yield strength.
std::string format_yield(const fracture::Verdict& verdict) {
  char text[96];
  std::snprintf(text, sizeof text, "%s: %.3g MPa of %.3g",
                verdict.von_mises > verdict.yield ? "yielded" : "did not yield", verdict.von_mises * 1e-6,
                verdict.yield * 1e-6);
  return text;
}

}  // namespace

std::string format_ratio(const char* word, double ratio) {
  char text[64];
  std::snprintf(text, sizeof text, "%s%.3g of its strength", word, ratio);
  return text;
}

ImpactRow describe_impact(const EvaluatedImpact& impact, const body::Body& body, double time) {
  const fracture::Verdict& verdict = impact.figures().verdict;
  ImpactRow row;
  row.time = time;
  row.body = body.name;
  row.id = body.id;
  row.is_struck = impact.is_struck;
  row.impulse = verdict.impulse;
  row.duration = verdict.duration;
  row.stress = verdict.stress;
  row.strength = verdict.strength;
  row.ratio = verdict.ratio;
  row.von_mises = verdict.von_mises;
  row.yield = verdict.yield;
  row.place = body.pose.apply(verdict.place - body.shape->material_from_body);
  switch (verdict.outcome) {
    case fracture::Outcome::broke:
      row.verdict = find_hole(impact) ? describe_perforation(*find_hole(impact))
                                      : format_ratio("broke: ", verdict.ratio);
      break;
    case fracture::Outcome::held:
      row.verdict = verdict.reason.empty()
                        ? format_ratio(verdict.is_estimate ? "held: about " : "held: ", verdict.ratio)
                        : "held: " + verdict.reason;
      break;
    case fracture::Outcome::not_evaluated:
      row.verdict = "not evaluated: " + verdict.reason;
      break;
  }
  if (verdict.von_mises > 0.0) row.verdict += ", " + format_yield(verdict);
  const fracture::Perforation* asked = find_perforation(impact);
  if (!asked || !asked->is_near()) return row;
  row.perforation_energy = asked->needed;
  row.perforation_ratio = asked->ratio();
  if (!find_hole(impact)) row.verdict += ", " + describe_perforation(*asked);
  return row;
}

}  // namespace shatterbox::world
