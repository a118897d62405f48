// The rest of the rules that Khronos' validator holds a glTF 2.0 file to, as far as they can apply to what we
// write: how objects refer to each other, and the ranges of their values. glb_reading.h has those about
// numbers in buffers.
#pragma once

#include <algorithm>
#include <functional>

#include "tests/sandbox/model/glb_reading.h"

namespace shatterbox::sandbox::model {

/// Every view has the target and stride of its use; together they are the buffer, without a gap or an
/// overlap.
inline void check_views(Glb& glb) {
  std::size_t end = 0;
  for (const auto& view : glb.json.at("bufferViews")) {
    glb.require(view.at("buffer") == 0, "BUFFER_VIEW: there is one buffer");
    glb.require(view.at("byteOffset") == end, "views follow each other");
    end += view.at("byteLength").get<std::size_t>();
    const int target = view.value("target", 0), stride = view.value("byteStride", 0);
    glb.require(target == 0 || target == 34962 || target == 34963, "BUFFER_VIEW_TARGET");
    glb.require((target == 34962) == (stride != 0), "BUFFER_VIEW_INVALID_BYTE_STRIDE: of vertices alone");
    glb.require(stride % 4 == 0 && stride <= 252, "BUFFER_VIEW_INVALID_BYTE_STRIDE");
  }
  glb.require(end == glb.binary.size(), "views are the whole buffer");
}

/// Each accessor is used in one way: in a view of that target, with that type.
inline void check_uses(Glb& glb) {
  std::vector<std::string> use_of(glb.json.at("accessors").size());
  const auto use = [&](const nlohmann::json& number, const std::string& how, int component, int target,
                       const std::string& type) {
    const auto& accessor = glb.at("accessors", number);
    std::string& known = use_of[number.get<std::size_t>()];
    glb.require(known.empty() || known == how, "ACCESSOR: one use each");
    known = how;
    glb.require(accessor.at("componentType") == component && accessor.at("type") == type,
                "ACCESSOR_INVALID_FORMAT: " + how);
    glb.require(glb.at("bufferViews", accessor.at("bufferView")).value("target", 0) == target,
                "BUFFER_VIEW_TARGET_OVERRIDE: " + how);
    glb.require(!accessor.contains("normalized") && !accessor.contains("sparse"), "plain numbers");
  };
  for (const auto& mesh : glb.json.at("meshes"))
    for (const auto& primitive : mesh.at("primitives")) {
      glb.require(primitive.value("mode", 4) == 4, "MESH_PRIMITIVE: triangles");
      for (const auto& [name, accessor] : primitive.at("attributes").items()) {
        glb.require(name == "POSITION" || name == "NORMAL", "MESH_PRIMITIVE_INVALID_ATTRIBUTE");
        use(accessor, name, 5126, 34962, "VEC3");
      }
      use(primitive.at("indices"), "indices", 5125, 34963, "SCALAR");
      const auto indices = glb.numbers<std::uint32_t>(primitive["indices"]);
      for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        glb.require(
            indices[i] != indices[i + 1] && indices[i + 1] != indices[i + 2] && indices[i] != indices[i + 2],
            "MESH_PRIMITIVE_INDICES_DEGENERATE");
        for (std::size_t k = i; k < i + 3; ++k)
          glb.require(indices[k] != 0xFFFFFFFFU, "ACCESSOR_INDEX_PRIMITIVE_RESTART");
      }
    }
  for (const auto& animation : glb.json.value("animations", nlohmann::json::array()))
    for (const auto& channel : animation.at("channels")) {
      const auto& sampler = animation.at("samplers").at(channel.at("sampler").get<std::size_t>());
      const std::string path = channel.at("target").at("path");
      glb.require(path == "translation" || path == "rotation" || path == "scale",
                  "ANIMATION_CHANNEL_TARGET_PATH");
      const std::string how = sampler.value("interpolation", "LINEAR");
      glb.require(how == "LINEAR" || how == "STEP", "ANIMATION_SAMPLER: interpolation");
      use(sampler.at("input"), "times", 5126, 0, "SCALAR");
      use(sampler.at("output"), "values of " + path, 5126, 0, path == "rotation" ? "VEC4" : "VEC3");
    }
  glb.require(std::find(use_of.begin(), use_of.end(), "") == use_of.end(), "UNUSED_OBJECT: accessor");
}

/// Everything that is named by a number is there, and everything that is there is named by one.
inline void check_references(Glb& glb) {
  const auto require_all = [&glb](const char* list, const std::set<std::size_t>& used) {
    const std::size_t count = glb.json.contains(list) ? glb.json[list].size() : 0;
    glb.require(used.empty() || *used.rbegin() < count, std::string("UNRESOLVED_REFERENCE: ") + list);
    glb.require(used.size() == count, std::string("UNUSED_OBJECT: ") + list);
    glb.require(!glb.json.contains(list) || count > 0, std::string("EMPTY_ENTITY: ") + list);
  };
  std::set<std::size_t> views, meshes, cameras, materials;
  for (const auto& accessor : glb.json.at("accessors"))
    views.insert(accessor.at("bufferView").get<std::size_t>());
  for (const auto& node : glb.json.at("nodes")) {
    if (node.contains("mesh")) meshes.insert(node["mesh"].get<std::size_t>());
    if (node.contains("camera")) cameras.insert(node["camera"].get<std::size_t>());
  }
  for (const auto& mesh : glb.json.at("meshes"))
    for (const auto& primitive : mesh.at("primitives"))
      materials.insert(primitive.at("material").get<std::size_t>());
  require_all("bufferViews", views);
  require_all("meshes", meshes);
  require_all("cameras", cameras);
  require_all("materials", materials);
  for (const auto& animation : glb.json.value("animations", nlohmann::json::array())) {
    std::set<std::size_t> samplers;
    for (const auto& channel : animation.at("channels"))
      samplers.insert(channel.at("sampler").get<std::size_t>());
    glb.require(samplers.size() == animation.at("samplers").size(), "UNUSED_OBJECT: sampler");
  }
}

/// The nodes are trees, whose roots are the scene's, and each stands where a node can stand.
inline void check_nodes(Glb& glb) {
  const auto& nodes = glb.json.at("nodes");
  std::vector<int> parents(nodes.size(), 0);
  for (const auto& node : nodes)
    for (const auto& child : node.value("children", nlohmann::json::array()))
      ++parents[child.get<std::size_t>()];
  const auto& scene = glb.at("scenes", glb.json.at("scene"));
  std::set<std::size_t> reached;
  std::function<void(std::size_t)> visit = [&](std::size_t number) {
    const bool is_new = reached.insert(number).second;
    glb.require(is_new, "NODE_LOOP");
    if (!is_new) return;
    for (const auto& child : nodes.at(number).value("children", nlohmann::json::array())) visit(child);
  };
  for (const auto& root : scene.at("nodes")) {
    glb.require(parents.at(root.get<std::size_t>()) == 0, "SCENE_NON_ROOT_NODE");
    visit(root.get<std::size_t>());
  }
  glb.require(reached.size() == nodes.size(), "UNUSED_OBJECT: node");
  for (const int count : parents) glb.require(count <= 1, "NODE_PARENT_OVERRIDE");
  std::set<std::string> names;
  for (const auto& node : nodes) {
    glb.require(!node.contains("matrix"), "NODE_MATRIX_TRS");
    glb.require(node.at("name").is_string() && names.insert(node["name"]).second,
                "each node has a name of its own");
    glb.require(!node.contains("extras") || node["extras"].is_object(), "extras are an object");
    const auto q = node.value("rotation", std::vector<double>{0, 0, 0, 1});
    double squared = 0.0;
    for (const double c : q) squared += c * c;
    glb.require(q.size() == 4 && std::abs(squared - 1.0) < 1e-6, "NODE_ROTATION_NON_UNIT");
    for (const char* path : {"translation", "scale"})
      glb.require(node.value(path, std::vector<double>(3)).size() == 3, "three numbers");
  }
}

/// Factors within their ranges, extensions told and used, cameras that can see.
inline void check_ranges(Glb& glb) {
  const auto is_share = [](const nlohmann::json& value) { return value >= 0.0 && value <= 1.0; };
  std::set<std::string> extensions;
  for (const auto& material : glb.json.at("materials")) {
    const auto& metal = material.at("pbrMetallicRoughness");
    for (const auto& c : metal.at("baseColorFactor"))
      glb.require(is_share(c), "VALUE_NOT_IN_RANGE: baseColorFactor");
    glb.require(metal["baseColorFactor"].size() == 4, "ARRAY_LENGTH: baseColorFactor");
    for (const char* factor : {"metallicFactor", "roughnessFactor"})
      glb.require(is_share(metal.at(factor)), std::string("VALUE_NOT_IN_RANGE: ") + factor);
    const auto own = material.value("extensions", nlohmann::json::object());
    for (const auto& [name, values] : own.items()) {
      extensions.insert(name);
      for (const auto& [key, value] : values.items())
        glb.require(is_share(value), "VALUE_NOT_IN_RANGE: " + key);
    }
  }
  const auto told = glb.json.value("extensionsUsed", std::vector<std::string>{});
  glb.require(
      std::set<std::string>(told.begin(), told.end()) == extensions && told.size() == extensions.size(),
      "UNDECLARED_EXTENSION or one that nobody uses");
  glb.require(!glb.json.contains("extensionsUsed") || !told.empty(), "EMPTY_ENTITY: extensionsUsed");
  for (const auto& camera : glb.json.value("cameras", nlohmann::json::array())) {
    const auto& lens = camera.at("perspective");
    glb.require(camera.at("type") == "perspective" && lens.at("yfov") > 0.0 && lens["yfov"] < 3.14159 &&
                    lens.at("znear") > 0.0 && lens.at("aspectRatio") > 0.0,
                "CAMERA: a lens that sees");
  }
}

inline void check_rules(Glb& glb) {
  check_views(glb);
  check_uses(glb);
  check_references(glb);
  check_nodes(glb);
  check_ranges(glb);
}

}  // namespace shatterbox::sandbox::model
