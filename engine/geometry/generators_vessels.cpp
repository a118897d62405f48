// Vessels, closed with a wall for solids or as one sheet for shells, and the egg.
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/geometry/generator_faults.h"
#include "engine/geometry/generators.h"

namespace shatterbox::geometry {
namespace {

/// One side of a wall: from its lower end up, smooth, with the radius `inset` less than given.
class WallProfile {
 public:
  WallProfile(const Vec2& from, double inset) : end_(from.x() - inset, from.y()), inset_(inset) {}

  void add_line(double radius, double y) { add(ProfileSegment::Kind::line, radius, y, Vec2::Zero()); }

  /// A parabola that leaves, or arrives, upright: `control_y` is where the tangents of its ends meet.
  void add_leaving_upright(double radius, double y, double control_y) {
    add(ProfileSegment::Kind::parabola, radius, y, Vec2(end_.x(), control_y));
  }
  void add_arriving_upright(double radius, double y, double control_y) {
    add(ProfileSegment::Kind::parabola, radius, y, Vec2(radius - inset_, control_y));
  }

  /// Upright at both ends: two parabolas that meet half way.
  void add_shoulder(double radius, double y) {
    const double low = end_.y(), old_radius = end_.x() + inset_;
    add_leaving_upright(0.5 * (old_radius + radius), 0.5 * (low + y), 0.75 * low + 0.25 * y);
    add_arriving_upright(radius, y, 0.25 * low + 0.75 * y);
  }

  const Vec2& end() const { return end_; }
  const std::vector<ProfileSegment>& segments() const { return segments_; }

 private:
  void add(ProfileSegment::Kind kind, double radius, double y, const Vec2& control) {
    const Vec2 to(radius - inset_, y);
    segments_.push_back({kind, end_, to, control, Part::body});
    end_ = to;
  }

  Vec2 end_;
  double inset_;
  std::vector<ProfileSegment> segments_;
};

void add_quarter(std::vector<ProfileSegment>& profile, const Vec2& to, const Vec2& centre) {
  profile.push_back({ProfileSegment::Kind::arc, profile.back().to, to, centre, Part::body});
}

/// Up the outer side (which begins where `profile` ends), over the lip, down the inner side and to the axis.
core::Result<TriangleMesh> close_vessel(std::vector<ProfileSegment> profile, const WallProfile& outer,
                                        const WallProfile& inner, double wall, Meshing meshing) {
  profile.insert(profile.end(), outer.segments().begin(), outer.segments().end());
  const Vec2 rim = outer.end();
  const Vec2 middle(rim.x() - 0.5 * wall, rim.y());
  add_quarter(profile, middle + Vec2(0.0, 0.5 * wall), middle);
  add_quarter(profile, inner.end(), middle);
  for (auto s = inner.segments().rbegin(); s != inner.segments().rend(); ++s) {
    profile.push_back(*s);
    std::swap(profile.back().from, profile.back().to);
  }
  const Vec2 floor(0.0, profile.back().to.y());
  profile.push_back({ProfileSegment::Kind::line, profile.back().to, floor, Vec2::Zero(), Part::body});
  if (meshing.edge_length > 2.0 * wall) meshing.edge_length = 2.0 * wall;
  core::Result<PartedMesh> vessel = make_surface_of_revolution(profile, meshing);
  if (!vessel) return core::Error{vessel.error()};
  return std::move(vessel.value().mesh);
}

struct NamedSize {
  const char* name;
  double value, least;
  const char* what_is_least = "";
};

template <std::size_t kCount>
std::optional<std::string> find_fault_of(const char* thing, const std::array<NamedSize, kCount>& sizes) {
  for (const NamedSize& size : sizes)
    if (auto fault =
            find_size_fault(std::string(thing) + " " + size.name, size.value, size.least, size.what_is_least))
      return fault;
  return std::nullopt;
}

std::optional<std::string> find_bottle_fault(const BottleSizes& sizes) {
  return find_fault_of(
      "a bottle's",
      std::array<NamedSize, 5>{
          {{"wall", sizes.wall, 0.0},
           {"neck_radius", sizes.neck_radius, 2.0 * sizes.wall, "two walls"},
           {"radius", sizes.radius, sizes.neck_radius, "neck_radius"},
           {"neck_length", sizes.neck_length, sizes.wall, "wall"},
           {"height", sizes.height, 2.0 * sizes.radius + sizes.neck_length, "two radii and neck_length"}}});
}

/// Radius of the rounded edge of the bottom.
double bottle_edge(const BottleSizes& sizes) {
  return 1.5 * sizes.wall;
}

std::vector<ProfileSegment> bottle_bottom(const BottleSizes& sizes) {
  const double edge = bottle_edge(sizes);
  std::vector<ProfileSegment> bottom{
      {ProfileSegment::Kind::line, {0.0, 0.0}, {sizes.radius - edge, 0.0}, Vec2::Zero(), Part::body}};
  add_quarter(bottom, {sizes.radius, edge}, {sizes.radius - edge, edge});
  return bottom;
}

WallProfile bottle_side(const BottleSizes& sizes, double low, double inset) {
  const double shoulder_end = sizes.height - sizes.neck_length;
  WallProfile profile({sizes.radius, low}, inset);
  profile.add_line(sizes.radius, shoulder_end - 1.5 * (sizes.radius - sizes.neck_radius));
  profile.add_shoulder(sizes.neck_radius, shoulder_end);
  profile.add_line(sizes.neck_radius, sizes.height - 0.5 * sizes.wall);
  return profile;
}

/// `wall`: 0 of a sheet.
std::optional<std::string> find_vase_fault(const VaseSizes& sizes, double wall) {
  const char* walls = wall > 0.0 ? "two walls" : "";
  return find_fault_of(
      "a vase's", std::array<NamedSize, 5>{
                      {{"height", sizes.height, 10.0 * wall, wall > 0.0 ? "ten walls" : ""},
                       {"foot_radius", sizes.foot_radius, 2.0 * wall, walls},
                       {"neck_radius", sizes.neck_radius, 2.0 * wall, walls},
                       {"rim_radius", sizes.rim_radius, 2.0 * wall, walls},
                       {"belly_radius", sizes.belly_radius, std::max(sizes.foot_radius, sizes.neck_radius),
                        "foot_radius and neck_radius"}}});
}

std::vector<ProfileSegment> vase_bottom(const VaseSizes& sizes) {
  return {{ProfileSegment::Kind::line, {0.0, 0.0}, {sizes.foot_radius, 0.0}, Vec2::Zero(), Part::body}};
}

WallProfile vase_side(const VaseSizes& sizes, double low, double top, double inset) {
  WallProfile profile({sizes.foot_radius, low}, inset);
  profile.add_arriving_upright(sizes.belly_radius, 0.33 * top, 0.15 * top);
  profile.add_shoulder(sizes.neck_radius, 0.8 * top);
  profile.add_leaving_upright(sizes.rim_radius, top, 0.92 * top);
  return profile;
}

core::Result<TriangleMesh> make_sheet(std::vector<ProfileSegment> bottom, const WallProfile& side,
                                      const Meshing& meshing) {
  bottom.insert(bottom.end(), side.segments().begin(), side.segments().end());
  core::Result<PartedMesh> sheet = make_surface_of_revolution(bottom, meshing);
  if (!sheet) return core::Error{sheet.error()};
  return std::move(sheet.value().mesh);
}

}  // namespace

core::Result<TriangleMesh> make_vase(const VaseSizes& sizes, const Meshing& meshing) {
  const double wall = sizes.wall, top = sizes.height - 0.5 * wall;
  if (const auto fault = find_size_fault("a vase's wall", wall, 0.0)) return core::Error{*fault};
  if (const auto fault = find_vase_fault(sizes, wall)) return core::Error{*fault};
  return close_vessel(vase_bottom(sizes), vase_side(sizes, 0.0, top, 0.0), vase_side(sizes, wall, top, wall),
                      wall, meshing);
}

core::Result<TriangleMesh> make_vase_sheet(const VaseSizes& sizes, const Meshing& meshing) {
  if (const auto fault = find_vase_fault(sizes, 0.0)) return core::Error{*fault};
  return make_sheet(vase_bottom(sizes), vase_side(sizes, 0.0, sizes.height, 0.0), meshing);
}

core::Result<TriangleMesh> make_bottle(const BottleSizes& sizes, const Meshing& meshing) {
  if (const auto fault = find_bottle_fault(sizes)) return core::Error{*fault};
  const double wall = sizes.wall;
  return close_vessel(bottle_bottom(sizes), bottle_side(sizes, bottle_edge(sizes), 0.0),
                      bottle_side(sizes, 2.0 * wall, wall), wall, meshing);
}

core::Result<TriangleMesh> make_bottle_sheet(const BottleSizes& sizes, const Meshing& meshing) {
  if (const auto fault = find_bottle_fault(sizes)) return core::Error{*fault};
  return make_sheet(bottle_bottom(sizes), bottle_side(sizes, bottle_edge(sizes), 0.0), meshing);
}

core::Result<TriangleMesh> make_wine_glass(const WineGlassSizes& sizes, const Meshing& meshing) {
  const double stem = sizes.stem_radius, fillet = 2.0 * stem, rise = 0.12 * sizes.foot_radius;
  if (const auto fault = find_fault_of(
          "a wine glass's",
          std::array<NamedSize, 6>{
              {{"stem_radius", stem, 0.0},
               {"foot_radius", sizes.foot_radius, stem + fillet, "three stem_radius"},
               {"stem_length", sizes.stem_length, rise + 2.0 * fillet, "what foot and stem are rounded by"},
               {"height", sizes.height, sizes.stem_length, "stem_length"},
               {"radius", sizes.radius, 2.0 * stem, "two stem_radius"},
               {"rim_radius", sizes.rim_radius, stem, "stem_radius"}}}))
    return core::Error{*fault};
  using Kind = ProfileSegment::Kind;
  const Vec2 foot(sizes.foot_radius, 0.0), foot_end(stem + fillet, rise);
  const double foot_meets_stem = rise * (foot.x() - stem) / (foot.x() - foot_end.x());
  const Vec2 stem_low(stem, foot_meets_stem + fillet), stem_high(stem, sizes.stem_length);
  // The bowl flares out of the stem and turns upright where it is widest; both curves have one tangent.
  const double depth = sizes.height - sizes.stem_length;
  const Vec2 leaves(stem, sizes.stem_length + 0.06 * depth);
  const Vec2 arrives(sizes.radius, sizes.stem_length + 0.12 * depth);
  const Vec2 turning = leaves + 0.3 * (arrives - leaves);
  const Vec2 widest(sizes.radius, sizes.stem_length + 0.45 * depth);
  const Vec2 rim(sizes.rim_radius, sizes.height);
  const std::vector<ProfileSegment> profile{
      {Kind::line, foot, foot_end, Vec2::Zero(), Part::body},
      {Kind::parabola, foot_end, stem_low, Vec2(stem, foot_meets_stem), Part::body},
      {Kind::line, stem_low, stem_high, Vec2::Zero(), Part::body},
      {Kind::parabola, stem_high, turning, leaves, Part::body},
      {Kind::parabola, turning, widest, arrives, Part::body},
      {Kind::parabola, widest, rim, Vec2(sizes.radius, 0.5 * (widest.y() + rim.y())), Part::body}};
  core::Result<PartedMesh> glass = make_surface_of_revolution(profile, meshing);
  if (!glass) return core::Error{glass.error()};
  return std::move(glass.value().mesh);
}

core::Result<TriangleMesh> make_egg(const EggSizes& sizes, const Meshing& meshing) {
  if (const auto fault = find_fault_of(
          "an egg's", std::array<NamedSize, 3>{{{"radius", sizes.radius, 0.0},
                                                {"blunt_height", sizes.blunt_height, 0.0},
                                                {"pointed_height", sizes.pointed_height, 0.0}}}))
    return core::Error{*fault};
  core::Result<TriangleMesh> egg = make_sphere(sizes.radius, meshing);
  if (!egg) return egg;
  for (Vec3& p : egg.value().positions)
    p.y() *= (p.y() < 0.0 ? sizes.blunt_height : sizes.pointed_height) / sizes.radius;
  return egg;
}

}  // namespace shatterbox::geometry
