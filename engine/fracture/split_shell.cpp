#include "engine/fracture/split_shell.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "engine/core/disjoint_sets.h"
#include "engine/core/index.h"
#include "engine/core/stop.h"

namespace shatterbox::fracture {
namespace {

using geometry::CellContact;
using geometry::ShellCell;
using geometry::ShellCorner;
using geometry::ShellMesh;
using geometry::SideKind;
using Size = std::size_t;
using core::at;

constexpr int kMergePasses = 8;
constexpr double kSamePlace = 1e-9;  // of a side

/// A crack face in its element, as a stretch of material space.
struct Face {
  int element = 0, id = 0, cell = 0, side = 0;
  Vec3 begin = Vec3::Zero(), end = Vec3::Zero();
};

/// Two crack faces that look at each other, and how much of them.
struct FacePair {
  Size first = 0, second = 0;
  double overlap = 0.0;  // m
};

std::vector<Face> collect_faces(const ShellMesh& mesh) {
  std::vector<Face> faces;
  for (Size c = 0; c < mesh.cells.size(); ++c) {
    const ShellCell& cell = mesh.cells[c];
    for (int s = 0; s < cell.corner_count; ++s) {
      const ShellCorner& from = mesh.corners[at(cell.first_corner + s)];
      if (from.side != SideKind::crack) continue;
      const ShellCorner& to = mesh.corners[at(cell.first_corner + (s + 1) % cell.corner_count)];
      faces.push_back({cell.element, from.side_id, static_cast<int>(c), s,
                       position_in_element(*mesh.elements, cell.element, from.barycentric),
                       position_in_element(*mesh.elements, cell.element, to.barycentric)});
    }
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return std::array{a.element, a.id, a.cell, a.side} < std::array{b.element, b.id, b.cell, b.side};
  });
  return faces;
}

/// Of those faces the ones that are no part of a crack which the whole had.
std::vector<Face> find_new_faces(const ShellMesh& mesh, std::vector<Face> faces,
                                 const geometry::StandingSurface* whole) {
  const auto is_older = [&](const Face& face) {
    const ShellCell& cell = mesh.cells[at(face.cell)];
    const int standing = whole->cell_of(mesh, cell);
    const Vec2 middle =
        0.5 * (mesh.corners[at(cell.first_corner + face.side)].barycentric +
               mesh.corners[at(cell.first_corner + (face.side + 1) % cell.corner_count)].barycentric);
    return standing >= 0 && whole->is_on_crack(standing, face.id, middle);
  };
  if (whole) std::erase_if(faces, is_older);
  return faces;
}

double overlap_of(const Face& a, const Face& b) {
  const Vec3 along = a.end - a.begin;
  const double length = along.norm();
  if (!(length > 0.0) || along.dot(b.end - b.begin) >= 0.0) return 0.0;
  const double from = std::max(0.0, along.dot(b.end - a.begin) / length);
  const double to = std::min(length, along.dot(b.begin - a.begin) / length);
  return to - from > 1e-6 * length ? to - from : 0.0;
}

std::vector<FacePair> pair_faces(const std::vector<Face>& faces) {
  std::vector<FacePair> pairs;
  for (Size i = 0; i < faces.size(); ++i)
    for (Size j = i + 1; j < faces.size(); ++j) {
      if (faces[j].element != faces[i].element || faces[j].id != faces[i].id) break;
      if (faces[j].cell == faces[i].cell) continue;
      const double overlap = overlap_of(faces[i], faces[j]);
      if (overlap > 0.0) pairs.push_back({i, j, overlap});
    }
  return pairs;
}

/// A stretch of a cell's side that becomes closed material.
struct Closing {
  int cell = 0, side = 0, id = 0;
  Vec2 begin = Vec2::Zero(), end = Vec2::Zero();  // in the side's own direction
};

/// The mesh with some stretches of crack closed; sides are divided where a stretch ends inside them.
ShellMesh close_faces(const ShellMesh& mesh, std::vector<Closing> closings) {
  std::sort(closings.begin(), closings.end(), [](const Closing& a, const Closing& b) {
    return std::array{a.cell, a.side, a.id} < std::array{b.cell, b.side, b.id};
  });
  ShellMesh out = mesh;
  out.corners.clear();
  Size next = 0;
  for (Size c = 0; c < mesh.cells.size(); ++c) {
    const ShellCell& cell = mesh.cells[c];
    out.cells[c].first_corner = static_cast<int>(out.corners.size());
    for (int s = 0; s < cell.corner_count; ++s) {
      const ShellCorner& from = mesh.corners[at(cell.first_corner + s)];
      const Vec2 along =
          mesh.corners[at(cell.first_corner + (s + 1) % cell.corner_count)].barycentric - from.barycentric;
      const auto along_side = [&](const Vec2& p) {
        return along.dot(p - from.barycentric) / along.squaredNorm();
      };
      std::vector<Closing> here;
      for (; next < closings.size() && closings[next].cell == static_cast<int>(c) && closings[next].side == s;
           ++next)
        here.push_back(closings[next]);
      std::sort(here.begin(), here.end(), [&](const Closing& a, const Closing& b) {
        return along_side(a.begin) < along_side(b.begin);
      });
      double reached = 0.0;
      Vec2 place = from.barycentric;
      for (const Closing& closing : here) {
        if (along_side(closing.begin) > reached + kSamePlace) {
          out.corners.push_back({place, from.side, from.side_id});
          place = closing.begin;
        }
        out.corners.push_back({place, SideKind::grain, closing.id});
        reached = along_side(closing.end);
        place = closing.end;
      }
      if (here.empty() || reached < 1.0 - kSamePlace) out.corners.push_back({place, from.side, from.side_id});
    }
    out.cells[c].corner_count = static_cast<int>(out.corners.size()) - out.cells[c].first_corner;
  }
  return out;
}

/// One round of joining pieces that are too narrow; false if there was nothing to do.
class Merger {
 public:
  Merger(ShellMesh& mesh, const SplitSettings& settings) : mesh_(mesh), settings_(settings) {}

  bool merge_once(const std::vector<CellContact>& contacts, ShellSplit& split) {
    int count = 0;
    const std::vector<int> label = label_pieces(mesh_.cells.size(), contacts, count);
    const std::vector<Face> faces = collect_faces(mesh_);
    std::vector<double> area(at(count), 0.0), border(at(count), 0.0);
    for (Size c = 0; c < mesh_.cells.size(); ++c) area[at(label[c])] += mesh_.cells[c].area;
    for (const Face& face : faces) border[at(label[at(face.cell)])] += (face.end - face.begin).norm();
    const auto is_narrow = [&](int p) { return 2.0 * area[at(p)] < settings_.least_width * border[at(p)]; };
    if (std::none_of(label.begin(), label.end(), is_narrow)) return false;

    const std::vector<Face> closable = find_new_faces(mesh_, faces, settings_.whole);
    const std::vector<FacePair> pairs = pair_faces(closable);
    std::map<std::pair<int, int>, double> common;  // narrow piece, neighbour: length of their common crack
    for (const FacePair& pair : pairs) {
      const int a = label[at(closable[pair.first].cell)];
      const int b = label[at(closable[pair.second].cell)];
      if (a == b) continue;
      if (is_narrow(a)) common[{a, b}] += pair.overlap;
      if (is_narrow(b)) common[{b, a}] += pair.overlap;
    }
    std::vector<int> partner(at(count), -1);
    std::vector<double> longest(at(count), 0.0);
    for (const auto& [pieces, length] : common)
      if (length > longest[at(pieces.first)]) {
        longest[at(pieces.first)] = length;
        partner[at(pieces.first)] = pieces.second;
      }
    std::vector<Closing> closings;
    for (const FacePair& pair : pairs) {
      const int a = label[at(closable[pair.first].cell)];
      const int b = label[at(closable[pair.second].cell)];
      if (a != b && (partner[at(a)] == b || partner[at(b)] == a))
        close(closable[pair.first], closable[pair.second], closings);
    }
    if (closings.empty()) return false;
    std::vector<char> is_joined(at(count), 0);
    for (int p = 0; p < count; ++p) {
      const int q = partner[at(p)];
      if (q < 0 || (partner[at(q)] == p && q > p)) continue;  // of two that join each other one is counted
      ++split.merged_count;
      is_joined[at(p)] = 1;
    }
    was_merged_.resize(mesh_.cells.size(), 0);
    for (Size c = 0; c < mesh_.cells.size(); ++c) {
      if (!is_joined[at(label[c])] || std::exchange(was_merged_[c], 1)) continue;
      split.merged_area += mesh_.cells[c].area;
    }
    mesh_ = close_faces(mesh_, std::move(closings));
    return true;
  }

 private:
  void close(const Face& a, const Face& b, std::vector<Closing>& closings) {
    if (next_id_ < 0) {
      next_id_ = 0;
      for (const ShellCorner& corner : mesh_.corners)
        if (corner.side != SideKind::element_edge) next_id_ = std::max(next_id_, corner.side_id + 1);
    }
    const int id = next_id_++;
    const auto corner = [this](const Face& f, int end) {
      const ShellCell& cell = mesh_.cells[at(f.cell)];
      return mesh_.corners[at(cell.first_corner + (f.side + end) % cell.corner_count)].barycentric;
    };
    // The common stretch: of the two begins the later one, seen along each face.
    const auto stretch = [&](const Face& f, const Face& g, Vec2& begin, Vec2& end) {
      const Vec3 along = f.end - f.begin;
      const double squared = along.squaredNorm();
      begin = along.dot(g.end - f.begin) > kSamePlace * squared ? corner(g, 1) : corner(f, 0);
      end = along.dot(g.begin - f.begin) < (1.0 - kSamePlace) * squared ? corner(g, 0) : corner(f, 1);
    };
    Closing of_a{a.cell, a.side, id, {}, {}};
    stretch(a, b, of_a.begin, of_a.end);
    closings.push_back(of_a);
    Closing of_b{b.cell, b.side, id, {}, {}};
    stretch(b, a, of_b.begin, of_b.end);
    closings.push_back(of_b);
  }

  ShellMesh& mesh_;
  std::vector<char> was_merged_;  // per cell; empty: none
  const SplitSettings& settings_;
  int next_id_ = -1;
};

}  // namespace

std::vector<int> label_pieces(Size cell_count, const std::vector<CellContact>& contacts, int& piece_count) {
  core::DisjointSets pieces(cell_count);
  for (const CellContact& contact : contacts) pieces.unite(contact.cell_a, contact.cell_b);
  std::vector<int> label(cell_count, -1);
  piece_count = 0;
  for (Size c = 0; c < cell_count; ++c) {
    const int root = pieces.find(static_cast<int>(c));
    label[c] = root == static_cast<int>(c) ? piece_count++ : label[at(root)];
  }
  return label;
}

ShellSplit split_shell(const ShellMesh& mesh, const SplitSettings& settings) {
  return split_shell(mesh, find_cell_contacts(mesh), settings);
}

ShellSplit split_shell(const ShellMesh& mesh, std::vector<CellContact> contacts,
                       const SplitSettings& settings) {
  ShellSplit split;
  ShellMesh whole = mesh;
  for (int pass = 0; settings.least_width > 0.0 && pass < kMergePasses; ++pass) {
    core::stop_if_asked();
    if (!Merger(whole, settings).merge_once(contacts, split)) break;
    contacts = find_cell_contacts(whole);
  }
  int count = 0;
  const std::vector<int> label = label_pieces(whole.cells.size(), contacts, count);
  split.pieces.resize(at(count));
  std::vector<int> own_number(whole.cells.size());
  for (Size c = 0; c < whole.cells.size(); ++c) {
    ShellMesh& piece = split.pieces[at(label[c])];
    ShellCell cell = whole.cells[c];
    own_number[c] = static_cast<int>(piece.cells.size());
    const auto first = whole.corners.begin() + cell.first_corner;
    cell.first_corner = static_cast<int>(piece.corners.size());
    piece.corners.insert(piece.corners.end(), first, first + cell.corner_count);
    piece.cells.push_back(cell);
  }
  std::vector<std::vector<CellContact>> own_contacts(at(count));
  for (CellContact contact : contacts) {
    const int piece = label[at(contact.cell_a)];
    contact.cell_a = own_number[at(contact.cell_a)];
    contact.cell_b = own_number[at(contact.cell_b)];
    own_contacts[at(piece)].push_back(contact);
  }
  for (Size p = 0; p < split.pieces.size(); ++p) {
    core::stop_if_asked();
    split.pieces[p].elements = whole.elements;
    assign_degrees_of_freedom(split.pieces[p], own_contacts[p]);
  }
  std::vector<double> areas;
  for (const ShellMesh& piece : split.pieces) areas.push_back(total_area(piece));
  std::vector<Size> order(split.pieces.size());
  std::iota(order.begin(), order.end(), Size{0});
  std::sort(order.begin(), order.end(),
            [&areas](Size a, Size b) { return areas[a] != areas[b] ? areas[a] > areas[b] : a < b; });
  std::vector<ShellMesh> sorted;
  sorted.reserve(order.size());
  for (const Size p : order) sorted.push_back(std::move(split.pieces[p]));
  split.pieces = std::move(sorted);
  return split;
}

}  // namespace shatterbox::fracture
