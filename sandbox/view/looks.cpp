#include "sandbox/view/looks.h"

#include <algorithm>
#include <cmath>

namespace shatterbox::sandbox::view {

namespace {

const render::Lights kNoon{.sun_direction = {0.3F, 1.0F, 0.25F},
                           .sun_colour = {1.0F, 0.97F, 0.91F},
                           .sun_strength = 1.6F,
                           .sun_size = 0.6F,
                           .sky_colour = {0.58F, 0.76F, 1.0F},
                           .sky_strength = 0.36F,
                           .softbox_strength = 0.15F};
const render::Lights kEvening{.sun_direction = {0.85F, 0.3F, 0.3F},
                              .sun_colour = {1.0F, 0.60F, 0.30F},
                              .sun_strength = 2.0F,
                              .sun_size = 1.0F,
                              .sky_colour = {0.62F, 0.66F, 1.0F},
                              .sky_strength = 0.38F,
                              .softbox_strength = 0.3F};
const render::Lights kOvercast{.sun_direction = {0.15F, 1.0F, 0.2F},
                               .sun_colour = {0.96F, 0.98F, 1.0F},
                               .sun_strength = 0.55F,
                               .sun_size = 35.0F,
                               .sky_colour = {0.90F, 0.95F, 1.0F},
                               .sky_strength = 0.85F,
                               .softbox_strength = 0.3F};

glm::vec3 hex(unsigned rgb) {
  return linear_colour(Vec3((rgb >> 16) & 255U, (rgb >> 8) & 255U, rgb & 255U) / 255.0);
}

render::Look make_look(const std::string& name, const std::optional<glm::vec3>& colour) {
  const auto paint = [&colour](unsigned usual) { return colour.value_or(hex(usual)); };
  if (name == "ornament") return render::ornament(paint(0xb5121f));
  if (name == "glass") return colour ? render::glass(*colour) : render::glass();
  if (name == "frosted") return render::frosted_glass(paint(0xe9f2f1));
  if (name == "chrome") return render::metal(paint(0xe6e8ea), 0.05F);
  if (name == "chocolate") {
    render::Look look = render::matt(paint(0x4a2a18));
    look.crack = 0.85F * look.outside;
    look.roughness = look.inside_roughness = 0.55F;
    look.clear_coat = 0.45F;
    look.clear_coat_roughness = 0.3F;
    return look;
  }
  if (name == "ceramic") return render::ceramic(paint(0x2f6f86));
  if (name == "porcelain") {
    render::Look look = render::ceramic(paint(0xd6dbe0));  // darker than white, so that gloss is seen on it
    look.inside = look.outside;
    look.clear_coat_roughness = 0.04F;
    look.crack = hex(0xfbfaf5);
    look.clear_coat = 1.0F;
    return look;
  }
  if (name == "steel") return render::metal(paint(0xc9ccd1), 0.22F);
  if (name == "aluminium") return render::metal(paint(0xd9dbdc), 0.35F);
  if (name == "terracotta") {
    render::Look look = render::stone(paint(0xae6243));
    look.pattern_colour = 0.82F * look.outside;
    return look;
  }
  if (name == "wood") {
    render::Look look = render::matt(paint(0x6f4a2c));
    look.crack = hex(0xd2a877);
    look.roughness = look.inside_roughness = 0.6F;
    look.clear_coat = 0.25F;
    look.clear_coat_roughness = 0.35F;
    return look;
  }
  if (name == "concrete") {  // cast: nearly even
    render::Look look = render::stone(paint(0x9d9a94));
    look.pattern_colour = 0.86F * look.outside;
    return look;
  }
  if (name == "brick") return render::stone(paint(0xa2543b));
  if (name == "plaster") return render::matt(paint(0xebe6da));
  if (name == "ice") {  // clear, with clouds of bubbles and snow on what is broken
    render::Look look = render::glass(paint(0xdbeaf0));
    look.transmission = 0.62F;
    look.pattern = render::Pattern::clouds;
    look.pattern_colour = hex(0xf4f9fb);
    look.crack = hex(0xeaf4f9);
    return look;
  }
  if (name == "eggshell") return render::matt(paint(0xe9d3b8));
  if (name == "glossy") return render::glossy_paint(paint(0x2a6fb0));
  return render::matt(paint(0xb9b4aa));
}

}  // namespace

glm::vec3 linear_colour(const Vec3& srgb) {
  const auto channel = [](double c) {
    return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
  };
  return {channel(srgb.x()), channel(srgb.y()), channel(srgb.z())};
}

std::vector<render::Look> make_looks(const std::string& name, const std::optional<Vec3>& colour, double size,
                                     const Vec3& centre, int axis) {
  std::optional<glm::vec3> linear;
  if (colour) linear = linear_colour(*colour);
  render::Look look = make_look(name, linear);
  look.pattern_centre = {centre.x(), centre.y(), centre.z()};
  look.pattern_size = static_cast<float>(0.02 * size);
  const render::Look metal = render::metal(hex(0xe3c06a), 0.3F);
  render::Look neck = look;
  if (name == "ornament") {
    look.pattern = render::Pattern::rings;
    look.pattern_colour = hex(0xf0d9a0);
    look.pattern_metalness = 0.9F;
    look.pattern_size = static_cast<float>(0.42 * size);
  } else if (name == "porcelain" && !colour) {  // painted with cobalt under the glaze
    look.pattern = render::Pattern::rings;
    look.pattern_colour = hex(0x1f3d8f);
    look.pattern_size = static_cast<float>(0.2 * size);
    look.pattern_centre = glm::vec3(0.0F);  // about the centre of mass, wherever the mesh's own origin is
  } else if (look.pattern == render::Pattern::none && name == "ceramic") {
    look.pattern = render::Pattern::speckle;
    look.pattern_colour = 0.55F * look.outside;
    look.pattern_size = static_cast<float>(0.05 * size);
  } else if (name == "wood") {
    constexpr render::Pattern kGrain[] = {render::Pattern::grain_x, render::Pattern::grain_y,
                                          render::Pattern::grain_z};
    look.pattern = kGrain[axis];
    look.pattern_colour = 0.45F * look.outside;
    look.outside *= 1.35F;
    look.pattern_size = static_cast<float>(std::min(0.012, 0.1 * size));
  } else if (look.pattern == render::Pattern::clouds) {
    // Stone and clay have grains of their own size; those of ice are as large as the block that froze.
    const double grain = name == "concrete" ? 0.07 : 0.04;
    look.pattern_size = static_cast<float>(name == "ice" ? 3.0 * size : std::min(grain, 0.4 * size));
  }
  return {look, neck, metal, metal};
}

void share_tint_of_two_faces(std::vector<render::Look>& looks) {
  for (render::Look& look : looks) {
    if (!(look.transmission > 0.0F)) continue;
    look.outside = glm::sqrt(look.outside);
    look.inside = glm::sqrt(look.inside);
  }
}

std::string usual_look(const std::string& preset) {
  for (const char* same : {"aluminium", "brick", "ceramic", "concrete", "eggshell", "glass", "ice", "plaster",
                           "porcelain", "steel", "terracotta"}) {
    if (preset == same) return same;
  }
  if (preset == "tempered_glass") return "glass";
  return preset == "ornament_glass" ? "ornament" : "matt";
}

std::optional<render::Ground> make_ground(const std::string& name, double height) {
  if (name == "none") return std::nullopt;
  render::Ground ground;
  ground.height = static_cast<float>(height);
  const auto lay = [&ground](render::GroundPattern pattern, float size) {
    ground.pattern = pattern;
    ground.pattern_size = size;
  };
  if (name == "concrete") {
    ground.colour = hex(0xa5a29c);
    lay(render::GroundPattern::concrete, 1.2F);
  }
  if (name == "wood") {
    ground.colour = hex(0x8d7357);
    lay(render::GroundPattern::planks, 0.12F);
  }
  if (name == "dark") ground.colour = hex(0x3a3d42);
  if (name == "checker") lay(render::GroundPattern::checker, 0.1F);
  return ground;
}

render::Lights make_light(const std::string& name) {
  if (name == "noon") return kNoon;
  if (name == "evening") return kEvening;
  return name == "overcast" ? kOvercast : render::Lights{};
}

std::string usual_backdrop(const std::string& light) {
  if (light == "noon") return "sky";
  return light.empty() ? "studio" : light;
}

render::Backdrop make_backdrop(const std::string& name) {
  render::Backdrop backdrop;
  if (name == "studio") backdrop.sweep = 0.8F;
  if (name == "dark") {
    backdrop.sweep = 0.5F;
    backdrop.top = hex(0x1d2126);
    backdrop.bottom = hex(0x3b4046);
  } else if (name == "sky") {
    backdrop.top = hex(0x6f9fd0);
    backdrop.bottom = hex(0xd8e4ee);
    backdrop.glow = 0.1F;
  } else if (name == "evening") {
    backdrop.top = hex(0x4a5a8c);
    backdrop.bottom = hex(0xe8b184);
    backdrop.glow = 0.15F;
  } else if (name == "overcast") {
    backdrop.top = hex(0x9aa5ae);
    backdrop.bottom = hex(0xd3d8da);
    backdrop.glow = 0.05F;
  } else if (name == "white") {
    backdrop.top = backdrop.bottom = glm::vec3(0.92F);
    backdrop.glow = backdrop.vignette = 0.0F;
  }
  return backdrop;
}

}  // namespace shatterbox::sandbox::view
