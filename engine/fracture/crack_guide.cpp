#include "engine/fracture/crack_guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/stress/front_solve.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kLeastConduction = 0.005;  // through a crack's plane, where the stress is sure
constexpr double kLeastShare = 0.02;  // of an element's volume that counts of one with hardly any material
constexpr double kHold = 1e-9;        // of the diagonal, so that a potential without a border is one
constexpr double kFaint = 1e-10;      // share of the greatest change below which a potential is but rounding
constexpr double kToNode = 0.15;      // of the change over the elements about: a node as near is on the crack
constexpr Size kGrain = 4096;         // elements to a task
constexpr double kOnNode = 1e-6;      // likewise: what it then has, for nodes on the crack are positive

/// Gradients of the four corners' shape functions, 1/m.
std::array<Vec3, 4> shape_gradients(const geometry::TetMesh& mesh, int element) {
  const geometry::Tetrahedron& t = mesh.tetrahedra[at(element)];
  const Vec3& a = mesh.positions[at(t[0])];
  const Vec3 b = mesh.positions[at(t[1])] - a, c = mesh.positions[at(t[2])] - a,
             d = mesh.positions[at(t[3])] - a;
  const double six_volumes = b.cross(c).dot(d);
  std::array<Vec3, 4> gradients;
  gradients[1] = c.cross(d) / six_volumes;
  gradients[2] = d.cross(b) / six_volumes;
  gradients[3] = b.cross(c) / six_volumes;
  gradients[0] = -(gradients[1] + gradients[2] + gradients[3]);
  return gradients;
}

}  // namespace

struct CrackGuide::Factor {
  std::shared_ptr<const stress::FrontTree> tree;
  std::optional<stress::FrontFactor> factor;

  /// |nodes|: unknown, -1 for none.
  const std::vector<int>& number() const { return tree->node_place; }

  /// In place of up to kMost loads, by unknown, their answers.
  void solve(std::span<std::vector<double>> loads) const {
    stress::SolveLanes x(*tree, loads.size());
    const Size lanes = at(x.lanes);
    for (Size l = 0; l < loads.size(); ++l)
      for (Size i = 0; i < loads[l].size(); ++i) x.values[lanes * i + l] = loads[l][i];
    solve_forward(*tree, *factor, x);
    solve_backward(*tree, *factor, x);
    for (Size l = 0; l < loads.size(); ++l)
      for (Size i = 0; i < loads[l].size(); ++i) loads[l][i] = x.values[lanes * i + l];
  }
};

Mat3 guide_conduction(const Vec3& across, double sureness) {
  return Mat3::Identity() - sureness * (1.0 - kLeastConduction) * across * across.transpose();
}

void settle_near_nodes(const geometry::TetMesh& mesh, const std::vector<double>& known,
                       std::vector<double>& field) {
  std::vector<double> change(field.size(), 0.0);
  for (const geometry::Tetrahedron& t : mesh.tetrahedra) {
    if (std::any_of(t.begin(), t.end(), [&](int v) { return known[at(v)] == 0.0; })) continue;
    const auto [low, high] =
        std::minmax({field[at(t[0])], field[at(t[1])], field[at(t[2])], field[at(t[3])]});
    for (const int v : t) change[at(v)] = std::max(change[at(v)], high - low);
  }
  for (Size v = 0; v < field.size(); ++v)
    if (known[v] != 0.0 && std::abs(field[v]) <= kToNode * change[v])
      field[v] = std::max(kOnNode * change[v], 1e-300);
}

GuideTrees::GuideTrees(const std::vector<int>& vertex_rank) : order_(vertex_rank.size()) {
  for (Size v = 0; v < order_.size(); ++v) order_[at(vertex_rank[v])] = static_cast<int>(v);
}

std::shared_ptr<const stress::FrontTree> GuideTrees::of(const geometry::TetMesh& mesh,
                                                        const std::vector<GuideElement>& elements) {
  if (last_ &&
      std::equal(elements.begin(), elements.end(), elements_of_last_.begin(), elements_of_last_.end(),
                 [](const GuideElement& own, int other) { return own.element == other; }))
    return last_;
  stress::NodeGraph graph;
  graph.element_unknowns = {1, 1, 1, 1, 0, 0};
  graph.node_size.assign(mesh.positions.size(), 1);
  elements_of_last_.clear();
  for (const GuideElement& e : elements) {
    const geometry::Tetrahedron& t = mesh.tetrahedra[at(e.element)];
    graph.elements.push_back({t[0], t[1], t[2], t[3], -1, -1});
    elements_of_last_.push_back(e.element);
  }
  last_ = std::make_shared<const stress::FrontTree>(build_front_tree(graph, order_));
  return last_;
}

CrackGuide::CrackGuide(const geometry::TetMesh& mesh, std::vector<GuideElement> elements, GuideTrees& trees)
    : mesh_(mesh), elements_(std::move(elements)), factor_(std::make_unique<Factor>()) {
  factor_->tree = trees.of(mesh_, elements_);

  using Entries = std::array<double, 10>;  // of an element: lower triangle, column after column
  std::vector<Entries> entries(elements_.size());
  core::parallel_for(elements_.size(), 1024, [&](Size k) {
    const GuideElement& e = elements_[k];
    const std::array<Vec3, 4> gradients = shape_gradients(mesh_, e.element);
    const double full = geometry::tetrahedron_volume(mesh_, e.element);
    const double volume = std::max(e.volume, kLeastShare * full);
    Size next = 0;
    for (Size j = 0; j < 4; ++j) {
      const Vec3 flow = volume * (e.conduction * gradients[j]);
      for (Size i = j; i < 4; ++i) entries[k][next++] = flow.dot(gradients[i]);
    }
  });
  double trace = 0.0;
  for (const Entries& e : entries) trace += (e[0] + e[4]) + (e[7] + e[9]);
  const std::vector<double> hold(at(factor_->tree->unknowns), kHold * trace / factor_->tree->unknowns);
  factor_->factor = stress::FrontFactor::make(*factor_->tree, hold, [&](int e) {
    return stress::ElementEntries{entries[at(e)].data(), 1.0};
  });
}

CrackGuide::~CrackGuide() = default;
CrackGuide::CrackGuide(CrackGuide&&) noexcept = default;

std::vector<std::vector<double>> CrackGuide::potentials(std::span<const GuideStart> starts) const {
  std::vector<std::vector<double>> values(starts.size());
  if (!factor_->factor) {
    for (std::vector<double>& unknown : values) unknown.assign(mesh_.positions.size(), 0.0);
    return values;
  }
  core::parallel_chunks(starts.size(), stress::SolveLanes::kMost, [&](Size begin, Size end) {
    for (Size i = begin; i < end; ++i) values[i] = source_at(starts[i]);
    factor_->solve(std::span(values).subspan(begin, end - begin));
    for (Size i = begin; i < end; ++i) values[i] = level(starts[i], values[i]);
  });
  return values;
}

/// A ball of sources and sinks, the elements about the start: the potential inside is nearly linear.
std::vector<double> CrackGuide::source_at(const GuideStart& start) const {
  const geometry::Tetrahedron& middle = mesh_.tetrahedra[at(start.element)];
  const std::vector<int>& number = factor_->number();
  std::vector<double> source(at(factor_->tree->unknowns), 0.0);
  const auto near = core::find_where(elements_.size(), kGrain, [&](Size k) {
    const geometry::Tetrahedron& t = mesh_.tetrahedra[at(elements_[k].element)];
    return std::any_of(t.begin(), t.end(),
                       [&](int v) { return std::find(middle.begin(), middle.end(), v) != middle.end(); });
  });
  for (const int k : near) {
    const GuideElement& e = elements_[at(k)];
    const geometry::Tetrahedron& t = mesh_.tetrahedra[at(e.element)];
    const std::array<Vec3, 4> gradients = shape_gradients(mesh_, e.element);
    const double volume = geometry::tetrahedron_volume(mesh_, e.element);
    for (Size i = 0; i < 4; ++i) source[at(number[at(t[i])])] += volume * gradients[i].dot(start.normal);
  }
  return source;
}

/// By node, of a flow by unknown.
std::vector<double> CrackGuide::level(const GuideStart& start, const std::vector<double>& flow) const {
  const geometry::Tetrahedron& middle = mesh_.tetrahedra[at(start.element)];
  const std::vector<int>& number = factor_->number();
  double here = 0.0;
  const std::array<Vec3, 4> gradients = shape_gradients(mesh_, start.element);
  for (Size i = 0; i < 4; ++i) {
    const double weight =
        (i == 0 ? 1.0 : 0.0) + gradients[i].dot(start.place - mesh_.positions[at(middle[0])]);
    here += weight * flow[at(number[at(middle[i])])];
  }
  // The change of the potential over the elements about each node is the measure of what is near zero.
  std::vector<double> values(mesh_.positions.size(), 0.0), change(values.size(), 0.0);
  std::vector<double> changes(elements_.size());
  core::parallel_for(elements_.size(), kGrain, [&](Size k) {
    const geometry::Tetrahedron& t = mesh_.tetrahedra[at(elements_[k].element)];
    double low = 1e300, high = -1e300;
    for (const int v : t) {
      low = std::min(low, flow[at(number[at(v)])]);
      high = std::max(high, flow[at(number[at(v)])]);
    }
    changes[k] = high - low;
  });
  for (Size k = 0; k < elements_.size(); ++k)
    for (const int v : mesh_.tetrahedra[at(elements_[k].element)])
      change[at(v)] = std::max(change[at(v)], changes[k]);
  const double faintest = kFaint * *std::max_element(change.begin(), change.end());
  for (Size v = 0; v < values.size(); ++v) {
    if (number[v] < 0 || !(change[v] > faintest)) continue;
    const double value = flow[at(number[v])] - here;
    values[v] = std::abs(value) < kToNode * change[v] ? kOnNode * change[v] : value;
  }
  return values;
}

}  // namespace shatterbox::fracture
