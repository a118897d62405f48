#include "render/frame/expand.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>

#include "render/frame/corner_table.h"

namespace shatterbox::render {
namespace {

using Corner = std::uint32_t;  // 3 * triangle + 0, 1 or 2

glm::vec3 unit_or(glm::vec3 v, glm::vec3 otherwise) {
  const float length = glm::length(v);
  return length > 0.0F && std::isfinite(length) ? v / length : otherwise;
}

bool is_crack_face(const Mesh& mesh, std::size_t triangle) {
  return mesh.surface == Surface::solid && !mesh.cracks.empty() && (mesh.cracks[triangle] & kCrackFace) != 0;
}

// Corners about each vertex, as rows of one array.
struct Fans {
  std::vector<std::uint32_t> first;  // |V| + 1
  std::vector<Corner> corners;       // 3|T|
};

Fans find_fans(const Mesh& mesh) {
  Fans fans{std::vector<std::uint32_t>(mesh.positions.size() + 1, 0),
            std::vector<Corner>(mesh.triangles.size() * 3)};
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++fans.first[t[k] + 1];
  }
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) fans.first[v + 1] += fans.first[v];
  std::vector<std::uint32_t> next(fans.first.begin(), fans.first.end() - 1);
  for (Corner c = 0; c < fans.corners.size(); ++c) {
    fans.corners[next[mesh.triangles[c / 3][static_cast<int>(c % 3)]]++] = c;
  }
  return fans;
}

std::vector<glm::vec3> crease_normals(const Mesh& mesh, const Fans& fans, const FaceNormals& faces) {
  const float least_cosine = std::cos(glm::radians(mesh.crease_angle));
  std::vector<glm::vec3> normals(mesh.triangles.size() * 3);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const std::span<const Corner> fan(fans.corners.data() + fans.first[v], fans.first[v + 1] - fans.first[v]);
    bool is_smooth = false;  // no two faces have a crease between them: one normal for all corners
    for (std::size_t k = 0; k < fan.size(); ++k) {
      if (is_smooth) {
        normals[fan[k]] = normals[fan[0]];
        continue;
      }
      const glm::vec3 own = faces.unit[fan[k] / 3];
      glm::vec3 sum(0.0F);
      float least = 1.0F;
      for (const Corner other : fan) {
        const glm::vec3 n = faces.unit[other / 3];
        const float cosine = crease_cosine(mesh, faces.unit, other / 3, fan[k] / 3);
        least = std::min(least, cosine);
        if (cosine >= least_cosine) sum += n * faces.weight[other];
      }
      normals[fan[k]] = unit_or(sum, unit_or(own, glm::vec3(0.0F, 1.0F, 0.0F)));
      // All within half the angle of one are within all of it of each other; a little less, for rounding.
      is_smooth = k == 0 && glm::dot(sum, sum) > 0.0F && 2.0F * least * least - 1.0F > least_cosine + 1e-5F &&
                  least > 0.0F;
    }
  }
  return normals;
}

// The angles at the corners, 3|T|, radians.
std::vector<float> find_angles(const Mesh& mesh) {
  std::vector<float> angles(mesh.triangles.size() * 3);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::uvec3 v = mesh.triangles[t];
    const glm::vec3 p[3] = {mesh.positions[v.x], mesh.positions[v.y], mesh.positions[v.z]};
    glm::vec3 along[3];  // from corner to corner
    for (std::size_t k = 0; k < 3; ++k) along[k] = unit_or(p[(k + 1) % 3] - p[k], glm::vec3(0.0F));
    for (std::size_t k = 0; k < 3; ++k)
      angles[3 * t + k] = std::acos(std::clamp(-glm::dot(along[k], along[(k + 2) % 3]), -1.0F, 1.0F));
  }
  return angles;
}

// How far a vertex moves for one metre of offset of the faces about it; longer at a fold, at most twice.
std::vector<glm::vec3> offset_directions(const Mesh& mesh, const Fans& fans, const FaceNormals& faces) {
  std::vector<glm::vec3> out(mesh.positions.size(), glm::vec3(0.0F));
  const std::vector<float> angles = find_angles(mesh);
  for (std::size_t v = 0; v < out.size(); ++v) {
    glm::vec3 sum(0.0F);
    float weight = 0.0F;
    for (std::uint32_t i = fans.first[v]; i < fans.first[v + 1]; ++i) {
      const Corner c = fans.corners[i];
      sum += faces.unit[c / 3] * angles[c];
      weight += angles[c];
    }
    if (weight <= 0.0F) continue;
    const glm::vec3 direction = unit_or(sum, glm::vec3(0.0F));
    out[v] = direction / std::max(0.5F, glm::length(sum) / weight);
  }
  return out;
}

// Corners whose edge (to the next corner) belongs to one triangle only.
std::vector<Corner> find_boundary(const Mesh& mesh) {
  CornerTable table;
  table.read(mesh);
  std::vector<Corner> boundary;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (table.opposite(CornerTable::previous(4 * t + k)) == CornerTable::kNone)
        boundary.push_back(3 * t + k);
    }
  }
  return boundary;
}

// Collects drawn vertices, sharing those of one source, face, part and normal.
class Builder {
 public:
  Builder(const Mesh& mesh, DrawnMesh& out) : mesh_(mesh), out_(out), newest_(mesh.positions.size(), -1) {}

  std::uint32_t vertex(std::uint32_t source, Face face, std::uint8_t part, glm::vec3 normal,
                       glm::vec3 shift) {
    DrawnVertex v{mesh_.positions[source] + shift, pack(normal),
                  mesh_.pattern_positions.empty() ? mesh_.positions[source] : mesh_.pattern_positions[source],
                  source, static_cast<std::uint32_t>(face) | (static_cast<std::uint32_t>(part) << 8U)};
    for (std::int64_t i = newest_[source]; i >= 0; i = older_[static_cast<std::size_t>(i)]) {
      const DrawnVertex& known = out_.vertices[static_cast<std::size_t>(i)];
      if (known.face_part == v.face_part && known.normal == v.normal && known.position == v.position) {
        return static_cast<std::uint32_t>(i);
      }
    }
    older_.push_back(newest_[source]);
    newest_[source] = static_cast<std::int64_t>(out_.vertices.size());
    out_.vertices.push_back(v);
    return static_cast<std::uint32_t>(out_.vertices.size() - 1);
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    out_.indices.insert(out_.indices.end(), {a, b, c});
  }

 private:
  static std::array<std::int16_t, 4> pack(glm::vec3 n) {
    const auto level = [](float x) {
      return static_cast<std::int16_t>(x * 32767.0F + (x < 0.0F ? -0.5F : 0.5F));
    };
    return {level(n.x), level(n.y), level(n.z), 0};
  }

  const Mesh& mesh_;
  DrawnMesh& out_;
  std::vector<std::int64_t> newest_, older_;  // chains of drawn vertices of one source
};

void find_bounds(DrawnMesh& out) {
  if (out.vertices.empty()) return;
  out.box_least = out.box_most = out.vertices.front().position;
  for (const DrawnVertex& v : out.vertices) {
    out.box_least = glm::min(out.box_least, v.position);
    out.box_most = glm::max(out.box_most, v.position);
  }
  out.centre = 0.5F * (out.box_least + out.box_most);
  for (const DrawnVertex& v : out.vertices) {
    out.radius = std::max(out.radius, glm::distance(v.position, out.centre));
  }
}

// One face of the mesh, moved by `shift` metres along the offset directions; inside it is turned over.
void add_face(const Mesh& mesh, Face face, const std::vector<glm::vec3>& normals,
              const std::vector<glm::vec3>& offsets, float shift, Builder& builder) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const bool is_crack = is_crack_face(mesh, t);
    const std::uint8_t part = mesh.parts.empty() ? std::uint8_t{0} : mesh.parts[t];
    std::uint32_t v[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t source = mesh.triangles[t][static_cast<int>(k)];
      const glm::vec3 normal = normals[3 * t + k];
      v[k] =
          builder.vertex(source, is_crack ? Face::crack : face, part, face == Face::inside ? -normal : normal,
                         offsets.empty() ? glm::vec3(0.0F) : shift * offsets[source]);
    }
    if (face == Face::inside) std::swap(v[1], v[2]);
    builder.triangle(v[0], v[1], v[2]);
  }
}

// A quad from the outer to the inner face along every boundary edge, smooth along the boundary where it runs
// on; and a line along it: between pieces at their common edge, elsewhere half a thickness from it.
void add_rim(const Mesh& mesh, const FaceNormals& faces, const std::vector<glm::vec3>& offsets,
             Builder& builder, std::vector<std::uint32_t>& rim_lines) {
  const std::vector<Corner> boundary = find_boundary(mesh);
  const float half = 0.5F * mesh.thickness;
  for (const Corner c : boundary) {
    const std::size_t t = c / 3, k = c % 3;
    const std::uint32_t a = mesh.triangles[t][static_cast<int>(k)];
    const std::uint32_t b = mesh.triangles[t][static_cast<int>((k + 1) % 3)];
    const glm::vec3 along = mesh.positions[b] - mesh.positions[a];
    const glm::vec3 out = unit_or(glm::cross(along, faces.unit[t]), glm::vec3(0.0F, 1.0F, 0.0F));
    const bool is_crack = !mesh.cracks.empty() && (mesh.cracks[t] & (1U << k)) != 0;
    const Face face = is_crack ? Face::crack : Face::outside;
    const std::uint8_t part = mesh.parts.empty() ? std::uint8_t{0} : mesh.parts[t];
    const std::uint32_t a_out = builder.vertex(a, face, part, out, half * offsets[a]);
    const std::uint32_t b_out = builder.vertex(b, face, part, out, half * offsets[b]);
    const std::uint32_t a_in = builder.vertex(a, face, part, out, -half * offsets[a]);
    const std::uint32_t b_in = builder.vertex(b, face, part, out, -half * offsets[b]);
    builder.triangle(a_out, a_in, b_in);
    builder.triangle(a_out, b_in, b_out);
    if (is_crack) {
      rim_lines.insert(rim_lines.end(), {a_out, b_out});
      continue;
    }
    // In front of a frame that it touches, not in it.
    const glm::vec3 inset = -half * out;
    rim_lines.push_back(builder.vertex(a, face, part, out, half * offsets[a] + inset));
    rim_lines.push_back(builder.vertex(b, face, part, out, half * offsets[b] + inset));
  }
}

}  // namespace

FaceNormals find_face_normals(const Mesh& mesh) {
  FaceNormals out{std::vector<glm::vec3>(mesh.triangles.size()),
                  std::vector<float>(mesh.triangles.size() * 3)};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::uvec3 v = mesh.triangles[t];
    const glm::vec3 along[3] = {mesh.positions[v.y] - mesh.positions[v.x],
                                mesh.positions[v.z] - mesh.positions[v.y],
                                mesh.positions[v.x] - mesh.positions[v.z]};
    const glm::vec3 area = glm::cross(along[0], along[1]);
    const float size = glm::length(area);
    if (!(size > 0.0F) || !std::isfinite(size)) continue;
    out.unit[t] = area / size;
    const float squares[3] = {glm::dot(along[0], along[0]), glm::dot(along[1], along[1]),
                              glm::dot(along[2], along[2])};
    const float share = size / (squares[0] * squares[1] * squares[2]);
    if (!std::isfinite(share)) continue;
    for (std::size_t k = 0; k < 3; ++k) out.weight[3 * t + k] = share * squares[(k + 1) % 3];
  }
  return out;
}

float crease_cosine(const Mesh& mesh, const std::vector<glm::vec3>& units, std::size_t a, std::size_t b) {
  return is_crack_face(mesh, a) != is_crack_face(mesh, b) ? -1.0F : glm::dot(units[a], units[b]);
}

std::vector<glm::vec3> find_corner_normals(const Mesh& mesh) {
  return crease_normals(mesh, find_fans(mesh), find_face_normals(mesh));
}

void check(const Mesh& mesh) {
  const auto fail = [&](const std::string& what) {
    throw std::invalid_argument("mesh " + std::to_string(mesh.id) + ": " + what);
  };
  for (const glm::uvec3& t : mesh.triangles) {
    if (std::max({t.x, t.y, t.z}) >= mesh.positions.size())
      fail("a triangle names a vertex that is not there");
  }
  const auto fits = [](std::size_t size, std::size_t wanted) { return size == 0 || size == wanted; };
  if (!fits(mesh.parts.size(), mesh.triangles.size())) fail("parts must be one a triangle");
  if (!fits(mesh.cracks.size(), mesh.triangles.size())) fail("cracks must be one a triangle");
  if (!fits(mesh.normals.size(), mesh.triangles.size() * 3)) fail("normals must be three a triangle");
  if (!fits(mesh.pattern_positions.size(), mesh.positions.size()))
    fail("pattern positions must be one a vertex");
}

DrawnMesh expand(const Mesh& mesh) {
  check(mesh);
  DrawnMesh out;
  out.vertices.reserve(4 * mesh.positions.size());
  out.indices.reserve(12 * mesh.triangles.size());
  Builder builder(mesh, out);
  const auto range_since = [&out](std::size_t first) {
    return IndexRange{static_cast<std::uint32_t>(first),
                      static_cast<std::uint32_t>(out.indices.size() - first)};
  };
  const Fans fans = find_fans(mesh);
  const FaceNormals faces = find_face_normals(mesh);
  const std::vector<glm::vec3> normals =
      mesh.normals.empty() ? crease_normals(mesh, fans, faces) : mesh.normals;
  if (mesh.surface == Surface::solid) {
    add_face(mesh, Face::outside, normals, {}, 0.0F, builder);
    out.outer = range_since(0);
  } else {
    const std::vector<glm::vec3> offsets = offset_directions(mesh, fans, faces);
    add_face(mesh, Face::outside, normals, offsets, 0.5F * mesh.thickness, builder);
    out.outer = range_since(0);
    add_face(mesh, Face::inside, normals, offsets, -0.5F * mesh.thickness, builder);
    out.inner = range_since(out.outer.count);
    std::vector<std::uint32_t> rim_lines;
    if (mesh.thickness > 0.0F) add_rim(mesh, faces, offsets, builder, rim_lines);
    out.rim = range_since(out.outer.count + out.inner.count);
    out.rim_lines = {static_cast<std::uint32_t>(out.indices.size()),
                     static_cast<std::uint32_t>(rim_lines.size())};
    out.indices.insert(out.indices.end(), rim_lines.begin(), rim_lines.end());
  }
  find_bounds(out);
  return out;
}

}  // namespace shatterbox::render
