#include "engine/world/pieces.h"

#include <algorithm>
#include <optional>

#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/fracture/split_shell.h"
#include "engine/world/forms.h"

namespace shatterbox::world {
namespace {

constexpr double kStraight = 0.05;  // of a kerf: what crack faces may be off their course

/// Tips that stopped in this piece's own material.
std::vector<fracture::CrackTip> tips_of_piece(const std::vector<fracture::CrackTip>& tips,
                                              const geometry::ShellMesh& mesh) {
  std::vector<int> elements;
  for (const geometry::ShellCell& cell : mesh.cells) elements.push_back(cell.element);
  std::sort(elements.begin(), elements.end());
  std::vector<fracture::CrackTip> own;
  for (const fracture::CrackTip& tip : tips)
    if (std::binary_search(elements.begin(), elements.end(), tip.element)) own.push_back(tip);
  return own;
}

Piece make_piece(geometry::ShellMesh mesh, const Fragile& parent, const fracture::Decision& decision,
                 double thickness, const geometry::StandingSurface* whole) {
  Piece piece;
  auto fragile = std::make_shared<Fragile>(parent);
  auto& subject = std::get<fracture::ShellSubject>(fragile->subject);
  if (whole) mesh = geometry::divide_at_bends(mesh, *whole, kStraight * kKerf * parent.size);
  subject.mesh = std::make_shared<const geometry::ShellMesh>(std::move(mesh));
  subject.systems = make_systems(subject, subject.systems->shared_stiffness());
  subject.tips = tips_of_piece(decision.tips, *subject.mesh);
  if (decision.dice > 0) subject.material.surface_compression = 0.0;
  piece.is_held = !subject.systems->support().empty();
  if (!piece.is_held) subject.clamped_vertices.clear();
  piece.shape = make_shell_shape(*subject.mesh, *fragile, thickness, whole);
  piece.fragile = std::move(fragile);
  return piece;
}

/// The solid as it is of that material of the parent's, after the decision's cracks.
std::shared_ptr<Fragile> cut_from(const Fragile& parent, const fracture::SolidDecision& decision,
                                  std::shared_ptr<const geometry::SolidComplex> complex) {
  auto fragile = std::make_shared<Fragile>(parent);
  auto& subject = std::get<fracture::SolidSubject>(fragile->subject);
  subject.complex = std::move(complex);
  subject.model = nullptr;
  subject.kept_model = std::make_shared<fracture::KeptSolidModel>();
  subject.first_cut_id += decision.cracks;
  return fragile;
}

Piece make_piece(fracture::SolidPiece split, const Fragile& parent, const fracture::SolidDecision& decision,
                 const geometry::SurfaceDistance* whole) {
  Piece piece;
  const auto complex = std::make_shared<geometry::SolidComplex>(std::move(split.complex));
  const auto fragile = cut_from(parent, decision, complex);
  auto& subject = std::get<fracture::SolidSubject>(fragile->subject);
  piece.is_held = std::any_of(split.mesh.vertex_source.begin(), split.mesh.vertex_source.end(), [&](int v) {
    return std::binary_search(subject.clamped_vertices.begin(), subject.clamped_vertices.end(), v);
  });
  if (!piece.is_held) subject.clamped_vertices.clear();
  piece.shape = make_solid_shape(*complex, *fragile, whole);
  piece.fragile = fragile;
  return piece;
}

/// Where a shell that has cracks already stands.
std::optional<geometry::StandingSurface> standing_of(const Fragile& fragile, const body::Shape& shape) {
  const geometry::ShellMesh& mesh = *std::get<fracture::ShellSubject>(fragile.subject).mesh;
  const bool has_cracks = std::any_of(mesh.corners.begin(), mesh.corners.end(), [](const auto& corner) {
    return corner.side == geometry::SideKind::crack;
  });
  if (!has_cracks) return std::nullopt;
  std::vector<Vec3> placed = shape.surface.positions;
  for (Vec3& p : placed) p += shape.material_from_body;
  return geometry::StandingSurface(mesh, std::move(placed));
}

Pieces split_up(const Fragile& parent, const body::Shape& shape, const fracture::Decision& decision) {
  const std::optional<geometry::StandingSurface> standing = standing_of(parent, shape);
  const geometry::StandingSurface* whole = standing ? &*standing : nullptr;
  fracture::ShellSplit split =
      fracture::split_shell(*decision.mesh, decision.contacts, {kLeastWidth * parent.size, whole});
  Pieces out;
  out.merged_count = split.merged_count;
  double area = 0.0;
  for (const geometry::ShellCell& cell : decision.mesh->cells) area += cell.area;
  out.merged_share = area > 0.0 ? split.merged_area / area : 0.0;
  out.pieces.resize(split.pieces.size());
  core::parallel_for(out.pieces.size(), 1, [&](std::size_t i) {
    out.pieces[i] = make_piece(std::move(split.pieces[i]), parent, decision, shape.thickness, whole);
  });
  return out;
}

/// `last` is what it was before anything joined.
Pieces split_up(const Fragile& parent, std::shared_ptr<const body::Shape> shape,
                const fracture::SolidDecision& decision, fracture::SolidSplitter& splitter,
                const geometry::SurfaceDistance* whole, const Pieces& last) {
  fracture::SolidSplit split = splitter.split();
  Pieces out;
  out.merged_count = split.merged_count;
  const double volume = total_volume(*decision.complex);
  out.merged_share = volume > 0.0 ? split.merged_volume / volume : 0.0;
  out.pieces.resize(split.pieces.size());
  core::parallel_for(out.pieces.size(), 1, [&](std::size_t i) {
    const int before = split.pieces[i].before;
    out.pieces[i] = before < 0 ? make_piece(std::move(split.pieces[i]), parent, decision, whole)
                               : last.pieces[core::at(before)];
  });
  // What was joined again stands where it stood.
  if (out.pieces.size() == 1) out.pieces[0].shape = shape;
  return out;
}

}  // namespace

std::shared_ptr<const Fragile> cracked(const Fragile& whole, const fracture::SolidDecision& decision) {
  return cut_from(whole, decision, decision.complex);
}

Splitter::Splitter(const Fragile& parent, std::shared_ptr<const body::Shape> shape,
                   const EvaluatedImpact& impact)
    : parent_(parent), shape_(std::move(shape)), impact_(impact) {
  const auto* solid = std::get_if<fracture::SolidDecision>(&impact.decision);
  if (!solid) return;
  solid_.emplace(*solid->complex, kLeastWidth * parent.size);
  const std::vector<std::uint8_t>& is_crack_face = shape_->crack_faces;
  if (std::find(is_crack_face.begin(), is_crack_face.end(), 1) == is_crack_face.end()) return;
  standing_ = shape_->surface;
  for (Vec3& p : standing_.positions) p += shape_->material_from_body;
  whole_.emplace(standing_);
}

Pieces Splitter::split() {
  last_ = solid_ ? split_up(parent_, shape_, std::get<fracture::SolidDecision>(impact_.decision), *solid_,
                            whole_ ? &*whole_ : nullptr, last_)
                 : split_up(parent_, *shape_, std::get<fracture::Decision>(impact_.decision));
  return last_;
}

bool Splitter::join(const std::vector<fracture::PieceClash>& clashes) {
  return solid_ && solid_->join(clashes);
}

}  // namespace shatterbox::world
