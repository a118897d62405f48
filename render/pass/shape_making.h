// The shapes that a frame needs and the GPU has not: simplified and expanded, on as many threads as the
// machine has.
#pragma once
#include <optional>
#include <vector>

#include "render/frame/expand.h"
#include "render/frame/mesh.h"

namespace shatterbox::render::pass {

struct WantedShape {
  const Mesh* mesh = nullptr;
  std::optional<float> tolerance;  // m; none: as given
  DrawnMesh shape;                 // made
};

// Each by itself, so that the number of threads changes nothing. Throws what the first that cannot be made
// throws.
void make_shapes(std::vector<WantedShape>& wanted);

}  // namespace shatterbox::render::pass
