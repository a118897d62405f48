#include "render/pass/mesh_store.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <stdexcept>

#include "render/gpu/program.h"

namespace shatterbox::render::pass {

void delete_vertex_array(unsigned name) {
  glDeleteVertexArrays(1, &name);
}

namespace {

constexpr std::uint32_t kNone = 0xffffffffU;

// As surface.vert reads them (std430).
struct DrawRow {
  glm::mat4 world_from_body;
  glm::uvec4 looks_scalars;
};
struct LookRow {
  glm::vec4 outside, inside, crack, finish, pattern, pattern_place, more;
};

LookRow to_row(const Look& look) {
  return {glm::vec4(look.outside, look.roughness),
          glm::vec4(look.inside, look.inside_roughness),
          glm::vec4(look.crack, look.crack_roughness),
          glm::vec4(look.metalness, look.inside_metalness, look.clear_coat, look.clear_coat_roughness),
          glm::vec4(look.pattern_colour, look.pattern_metalness),
          glm::vec4(look.pattern_centre, std::max(look.pattern_size, 1e-9F)),
          glm::vec4(look.transmission, static_cast<float>(look.pattern), 0.0F, 0.0F)};
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
  return name;
}

// The view frustum's planes (left, right, bottom, top), pointing in, of unit normal.
std::array<glm::vec4, 4> find_sides(const glm::mat4& clip_from_world) {
  const glm::mat4 m = glm::transpose(clip_from_world);
  std::array<glm::vec4, 4> sides = {m[3] + m[0], m[3] - m[0], m[3] + m[1], m[3] - m[1]};
  for (glm::vec4& side : sides) side /= glm::length(glm::vec3(side));
  return sides;
}

}  // namespace

MeshStore::MeshStore() : vertex_array_(create_vertex_array()) {}

MeshStore::Stored& MeshStore::find_or_upload(const Mesh& mesh) {
  const auto known = meshes_.find(mesh.id);
  if (known != meshes_.end()) return known->second;
  Stored stored;
  stored.shape = expand(mesh);
  stored.vertices = gpu::Buffer::of(std::span<const DrawnVertex>(stored.shape.vertices));
  stored.indices = gpu::Buffer::of(std::span<const std::uint32_t>(stored.shape.indices));
  stored.shape.vertices = {};
  stored.shape.indices = {};
  return meshes_.emplace(mesh.id, std::move(stored)).first->second;
}

void MeshStore::drop_unseen() {
  std::erase_if(meshes_, [this](const auto& entry) { return entry.second.last_frame != frame_; });
}

void MeshStore::prepare(const Frame& frame, const glm::mat4& clip_from_world) {
  ++frame_;
  const std::array<glm::vec4, 4> sides = find_sides(clip_from_world);
  std::vector<DrawRow> draws;
  std::vector<LookRow> looks;
  std::vector<float> scalars;
  items_.clear();
  for (const Draw& draw : frame.draws) {
    if (draw.mesh == nullptr) throw std::invalid_argument("a draw without a mesh");
    if (draw.scalars != nullptr && draw.scalars->size() != draw.mesh->positions.size()) {
      throw std::invalid_argument("mesh " + std::to_string(draw.mesh->id) + ": scalars must be one a vertex");
    }
    Stored& stored = find_or_upload(*draw.mesh);
    stored.last_frame = frame_;
    const bool has_scalars = frame.overlay.kind == OverlayKind::stress && draw.scalars != nullptr;
    draws.push_back({draw.world_from_body,
                     {looks.size(), std::max<std::size_t>(draw.looks.size(), 1),
                      has_scalars ? static_cast<std::uint32_t>(scalars.size()) : kNone,
                      draw.colour_index == Draw::kNoColour ? 0U : draw.colour_index + 1U}});
    if (has_scalars) scalars.insert(scalars.end(), draw.scalars->begin(), draw.scalars->end());
    if (draw.looks.empty()) looks.push_back(to_row(Look{}));
    for (const Look& look : draw.looks) looks.push_back(to_row(look));

    Item item;
    item.mesh = draw.mesh->id;
    item.row = static_cast<int>(draws.size()) - 1;
    item.centre_world = glm::vec3(draw.world_from_body * glm::vec4(stored.shape.centre, 1.0F));
    item.radius = stored.shape.radius * glm::length(glm::vec3(draw.world_from_body[0]));
    item.eye_distance = glm::distance(item.centre_world, frame.camera.position);
    item.is_glass = frame.overlay.kind != OverlayKind::pieces &&
                    std::any_of(draw.looks.begin(), draw.looks.end(),
                                [](const Look& look) { return look.transmission > 0.0F; });
    item.is_on_screen = std::all_of(sides.begin(), sides.end(), [&item](const glm::vec4& side) {
      return glm::dot(glm::vec3(side), item.centre_world) + side.w > -item.radius;
    });
    item.casts_shadow = draw.casts_shadow;
    items_.push_back(item);
  }
  drop_unseen();
  std::stable_sort(items_.begin(), items_.end(),
                   [](const Item& a, const Item& b) { return a.eye_distance < b.eye_distance; });
  draw_rows_.assign(std::span<const DrawRow>(draws));
  look_rows_.assign(std::span<const LookRow>(looks));
  scalars_.assign(std::span<const float>(scalars));
  draw_rows_.bind_storage(0);
  look_rows_.bind_storage(1);
  scalars_.bind_storage(2);
}

void MeshStore::bind_vertices() const {
  glBindVertexArray(vertex_array_.get());
}

void MeshStore::draw(const Item& item, Part part) const {
  const Stored& stored = meshes_.at(item.mesh);
  const DrawnMesh& shape = stored.shape;
  glVertexArrayVertexBuffer(vertex_array_.get(), 0, stored.vertices.name(), 0, sizeof(DrawnVertex));
  glVertexArrayElementBuffer(vertex_array_.get(), stored.indices.name());
  gpu::Program::set(0, item.row);
  const auto draw_range = [](IndexRange range) {
    if (range.count == 0) return;
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(std::uintptr_t{range.first} * sizeof(std::uint32_t)));
  };
  if (part == Part::all) draw_range({0, shape.outer.count + shape.inner.count + shape.rim.count});
  if (part == Part::outer || part == Part::outer_and_rim) draw_range(shape.outer);
  if (part == Part::inner) draw_range(shape.inner);
  if (part == Part::outer_and_rim) draw_range(shape.rim);
}

Part MeshStore::shadow_part(const Item& item) const {
  return meshes_.at(item.mesh).shape.inner.count > 0 ? Part::outer : Part::all;
}

}  // namespace shatterbox::render::pass
