#include "engine/collision/feature_list.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "engine/collision/relative_way.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/crossings.h"

namespace shatterbox::collision {
namespace {

using Node = geometry::TriangleTree::Node;
using core::at;

// Boxes of triangles and nodes from those of the vertices.
void refit(const Collider& c, FeatureBoxes& boxes) {
  boxes.triangles.resize(c.triangles.size());
  for (std::size_t k = 0; k < c.triangles.size(); ++k) {
    const geometry::Triangle& triangle = c.triangles[at(c.tree.order[k])];
    TightBox& box = boxes.triangles[k] = boxes.vertices[at(triangle[0])];
    box.include(boxes.vertices[at(triangle[1])]);
    box.include(boxes.vertices[at(triangle[2])]);
  }
  boxes.nodes.resize(c.tree.nodes.size());
  for (std::size_t i = c.tree.nodes.size(); i-- > 0;) {
    const Node& node = c.tree.nodes[i];
    TightBox box;
    if (node.count == 0) {
      box = boxes.nodes[i + 1];
      box.include(boxes.nodes[at(node.right)]);
    }
    for (int k = node.begin; k < node.begin + node.count; ++k) box.include(boxes.triangles[at(k)]);
    boxes.nodes[i] = box;
  }
}

float extent(const TightBox& box) {
  const BoxLanes sides = box.high - box.low;
  return (sides[0] + sides[1]) + sides[2];
}

TightBox box_of_edge(const Collider& c, const FeatureBoxes& boxes, int edge) {
  const auto [v, w] = c.edges[at(edge)];
  TightBox box = boxes.vertices[at(v)];
  box.include(boxes.vertices[at(w)]);
  return box;
}

// Descends two trees together; visit(triangle_a, its box, triangle_b, its box, place of the latter in its
// leaf) for triangles whose boxes come within the margin.
class Descent {
 public:
  Descent(const Collider& a, const FeatureBoxes& boxes_a, const Collider& b, const FeatureBoxes& boxes_b,
          const RelativeWays& ways, double margin)
      : a_(a), b_(b), boxes_a_(boxes_a), boxes_b_(boxes_b), ways_(ways) {
    const float m = round_up(margin), beyond = m * (1.0F + 1e-5F);
    reach_squared_ = m * m * (1.0F + 1e-5F);
    reach_ = BoxLanes{beyond, beyond, beyond, round_up(kDiagonal * beyond)};
  }

  float reach_squared() const { return reach_squared_; }

  // Whose triangles are visited.
  int leaf_a() const { return leaf_a_; }
  int leaf_b() const { return leaf_b_; }

  // Mostly one axis tells; what it does not, the distance does.
  bool is_about_near(const TightBox& box_a, const TightBox& box_b) const {
    return !any_exceeds(apart(box_a, box_b), reach_);
  }
  bool is_near(const TightBox& box_a, const TightBox& box_b) const {
    return is_about_near(box_a, box_b) && distance_squared(box_a, box_b) <= reach_squared_;
  }

  using NodePair = std::pair<int, int>;

  template <class Visit>
  void run(const Visit& visit) {
    for (const NodePair& root : split(1)) run_below(root, visit);
  }

  // At least so many pairs of nodes, unless there are fewer, below which all is that may be near; in the
  // order in which they are visited.
  std::vector<NodePair> split(std::size_t least) {
    std::vector<NodePair> pairs;
    if (boxes_a_.nodes.empty() || boxes_b_.nodes.empty()) return pairs;
    stack_.clear();
    push_if_near(0, ways_.a.along(boxes_a_.nodes[0]), 0, ways_.b.along(boxes_b_.nodes[0]));
    pairs.swap(stack_);
    for (bool goes_on = true; goes_on && pairs.size() < least;) {
      std::vector<NodePair> below;
      for (const NodePair& pair : pairs) {
        if (are_leaves(pair))
          below.push_back(pair);
        else
          push_children(pair);
        below.insert(below.end(), stack_.rbegin(), stack_.rend());
        stack_.clear();
      }
      goes_on = !std::all_of(below.begin(), below.end(), [this](const NodePair& p) { return are_leaves(p); });
      pairs = std::move(below);
    }
    return pairs;
  }

  template <class Visit>
  void run_below(const NodePair& root, const Visit& visit) {
    stack_.assign(1, root);
    while (!stack_.empty()) {
      const NodePair pair = stack_.back();
      stack_.pop_back();
      if (are_leaves(pair))
        visit_leaves(pair, visit);
      else
        push_children(pair);
    }
  }

 private:
  bool are_leaves(const NodePair& pair) const {
    return a_.tree.nodes[at(pair.first)].count > 0 && b_.tree.nodes[at(pair.second)].count > 0;
  }

  // The last one comes first.
  void push_children(const NodePair& pair) {
    const auto [i, j] = pair;
    const TightBox box_a = ways_.a.along(boxes_a_.nodes[at(i)]), box_b = ways_.b.along(boxes_b_.nodes[at(j)]);
    const Node &node_a = a_.tree.nodes[at(i)], &node_b = b_.tree.nodes[at(j)];
    if (node_b.count > 0 || (node_a.count == 0 && extent(box_a) >= extent(box_b))) {
      for (const int child : {node_a.right, i + 1})
        push_if_near(child, ways_.a.along(boxes_a_.nodes[at(child)]), j, box_b);
    } else {
      for (const int child : {node_b.right, j + 1})
        push_if_near(i, box_a, child, ways_.b.along(boxes_b_.nodes[at(child)]));
    }
  }

  template <class Visit>
  void visit_leaves(const NodePair& pair, const Visit& visit) {
    const auto [i, j] = pair;
    leaf_a_ = i;
    leaf_b_ = j;
    visit_triangles(a_.tree.nodes[at(i)], ways_.a.along(boxes_a_.nodes[at(i)]), b_.tree.nodes[at(j)],
                    ways_.b.along(boxes_b_.nodes[at(j)]), visit);
  }

  void push_if_near(int i, const TightBox& box_a, int j, const TightBox& box_b) {
    if (is_about_near(box_a, box_b)) stack_.push_back({i, j});
  }

  template <class Visit>
  void visit_triangles(const Node& node_a, const TightBox& box_a, const Node& node_b, const TightBox& box_b,
                       const Visit& visit) {
    std::array<NearTriangle, geometry::kLeafSize> near;
    std::size_t count = 0;
    for (int k = 0; k < node_b.count; ++k) {
      const TightBox box = ways_.b.along(boxes_b_.triangles[at(node_b.begin + k)]);
      if (is_near(box_a, box)) near[count++] = {b_.tree.order[at(node_b.begin + k)], k, box};
    }
    if (count == 0) return;
    for (int k = node_a.begin; k < node_a.begin + node_a.count; ++k) {
      const TightBox box = ways_.a.along(boxes_a_.triangles[at(k)]);
      if (!is_near(box, box_b)) continue;
      const int t = a_.tree.order[at(k)];
      for (const NearTriangle& other : std::span(near).first(count)) {
        if (is_near(box, other.box)) visit(t, box, other.number, other.box, other.place);
      }
    }
  }

  struct NearTriangle {
    int number, place;
    TightBox box;
  };

  const Collider &a_, &b_;
  const FeatureBoxes &boxes_a_, &boxes_b_;
  const RelativeWays& ways_;
  BoxLanes reach_ = {};  // m
  float reach_squared_ = 0.0F;
  int leaf_a_ = 0, leaf_b_ = 0;
  std::vector<NodePair> stack_;
};

// Where the vertices of a body are, and go to by themselves.
struct Places {
  const std::vector<Vec3>& start;
  const std::vector<Vec3>* end;  // none: they go as the body goes
};

// Whether triangles stay apart along the directions of their planes. Boxes about triangles that lie askew are
// thick; the triangles are not. Along a fixed direction, what goes straight is within what it was at both
// ends.
class Planes {
 public:
  Planes(const Collider& a, const Places& places_a, const Collider& b, const Places& places_b,
         const RelativeWays& ways, double margin)
      : a_(a),
        b_(b),
        places_a_(places_a),
        places_b_(places_b),
        ways_(ways),
        stay_(!places_a.end && ways.a.stays() && ways.b.stays()),
        // What rounding may add is far below this share of the margin.
        apart_from_((margin + a.radius + b.radius) * (1.0 + 1e-5)) {}

  // `place` of the second triangle in its leaf: those of a leaf are asked for again and again.
  bool are_apart(int ta, int tb, int place) {
    if (ta != first_.number) first_ = face(a_, places_a_, ways_.a, ta);
    Face& second = seconds_[at(place)];
    if (tb != second.number) second = face(b_, places_b_, ways_.b, tb);
    return separates(first_.normal, first_.start, second.start, first_.end, second.end) ||
           separates(second.normal, second.start, first_.start, second.end, first_.end);
  }

 private:
  using Corners = std::array<Vec3, 3>;
  struct Face {
    int number = -1;
    Corners start, end;
    Vec3 normal = Vec3::Zero();  // at the start; not of length one
  };

  Face face(const Collider& c, const Places& places, const SeenWay& way, int triangle) const {
    const auto& t = c.triangles[at(triangle)];
    Face f;
    f.number = triangle;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& start = places.start[at(t[i])];
      f.start[i] = way.begin_of(start);
      if (!stay_) f.end[i] = places.end ? (*places.end)[at(t[i])] : way.end_of(start);
    }
    f.normal = (f.start[1] - f.start[0]).cross(f.start[2] - f.start[0]);
    return f;
  }

  // `face` has the normal.
  bool separates(const Vec3& normal, const Corners& face, const Corners& other, const Corners& face_then,
                 const Corners& other_then) const {
    const double b0 = normal.dot(other[0] - face[0]);
    const double needed_squared = apart_from_ * apart_from_ * normal.squaredNorm();
    if (b0 * b0 <= needed_squared || needed_squared == 0.0) return false;
    const double side = b0 > 0.0 ? 1.0 : -1.0;
    const double least = side * std::min({side * b0, side * normal.dot(other[1] - face[0]),
                                          side * normal.dot(other[2] - face[0])});
    if (side * least <= 0.0 || least * least <= needed_squared) return false;
    if (stay_) return true;
    const double most = std::max({0.0, side * normal.dot(face_then[1] - face_then[0]),
                                  side * normal.dot(face_then[2] - face_then[0])});
    const double left = std::min({side * normal.dot(other_then[0] - face_then[0]),
                                  side * normal.dot(other_then[1] - face_then[0]),
                                  side * normal.dot(other_then[2] - face_then[0])}) -
                        most;
    return left > 0.0 && left * left > needed_squared;
  }

  const Collider &a_, &b_;
  const Places &places_a_, &places_b_;
  const RelativeWays& ways_;
  const bool stay_;
  const double apart_from_;  // m
  Face first_;
  std::array<Face, geometry::kLeafSize> seconds_;  // by place in a leaf
};

// One that holds nothing gives its place to the next.
void begin_block(int leaf_a, int leaf_b, int begin, std::vector<FeatureBlock>& blocks) {
  if (!blocks.empty() && blocks.back().leaf_a == leaf_a && blocks.back().leaf_b == leaf_b) return;
  if (!blocks.empty() && blocks.back().begin == begin) blocks.pop_back();
  blocks.push_back({leaf_a, leaf_b, begin});
}

// Two bodies, their places and boxes, and how far features are looked for.
struct FeatureQuery {
  const Collider& a;
  const FeatureBoxes& boxes_a;
  const Places places_a;
  const Collider& b;
  const FeatureBoxes& boxes_b;
  const Places places_b;
  const RelativeWays& ways;
  const double margin;  // m

  double radii() const { return a.radius + b.radius; }
  double seen_margin() const { return ways.seen_margin(margin, radii()); }
};

// Features that near triangles own.
class Lister {
 public:
  explicit Lister(const FeatureQuery& query)
      : a_(query.a),
        b_(query.b),
        boxes_a_(query.boxes_a),
        boxes_b_(query.boxes_b),
        ways_(query.ways),
        radii_(query.radii()),
        descent_(a_, boxes_a_, b_, boxes_b_, ways_, query.seen_margin()),
        planes_(a_, query.places_a, b_, query.places_b, ways_, query.seen_margin()) {}

  Descent& descent() { return descent_; }

  // Adds those below two nodes; of blocks only if they are asked for.
  void list_below(const Descent::NodePair& root, FeatureList& out, std::vector<FeatureBlock>* blocks) {
    const std::size_t first = out.size();
    descent_.run_below(root, [&](int ta, const TightBox& box_a, int tb, const TightBox& box_b, int place) {
      if (!own_features(ta, tb) || planes_.are_apart(ta, tb, place)) return;
      if (blocks) begin_block(descent_.leaf_a(), descent_.leaf_b(), static_cast<int>(out.size()), *blocks);
      list_owned(ta, box_a, tb, box_b, out);
    });
    if (blocks && !blocks->empty() && at(blocks->back().begin) == out.size()) blocks->pop_back();
    for (std::size_t i = first; i < out.size(); ++i) {
      const float seen = std::sqrt(out[i].bound) * (1.0F - 1e-5F);
      out[i].bound = ways_.least_length == 1.0 && ways_.bow == 0.0
                         ? seen
                         : round_down(ways_.apart_at_least(seen, radii_));
    }
  }

 private:
  // Whether any feature of theirs could be listed: many triangles own no vertex, or no edge.
  bool own_features(int ta, int tb) const {
    const auto owns = [](const std::vector<int>& begin, int t) { return begin[at(t)] < begin[at(t) + 1]; };
    return owns(a_.owned_vertex_begin, ta) || owns(b_.owned_vertex_begin, tb) ||
           (owns(a_.owned_edge_begin, ta) && owns(b_.owned_edge_begin, tb));
  }

  void list_owned(int ta, const TightBox& box_a, int tb, const TightBox& box_b, FeatureList& out) {
    const auto add = [&](FeatureKind kind, int i, const TightBox& box_i, int j, const TightBox& box_j) {
      if (!descent_.is_about_near(box_i, box_j)) return;
      const float squared = distance_squared(box_i, box_j);
      if (squared <= descent_.reach_squared()) out.push_back({kind, squared, i, j});
    };
    // A sphere is but a vertex: what touches it, it touches with that.
    const bool a_has_faces = !a_.edges.empty(), b_has_faces = !b_.edges.empty();
    for (int k = a_.owned_vertex_begin[at(ta)]; b_has_faces && k < a_.owned_vertex_begin[at(ta) + 1]; ++k) {
      const int v = a_.owned_vertices[at(k)];
      add(FeatureKind::vertex_triangle, v, ways_.a.along(boxes_a_.vertices[at(v)]), tb, box_b);
    }
    for (int k = b_.owned_vertex_begin[at(tb)]; a_has_faces && k < b_.owned_vertex_begin[at(tb) + 1]; ++k) {
      const int v = b_.owned_vertices[at(k)];
      add(FeatureKind::triangle_vertex, ta, box_a, v, ways_.b.along(boxes_b_.vertices[at(v)]));
    }
    const int first = a_.owned_edge_begin[at(ta)], last = a_.owned_edge_begin[at(ta) + 1];
    for (int k = first; edges_of_ != ta && k < last; ++k)
      boxes_e_[at(k - first)] = ways_.a.along(box_of_edge(a_, boxes_a_, a_.owned_edges[at(k)]));
    edges_of_ = ta;
    for (int l = b_.owned_edge_begin[at(tb)]; first < last && l < b_.owned_edge_begin[at(tb) + 1]; ++l) {
      const int f = b_.owned_edges[at(l)];
      const TightBox box_f = ways_.b.along(box_of_edge(b_, boxes_b_, f));
      for (int k = first; k < last; ++k)
        add(FeatureKind::edge_edge, a_.owned_edges[at(k)], boxes_e_[at(k - first)], f, box_f);
    }
  }

  const Collider &a_, &b_;
  const FeatureBoxes &boxes_a_, &boxes_b_;
  const RelativeWays& ways_;
  const double radii_;  // m
  Descent descent_;
  Planes planes_;
  int edges_of_ = -1;  // triangle of a, whose edges have these boxes
  std::array<TightBox, 3> boxes_e_;
};

// Great bodies in parts that depend on their trees alone, one after the other in the list.
void list_features(const FeatureQuery& query, FeatureList& out, std::vector<FeatureBlock>* blocks) {
  constexpr std::size_t kManyTriangles = 4000, kParts = 16;
  Lister whole(query);
  const bool is_great = query.a.triangles.size() + query.b.triangles.size() > kManyTriangles;
  const auto roots = whole.descent().split(is_great ? kParts : 1);
  if (roots.size() <= 1) {
    for (const auto& root : roots) whole.list_below(root, out, blocks);
    return;
  }
  struct Part {
    FeatureList features;
    std::vector<FeatureBlock> blocks;
  };
  std::vector<Part> parts(roots.size());
  core::parallel_for(roots.size(), 1, [&](std::size_t k) {
    Lister(query).list_below(roots[k], parts[k].features, blocks ? &parts[k].blocks : nullptr);
  });
  for (const Part& part : parts) {
    for (FeatureBlock block : part.blocks) {
      block.begin += static_cast<int>(out.size());
      blocks->push_back(block);
    }
    out.insert(out.end(), part.features.begin(), part.features.end());
  }
}

std::array<Vec3, 3> corners(const PlacedCollider& placed, int triangle) {
  const auto& t = placed.collider->triangles[at(triangle)];
  return {placed.start[at(t[0])], placed.start[at(t[1])], placed.start[at(t[2])]};
}

bool an_edge_pierces(const std::array<Vec3, 3>& edges, const std::array<Vec3, 3>& face) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (geometry::segment_pierces_triangle(edges[i], edges[(i + 1) % 3], face[0], face[1], face[2]))
      return true;
  }
  return false;
}

// Radii do not count.
bool any_edge_pierces(const PlacedCollider& a, const PlacedCollider& b) {
  bool result = false;
  const RelativeWays stay;
  Descent(*a.collider, a.boxes, *b.collider, b.boxes, stay, 0.0)
      .run([&](int ta, const TightBox&, int tb, const TightBox&, int) {
        if (result) return;
        const auto p = corners(a, ta), q = corners(b, tb);
        result = an_edge_pierces(p, q) || an_edge_pierces(q, p);
      });
  return result;
}

}  // namespace

void place_vertices(const Collider& collider, const Pose& pose, std::vector<Vec3>& out) {
  const Mat3 r = pose.rotation.toRotationMatrix();
  const auto& vertices = collider.vertices;
  out.resize(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) out[i] = r * vertices[i] + pose.translation;
}

PlacedCollider place_collider(const Collider& collider, const Pose& pose) {
  PlacedCollider placed;
  placed.collider = &collider;
  place_vertices(collider, pose, placed.start);
  refit_boxes(placed);
  return placed;
}

void PlacedCollider::clear() {
  for (std::vector<TightBox>* part : {&boxes.vertices, &boxes.triangles, &boxes.nodes}) part->clear();
  start.clear();
}

void refit_boxes(PlacedCollider& placed) {
  const double radius = placed.collider->radius;
  placed.boxes.vertices.resize(placed.start.size());
  for (std::size_t v = 0; v < placed.start.size(); ++v) {
    placed.boxes.vertices[v] = box_of_point(placed.start[v], radius);
  }
  refit(*placed.collider, placed.boxes);
}

void refit_swept_boxes(SweptCollider& swept) {
  const double radius = swept.collider->radius;
  swept.boxes.vertices.resize(swept.start.size());
  for (std::size_t v = 0; v < swept.start.size(); ++v)
    swept.boxes.vertices[v] = box_of_path(swept.start[v], swept.end[v], radius);
  refit(*swept.collider, swept.boxes);
}

Span leaf_span(const Collider& collider, int leaf, const std::vector<Vec3>& positions,
               const Vec3& direction) {
  Span span{1e300, -1e300};
  for (int k = collider.leaf_vertex_begin[at(leaf)]; k < collider.leaf_vertex_begin[at(leaf) + 1]; ++k) {
    const double along = direction.dot(positions[at(collider.leaf_vertices[at(k)])]);
    span.least = std::min(span.least, along);
    span.most = std::max(span.most, along);
  }
  return span;
}

void sort_by_bound(FeatureList& features) {
  std::sort(features.begin(), features.end(), [](const FeaturePair& x, const FeaturePair& y) {
    return x.bound < y.bound || (x.bound == y.bound && x.key() < y.key());
  });
}

void list_near_features(const PlacedCollider& a, const PlacedCollider& b, double margin, FeatureList& out) {
  out.clear();
  const Places places_a{a.start, nullptr}, places_b{b.start, nullptr};
  const RelativeWays stay;
  list_features({*a.collider, a.boxes, places_a, *b.collider, b.boxes, places_b, stay, margin}, out, nullptr);
}

void list_met_features(const PlacedCollider& a, const BodyWay& way_a, const PlacedCollider& b,
                       const BodyWay& way_b, double margin, FeatureList& out,
                       std::vector<FeatureBlock>* blocks) {
  out.clear();
  if (blocks) blocks->clear();
  const Places places_a{a.start, nullptr}, places_b{b.start, nullptr};
  const RelativeWays ways(way_a, a.collider->bounding_radius, way_b, b.collider->bounding_radius);
  list_features({*a.collider, a.boxes, places_a, *b.collider, b.boxes, places_b, ways, margin}, out, blocks);
}

void list_swept_features(const SweptCollider& a, const SweptCollider& b, double margin, FeatureList& out) {
  out.clear();
  const Places places_a{a.start, &a.end}, places_b{b.start, &b.end};
  const RelativeWays stay;
  list_features({*a.collider, a.boxes, places_a, *b.collider, b.boxes, places_b, stay, margin}, out, nullptr);
}

bool may_meet_ball(const PlacedCollider& body, const BodyWay& way, const BodyWay& ball, double radius,
                   double margin) {
  BodyWay centre = ball;  // all that is asked of the ball
  centre.turned_from = centre.turned_to = Mat3::Identity();
  centre.least_length = 0.0;
  const RelativeWays ways(way, body.collider->bounding_radius, centre, 0.0);
  const TightBox path = ways.b.along(box_of_point(ball.centre, 0.0));
  const float reach = round_up(ways.seen_margin(margin, radius + body.collider->radius) + radius),
              reach_squared = reach * reach * (1.0F + 1e-5F);
  const auto is_near = [&](const TightBox& box) {
    return distance_squared(ways.a.along(box), path) <= reach_squared;
  };
  const auto& nodes = body.collider->tree.nodes;
  std::vector<int> stack;
  if (!nodes.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const int i = stack.back();
    stack.pop_back();
    if (!is_near(body.boxes.nodes[at(i)])) continue;
    const Node& node = nodes[at(i)];
    if (node.count == 0) {
      stack.push_back(node.right);
      stack.push_back(i + 1);
      continue;
    }
    for (int k = node.begin; k < node.begin + node.count; ++k)
      if (is_near(body.boxes.triangles[at(k)])) return true;
  }
  return false;
}

bool crosses(const PlacedCollider& a, const PlacedCollider& b) {
  return a.collider->radius == 0.0 && b.collider->radius == 0.0 && any_edge_pierces(a, b);
}

bool is_run_through(const PlacedCollider& a, const PlacedCollider& b) {
  return (a.collider->kind == body::ShapeKind::capsule || b.collider->kind == body::ShapeKind::capsule) &&
         any_edge_pierces(a, b);
}

}  // namespace shatterbox::collision
