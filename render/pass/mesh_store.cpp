#include "render/pass/mesh_store.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "render/pass/shape_making.h"

namespace shatterbox::render::pass {

void delete_vertex_array(unsigned name) {
  glDeleteVertexArrays(1, &name);
}

namespace {

constexpr std::uint32_t kNone = 0xffffffffU;

// As surface.vert reads it (std430).
struct DrawRow {
  glm::mat4 world_from_body;
  glm::uvec4 rows;
};

constexpr float kLeastPixels = 0.25F;     // bodies of a smaller radius are not drawn
constexpr float kSeenPixels = 0.5F;       // a surface may be off by so much
constexpr float kLeastTolerance = 1e-7F;  // m; nothing is simplified for eyes so near
constexpr float kOctaveLevels = 2.0F;     // levels from a tolerance to its double
constexpr GLuint kRowAttribute = 5;

unsigned create_vertex_array() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  const auto attribute = [name](GLuint index, GLint size, GLenum type, GLboolean normalised,
                                std::size_t offset) {
    glEnableVertexArrayAttrib(name, index);
    glVertexArrayAttribFormat(name, index, size, type, normalised, static_cast<GLuint>(offset));
    glVertexArrayAttribBinding(name, index, 0);
  };
  const auto whole = [name](GLuint index, std::size_t offset) {
    glEnableVertexArrayAttrib(name, index);
    glVertexArrayAttribIFormat(name, index, 1, GL_UNSIGNED_INT, static_cast<GLuint>(offset));
    glVertexArrayAttribBinding(name, index, 0);
  };
  attribute(0, 3, GL_FLOAT, GL_FALSE, offsetof(DrawnVertex, position));
  attribute(1, 3, GL_SHORT, GL_TRUE, offsetof(DrawnVertex, normal));
  attribute(2, 3, GL_FLOAT, GL_FALSE, offsetof(DrawnVertex, pattern));
  whole(3, offsetof(DrawnVertex, source));
  whole(4, offsetof(DrawnVertex, face_part));
  glEnableVertexArrayAttrib(name, kRowAttribute);  // stepped by instance: a draw's base instance is its row
  glVertexArrayAttribIFormat(name, kRowAttribute, 1, GL_UNSIGNED_INT, 0);
  glVertexArrayAttribBinding(name, kRowAttribute, 1);
  glVertexArrayBindingDivisor(name, 1, 1);
  return name;
}

// The view frustum's planes (left, right, bottom, top), pointing in, of unit normal.
std::array<glm::vec4, 4> find_sides(const glm::mat4& clip_from_world) {
  const glm::mat4 m = glm::transpose(clip_from_world);
  std::array<glm::vec4, 4> sides = {m[3] + m[0], m[3] - m[0], m[3] + m[1], m[3] - m[1]};
  for (glm::vec4& side : sides) side /= glm::length(glm::vec3(side));
  return sides;
}

// Surfaces are drawn as coarsely as the eye does not see: in steps, so that it rarely changes.
std::optional<int> level_of(const Draw& draw, glm::vec3 centre_body, float radius, glm::vec3 eye,
                            float pixel_slope) {
  const float scale = glm::length(glm::vec3(draw.world_from_body[0]));
  const glm::vec3 centre(draw.world_from_body * glm::vec4(centre_body, 1.0F));
  const float nearest = glm::distance(centre, eye) - radius * scale;
  const float tolerance = kSeenPixels * pixel_slope * nearest / scale;
  if (!(tolerance > kLeastTolerance)) return {};
  return static_cast<int>(std::floor(kOctaveLevels * std::log2(tolerance)));
}

bool has_scalars(const Overlay& overlay) {
  return overlay.kind == OverlayKind::heat || overlay.kind == OverlayKind::groups;
}

bool have_equal_scalars(const Item& a, const Item& b) {
  if (a.scalars == b.scalars) return true;
  return a.scalars && b.scalars && a.scalars->size() == b.scalars->size() &&
         std::memcmp(a.scalars->data(), b.scalars->data(), a.scalars->size() * sizeof(float)) == 0;
}

// Their paints apart. To the bit: what is equal draws the same.
bool is_drawn_alike(const Item& a, const Item& b) {
  return a.stored_id == b.stored_id && a.is_glass == b.is_glass && a.is_on_screen == b.is_on_screen &&
         a.casts_shadow == b.casts_shadow &&
         std::memcmp(&a.world_from_body, &b.world_from_body, sizeof a.world_from_body) == 0 &&
         have_equal_scalars(a, b);
}

}  // namespace

MeshStore::MeshStore() : vertex_array_(create_vertex_array()) {}

MeshStore::Levels& MeshStore::find_or_measure(const Mesh& mesh) {
  const auto known = meshes_.find(mesh.id);
  if (known != meshes_.end()) return known->second;
  check(mesh);
  Levels& levels = meshes_[mesh.id];
  if (mesh.positions.empty()) return levels;
  glm::vec3 least = mesh.positions.front(), most = least;
  for (const glm::vec3& p : mesh.positions) {
    least = glm::min(least, p);
    most = glm::max(most, p);
  }
  levels.centre = 0.5F * (least + most);
  levels.radius = 0.5F * glm::distance(least, most) + mesh.thickness;
  return levels;
}

MeshStore::Choice MeshStore::choose(const Draw& draw, const Frame& frame, float pixel_slope) {
  if (draw.mesh == nullptr) throw std::invalid_argument("a draw without a mesh");
  if (draw.scalars != nullptr && draw.scalars->size() != draw.mesh->positions.size()) {
    throw std::invalid_argument("mesh " + std::to_string(draw.mesh->id) + ": scalars must be one a vertex");
  }
  Levels& levels = find_or_measure(*draw.mesh);
  levels.last_frame = frame_;
  const bool is_as_given = (has_scalars(frame.overlay) && draw.scalars != nullptr) || frame.overlay.has_wires;
  if (is_as_given) return {&levels, kAsGiven};
  const std::optional<int> level =
      level_of(draw, levels.centre, levels.radius, frame.camera.position, pixel_slope);
  return {&levels, level.value_or(kAsGiven)};
}

void MeshStore::make_missing(const Frame& frame, const std::vector<Choice>& choices) {
  std::vector<WantedShape> wanted;
  std::vector<StoredMesh*> rooms;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const auto [room, is_new] = choices[i].levels->meshes.try_emplace(choices[i].level);
    if (!is_new && room->second.id != 0) continue;
    if (!is_new && std::find(rooms.begin(), rooms.end(), &room->second) != rooms.end()) continue;
    wanted.push_back({frame.draws[i].mesh.get(), {}, {}});
    if (choices[i].level != kAsGiven)
      wanted.back().tolerance = std::exp2(static_cast<float>(choices[i].level) / kOctaveLevels);
    rooms.push_back(&room->second);
  }
  make_shapes(wanted);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    StoredMesh& stored = *rooms[i];
    stored.id = next_id_++;
    stored.shape = std::move(wanted[i].shape);
    stored.vertices = gpu::Buffer::of(std::span<const DrawnVertex>(stored.shape.vertices));
    stored.indices = gpu::Buffer::of(std::span<const std::uint32_t>(stored.shape.indices));
    stored.shape.vertices = {};
    stored.shape.indices = {};
  }
}

void MeshStore::drop_unseen() {
  std::erase_if(meshes_, [this](const auto& entry) { return entry.second.last_frame != frame_; });
}

Item MeshStore::make_item(const Draw& draw, const Frame& frame, const StoredMesh& stored, float pixel_slope) {
  const glm::vec3 eye = frame.camera.position;
  Item item;
  if (has_scalars(frame.overlay)) item.scalars = draw.scalars;
  item.stored = &stored;
  item.mesh_id = draw.mesh->id;
  item.stored_id = item.stored->id;
  item.world_from_body = draw.world_from_body;
  const DrawnMesh& shape = item.stored->shape;
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 corner((i & 1) ? shape.box_most.x : shape.box_least.x,
                           (i & 2) ? shape.box_most.y : shape.box_least.y,
                           (i & 4) ? shape.box_most.z : shape.box_least.z);
    item.box_world.at[i] = glm::vec3(draw.world_from_body * glm::vec4(corner, 1.0F));
  }
  const float scale = glm::length(glm::vec3(draw.world_from_body[0]));
  item.centre_world = glm::vec3(draw.world_from_body * glm::vec4(shape.centre, 1.0F));
  item.radius = shape.radius * scale;
  item.eye_distance = glm::distance(item.centre_world, eye);
  item.rim_pixels = draw.mesh->thickness * scale / std::max(pixel_slope * item.eye_distance, 1e-9F);
  item.is_glass = frame.overlay.kind != OverlayKind::pieces &&
                  std::any_of(draw.looks.begin(), draw.looks.end(),
                              [](const Look& look) { return look.transmission > 0.0F; });
  item.is_cloudy =
      item.is_glass &&
      (draw.scalars != nullptr || std::any_of(draw.looks.begin(), draw.looks.end(),
                                              [](const Look& look) { return look.transmission < kClear; }));
  const bool is_dust = item.radius < kLeastPixels * pixel_slope * item.eye_distance;
  item.is_on_screen = !is_dust;
  item.casts_shadow = draw.casts_shadow && !is_dust;
  return item;
}

// The draws are followed by their meshes, in order: what is not found is new, what was passed over is gone.
void MeshStore::compare_with_earlier(std::vector<Item>& items, const Frame& frame) {
  gone_.clear();
  if (paints_.begin(frame)) gone_.swap(earlier_);
  std::size_t next = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    Item& item = items[i];
    const Draw& draw = frame.draws[i];
    std::size_t found = next;
    while (found < earlier_.size() && earlier_[found].mesh_id != item.mesh_id) ++found;
    const bool is_known =
        found < earlier_.size() && earlier_[found].paints.count == PaintTable::count_of(draw);
    item.paints =
        paints_.write(draw, frame.overlay, is_known ? earlier_[found].paints.first : PaintTable::kNone);
    if (found == earlier_.size()) continue;
    item.is_as_before = item.paints.is_as_before && is_drawn_alike(item, earlier_[found]);
    gone_.insert(gone_.end(), earlier_.begin() + static_cast<std::ptrdiff_t>(next),
                 earlier_.begin() + static_cast<std::ptrdiff_t>(item.is_as_before ? found : found + 1));
    next = found + 1;
  }
  gone_.insert(gone_.end(), earlier_.begin() + static_cast<std::ptrdiff_t>(std::min(next, earlier_.size())),
               earlier_.end());
  earlier_ = items;
}

void MeshStore::upload_rows(const std::vector<Item>& items) {
  std::vector<DrawRow> draws;
  std::vector<float> scalars;
  for (const Item& item : items) {
    const auto first_scalar = item.scalars ? static_cast<std::uint32_t>(scalars.size()) : kNone;
    draws.push_back(
        {item.world_from_body, {item.paints.first, item.paints.count / 3U, first_scalar, item.id}});
    if (item.scalars) scalars.insert(scalars.end(), item.scalars->begin(), item.scalars->end());
  }
  draw_rows_.assign(std::span<const DrawRow>(draws));
  std::vector<std::uint32_t> rows(std::max<std::size_t>(draws.size(), 1));
  std::iota(rows.begin(), rows.end(), 0U);
  rows_.assign(std::span<const std::uint32_t>(rows));
  glVertexArrayVertexBuffer(vertex_array_.get(), 1, rows_.name(), 0, sizeof(std::uint32_t));
  scalars_.assign(std::span<const float>(scalars));
  paints_.upload();
  draw_rows_.bind_storage(0);
  scalars_.bind_storage(1);
}

void MeshStore::forget() {
  paints_.forget();
  earlier_.clear();
}

void MeshStore::prepare(const Frame& frame, const glm::mat4& clip_from_world, float pixel_slope) {
  ++frame_;
  const std::array<glm::vec4, 4> sides = find_sides(clip_from_world);
  std::vector<Choice> choices;
  choices.reserve(frame.draws.size());
  for (const Draw& draw : frame.draws) choices.push_back(choose(draw, frame, pixel_slope));
  make_missing(frame, choices);
  std::vector<Item> items;
  items.reserve(frame.draws.size());
  for (const Draw& draw : frame.draws) {
    const Choice& choice = choices[items.size()];
    Item item = make_item(draw, frame, choice.levels->meshes.at(choice.level), pixel_slope);
    item.row = static_cast<int>(items.size());
    item.id = draw.id;
    item.is_on_screen &= std::all_of(sides.begin(), sides.end(), [&item](const glm::vec4& side) {
      return glm::dot(glm::vec3(side), item.centre_world) + side.w > -item.radius;
    });
    items.push_back(std::move(item));
  }
  drop_unseen();
  compare_with_earlier(items, frame);
  upload_rows(items);
  std::vector<std::size_t> order(items.size());  // rows of items are long: these are sorted instead
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&items](std::size_t i, std::size_t j) {
    return items[i].eye_distance < items[j].eye_distance;
  });
  items_.clear();
  items_.reserve(items.size());
  for (const std::size_t i : order) items_.push_back(std::move(items[i]));
}

void MeshStore::bind_vertices() const {
  glBindVertexArray(vertex_array_.get());
}

void MeshStore::draw(const Item& item, Part part) const {
  const StoredMesh& stored = *item.stored;
  const DrawnMesh& shape = stored.shape;
  glVertexArrayVertexBuffer(vertex_array_.get(), 0, stored.vertices.name(), 0, sizeof(DrawnVertex));
  glVertexArrayElementBuffer(vertex_array_.get(), stored.indices.name());
  const auto draw_range = [&item](GLenum kind, std::uint32_t from, std::uint32_t count) {
    if (count == 0) return;
    const std::uintptr_t offset = from * sizeof(std::uint32_t);
    glDrawElementsInstancedBaseInstance(kind, static_cast<GLsizei>(count), GL_UNSIGNED_INT,
                                        reinterpret_cast<const void*>(offset), 1,
                                        static_cast<GLuint>(item.row));
  };
  const std::uint32_t faces = shape.outer.count + shape.inner.count;
  switch (part) {
    case Part::all:
      return draw_range(GL_TRIANGLES, 0, faces + shape.rim.count);
    case Part::outer:
      return draw_range(GL_TRIANGLES, 0, shape.outer.count);
    case Part::rims:
      draw_range(GL_TRIANGLES, shape.rim.first, shape.rim.count);
      return draw_range(GL_LINES, shape.rim_lines.first, shape.rim_lines.count);
    case Part::rim_lines:
      return draw_range(GL_LINES, shape.rim_lines.first, shape.rim_lines.count);
  }
}

Part MeshStore::shadow_part(const Item& item) const {
  return item.stored->shape.inner.count > 0 ? Part::outer : Part::all;
}

}  // namespace shatterbox::render::pass
