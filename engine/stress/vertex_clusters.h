// Clusters of vertices that are stiffly joined, by METIS.
#pragma once

#include <vector>

#include "engine/stress/block_rows.h"

namespace shatterbox::stress {

/// The cluster of each vertex (|V|), about `count` of them, alike in size, cut where the matrix couples
/// least; -1 for rows without blocks. Same matrix, same answer, any thread.
std::vector<int> cluster_vertices(const BlockRows& rows, int count);

}  // namespace shatterbox::stress
