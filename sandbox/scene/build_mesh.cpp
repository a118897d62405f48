#include "sandbox/scene/build_mesh.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/core/elementary.h"
#include "engine/geometry/edge_topology.h"
#include "engine/geometry/finer_triangles.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/mesh_diagnosis.h"
#include "sandbox/scene/mesh_file.h"

namespace shatterbox::sandbox::scene {

namespace {

constexpr double kUsualTriangles = 5000.0;
constexpr double kTrianglesOfFigure = 20000.0;  // fingers and armour want more
constexpr double kStationsOfBoat = 15.0;        // 300 triangles
constexpr double kHardlyMeant = 10.0;  // m, across what is to break: more likely its file is in millimetres

geometry::PartedMesh one_part(geometry::TriangleMesh mesh) {
  geometry::PartedMesh parted{std::move(mesh), {}};
  parted.parts.assign(parted.mesh.triangles.size(), geometry::Part::body);
  return parted;
}

core::Result<geometry::PartedMesh> with_parts(core::Result<geometry::TriangleMesh> mesh) {
  if (!mesh) return core::Error{mesh.error()};
  return one_part(std::move(mesh.value()));
}

struct Generate {
  geometry::Meshing meshing;

  core::Result<geometry::PartedMesh> operator()(const geometry::OrnamentSizes& sizes) const {
    return geometry::make_ornament(sizes, meshing);
  }
  core::Result<geometry::PartedMesh> operator()(const SphereShape& sizes) const {
    return with_parts(geometry::make_sphere(sizes.radius, meshing));
  }
  core::Result<geometry::PartedMesh> operator()(const geometry::BowlSizes& sizes) const {
    return with_parts(geometry::make_bowl(sizes, meshing));
  }
  core::Result<geometry::PartedMesh> operator()(const PaneShape& sizes) const {
    return with_parts(geometry::make_pane(sizes.width, sizes.height, meshing));
  }
  core::Result<geometry::PartedMesh> operator()(const geometry::BoatSizes& sizes) const {
    return with_parts(geometry::make_boat(sizes, meshing));
  }
  core::Result<geometry::PartedMesh> operator()(const geometry::VaseSizes& sizes) const {
    return with_parts(geometry::make_vase(sizes, meshing));
  }
  core::Result<geometry::PartedMesh> operator()(const geometry::BottleSizes& sizes) const {
    return with_parts(geometry::make_bottle(sizes, meshing));
  }
  core::Result<geometry::PartedMesh> operator()(const geometry::EggSizes& sizes) const {
    return with_parts(geometry::make_egg(sizes, meshing));
  }
  core::Result<geometry::PartedMesh> operator()(const BottleSheet& sheet) const {
    return with_parts(geometry::make_bottle_sheet(sheet.sizes, meshing));
  }
  core::Result<geometry::PartedMesh> operator()(const VaseSheet& sheet) const {
    return with_parts(geometry::make_vase_sheet(sheet.sizes, meshing));
  }
  core::Result<geometry::PartedMesh> operator()(const geometry::WineGlassSizes& sizes) const {
    return with_parts(geometry::make_wine_glass(sizes, meshing));
  }
  core::Result<geometry::PartedMesh> operator()(const geometry::LatheSizes& sizes) const {
    return with_parts(geometry::make_lathe(sizes, meshing));
  }
  core::Result<geometry::PartedMesh> operator()(const FigureShape& figure) const {
    return with_parts(geometry::make_figure(figure.height, meshing));
  }
  core::Result<geometry::PartedMesh> operator()(const SlabShape& slab) const {
    return one_part(geometry::make_box_surface(0.5 * slab.size));
  }
  core::Result<geometry::PartedMesh> operator()(const MeshFileShape&) const {
    return core::Error{"not a generated shape"};
  }
};

double widest_radius(const geometry::LatheSizes& lathe) {
  double widest = 0.0;
  for (const Vec2& point : lathe.profile) widest = std::max(widest, point.x());
  return widest;
}

/// A length that the shape is large against: the first, coarse mesh only tells its area.
double coarse_edge(const MeshShape& shape) {
  if (const auto* ornament = std::get_if<geometry::OrnamentSizes>(&shape)) return 0.2 * ornament->radius;
  if (const auto* sphere = std::get_if<SphereShape>(&shape)) return 0.2 * sphere->radius;
  if (const auto* bowl = std::get_if<geometry::BowlSizes>(&shape)) return 0.2 * bowl->rim_radius;
  if (const auto* boat = std::get_if<geometry::BoatSizes>(&shape)) return boat->length / kStationsOfBoat;
  if (const auto* slab = std::get_if<SlabShape>(&shape)) return slab->size.maxCoeff();
  if (const auto* vase = std::get_if<geometry::VaseSizes>(&shape)) return 0.2 * vase->neck_radius;
  if (const auto* bottle = std::get_if<geometry::BottleSizes>(&shape)) return 0.2 * bottle->neck_radius;
  if (const auto* sheet = std::get_if<BottleSheet>(&shape)) return 0.2 * sheet->sizes.neck_radius;
  if (const auto* sheet = std::get_if<VaseSheet>(&shape)) return 0.2 * sheet->sizes.neck_radius;
  if (const auto* figure = std::get_if<FigureShape>(&shape)) return figure->height / 40.0;
  if (const auto* glass = std::get_if<geometry::WineGlassSizes>(&shape)) return 0.2 * glass->radius;
  if (const auto* egg = std::get_if<geometry::EggSizes>(&shape)) return 0.2 * egg->radius;
  if (const auto* lathe = std::get_if<geometry::LatheSizes>(&shape)) return 0.2 * widest_radius(*lathe);
  const auto& pane = std::get<PaneShape>(shape);
  return 0.1 * std::min(pane.width, pane.height);
}

/// m, of so many triangles that are alike.
double edge_length_of(const geometry::TriangleMesh& mesh, double triangles) {
  return core::sqrt(geometry::surface_area(mesh) / triangles * 4.0 / core::sqrt(3.0));
}

core::Result<geometry::PartedMesh> generate(const MeshForm& form) {
  Generate generator;
  if (form.edge_length) {
    generator.meshing.edge_length = *form.edge_length;
    return std::visit(generator, form.shape);
  }
  generator.meshing.edge_length = coarse_edge(form.shape);
  auto coarse = std::visit(generator, form.shape);
  if (!coarse || std::holds_alternative<geometry::BoatSizes>(form.shape) ||
      std::holds_alternative<SlabShape>(form.shape))
    return coarse;
  const bool is_figure = std::holds_alternative<FigureShape>(form.shape);
  generator.meshing.edge_length =
      edge_length_of(coarse.value().mesh, is_figure ? kTrianglesOfFigure : kUsualTriangles);
  return std::visit(generator, form.shape);
}

void append(geometry::TriangleMesh& whole, const geometry::TriangleMesh& part) {
  const int first = static_cast<int>(whole.positions.size());
  whole.positions.insert(whole.positions.end(), part.positions.begin(), part.positions.end());
  for (const geometry::Triangle& t : part.triangles) {
    whole.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

std::optional<geometry::PartedMesh> read_files(const MeshFileShape& shape, const Place& place,
                                               Problems& problems, std::vector<std::string>& notes) {
  geometry::TriangleMesh whole;
  std::string names;
  for (const std::string& file : shape.files) {
    auto mesh = read_mesh(file, &notes);
    if (!mesh) {
      book(problems, place, mesh.error(), "");
      return std::nullopt;
    }
    append(whole, mesh.value());
    names += (names.empty() ? "" : ", ") + file;
  }
  geometry::MendOptions options;
  options.allow_loose_parts = true;
  geometry::MendedMesh mended = geometry::mend(whole, options);
  if (mended.diagnosis.refused()) {
    book(problems, place, fmt::format("the mesh {} cannot be used", names),
         mended.diagnosis.sentences(geometry::Severity::refused));
    return std::nullopt;
  }
  for (const geometry::MeshFinding& finding : mended.diagnosis.findings) {
    notes.push_back(fmt::format("{}: {}", names, finding.sentence));
  }
  return one_part(std::move(mended.mesh));
}

struct Bounds {
  Vec3 least = Vec3::Zero(), most = Vec3::Zero();
};

Bounds bounds_of(const std::vector<Vec3>& positions) {
  Bounds bounds{positions.front(), positions.front()};
  for (const Vec3& p : positions) {
    bounds.least = bounds.least.cwiseMin(p);
    bounds.most = bounds.most.cwiseMax(p);
  }
  return bounds;
}

/// Turns, then stretches to a size (about the origin) or by a scale. False with a problem if a flat side
/// cannot be stretched to the size asked for.
bool fit(geometry::TriangleMesh& mesh, const MeshForm& form, const Place& place, Problems& problems) {
  if (form.up_is_z) {
    for (Vec3& p : mesh.positions) p = Vec3(p.x(), p.z(), -p.y());
  }
  Vec3 scale = form.scale;
  if (form.size) {
    const Bounds bounds = bounds_of(mesh.positions);
    const Vec3 extent = bounds.most - bounds.least;
    const double longest = extent.maxCoeff();
    for (int axis = 0; axis < 3; ++axis) {
      scale[axis] = extent[axis] > 1e-9 * longest ? (*form.size)[axis] / extent[axis] : 1.0;
    }
  }
  for (Vec3& p : mesh.positions) p = p.cwiseProduct(scale);
  const Bounds bounds = bounds_of(mesh.positions);
  const double extent = (bounds.most - bounds.least).maxCoeff();
  if (extent >= 1e-4 && extent <= 1e4) return true;
  book(problems, place, fmt::format("the mesh is {:g} m across", extent),
       "bodies are from 1e-4 to 1e4 m; if the file is in millimetres, write scale = 0.001");
  return false;
}

/// Moves a file's mesh to where its frame is to begin.
void set_origin(geometry::TriangleMesh& mesh, MeshOrigin origin) {
  if (origin == MeshOrigin::file) return;
  const Bounds bounds = bounds_of(mesh.positions);
  Vec3 begin = 0.5 * (bounds.least + bounds.most);
  if (origin == MeshOrigin::foot) begin.y() = bounds.least.y();
  for (Vec3& p : mesh.positions) p -= begin;
}

/// Makes the triangles of a file no larger than that, m.
bool divide(double edge_length, const Place& place, BuiltMesh& built, Problems& problems) {
  // Halving overshoots: there may be four times as many as of that length.
  if (edge_length < edge_length_of(built.mesh, geometry::kMostTriangles / 4.0)) {
    book(problems, place,
         fmt::format("an edge length of {:g} m would make millions of triangles", edge_length),
         fmt::format("with edge_length = {:.2g} there are about {:.0f}", usual_edge_length(built.mesh),
                     kUsualTriangles));
    return false;
  }
  built.mesh = geometry::divide_long_edges(built.mesh, edge_length);
  built.parts.assign(built.mesh.triangles.size(), static_cast<std::uint8_t>(geometry::Part::body));
  return true;
}

}  // namespace

double usual_edge_length(const geometry::TriangleMesh& mesh) {
  return edge_length_of(mesh, kUsualTriangles);
}

std::optional<BuiltMesh> build_mesh(const MeshForm& form, const Place& place, Problems& problems,
                                    std::vector<std::string>& notes) {
  std::optional<geometry::PartedMesh> parted;
  if (const auto* files = std::get_if<MeshFileShape>(&form.shape)) {
    parted = read_files(*files, files->place, problems, notes);
    if (!parted) return std::nullopt;
  } else {
    auto generated = generate(form);
    if (!generated) {
      book(problems, place, generated.error(), "");
      return std::nullopt;
    }
    parted = std::move(generated.value());
  }
  BuiltMesh built{std::move(parted->mesh), {}};
  for (const geometry::Part part : parted->parts) built.parts.push_back(static_cast<std::uint8_t>(part));
  if (!fit(built.mesh, form, place, problems)) return std::nullopt;
  if (const auto* files = std::get_if<MeshFileShape>(&form.shape)) {
    set_origin(built.mesh, form.origin);
    if (form.edge_length && !divide(*form.edge_length, files->place, built, problems)) return std::nullopt;
    const Bounds bounds = bounds_of(built.mesh.positions);
    const double across = (bounds.most - bounds.least).maxCoeff();
    if (across > kHardlyMeant)
      notes.push_back(describe(
          Problem{files->place, fmt::format("the mesh {} is {:.3g} m across", files->files.front(), across),
                  "if the file is in millimetres, write scale = 0.001"}));
  }
  return built;
}

namespace {

/// The height below which a body stands on its foot, in the frame of `turned`.
double foot_top(const Bounds& turned) {
  return turned.least.y() + 0.02 * (turned.most.y() - turned.least.y());
}

Bounds turned_bounds(const geometry::TriangleMesh& mesh, const Quat& rotation) {
  std::vector<Vec3> turned;
  for (const Vec3& p : mesh.positions) turned.push_back(rotation * p);
  return bounds_of(turned);
}

std::string box_hint(const geometry::TriangleMesh& mesh) {
  const Bounds bounds = bounds_of(mesh.positions);
  return fmt::format(
      "the box is in the mesh's own frame, where the mesh reaches from [{:g}, {:g}, {:g}] to "
      "[{:g}, {:g}, {:g}]",
      bounds.least.x(), bounds.least.y(), bounds.least.z(), bounds.most.x(), bounds.most.y(),
      bounds.most.z());
}

}  // namespace

std::vector<world::HalfSpace> find_held(const geometry::TriangleMesh& mesh, const Quat& rotation,
                                        const Support& support, const Place& place, Problems& problems) {
  std::vector<world::HalfSpace> held;
  if (std::holds_alternative<FootSupport>(support))
    held.push_back({rotation.conjugate() * Vec3::UnitY(), foot_top(turned_bounds(mesh, rotation))});
  if (const auto* box = std::get_if<BoxSupport>(&support)) {
    const Bounds bounds = bounds_of(mesh.positions);
    if ((box->least.array() > bounds.most.array()).any() || (box->most.array() < bounds.least.array()).any())
      book(problems, place, "the support's box is beside the mesh", box_hint(mesh));
    for (int axis = 0; axis < 3; ++axis) {
      held.push_back({Vec3::Unit(axis), box->most[axis]});
      held.push_back({-Vec3::Unit(axis), -box->least[axis]});
    }
  }
  return held;
}

std::vector<int> find_clamped(const geometry::TriangleMesh& mesh, const Quat& rotation,
                              const Support& support, const Place& place, Problems& problems) {
  std::vector<bool> is_clamped(mesh.positions.size(), false);
  std::string fault, hint;
  if (std::holds_alternative<EdgeSupport>(support)) {
    const geometry::EdgeTopology topology = geometry::build_edge_topology(mesh.triangles);
    for (std::size_t e = 0; e < topology.edges.size(); ++e) {
      if (!topology.is_boundary(static_cast<int>(e))) continue;
      for (const int v : topology.edges[e]) is_clamped[static_cast<std::size_t>(v)] = true;
    }
    fault = "support = \"edge\", but the mesh has no open border";
    hint = "use \"foot\" or {box = [[x, y, z], [x, y, z]]}";
  } else if (std::holds_alternative<FootSupport>(support)) {
    const double top = foot_top(turned_bounds(mesh, rotation));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      is_clamped[v] = (rotation * mesh.positions[v]).y() <= top;
  } else if (const auto* box = std::get_if<BoxSupport>(&support)) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3& p = mesh.positions[v];
      is_clamped[v] = (p.array() >= box->least.array()).all() && (p.array() <= box->most.array()).all();
    }
    fault = "no vertex of the mesh is in the support's box";
    hint = box_hint(mesh);
  }
  std::vector<int> clamped;
  for (std::size_t v = 0; v < is_clamped.size(); ++v) {
    if (is_clamped[v]) clamped.push_back(static_cast<int>(v));
  }
  if (clamped.empty() && !fault.empty()) book(problems, place, fault, hint);
  return clamped;
}

}  // namespace shatterbox::sandbox::scene
