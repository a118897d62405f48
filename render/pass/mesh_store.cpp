#include "render/pass/mesh_store.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <stdexcept>

#include "render/frame/simplify.h"

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

// Four texels as common/paint.glsl reads them: colour, roughness | metalness, coat, its roughness,
// transmission | pattern colour, kind + metalness / 2 | pattern centre, size.
struct PaintRow {
  glm::vec4 paint, finish, pattern, place;
};
constexpr float kHeatMap = 8.0F;  // a pattern kind of its own
constexpr int kRowsAbreast = 256;
constexpr float kLeastPixels = 0.25F;     // bodies of a smaller radius are not drawn
constexpr float kSeenPixels = 0.4F;       // a surface may be off by so much
constexpr float kLeastTolerance = 1e-7F;  // m; nothing is simplified for eyes so near
constexpr int kAsGiven = -1000;           // a level of its own: not simplified
constexpr GLuint kRowAttribute = 5;

PaintRow to_paint(const Look& look, Face face) {
  PaintRow row{};
  row.place = glm::vec4(look.pattern_centre, std::max(look.pattern_size, 1e-9F));
  switch (face) {
    case Face::outside: {
      const float metal =
          std::clamp(look.pattern_metalness, 0.0F, 1.0F) * 0.499F;  // stays below the next kind
      row.paint = glm::vec4(look.outside, look.roughness);
      row.finish = {look.metalness, look.clear_coat, look.clear_coat_roughness, look.transmission};
      row.pattern = glm::vec4(look.pattern_colour, static_cast<float>(look.pattern) + metal);
      if (look.pattern == Pattern::none) row.pattern.w = 0.0F;
      break;
    }
    case Face::inside:
      row.paint = glm::vec4(look.inside, look.inside_roughness);
      row.finish = {look.inside_metalness, 0.5F * look.clear_coat, look.clear_coat_roughness,
                    look.transmission};
      break;
    case Face::crack:  // rims of glass scatter
      row.paint = glm::vec4(look.crack, look.crack_roughness);
      row.finish = {0.0F, 0.0F, 0.1F, 0.25F * look.transmission};
      break;
  }
  return row;
}

// A colour of its own for each piece: hues by the golden ratio, two lightnesses.
glm::vec3 piece_colour(std::uint32_t index) {
  const double turn = static_cast<double>(index) * 0.6180339887498949;
  const auto hue = static_cast<float>(turn - std::floor(turn));
  glm::vec3 c;
  for (int k = 0; k < 3; ++k) {
    const float x = hue + static_cast<float>((3 - k) % 3) / 3.0F;
    c[k] = std::clamp(std::abs((x - std::floor(x)) * 6.0F - 3.0F) - 1.0F, 0.0F, 1.0F);
  }
  return glm::mix(glm::vec3(0.30F), c * c, 0.66F) * ((index & 1U) == 0 ? 0.85F : 0.5F);
}

void lay_over(PaintRow& row, const Draw& draw, const Overlay& overlay, Face face) {
  if (overlay.kind == OverlayKind::pieces && draw.colour_index != Draw::kNoColour) {
    const glm::vec3 own = piece_colour(draw.colour_index);
    row.paint = glm::vec4(face == Face::crack ? glm::mix(own, glm::vec3(0.85F), 0.7F) : own, 0.5F);
    row.finish = {0.0F, 0.4F * row.finish.y, std::max(row.finish.z, 0.1F), 0.0F};
    row.pattern.w = 0.0F;
  }
  if (overlay.kind == OverlayKind::stress && draw.scalars != nullptr && face != Face::crack) {
    row.paint.w = 0.5F;
    row.finish = {0.0F, 0.4F * row.finish.y, std::max(row.finish.z, 0.1F), 0.5F * row.finish.w};
    row.pattern.w = kHeatMap;
  }
}

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

// Shells are drawn as coarsely as the eye does not see: in steps, so that it rarely changes.
int level_of(const Draw& draw, glm::vec3 centre_body, float radius, glm::vec3 eye, float pixel_slope) {
  if (draw.mesh->surface != Surface::shell) return kAsGiven;
  const float scale = glm::length(glm::vec3(draw.world_from_body[0]));
  const glm::vec3 centre(draw.world_from_body * glm::vec4(centre_body, 1.0F));
  const float nearest = glm::distance(centre, eye) - radius * scale;
  const float tolerance = kSeenPixels * pixel_slope * nearest / scale;
  return tolerance > kLeastTolerance ? static_cast<int>(std::floor(std::log2(tolerance))) : kAsGiven;
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

const StoredMesh& MeshStore::find_or_upload(const Mesh& mesh, int level, Levels& levels) {
  const auto known = levels.meshes.find(level);
  if (known != levels.meshes.end()) return known->second;
  StoredMesh stored;
  stored.id = next_id_++;
  stored.shape = expand(level == kAsGiven ? mesh : simplify(mesh, std::exp2(static_cast<float>(level))));
  stored.vertices = gpu::Buffer::of(std::span<const DrawnVertex>(stored.shape.vertices));
  stored.indices = gpu::Buffer::of(std::span<const std::uint32_t>(stored.shape.indices));
  stored.shape.vertices = {};
  stored.shape.indices = {};
  return levels.meshes.emplace(level, std::move(stored)).first->second;
}

void MeshStore::drop_unseen() {
  std::erase_if(meshes_, [this](const auto& entry) { return entry.second.last_frame != frame_; });
}

std::uint32_t MeshStore::add_paints(const Draw& draw, const Overlay& overlay) {
  constexpr std::size_t kFloats = sizeof(PaintRow) / sizeof(float);
  const auto first = static_cast<std::uint32_t>(paint_rows_.size() / kFloats);
  const std::vector<Look> plain(1);
  for (const Look& look : draw.looks.empty() ? plain : draw.looks) {
    for (const Face face : {Face::outside, Face::inside, Face::crack}) {
      PaintRow row = to_paint(look, face);
      lay_over(row, draw, overlay, face);
      if (row.pattern.w >= 1.0F) pattern_kinds_ |= 1U << static_cast<unsigned>(row.pattern.w);
      const auto* values = reinterpret_cast<const float*>(&row);
      paint_rows_.insert(paint_rows_.end(), values, values + kFloats);
    }
  }
  return first;
}

void MeshStore::upload_paints() {
  constexpr std::size_t kFloatsAbreast = kRowsAbreast * sizeof(PaintRow) / sizeof(float);
  const auto lines = static_cast<int>((paint_rows_.size() + kFloatsAbreast - 1) / kFloatsAbreast);
  paint_rows_.resize(static_cast<std::size_t>(lines) * kFloatsAbreast, 0.0F);
  if (paints_.height() < std::max(lines, 1)) {
    paints_ = gpu::Texture(4 * kRowsAbreast, std::max(2 * lines, 1), GL_RGBA32F, gpu::Filter::nearest);
  }
  if (lines > 0) {
    glTextureSubImage2D(paints_.name(), 0, 0, 0, 4 * kRowsAbreast, lines, GL_RGBA, GL_FLOAT,
                        paint_rows_.data());
  }
}

void MeshStore::prepare(const Frame& frame, const glm::mat4& clip_from_world, float pixel_slope) {
  ++frame_;
  const std::array<glm::vec4, 4> sides = find_sides(clip_from_world);
  std::vector<DrawRow> draws;
  std::vector<float> scalars;
  items_.clear();
  paint_rows_.clear();
  pattern_kinds_ = 0;
  for (const Draw& draw : frame.draws) {
    if (draw.mesh == nullptr) throw std::invalid_argument("a draw without a mesh");
    if (draw.scalars != nullptr && draw.scalars->size() != draw.mesh->positions.size()) {
      throw std::invalid_argument("mesh " + std::to_string(draw.mesh->id) + ": scalars must be one a vertex");
    }
    Levels& levels = find_or_measure(*draw.mesh);
    levels.last_frame = frame_;
    const bool has_scalars = frame.overlay.kind == OverlayKind::stress && draw.scalars != nullptr;
    draws.push_back({draw.world_from_body,
                     {add_paints(draw, frame.overlay), std::max<std::size_t>(draw.looks.size(), 1),
                      has_scalars ? static_cast<std::uint32_t>(scalars.size()) : kNone, 0U}});
    if (has_scalars) scalars.insert(scalars.end(), draw.scalars->begin(), draw.scalars->end());

    Item item;
    const int level = has_scalars
                          ? kAsGiven
                          : level_of(draw, levels.centre, levels.radius, frame.camera.position, pixel_slope);
    item.stored = &find_or_upload(*draw.mesh, level, levels);
    const DrawnMesh& shape = item.stored->shape;
    item.row = static_cast<int>(draws.size()) - 1;
    item.world_from_body = draw.world_from_body;
    item.centre_world = glm::vec3(draw.world_from_body * glm::vec4(shape.centre, 1.0F));
    item.radius = shape.radius * glm::length(glm::vec3(draw.world_from_body[0]));
    item.eye_distance = glm::distance(item.centre_world, frame.camera.position);
    item.rim_pixels = draw.mesh->thickness * glm::length(glm::vec3(draw.world_from_body[0])) /
                      std::max(pixel_slope * item.eye_distance, 1e-9F);
    item.is_glass = frame.overlay.kind != OverlayKind::pieces &&
                    std::any_of(draw.looks.begin(), draw.looks.end(),
                                [](const Look& look) { return look.transmission > 0.0F; });
    const bool is_dust = item.radius < kLeastPixels * pixel_slope * item.eye_distance;
    item.is_on_screen = !is_dust && std::all_of(sides.begin(), sides.end(), [&item](const glm::vec4& side) {
      return glm::dot(glm::vec3(side), item.centre_world) + side.w > -item.radius;
    });
    item.casts_shadow = draw.casts_shadow && !is_dust;
    items_.push_back(item);
  }
  drop_unseen();
  std::stable_sort(items_.begin(), items_.end(),
                   [](const Item& a, const Item& b) { return a.eye_distance < b.eye_distance; });
  draw_rows_.assign(std::span<const DrawRow>(draws));
  std::vector<std::uint32_t> rows(std::max<std::size_t>(draws.size(), 1));
  std::iota(rows.begin(), rows.end(), 0U);
  rows_.assign(std::span<const std::uint32_t>(rows));
  glVertexArrayVertexBuffer(vertex_array_.get(), 1, rows_.name(), 0, sizeof(std::uint32_t));
  scalars_.assign(std::span<const float>(scalars));
  upload_paints();
  draw_rows_.bind_storage(0);
  scalars_.bind_storage(1);
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
      return draw_range(GL_LINES, shape.crack_lines.first, shape.crack_lines.count);
    case Part::crack_lines:
      return draw_range(GL_LINES, shape.crack_lines.first, shape.crack_lines.count);
  }
}

Part MeshStore::shadow_part(const Item& item) const {
  return item.stored->shape.inner.count > 0 ? Part::outer : Part::all;
}

}  // namespace shatterbox::render::pass
