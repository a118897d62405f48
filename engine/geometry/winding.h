// Which way round the triangles of a surface run, and making neighbours agree.
#pragma once

#include <vector>

#include "engine/geometry/edge_topology.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

struct Winding {
  std::vector<int> part;        // per triangle: the connected part it belongs to
  int part_count = 0;           // 0 if one-sided
  int one_sided_triangle = -1;  // where a way round comes back on the other side (a Moebius strip); else -1
  int turned_count = 0;         // triangles that ran against their neighbours
  int first_turned = -1;        // the first of them
  bool is_closed = false;       // no border edge
  int inside_out_parts = 0;     // closed ones that enclosed a negative volume, and are no hollow in another
  int first_inside_out = -1;    // a triangle of the first of them
};

/// Turns triangles so that neighbours agree, of each part the smaller half; then closed parts that are inside
/// out: who stands out of the box about each other part is no hollow. `topology` of the triangles given, no
/// edge with more than two. A one-sided surface is left as it is.
Winding make_windings_agree(TriangleMesh& mesh, const EdgeTopology& topology);

}  // namespace shatterbox::geometry
