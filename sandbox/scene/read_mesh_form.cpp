#include "sandbox/scene/read_mesh_form.h"

#include <filesystem>

#include <fmt/format.h>

#include "engine/geometry/tetrahedralise.h"
#include "sandbox/scene/nearest_name.h"

namespace shatterbox::sandbox::scene {

namespace {

constexpr const char* kGlmarkFolder = "/usr/share/glmark2/";  // of a package, for the scene of the bunny

/// What shapes there are for a kind of body.
struct Shapes {
  const char* kind;
  std::vector<std::string> known;
};
const Shapes kShellShapes{
    "shell", {"ornament", "sphere", "bowl", "wine_glass", "pane", "boat", "vase", "bottle", "egg", "lathe"}};
const Shapes kSolidShapes{"solid", {"sphere", "slab", "bricks", "vase", "bottle", "egg", "figure", "lathe"}};
/// What goes by another name here.
struct OtherName {
  const char *name, *what, *hint;
};
constexpr const char* kBox = "a box that may break is a slab";
constexpr const char* kSlab =
    "write kind = \"solid\", shape = \"slab\", size = [0.2, 0.1, 0.1]; a kind = \"box\" never breaks";
constexpr const char* kGlass = "a drinking glass or cup is a high bowl, or a wine_glass";
constexpr const char* kTumbler =
    "write kind = \"shell\", shape = \"bowl\", radius = 0.037, foot_radius = 0.03, foot_height = 0, "
    "height = 0.1, thickness = 0.0015; or shape = \"wine_glass\"";
constexpr const char* kTurned = "what is round about an axis is turned on a lathe";
constexpr const char* kColumn =
    "write shape = \"lathe\", profile = [[0.1, 0], [0.1, 1]]: a radius and a height in metres for each "
    "point, from one end to the other";
constexpr const char* kSheet = "a flat sheet is a pane";
constexpr const char* kPane = "write kind = \"shell\", shape = \"pane\", width = 0.3, height = 0.2";
constexpr OtherName kOtherNames[] = {
    {"box", kBox, kSlab},
    {"cube", kBox, kSlab},
    {"block", kBox, kSlab},
    {"brick", kBox, kSlab},
    {"plate", "a plate is a low bowl",
     "write kind = \"shell\", shape = \"bowl\" with radius, foot_radius and height, as the scene plate_stack "
     "does"},
    {"sheet", kSheet, kPane},
    {"panel", kSheet, kPane},
    {"window", kSheet, kPane},
    {"glass", kGlass, kTumbler},
    {"tumbler", kGlass, kTumbler},
    {"cup", kGlass, kTumbler},
    {"mug", kGlass, kTumbler},
    {"cylinder", kTurned, kColumn},
    {"column", kTurned, kColumn},
    {"pillar", kTurned, kColumn},
    {"cone", kTurned, kColumn},
    {"tube", kTurned, kColumn},
    {"pipe", kTurned, kColumn},
    {"ring", kTurned, kColumn},
    {"torus", kTurned, kColumn},
};
const std::vector<std::string> kShapeKeys{"radius",       "neck_radius",    "neck_height",  "cap",
                                          "foot_radius",  "foot_height",    "height",       "width",
                                          "brick",        "edge_length",    "length",       "beam",
                                          "depth",        "sheer",          "belly_radius", "rim_radius",
                                          "wall",         "neck_length",    "stem_radius",  "stem_length",
                                          "blunt_height", "pointed_height", "profile",      "smooth"};

/// Where a mesh file named in a scene lies: beside the scene, or, as one that is named at its call may, where
/// the program runs.
std::string find_mesh_file(const std::string& file, const std::string& scene_file) {
  namespace fs = std::filesystem;
  const fs::path path(file);
  if (path.is_absolute()) return file;
  const fs::path beside = (fs::path(scene_file).parent_path() / path).lexically_normal();
  std::error_code code;
  const bool is_here = !fs::exists(beside, code) && fs::is_regular_file(path, code);
  return is_here ? fs::absolute(path).string() : beside.string();
}

std::optional<MeshFileShape> read_mesh_files(TableReader& reader, const SceneDescription& scene) {
  const TomlValue* value = reader.value("mesh");
  MeshFileShape shape;
  shape.place = value->place;
  std::vector<const TomlValue*> names;
  if (value->is_array()) {
    for (const TomlValue& item : value->items) names.push_back(&item);
  } else {
    names.push_back(value);
  }
  for (const TomlValue* name : names) {
    if (!name->is_text()) {
      reader.add_problem(name->place,
                         fmt::format("mesh must be the name of a file, but is {}", kind_in_words(*name)),
                         "write mesh = \"file.obj\", or a list of files that are one body");
      return std::nullopt;
    }
    shape.files.push_back(find_mesh_file(name->text, scene.file));
    std::error_code code;
    if (!std::filesystem::is_regular_file(shape.files.back(), code)) {
      reader.add_problem(name->place, fmt::format("there is no mesh file {}", shape.files.back()),
                         shape.files.back().starts_with(kGlmarkFolder)
                             ? "it comes with Debian's package: sudo apt install glmark2-data"
                             : "files are looked for beside the scene, and where you are; .obj, .ply, .stl, "
                               ".glb, .gltf and .3ds are read");
    }
  }
  if (names.empty()) reader.add_problem_at("mesh", "mesh names no file");
  return shape;
}

SlabShape read_slab(TableReader& reader) {
  SlabShape slab;
  slab.size = reader.number_or_vector("size", extent()).value_or(slab.size);
  if (!reader.has("size"))
    reader.add_problem(reader.table().place, fmt::format("{} has no size", reader.what()),
                       "add size = [x, y, z] in metres");
  return slab;
}

/// One brick of a wall; of a German one, if its size is not given.
SlabShape read_brick(TableReader& reader, MeshForm& form) {
  SlabShape brick;
  brick.size = reader.vector("brick", extent()).value_or(Vec3(0.24, 0.071, 0.115));
  form.wall = reader.vector("size", extent());
  if (!reader.has("size"))
    reader.add_problem(
        reader.table().place, fmt::format("{} has no size", reader.what()),
        "add the size of the whole wall, size = [x, y, z] in metres; brick = [x, y, z] is that of one");
  return brick;
}

struct NamedSize {
  const char* key;
  double* size;  // m, as it usually is
};

/// A size and others that follow it in proportion, unless they are given.
void read_scaled(TableReader& reader, NamedSize lead, const std::vector<NamedSize>& others) {
  const double usual = *lead.size;
  *lead.size = reader.number(lead.key, extent()).value_or(usual);
  for (const NamedSize& other : others)
    *other.size = reader.number(other.key, extent()).value_or(*other.size * (*lead.size / usual));
}

void read_size(TableReader& reader, const char* key, double& size) {
  size = reader.number(key, extent()).value_or(size);
}

geometry::OrnamentSizes read_ornament(TableReader& reader) {
  geometry::OrnamentSizes sizes;
  read_size(reader, "radius", sizes.radius);
  sizes.neck_radius = 0.225 * sizes.radius;
  sizes.neck_height = 0.2 * sizes.radius;
  read_size(reader, "neck_radius", sizes.neck_radius);
  read_size(reader, "neck_height", sizes.neck_height);
  sizes.has_cap = reader.truth("cap").value_or(true);
  return sizes;
}

geometry::BowlSizes read_bowl(TableReader& reader) {
  geometry::BowlSizes sizes;
  read_size(reader, "radius", sizes.rim_radius);
  sizes.foot_radius = 0.44 * sizes.rim_radius;
  sizes.foot_height = 0.075 * sizes.rim_radius;
  sizes.height = 0.875 * sizes.rim_radius;
  read_size(reader, "foot_radius", sizes.foot_radius);
  sizes.foot_height = reader.number("foot_height", not_negative("m")).value_or(sizes.foot_height);
  read_size(reader, "height", sizes.height);
  return sizes;
}

PaneShape read_pane(TableReader& reader) {
  PaneShape sizes;
  read_size(reader, "width", sizes.width);
  read_size(reader, "height", sizes.height);
  return sizes;
}

geometry::BoatSizes read_boat(TableReader& reader) {
  geometry::BoatSizes sizes;
  read_size(reader, "length", sizes.length);
  sizes.beam = 0.4 * sizes.length;
  sizes.depth = 0.2 * sizes.length;
  sizes.sheer = 0.1 * sizes.length;
  read_size(reader, "beam", sizes.beam);
  read_size(reader, "depth", sizes.depth);
  sizes.sheer = reader.number("sheer", not_negative("m")).value_or(sizes.sheer);
  return sizes;
}

void refuse_wall(TableReader& reader) {
  reader.foreign({"wall"}, "how thick the wall of a shell is, is its thickness");
}

MeshShape read_vase(TableReader& reader, bool is_sheet) {
  geometry::VaseSizes sizes;
  std::vector<NamedSize> others{{"foot_radius", &sizes.foot_radius},
                                {"belly_radius", &sizes.belly_radius},
                                {"neck_radius", &sizes.neck_radius},
                                {"rim_radius", &sizes.rim_radius}};
  if (!is_sheet) others.push_back({"wall", &sizes.wall});
  read_scaled(reader, {"height", &sizes.height}, others);
  if (!is_sheet) return sizes;
  refuse_wall(reader);
  return VaseSheet{sizes};
}

MeshShape read_bottle(TableReader& reader, bool is_sheet) {
  geometry::BottleSizes sizes;
  std::vector<NamedSize> others{
      {"radius", &sizes.radius}, {"neck_radius", &sizes.neck_radius}, {"neck_length", &sizes.neck_length}};
  // A sheet's wall is its thickness; here it only rounds the edge of the bottom.
  const double edge = sizes.wall * reader.number("height", extent()).value_or(sizes.height) / sizes.height;
  if (!is_sheet) others.push_back({"wall", &sizes.wall});
  read_scaled(reader, {"height", &sizes.height}, others);
  if (!is_sheet) return sizes;
  refuse_wall(reader);
  sizes.wall = edge;
  return BottleSheet{sizes};
}

geometry::WineGlassSizes read_wine_glass(TableReader& reader) {
  geometry::WineGlassSizes sizes;
  read_scaled(reader, {"height", &sizes.height},
              {{"radius", &sizes.radius},
               {"rim_radius", &sizes.rim_radius},
               {"foot_radius", &sizes.foot_radius},
               {"stem_radius", &sizes.stem_radius},
               {"stem_length", &sizes.stem_length}});
  return sizes;
}

geometry::EggSizes read_egg(TableReader& reader) {
  geometry::EggSizes sizes;
  read_scaled(reader, {"radius", &sizes.radius},
              {{"blunt_height", &sizes.blunt_height}, {"pointed_height", &sizes.pointed_height}});
  return sizes;
}

geometry::LatheSizes read_lathe(TableReader& reader, bool is_sheet) {
  geometry::LatheSizes lathe;
  lathe.is_closed = !is_sheet;
  lathe.is_smooth = reader.truth("smooth").value_or(false);
  const TomlValue* value = reader.value("profile");
  const auto refuse = [&](const Place& place, std::string message) {
    reader.add_problem(place, std::move(message), kColumn);
    return lathe;
  };
  if (value == nullptr) return refuse(reader.table().place, fmt::format("{} has no profile", reader.what()));
  if (!value->is_array()) return refuse(value->place, "profile must be a list of points");
  for (const TomlValue& point : value->items) {
    if (!point.is_array() || point.items.size() != 2)
      return refuse(point.place, "a point of a profile is a radius and a height");
    const auto radius = reader.as_number(point.items[0], "the radius of a point", not_negative("m"));
    const auto height = reader.as_number(point.items[1], "the height of a point", coordinate());
    if (!radius || !height) return lathe;
    lathe.profile.emplace_back(*radius, *height);
  }
  if (const auto fault = geometry::find_fault(lathe)) return refuse(value->place, *fault);
  return lathe;
}

FigureShape read_figure(TableReader& reader) {
  FigureShape sizes;
  read_size(reader, "height", sizes.height);
  return sizes;
}

MeshShape read_shape(TableReader& reader, const std::string& shape, bool is_sheet) {
  if (shape == "slab") return read_slab(reader);
  if (shape == "ornament") return read_ornament(reader);
  if (shape == "bowl") return read_bowl(reader);
  if (shape == "pane") return read_pane(reader);
  if (shape == "boat") return read_boat(reader);
  if (shape == "vase") return read_vase(reader, is_sheet);
  if (shape == "bottle") return read_bottle(reader, is_sheet);
  if (shape == "wine_glass") return read_wine_glass(reader);
  if (shape == "figure") return read_figure(reader);
  if (shape == "egg") return read_egg(reader);
  if (shape == "lathe") return read_lathe(reader, is_sheet);
  SphereShape sizes;
  read_size(reader, "radius", sizes.radius);
  return sizes;
}

/// The name of a shape; nothing, and it is said why, if there is none of that name for this kind of body.
std::optional<std::string> read_shape_name(TableReader& reader, const Shapes& shapes) {
  const auto has = [](const Shapes& some, const std::string& name) {
    return std::find(some.known.begin(), some.known.end(), name) != some.known.end();
  };
  const Shapes& others = &shapes == &kShellShapes ? kSolidShapes : kShellShapes;
  const TomlValue* value = reader.table().find("shape");
  const OtherName* other = std::find_if(
      std::begin(kOtherNames), std::end(kOtherNames),
      [&](const OtherName& o) { return value != nullptr && value->is_text() && value->text == o.name; });
  if (other != std::end(kOtherNames)) {
    reader.value("shape");
    reader.add_problem(value->place, other->what, other->hint);
    return std::nullopt;
  }
  if (value == nullptr || !value->is_text() || has(shapes, value->text) || !has(others, value->text))
    return reader.choice("shape", shapes.known);
  reader.value("shape");
  reader.add_problem(value->place, fmt::format("\"{}\" is the shape of a {}", value->text, others.kind),
                     fmt::format("write kind = \"{}\"", others.kind));
  return std::nullopt;
}

/// What a shape is stretched to, if anything.
std::optional<Vec3> read_whole_size(TableReader& reader, const std::string& shape) {
  const TomlValue* size = reader.value("size");
  const bool is_vector = size != nullptr && size->is_array() && size->items.size() == 3;
  if (shape != "pane" || size == nullptr || is_vector) return reader.vector("size", extent());
  reader.add_problem(size->place, "a pane has a width and a height",
                     "write width = 0.3, height = 0.2 in place of size");
  return std::nullopt;
}

void read_mesh_form(TableReader& reader, const SceneDescription& scene, const Shapes& shapes,
                    MeshForm& form) {
  if (reader.has("mesh") && reader.has("shape")) {
    reader.add_problem_at("shape", "a body has either a mesh or a shape, not both", "remove one of them");
  }
  if (reader.has("mesh")) {
    if (auto files = read_mesh_files(reader, scene)) form.shape = std::move(*files);
    std::vector<std::string> foreign = kShapeKeys;
    if (&shapes == &kShellShapes) {
      form.edge_length = reader.number("edge_length", extent());
      std::erase(foreign, "edge_length");
    }
    reader.foreign(foreign, "sizes belong to a shape; a mesh takes scale or size = [x, y, z]");
    form.size = reader.vector("size", extent());
    reader.value("shape");
  } else {
    const auto shape = read_shape_name(reader, shapes);
    if (!reader.has("shape")) {
      reader.add_problem(
          reader.table().place, fmt::format("{} has neither a mesh nor a shape", reader.what()),
          fmt::format("add mesh = \"file.obj\", or shape = one of {}", quoted_list(shapes.known)));
    }
    reader.value("mesh");
    if (shape == "bricks")
      form.shape = read_brick(reader, form);
    else
      form.shape = read_shape(reader, shape.value_or("sphere"), &shapes == &kShellShapes);
    form.edge_length = reader.number("edge_length", extent());
    if (shape) {
      reader.foreign(kShapeKeys, fmt::format("it is no size of shape \"{}\"", *shape));
    } else {
      for (const std::string& key : kShapeKeys) reader.value(key);  // one fault is enough
      reader.value("size");
    }
    if (shape && shape != "slab" && shape != "bricks") form.size = read_whole_size(reader, *shape);
  }
  form.scale = reader.number_or_vector("scale", positive()).value_or(form.scale);
  if (form.size && reader.has("scale")) {
    reader.add_problem_at("size", "a body has either a scale or a size, not both", "remove one of them");
  }
  form.up_is_z = reader.choice("up", {"y", "z"}).value_or("y") == "z";
  if (const auto origin = reader.choice("origin", {"file", "middle", "foot"}))
    form.origin = *origin == "foot"     ? MeshOrigin::foot
                  : *origin == "middle" ? MeshOrigin::middle
                                        : MeshOrigin::file;
  form.is_breakable = reader.truth("breakable").value_or(true);
}

}  // namespace

const std::vector<std::string>& shape_keys() {
  return kShapeKeys;
}

ShellForm read_shell(TableReader& reader, const SceneDescription& scene) {
  ShellForm form;
  read_mesh_form(reader, scene, kShellShapes, form);
  form.thickness = reader.number("thickness", extent());
  return form;
}

SolidForm read_solid(TableReader& reader, const SceneDescription& scene) {
  SolidForm form;
  read_mesh_form(reader, scene, kSolidShapes, form);
  form.element_size = reader.number("element_size", extent());
  if (const auto grading = reader.whole_number("grading", 1, 8)) {
    form.grading = static_cast<int>(*grading);
    if (!geometry::is_grading(*form.grading))
      reader.add_problem_at("grading", fmt::format("elements inside cannot be {} times as large", *grading),
                            "eight of them join to one, and these again: 2, 4 or 8");
  }
  return form;
}

}  // namespace shatterbox::sandbox::scene
