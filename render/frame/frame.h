// What a picture is made of: plain data in, no GL and no engine types. World space, metres, right-handed, y
// up. Colours are linear light (Rec. 709 primaries, 0..1 for surfaces) unless a name says srgb.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/frame/look.h"
#include "render/frame/mesh.h"

namespace shatterbox::render {

// One body in the picture. Draws may share a mesh.
struct Draw {
  static constexpr std::uint32_t kNoColour = 0xffffffffU;  // keeps its look

  std::shared_ptr<const Mesh> mesh;  // never null
  glm::mat4 world_from_body{1.0F};   // rotation and translation (a uniform scale is allowed)
  std::vector<Look> looks{Look{}};   // by Mesh::parts; a part beyond the end takes the last
  std::shared_ptr<const std::vector<float>>
      scalars;                     // |V| or null; shown by OverlayKind::heat, in Overlay::unit, and by groups
  std::uint32_t colour_index = 0;  // Overlay::pieces: equal index, equal colour
  bool casts_shadow = true;
  std::uint32_t id = 0;  // in truth images; 0: it is not in them
};

struct Camera {
  glm::vec3 position{0.0F, 0.3F, 1.0F};
  glm::vec3 target{0.0F};
  glm::vec3 up{0.0F, 1.0F, 0.0F};
  float vertical_fov = 35.0F;  // degrees
  // Width over height: narrower pictures see as much at the sides as one of this, and more above and below.
  float least_aspect = 0.0F;

  /// How far a picture of this aspect sees above and below, per distance.
  float slope(float aspect) const {
    const float half = 0.5F * glm::radians(std::clamp(vertical_fov, 1.0F, 150.0F));
    return std::tan(half) * std::max(1.0F, least_aspect / aspect);
  }
};

// Sun, sky and two studio soft boxes that only glossy things reflect.
struct Lights {
  glm::vec3 sun_direction{0.45F, 0.8F, 0.4F};  // from the scene towards the sun; any length
  glm::vec3 sun_colour{1.0F, 0.95F, 0.88F};
  float sun_strength = 1.55F;                    // a white matt surface facing the sun gets this radiance
  float sun_size = 3.0F;                         // degrees across; sets how soft shadows grow with distance
  glm::vec3 sky_colour{0.78F, 0.86F, 1.0F};      // from above
  glm::vec3 ground_colour{0.36F, 0.33F, 0.30F};  // from below, where there is no Ground to send its own
  float sky_strength = 0.42F;
  float softbox_strength = 1.0F;  // 0: no soft boxes
  bool casts_shadow = true;       // false: the shadow pass does not exist
};

// What the floor is laid with.
enum class GroundPattern : std::uint8_t {
  plain,
  checker,   // squares, `pattern_size` wide
  planks,    // boards along x, `pattern_size` wide and eight times as long
  concrete,  // cast and smoothed; again after `pattern_size`
};

// The floor at a height, without an edge: it fades into the backdrop.
struct Ground {
  float height = 0.0F;  // m
  glm::vec3 colour{0.34F, 0.335F, 0.33F};
  // Where it fades, m along the ground from the eye, into the picture; both 0: from the target to the
  // horizon.
  float fade_from = 0.0F, fade_to = 0.0F;
  GroundPattern pattern = GroundPattern::plain;
  float pattern_size = 0.1F;  // m
  std::uint32_t id = 0;       // in truth images
};

// Shown linear behind everything: a vertical gradient with a soft glow in the middle, or a studio's sweep:
// the floor curved up into a wall that the light reaches less and less.
struct Backdrop {
  glm::vec3 top{0.085F, 0.105F, 0.135F};
  glm::vec3 bottom{0.40F, 0.41F, 0.43F};
  float glow = 0.3F;       // brighter behind the target
  float vignette = 0.25F;  // darker towards the corners; 0: exactly the gradient
  float sweep = 0.0F;      // 0..1: how much of the gradient is the ground's own colour instead
};

enum class OverlayKind : std::uint8_t {
  none,
  heat,    // scalars as colours, with a scale
  pieces,  // each draw by its colour_index
  groups,  // scalars from 0 to 1, a number a group: equal number, equal colour; no scale
};

struct Overlay {
  OverlayKind kind = OverlayKind::none;
  float least = 0.0F, most = 1.0F;  // range of the colour scale, in the unit below
  std::string title = "stress";     // drawn above the scale
  std::string unit = "MPa";         // the numbers' unit; scalars are given in it
  bool has_wires = false;           // edges of all triangles as given, seen through glass
};

// Written large in the middle above the picture's lower edge, in lines as wide as the picture allows.
struct Title {
  std::string text;      // as Frame::caption
  float opacity = 0.0F;  // 0..1
};

// Everything in one picture.
struct Frame {
  std::vector<Draw> draws;  // all that exists: meshes not listed leave the GPU
  Camera camera;
  Lights lights;
  std::optional<Ground> ground = Ground{};
  Backdrop backdrop;
  Overlay overlay;
  float exposure = 1.0F;
  Title title;
  std::string caption;  // ASCII 32 to 126, '\n' starts a line; anything else is drawn as a box
};

}  // namespace shatterbox::render
