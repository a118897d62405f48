#include "render/frame/look.h"

namespace shatterbox::render {

Look matt(glm::vec3 paint) {
  Look look;
  look.outside = look.inside = paint;
  look.crack = glm::mix(paint, glm::vec3(0.8F), 0.5F);
  look.roughness = look.inside_roughness = 0.85F;
  return look;
}

Look glossy_paint(glm::vec3 paint) {
  Look look = matt(paint);
  look.roughness = 0.5F;
  look.clear_coat = 1.0F;
  return look;
}

Look ornament(glm::vec3 paint) {
  Look look;
  look.outside = paint;
  look.metalness = 0.55F;
  look.roughness = 0.32F;
  look.inside = {0.90F, 0.89F, 0.86F};  // silver
  look.inside_metalness = 1.0F;
  look.inside_roughness = 0.1F;
  look.crack = {0.93F, 0.95F, 0.94F};
  look.crack_roughness = 0.25F;
  look.clear_coat = 1.0F;
  look.clear_coat_roughness = 0.05F;
  return look;
}

Look metal(glm::vec3 tint, float roughness) {
  Look look;
  look.outside = look.inside = tint;
  look.crack = glm::mix(tint, glm::vec3(0.6F), 0.3F);
  look.roughness = look.inside_roughness = roughness;
  look.metalness = look.inside_metalness = 1.0F;
  return look;
}

Look ceramic(glm::vec3 glaze) {
  Look look;
  look.outside = glaze;
  look.inside = glm::mix(glaze, glm::vec3(0.86F, 0.83F, 0.77F), 0.75F);
  look.crack = {0.58F, 0.36F, 0.24F};
  look.roughness = look.inside_roughness = 0.55F;
  look.crack_roughness = 0.95F;
  look.clear_coat = 0.9F;
  look.clear_coat_roughness = 0.1F;
  return look;
}

Look glass(glm::vec3 tint) {
  Look look;
  look.outside = look.inside = tint;
  look.crack = {0.62F, 0.82F, 0.76F};
  look.roughness = look.inside_roughness = 0.03F;
  look.crack_roughness = 0.2F;
  look.transmission = 1.0F;
  return look;
}

Look frosted_glass(glm::vec3 tint) {
  Look look = glass(tint);
  look.roughness = look.inside_roughness = 0.5F;
  look.transmission = 0.45F;
  return look;
}

Look stone(glm::vec3 colour) {
  Look look = matt(colour);
  look.crack = glm::mix(1.25F * colour, glm::vec3(0.7F), 0.1F);
  look.crack_roughness = 0.95F;
  look.pattern = Pattern::clouds;
  look.pattern_colour = 0.58F * colour;
  return look;
}

}  // namespace shatterbox::render
