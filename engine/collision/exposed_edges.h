// Which edges of a surface can be where it touches another one first?
#pragma once

#include <vector>

#include "engine/collision/collider.h"
#include "engine/geometry/edge_topology.h"

namespace shatterbox::collision {

/// Per edge of the collider's surface (|E|), 0 if another surface that does not cross it can neither touch
/// the inside of that edge and nothing else near it, nor be nearest to it there alone, wherever the body
/// goes: edges between two triangles of one plane and, of a closed surface, notches. `collider` has its tree
/// and its bounding radius; `topology` is that of its triangles.
std::vector<char> find_exposed_edges(const Collider& collider, const geometry::EdgeTopology& topology);

}  // namespace shatterbox::collision
