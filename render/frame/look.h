// How a surface looks. Colours are linear light, 0..1. Lengths in metres, in pattern space
// (Mesh::pattern_positions).
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

namespace shatterbox::render {

// Paint on the outer face.
enum class Pattern : std::uint8_t {
  none,
  rings,    // an ornament's belt about the y axis: two rings with diamonds between them, `pattern_size` high
  speckle,  // stoneware: small dots, about `pattern_size` apart
  checker,  // cubes of `pattern_size`
  clouds,   // smooth noise of three grains, the largest `pattern_size` across: stone, clay, ice; on crack
            // faces too
  grain_x,  // wood: fibres along the axis, growth rings about it, a ring about `pattern_size` wide
  grain_y,
  grain_z,
};

struct Look {
  glm::vec3 outside{0.55F};
  glm::vec3 inside{0.55F};  // a shell's inner face
  glm::vec3 crack{0.75F};   // crack rims and crack faces: the bare material
  float roughness = 0.45F;
  float metalness = 0.0F;
  float inside_roughness = 0.5F;
  float inside_metalness = 0.0F;
  float crack_roughness = 0.7F;
  float clear_coat = 0.0F;  // 0..1: a thin gloss layer over it, inside too by half
  float clear_coat_roughness = 0.06F;
  float transmission = 0.0F;  // 0 opaque, 1 clear thin glass; `outside` then tints what is seen through it
  Pattern pattern = Pattern::none;
  glm::vec3 pattern_colour{0.8F};
  float pattern_metalness = 0.0F;
  float pattern_size = 0.01F;
  glm::vec3 pattern_centre{0.0F};
};

// Ready looks. `paint` is the outer colour.
Look matt(glm::vec3 paint);
Look glossy_paint(glm::vec3 paint);  // lacquer over paint
Look ornament(glm::vec3 paint);      // metallic lacquer, silvered inside, bright glass rim
Look metal(glm::vec3 tint, float roughness = 0.3F);
Look ceramic(glm::vec3 glaze);  // glazed both sides, matt earthenware where broken
Look glass(glm::vec3 tint = {0.95F, 0.985F, 0.97F});
Look frosted_glass(glm::vec3 tint);
Look stone(glm::vec3 colour);

}  // namespace shatterbox::render
