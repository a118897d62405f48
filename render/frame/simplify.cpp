#include "render/frame/simplify.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "render/frame/expand.h"

namespace shatterbox::render {
namespace {

constexpr int kMostRounds = 12;
constexpr double kMeanShare =
    0.4;  // the mean of the squared distances may be this share of the greatest one's square
constexpr float kLeastTurnCosine = 0.8F;     // a triangle's plane turns by no more in one collapse
constexpr float kLeastNormalCosine = 0.95F;  // nor does the normal differ from end to end of a collapsed edge
constexpr float kEqualCosine = 0.9999F;      // of normals between which is no crease
constexpr float kLeastShape = 0.05F;         // of a triangle: 1 equilateral, 0 a line
constexpr std::size_t kMostFan = CornerTable::Fan::kMost;

}  // namespace

void Simplifier::Quadric::add_plane(glm::dvec3 n) {
  a[0] += n.x * n.x;
  a[1] += n.x * n.y;
  a[2] += n.x * n.z;
  a[3] += n.y * n.y;
  a[4] += n.y * n.z;
  a[5] += n.z * n.z;
  planes += 1.0;
}

glm::dvec3 Simplifier::Quadric::times(glm::dvec3 x) const {
  return {a[0] * x.x + a[1] * x.y + a[2] * x.z, a[1] * x.x + a[3] * x.y + a[4] * x.z,
          a[2] * x.x + a[4] * x.y + a[5] * x.z};
}

double Simplifier::Quadric::mean_at(glm::dvec3 x) const {
  return std::max(glm::dot(x, times(x) + 2.0 * b) + c, 0.0) / std::max(planes, 1.0);
}

// from_other: from the other's vertex to this one.
void Simplifier::Quadric::add(const Quadric& other, glm::dvec3 from_other) {
  const glm::dvec3 turned = other.times(from_other);
  c += glm::dot(from_other, turned + 2.0 * other.b) + other.c;
  b += other.b + turned;
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += other.a[i];
  planes += other.planes;
}

void Simplifier::read(const Mesh& mesh) {
  mesh_ = &mesh;
  corners_.read(mesh);
  cracks_ = mesh.cracks;
  states_.assign(mesh.positions.size(), State::ready);
  stamps_.assign(mesh.positions.size(), 0);
  stamp_ = 0;
  has_groups_ =
      std::adjacent_find(mesh.parts.begin(), mesh.parts.end(), std::not_equal_to<>()) != mesh.parts.end() ||
      mesh.surface == Surface::solid;
  crease_cosine_ = std::cos(glm::radians(mesh.crease_angle));
  find_faces();
  normals_ = mesh.normals.empty() ? &own_normals_ : &mesh.normals;
  own_normals_.assign(mesh.normals.empty() ? mesh.positions.size() : 0, glm::vec3(0.0F));
  if (find_places()) return;
  // Not all corners are in fans: normals are found without these.
  own_normals_ = find_corner_normals(mesh);
  find_places();
}

void Simplifier::find_faces() {
  FaceNormals faces = find_face_normals(*mesh_);
  units_.swap(faces.unit);
  weights_.swap(faces.weight);
}

// Which vertices may move where, and what that costs. False if normals are to be found about a vertex that is
// odd.
bool Simplifier::find_places() {
  const bool has_corner_normals = normals_->size() == 3 * mesh_->triangles.size();
  normal_of_.resize(4 * mesh_->triangles.size());
  for (std::uint32_t t = 0; has_corner_normals && t < mesh_->triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) normal_of_[4 * t + k] = 3 * t + k;
  places_.assign(mesh_->positions.size(), Place::stays);
  quadrics_.assign(mesh_->positions.size(), {});
  left_.clear();
  Fan fan;
  for (std::uint32_t v = 0; v < places_.size(); ++v) {
    if (corners_.corner_of(v) == CornerTable::kNone) continue;
    if (corners_.find_odd(v, fan)) {
      if (!has_corner_normals) return false;
      continue;
    }
    const bool is_smooth = !has_corner_normals && find_normals(v, fan);
    // Where nothing but the outline can be a line, only its two edges are asked: the fan's first and last.
    const std::size_t step = is_smooth && !has_groups_ ? fan.count : 1;
    int lines = 0;
    for (std::size_t i = 0; i < fan.neighbours().size(); i += step) lines += is_line(fan, i) ? 1 : 0;
    weigh(v, fan, lines > 0 ? step : 0);
    // A solid's outline is a seam: the other side of it must find it where it is.
    const bool is_seam = fan.is_outline && mesh_->surface == Surface::solid;
    if (is_seam || (lines != 0 && lines != 2)) continue;
    places_[v] = lines == 0 ? Place::inside : Place::on_line;
    left_.push_back(v);
  }
  return true;
}

// As find_corner_normals does: one for all corners where there is no crease, which it tells.
bool Simplifier::find_normals(std::uint32_t v, const Fan& fan) {
  for (std::size_t k = 0; k < fan.count; ++k) {
    const std::uint32_t own_triangle = CornerTable::triangle(fan.corners[k]);
    const glm::vec3 own = units_[own_triangle];
    glm::vec3 sum(0.0F);
    float least = 1.0F;
    for (std::size_t i = 0; i < fan.count; ++i) {
      const std::uint32_t t = CornerTable::triangle(fan.corners[i]);
      const float cosine = crease_cosine(*mesh_, units_, t, own_triangle);
      least = std::min(least, cosine);
      if (cosine >= crease_cosine_) sum += units_[t] * weights_[3 * t + (fan.corners[i] & 3U)];
    }
    const float length = glm::length(sum);
    const glm::vec3 mean = length > 0.0F && std::isfinite(length) ? sum / length
                           : own == glm::vec3(0.0F)               ? glm::vec3(0.0F, 1.0F, 0.0F)
                                                                  : own;
    const bool is_smooth =
        k == 0 && length > 0.0F && least > 0.0F && 2.0F * least * least - 1.0F > crease_cosine_ + 1e-5F;
    if (is_smooth) {
      own_normals_[v] = mean;
      for (std::size_t i = 0; i < fan.count; ++i) normal_of_[fan.corners[i]] = v;
      return true;
    }
    normal_of_[fan.corners[k]] = static_cast<std::uint32_t>(own_normals_.size());
    own_normals_.push_back(mean);
  }
  return false;
}

// Planes of the triangles about a vertex and, square to them, through the lines that end at it, which are
// among every `step`th edge of the fan (0: there are none).
void Simplifier::weigh(std::uint32_t v, const Fan& fan, std::size_t step) {
  Quadric sum;
  for (std::size_t i = 0; i < fan.count; ++i) sum.add_plane(units_[CornerTable::triangle(fan.corners[i])]);
  const std::size_t size = fan.neighbours().size();
  for (std::size_t i = 0; step > 0 && i < size; i += step) {
    if (!is_line(fan, i)) continue;
    for (const bool is_after : {false, true}) {
      if (fan.is_outline && i == (is_after ? fan.count : 0)) continue;
      const std::size_t beside = is_after ? i : i == 0 ? fan.count - 1 : i - 1;
      const glm::vec3 side = glm::cross(position(fan.around[i]) - position(v),
                                        units_[CornerTable::triangle(fan.corners[beside])]);
      const float length = glm::length(side);
      if (length > 0.0F) sum.add_plane(side / length);
    }
  }
  quadrics_[v] = sum;
}

bool Simplifier::is_cracked(std::uint32_t c) const {
  return !cracks_.empty() && ((cracks_[CornerTable::triangle(c)] >> (c & 3U)) & 1U) != 0;
}

// Triangles of different groups have a line between them: other paint, or a solid's crack.
int Simplifier::group(std::uint32_t c) const {
  const std::uint32_t triangle = CornerTable::triangle(c);
  const int part = mesh_->parts.empty() ? 0 : mesh_->parts[triangle];
  return 2 * part + (!cracks_.empty() && (cracks_[triangle] & kCrackFace) != 0 ? 1 : 0);
}

// Whether there is a line along the fan's edge to its neighbour i, as the vertex sees it.
bool Simplifier::is_line(const Fan& fan, std::size_t i) const {
  if (fan.is_outline && (i == 0 || i == fan.count)) return true;
  const std::uint32_t a = fan.corners[(i > 0 ? i : fan.count) - 1], b = fan.corners[i];
  return group(a) != group(b) ||
         (normal_of_[a] != normal_of_[b] && glm::dot(normal(a), normal(b)) < kEqualCosine);
}

// The corner of neighbour i in the fan's triangle after the edge to it, or before.
std::uint32_t Simplifier::corner_beside(const Fan& fan, std::size_t i, bool is_after) const {
  if (is_after) return CornerTable::next(fan.corners[i]);
  return CornerTable::previous(fan.corners[(i > 0 ? i : fan.count) - 1]);
}

// Turns the fan so that its neighbours 0 and `middle` are those along the line.
bool Simplifier::find_ends(Fan& fan, std::size_t& middle) const {
  std::size_t ends[2] = {0, 0}, count = 0;
  for (std::size_t i = 0; i < fan.neighbours().size(); ++i) {
    if (!is_line(fan, i)) continue;
    if (count == 2) return false;
    ends[count++] = i;
  }
  if (count != 2) return false;
  middle = ends[1] - ends[0];
  if (fan.is_outline) return ends[0] == 0;
  std::rotate(fan.corners, fan.corners + ends[0], fan.corners + fan.count);
  std::rotate(fan.around, fan.around + ends[0], fan.around + fan.count);
  return true;
}

// Neighbours that both share are only those of the triangles that vanish: else the surface would fold
// together.
bool Simplifier::is_link_simple(const Fan& fan, std::uint32_t v, std::size_t i) {
  Fan other;
  const std::uint32_t u = fan.around[i];
  if (corners_.is_odd(u) || !corners_.walk(u, other)) return false;
  ++stamp_;
  for (const std::uint32_t n : fan.neighbours()) stamps_[n] = stamp_;
  int shared = 0;
  for (const std::uint32_t n : other.neighbours()) shared += n != v && stamps_[n] == stamp_ ? 1 : 0;
  return shared == (fan.is_outline && (i == 0 || i == fan.count) ? 1 : 2);
}

// Whether the triangles of v, but for those that vanish, keep their sense and a shape when v moves to u.
bool Simplifier::keeps_shape(const Fan& fan, std::uint32_t v, std::uint32_t u) const {
  const glm::vec3 from = position(v), to = position(u);
  const auto size = fan.neighbours().size();
  for (std::size_t i = 0; i < fan.count; ++i) {
    const std::uint32_t na = fan.around[i], nb = fan.around[i + 1 == size ? 0 : i + 1];
    if (na == u || nb == u) continue;
    const glm::vec3 a = position(na), b = position(nb), far = b - a;
    const glm::vec3 before = glm::cross(a - from, far), after = glm::cross(a - to, far);
    const float product = glm::dot(before, before) * glm::dot(after, after), along = glm::dot(before, after);
    if (along <= 0.0F || along * along <= kLeastTurnCosine * kLeastTurnCosine * product) return false;
    const float edges = glm::dot(far, far) + glm::dot(a - to, a - to) + glm::dot(b - to, b - to);
    if (12.0F * glm::dot(after, after) < kLeastShape * kLeastShape * edges * edges) return false;
  }
  return true;
}

bool Simplifier::keeps_normals(const Fan& fan, std::size_t i, std::size_t middle) const {
  const auto size = fan.neighbours().size();
  const auto alike = [&](bool is_after, std::size_t corner) {
    return glm::dot(normal(corner_beside(fan, i, is_after)), normal(fan.corners[corner])) >=
           kLeastNormalCosine;
  };
  if (middle == 0) return alike(true, 0);
  const bool has_after = i + 1 < size || !fan.is_outline, has_before = i > 0 || !fan.is_outline;
  return (!has_after || alike(true, i == 0 ? 0 : middle)) &&
         (!has_before || alike(false, i == 0 ? fan.count - 1 : middle - 1));
}

bool Simplifier::may_move(const Fan& fan, std::uint32_t v, std::size_t i, std::size_t middle) {
  return keeps_normals(fan, i, middle) && keeps_shape(fan, v, fan.around[i]) && is_link_simple(fan, v, i);
}

bool Simplifier::collapse(std::uint32_t v) {
  Fan fan;
  std::size_t middle = 0;  // none
  if (!corners_.walk(v, fan)) return false;
  const bool is_line = places_[v] == Place::on_line;
  if (fan.count < (fan.is_outline ? 2U : 3U) || (is_line && !find_ends(fan, middle))) return false;
  if (fan.is_outline) {
    const std::uint32_t last = CornerTable::previous(fan.corners[fan.count - 1]);
    if (is_cracked(fan.corners[0]) != is_cracked(last)) return false;
  }
  // The cheapest that may be: what that asks costs more than the cost.
  const std::size_t size = fan.neighbours().size();
  const auto cost = [&](std::size_t i) {
    const Quadric& other = quadrics_[fan.around[i]];
    return quadrics_[v].mean_at(glm::dvec3(position(fan.around[i]) - position(v))) +
           std::max(other.c, 0.0) / std::max(other.planes, 1.0);
  };
  std::array<double, kMostFan + 1> costs;
  for (std::size_t i = 0; i < size; ++i)
    costs[i] = !is_line || i == 0 || i == middle ? cost(i) : std::numeric_limits<double>::max();
  for (;;) {
    const auto cheapest = std::min_element(costs.begin(), costs.begin() + static_cast<std::ptrdiff_t>(size));
    if (!(*cheapest < tolerance_squared_)) return false;
    *cheapest = std::numeric_limits<double>::max();
    const auto i = static_cast<std::size_t>(cheapest - costs.begin());
    if (!may_move(fan, v, i, middle)) continue;
    move(fan, v, i, middle);
    return true;
  }
}

void Simplifier::move(const Fan& fan, std::uint32_t v, std::size_t i, std::size_t middle) {
  const std::uint32_t u = fan.around[i];
  for (const std::uint32_t n : fan.neighbours()) {
    states_[n] = State::waits;  // one collapse a neighbourhood and round
  }
  const std::size_t size = fan.neighbours().size();
  const bool has_after = i + 1 < size || !fan.is_outline, has_before = i > 0 || !fan.is_outline;
  const std::uint32_t after = has_after ? normal_of_[corner_beside(fan, i, true)] : 0;
  const std::uint32_t before = has_before ? normal_of_[corner_beside(fan, i, false)] : after;
  // The side of the line that begins at neighbour 0, and the other.
  const std::uint32_t first = i == 0 || middle == 0 ? (has_after ? after : before) : before;
  const std::uint32_t second = i == 0 || middle == 0 ? (middle == 0 ? first : before) : after;
  for (std::size_t k = 0; k < fan.count; ++k)
    normal_of_[fan.corners[k]] = middle == 0 || k < middle ? first : second;
  if (!cracks_.empty() && mesh_->surface == Surface::shell) {
    if (has_after) hand_on_crack(corner_beside(fan, i, true), corner_beside(fan, i, true));
    if (has_before) {
      const std::uint32_t at_u = corner_beside(fan, i, false);
      hand_on_crack(at_u, CornerTable::previous(at_u));
    }
  }
  corners_.collapse(fan, v, i);
  quadrics_[u].add(quadrics_[v], glm::dvec3(position(u) - position(v)));
}

// Of a triangle that vanishes two edges become one, whose flag is that of the edge at u (at the corner
// edge_u): the other's neighbour, beyond u's far edge, takes it.
void Simplifier::hand_on_crack(std::uint32_t at_u, std::uint32_t edge_u) {
  const std::uint32_t beyond = corners_.opposite(at_u);
  if (beyond >= CornerTable::kSeveral) return;
  const std::uint32_t edge = CornerTable::next(beyond);
  const unsigned bit = 1U << (edge & 3U), flags = cracks_[CornerTable::triangle(edge)] & ~bit;
  cracks_[CornerTable::triangle(edge)] = static_cast<std::uint8_t>(flags | (is_cracked(edge_u) ? bit : 0U));
}

int Simplifier::take_round() {
  int collapsed = 0;
  std::size_t kept = 0;
  for (const std::uint32_t v : left_) {
    if (states_[v] == State::ready) {
      if (collapse(v)) {
        ++collapsed;
        continue;
      }
      states_[v] = State::settled;
    }
    left_[kept++] = v;
  }
  left_.resize(kept);
  for (const std::uint32_t v : left_)
    if (states_[v] == State::waits) states_[v] = State::ready;
  return collapsed;
}

Mesh Simplifier::result() const {
  Mesh out;
  out.id = mesh_->id;
  out.surface = mesh_->surface;
  out.thickness = mesh_->thickness;
  out.crease_angle = mesh_->crease_angle;
  std::vector<std::uint32_t> number(mesh_->positions.size(), CornerTable::kNone);
  for (std::uint32_t t = 0; t < mesh_->triangles.size(); ++t) {
    if (corners_.is_gone(t)) continue;
    for (std::uint32_t k = 0; k < 3; ++k) number[corners_.vertex(4 * t + k)] = 0;
  }
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    if (number[v] == CornerTable::kNone) continue;
    number[v] = static_cast<std::uint32_t>(out.positions.size());
    out.positions.push_back(position(v));
    if (!mesh_->pattern_positions.empty()) out.pattern_positions.push_back(mesh_->pattern_positions[v]);
  }
  for (std::uint32_t t = 0; t < mesh_->triangles.size(); ++t) {
    if (corners_.is_gone(t)) continue;
    out.triangles.emplace_back(number[corners_.vertex(4 * t)], number[corners_.vertex(4 * t + 1)],
                               number[corners_.vertex(4 * t + 2)]);
    for (std::uint32_t k = 0; k < 3; ++k) out.normals.push_back(normal(4 * t + k));
    if (!mesh_->parts.empty()) out.parts.push_back(mesh_->parts[t]);
    if (!mesh_->cracks.empty()) out.cracks.push_back(cracks_[t]);
  }
  return out;
}

Mesh Simplifier::simplify(const Mesh& mesh, float tolerance) {
  check(mesh);
  tolerance_squared_ = kMeanShare * tolerance * tolerance;
  read(mesh);
  for (int round = 0; round < kMostRounds; ++round) {
    const auto before = left_.size();
    if (static_cast<std::size_t>(take_round()) * 50 <= before) break;
  }
  return result();
}

Mesh simplify(const Mesh& mesh, float tolerance) {
  return Simplifier().simplify(mesh, tolerance);
}

}  // namespace shatterbox::render
