// The exported model: valid by the format's rules, and every body is where the world had it, when it was
// there.
#include <catch2/catch.hpp>
#include <map>

#include "sandbox/model/model_film.h"
#include "sandbox/report/run_tables.h"
#include "sandbox/view/view.h"
#include "tests/sandbox/model/glb_rules.h"
#include "tests/sandbox/run/folder.h"
#include "tests/sandbox/scene/reading.h"

using namespace shatterbox;
using namespace shatterbox::sandbox;

namespace {

constexpr const char* kBreakingPane = R"(# a ball breaks a pane
[[body]]
kind = "plane"
position = [0, -0.3, 0]
[[body]]
name = "crate"
kind = "box"
size = [0.1, 0.2, 0.3]
position = [1, 2, 3]
motion = "static"
[[body]]
name = "wall"
kind = "box"
size = 0.1
position = [-1, 2, 3]
look = "hidden"
[[body]]
name = "pane"
kind = "shell"
shape = "pane"
width = 0.4
height = 0.4
edge_length = 0.04
material = "glass"
support = "edge"
[[body]]
name = "balls"
kind = "sphere"
radius = 0.03
position = [0, 0, 0.2]
velocity = [0, 0, -12]
angular_velocity = [3, 40, 5]
material = "steel"
repeat = {count = 2, spacing = [0.5, 0, 0]}
[camera]
path = [{at = 0, position = [0, 0, 2], target = [0, 0, 0]}, {at = 1, position = [1, 0, 2]}]
)";

constexpr int kFramesPerSecond = 60, kFrames = 24;

/// What the film showed.
struct Shown {
  std::vector<std::map<body::BodyId, Pose>> frames;
  std::map<body::BodyId, std::string> names;
};

/// The film of a scene, as bytes of its model; `shown` gets what was there.
std::string film(const std::string& text, const run::Folder& folder, Shown& shown) {
  const auto reading = scene::read(text);
  INFO(reading.text);
  REQUIRE(reading.scene.has_value());
  scene::Problems problems;
  auto built = scene::build_world(*reading.scene, problems);
  REQUIRE(built.has_value());
  view::View view(*reading.scene, *built);
  model::ModelFilm model(*reading.scene, *built, kFramesPerSecond, 16.0 / 9.0);
  report::RunTables tables(folder.path().string());
  for (int frame = 0; frame < kFrames; ++frame) {
    const double time = built->world.time();
    const view::Moment moment{time, time, 1.0, built->world.bodies()};
    model.add(moment, view.camera_at(moment));
    CHECK(tables.add(frame, time, time, moment.bodies).empty());
    auto& here = shown.frames.emplace_back();
    for (const body::Body& body : moment.bodies) {
      if (body.shape->kind == body::ShapeKind::plane || body.name == "wall") continue;
      here[body.id] = body.pose;
      shown.names[body.id] = body.name;
    }
    for (int step = 0; step < 4; ++step) built->world.step();
  }
  REQUIRE(model.write(folder / "film.glb").empty());
  CHECK(tables.close(built->world).empty());
  return run::read_text(folder / "film.glb");
}

const nlohmann::json* find_named(const nlohmann::json& list, const std::string& name) {
  for (const auto& entry : list)
    if (entry["name"] == name) return &entry;
  return nullptr;
}

/// The rules that exported models are held to find what breaks them.
void check_damages(const model::Glb& glb) {
  using Json = nlohmann::json;
  const std::pair<const char*, std::function<void(Json&)>> damages[] = {
      {"BUFFER_VIEW_INVALID_BYTE_STRIDE", [](Json& j) { j["bufferViews"][0].erase("byteStride"); }},
      {"BUFFER_VIEW_TARGET_OVERRIDE", [](Json& j) { j["bufferViews"][0].erase("target"); }},
      {"ACCESSOR_INVALID_FORMAT", [](Json& j) { j["accessors"][0]["type"] = "VEC4"; }},
      {"ANIMATION_SAMPLER", [](Json& j) { j["animations"][0]["samplers"][0]["interpolation"] = "SMOOTH"; }},
      {"UNUSED_OBJECT: accessor", [](Json& j) { j["accessors"].push_back(j["accessors"][0]); }},
      {"UNUSED_OBJECT: materials", [](Json& j) { j["materials"].push_back(j["materials"][0]); }},
      {"UNRESOLVED_REFERENCE: meshes", [](Json& j) { j["nodes"][1]["mesh"] = 10000; }},
      {"NODE_LOOP", [](Json& j) { j["nodes"][0]["children"] = {0}; }},
      {"SCENE_NON_ROOT_NODE", [](Json& j) { j["nodes"][0]["children"] = {1}; }},
      {"UNUSED_OBJECT: node", [](Json& j) { j["scenes"][0]["nodes"].erase(1); }},
      {"NODE_ROTATION_NON_UNIT",
       [](Json& j) {
         j["nodes"][1]["rotation"] = {0, 0, 0, 2};
       }},
      {"VALUE_NOT_IN_RANGE",
       [](Json& j) { j["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 1.5; }},
      {"UNDECLARED_EXTENSION", [](Json& j) { j["extensionsUsed"].erase(0); }},
      {"CAMERA", [](Json& j) { j["cameras"][0]["perspective"]["znear"] = 0; }}};
  for (const auto& [rule, damage] : damages) {
    model::Glb damaged = glb;
    damage(damaged.json);
    try {
      check_rules(damaged);
    } catch (const Json::exception&) {  // a later rule stumbled over it
    }
    INFO(rule);
    CHECK(std::any_of(damaged.faults.begin(), damaged.faults.end(),
                      [&rule = rule](const std::string& fault) { return fault.rfind(rule, 0) == 0; }));
  }
}

}  // namespace

TEST_CASE("an exported film of a break is valid glTF and shows each body where and when it was") {
  const run::Folder folder;
  Shown shown;
  const model::Glb glb = model::read_glb(film(kBreakingPane, folder, shown));
  model::Glb checked = glb;
  check_rules(checked);
  for (const std::string& fault : checked.faults) FAIL_CHECK(fault);
  check_damages(glb);
  REQUIRE(shown.names.size() > 6);  // it broke
  REQUIRE(shown.frames.front().size() == 4);

  std::map<body::BodyId, std::size_t> nodes;
  for (std::size_t i = 0; i < glb.json["nodes"].size(); ++i) {
    const auto& node = glb.json["nodes"][i];
    CHECK(node["name"] != "wall");  // hidden in the film too
    if (!node.contains("extras") || !node["extras"].contains("body")) continue;
    const body::BodyId id = node["extras"]["body"];
    CHECK(node["name"] == shown.names[id] + "#" + std::to_string(id));
    nodes[id] = i;
  }
  CHECK(nodes.size() == shown.names.size());
  for (int frame = 0; frame < kFrames; ++frame) {
    const auto time = static_cast<float>(static_cast<double>(frame) / kFramesPerSecond);
    for (const auto& [id, node] : nodes) {
      const auto& here = shown.frames[static_cast<std::size_t>(frame)];
      const auto found = here.find(id);
      const std::vector<float> scale = value_at(glb, node, "scale", time);
      CHECK(scale == std::vector<float>(3, found == here.end() ? 0.0F : 1.0F));
      if (found == here.end()) continue;
      const std::vector<float> place = value_at(glb, node, "translation", time);
      const std::vector<float> turn = value_at(glb, node, "rotation", time);
      const Quat rotation(turn[3], turn[0], turn[1], turn[2]);
      CHECK((Vec3(place[0], place[1], place[2]) - found->second.translation).norm() < 1e-6);
      CHECK(rotation.angularDistance(found->second.rotation) < 1e-6);
    }
  }
  // Before the film plays, what is not born yet is not to be seen.
  for (const auto& [id, node] : nodes)
    CHECK(glb.json["nodes"][node].contains("scale") == (shown.frames.front().count(id) == 0));
}

TEST_CASE("an exported model is in metres with y up, copies share a mesh, crack faces have a material") {
  const run::Folder folder;
  Shown shown;
  const model::Glb glb = model::read_glb(film(kBreakingPane, folder, shown));
  const auto* crate = find_named(glb.json["meshes"], "crate");
  REQUIRE(crate != nullptr);
  const auto& box = glb.at("accessors", (*crate)["primitives"][0]["attributes"]["POSITION"]);
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(box["max"][k].get<double>() == Approx(0.05 * static_cast<double>(k + 1)));
  std::map<std::size_t, int> uses;
  for (const auto& node : glb.json["nodes"])
    if (node.contains("mesh")) ++uses[node["mesh"].get<std::size_t>()];
  CHECK(std::count_if(uses.begin(), uses.end(), [](const auto& use) { return use.second == 2; }) == 1);
  for (const char* name : {"pane outside", "pane inside", "pane crack"})
    CHECK(find_named(glb.json["materials"], name) != nullptr);
  const auto* glass = find_named(glb.json["materials"], "pane outside");
  CHECK((*glass)["extensions"]["KHR_materials_transmission"]["transmissionFactor"] == 1.0);
  CHECK(glb.json["extensionsUsed"].size() >= 1);
  // The level plane is a slab whose top is where the floor is.
  const auto* floor = find_named(glb.json["nodes"], "floor");
  REQUIRE(floor != nullptr);
  const auto& slab =
      glb.at("accessors", glb.at("meshes", (*floor)["mesh"])["primitives"][0]["attributes"]["POSITION"]);
  CHECK((*floor)["translation"][1].get<double>() + slab["max"][1].get<double>() == Approx(-0.3).margin(1e-6));
  // The camera looks along its -z from where it stands to its target.
  const auto first = value_at(glb, 0, "translation", 0.0F), turn = value_at(glb, 0, "rotation", 0.0F);
  CHECK(glb.json["nodes"][0]["camera"] == 0);
  CHECK(first == std::vector<float>{0.0F, 0.0F, 2.0F});
  CHECK((Quat(turn[3], turn[0], turn[1], turn[2]) * Vec3(0, 0, -1) - Vec3(0, 0, -1)).norm() < 1e-6);
  CHECK(glb.json["cameras"][0]["perspective"]["yfov"].get<double>() ==
        Approx(35.0 * 3.14159265358979 / 180.0));
}

TEST_CASE("an exported film is the same to the bit when it is made again, and rest costs no keys") {
  const run::Folder folder;
  Shown shown, again;
  const std::string bytes = film(kBreakingPane, folder, shown);
  CHECK(bytes == film(kBreakingPane, folder, again));
  const model::Glb still = model::open_glb(
      film("[[body]]\nkind = \"box\"\nsize = 1\nposition = [0, 3, 0]\nmotion = \"static\"\n", folder, again));
  CHECK_FALSE(still.json.contains("animations"));
  model::Track<int> track;
  for (const int value : {1, 1, 1, 1, 2, 3, 3, 3}) track.add(static_cast<int>(track.frames().size()), value);
  CHECK(track.values() == std::vector<int>{1, 1, 2, 3, 3});
}

TEST_CASE("the tables of a run tell the poses that the film shows, and both forms the same") {
  const run::Folder folder;
  Shown shown;
  (void)film(kBreakingPane, folder, shown);
  const auto json = nlohmann::json::parse(run::read_text(folder / "trajectories.json"));
  std::istringstream csv(run::read_text(folder / "trajectories.csv"));
  std::string line;
  REQUIRE(std::getline(csv, line));
  std::string header;
  for (const auto& column : json["columns"])
    header += (header.empty() ? "" : ",") + column["name"].get<std::string>();
  CHECK(line == header);
  for (const auto& row : json["rows"]) {
    REQUIRE(std::getline(csv, line));
    std::istringstream cells(line);
    std::string cell;
    for (const auto& value : row) {
      REQUIRE(std::getline(cells, cell, ','));
      CHECK(std::strtod(cell.c_str(), nullptr) == value.get<double>());
    }
    const auto& poses = shown.frames[row[0].get<std::size_t>()];
    const auto pose = poses.find(row[3].get<body::BodyId>());
    if (pose == poses.end()) continue;                                // the hidden one
    CHECK(Vec3(row[4], row[5], row[6]) == pose->second.translation);  // to the bit
  }
  const auto bodies = nlohmann::json::parse(run::read_text(folder / "bodies.json"));
  double mass = 0.0, whole = 0.0;
  for (const auto& row : bodies["rows"]) {
    if (row[1] == "pane") whole = row[6];
    const bool is_piece = row[1].get<std::string>().rfind("pane/", 0) == 0;
    if (is_piece && row[8].is_null()) mass += row[6].get<double>();
    if (is_piece) CHECK_FALSE(row[2].is_null());
    if (row[1] == "pane") CHECK_FALSE(row[8].is_null());  // gone when it broke
  }
  CHECK(mass == Approx(whole).epsilon(1e-9));
  CHECK_FALSE(nlohmann::json::parse(run::read_text(folder / "breaks.json"))["rows"].empty());
  CHECK_FALSE(nlohmann::json::parse(run::read_text(folder / "impacts.json"))["rows"].empty());
}

TEST_CASE("cells of a table: quotes and commas, nothing for nan") {
  const run::Folder folder;
  report::TableFile file(folder.path().string(), "t", {{"a", ""}, {"b_m", "m"}, {"c", "1"}});
  file.add_row({std::string("x, \"y\""), 0.1, 7L});
  file.add_row({std::monostate{}, std::nan(""), 1e300});
  CHECK(file.close().empty());
  CHECK(run::read_text(folder / "t.csv") == "a,b_m,c\n\"x, \"\"y\"\"\",0.1,7\n,,1e+300\n");
  const auto json = nlohmann::json::parse(run::read_text(folder / "t.json"));
  CHECK(json["rows"] == nlohmann::json::parse("[[\"x, \\\"y\\\"\",0.1,7],[null,null,1e300]]"));
  CHECK(json["columns"][1]["unit"] == "m");
  CHECK_FALSE(run::fs::exists(folder / "t.csv.part"));
  report::TableFile nowhere((folder / "none").string(), "t", {{"a", ""}});
  CHECK(nowhere.close().find("none/t.csv cannot be written") != std::string::npos);
}
