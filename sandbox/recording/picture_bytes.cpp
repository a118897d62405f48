#include "sandbox/recording/picture_bytes.h"

#include <algorithm>

#include "render/frame/expand.h"
#include "sandbox/recording/fields.h"

namespace shatterbox::sandbox::recording {

namespace {

constexpr std::size_t kMostLooks = 16;  // of one body

/// What a run of draws is, beside the draws of the picture before, which are passed in their order.
enum class Run : std::uint8_t {
  same,   // the next ones there
  moved,  // the next ones there, with other poses
  gone,   // the next ones there are in this picture no more
  fresh,  // others, told wholly
};

void put_run(Run run, std::size_t count, ByteWriter& out) {
  out.count((static_cast<std::uint64_t>(count) << 2U) | static_cast<std::uint64_t>(run));
}

/// The last row is 0, 0, 0, 1.
template <class Archive, class Matrix>
void pass_pose(Archive& archive, Matrix& matrix) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) archive(matrix[column][row]);
}

bool has_equal_pose(const Placed& a, const Placed& b) {
  return std::memcmp(&a.world_from_body, &b.world_from_body, sizeof a.world_from_body) == 0;
}

bool has_equal_scalars(const Placed& a, const Placed& b) {
  if (a.scalars == b.scalars) return true;
  return a.scalars && b.scalars && a.scalars->size() == b.scalars->size() &&
         std::memcmp(a.scalars->data(), b.scalars->data(), a.scalars->size() * sizeof(float)) == 0;
}

bool is_equal_but_pose(const Placed& a, const Placed& b) {
  return a.mesh->id == b.mesh->id && a.looks == b.looks && a.colour_index == b.colour_index && a.id == b.id &&
         a.casts_shadow == b.casts_shadow && has_equal_scalars(a, b);
}

void put_fresh(const Placed& draw, ByteWriter& out) {
  out.count(draw.mesh->id);
  out.count(draw.looks);
  out(draw.colour_index), out(draw.id), out(draw.casts_shadow);
  out(draw.scalars != nullptr);
  if (draw.scalars) out.array(*draw.scalars);
  pass_pose(out, draw.world_from_body);
}

Placed take_fresh(ByteReader& in, const PictureReader::FindMesh& find_mesh) {
  Placed draw;
  draw.mesh = find_mesh(in.count());
  draw.looks = in.count();
  in(draw.colour_index), in(draw.id), in(draw.casts_shadow);
  bool has_scalars = false;
  in(has_scalars);
  if (has_scalars) {
    std::vector<float> scalars;
    in.array(scalars);
    if (scalars.size() != draw.mesh->positions.size()) throw Unreadable("not one value a vertex");
    draw.scalars = std::make_shared<const std::vector<float>>(std::move(scalars));
  }
  pass_pose(in, draw.world_from_body);
  return draw;
}

/// What a draw is beside those of the picture before.
struct Known {
  Run run = Run::fresh;
  std::size_t place = 0;  // of its like there
};

/// Bodies keep their order from picture to picture: each is looked for behind the one before it.
std::vector<Known> find_known(const std::vector<Placed>& draws, const std::vector<Placed>& last) {
  std::vector<Known> known(draws.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < draws.size() && next < last.size(); ++i) {
    if (draws[i].id == 0) continue;
    const auto like = std::find_if(last.begin() + static_cast<std::ptrdiff_t>(next), last.end(),
                                   [&](const Placed& other) { return other.id == draws[i].id; });
    if (like == last.end()) continue;
    const auto place = static_cast<std::size_t>(like - last.begin());
    next = place + 1;
    if (is_equal_but_pose(draws[i], *like))
      known[i] = {has_equal_pose(draws[i], *like) ? Run::same : Run::moved, place};
  }
  return known;
}

}  // namespace

void put_mesh(const render::Mesh& mesh, ByteWriter& out) {
  out.count(mesh.id);
  pass_mesh(out, mesh);
  out.count(mesh.triangles.size());
  std::uint32_t last = 0;  // corners lie near each other: the differences, the sign in the lowest bit
  for (const glm::uvec3& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t way = triangle[corner] - last;
      out.count((way << 1U) ^ (0U - (way >> 31U)));
      last = triangle[corner];
    }
  }
}

std::shared_ptr<const render::Mesh> take_mesh(ByteReader& in) {
  auto mesh = std::make_shared<render::Mesh>();
  mesh->id = in.count();
  pass_mesh(in, *mesh);
  mesh->triangles.resize(in.count_of(3));
  std::uint32_t last = 0;
  for (glm::uvec3& triangle : mesh->triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto way = static_cast<std::uint32_t>(in.count());
      last += (way >> 1U) ^ (0U - (way & 1U));
      triangle[corner] = last;
    }
  }
  try {
    render::check(*mesh);
  } catch (const std::invalid_argument& fault) {
    throw Unreadable(fault.what());
  }
  return mesh;
}

void put_looks(const std::vector<render::Look>& looks, ByteWriter& out) {
  out.count(looks.size());
  for (const render::Look& look : looks) pass_look(out, look);
}

std::vector<render::Look> take_looks(ByteReader& in) {
  const std::uint64_t count = in.count();
  if (count == 0 || count > kMostLooks) throw Unreadable("a body with no looks, or with too many");
  std::vector<render::Look> looks(static_cast<std::size_t>(count));
  for (render::Look& look : looks) pass_look(in, look);
  return looks;
}

std::uint64_t LookNumbers::number_of(const std::vector<render::Look>& looks) {
  ByteWriter out;
  put_looks(looks, out);
  const auto [place, is_new] = numbers_.try_emplace(out.bytes(), all_.size());
  if (is_new) all_.push_back(out.take());
  return place->second;
}

void PictureWriter::put(const render::Frame& picture, LookNumbers& looks, ByteWriter& out) {
  ByteWriter stage;
  pass_stage(stage, picture);
  const bool has_new_stage = stage.bytes() != stage_;
  out(has_new_stage);
  if (has_new_stage) out(stage.bytes());
  if (has_new_stage) stage_ = stage.take();
  std::vector<Placed> draws;
  draws.reserve(picture.draws.size());
  for (const render::Draw& draw : picture.draws)
    draws.push_back({draw.mesh, draw.scalars, looks.number_of(draw.looks), draw.colour_index, draw.id,
                     draw.casts_shadow, draw.world_from_body});
  put_draws(draws, out);
  last_ = std::move(draws);
}

void PictureWriter::put_draws(const std::vector<Placed>& draws, ByteWriter& out) const {
  const std::vector<Known> known = find_known(draws, last_);
  out.count(draws.size());
  std::size_t next = 0;  // of the last picture's, for the reader
  for (std::size_t i = 0; i < draws.size();) {
    const Known& first = known[i];
    std::size_t count = 1;
    const auto goes_on = [&](const Known& other) {
      return other.run == first.run && (first.run == Run::fresh || other.place == first.place + count);
    };
    while (i + count < draws.size() && goes_on(known[i + count])) ++count;
    if (first.run != Run::fresh) {
      if (first.place > next) put_run(Run::gone, first.place - next, out);
      next = first.place + count;
    }
    put_run(first.run, count, out);
    for (const std::size_t end = i + count; i < end; ++i) {
      if (first.run == Run::fresh) put_fresh(draws[i], out);
      if (first.run == Run::moved) pass_pose(out, draws[i].world_from_body);
    }
  }
}

void PictureWriter::forget() {
  stage_.clear();
  last_.clear();
}

render::Frame PictureReader::take(ByteReader& in, const std::vector<std::vector<render::Look>>& looks,
                                  const FindMesh& find_mesh) {
  bool has_new_stage = false;
  in(has_new_stage);
  if (has_new_stage) {
    std::string bytes;
    in(bytes);
    ByteReader stage(bytes);
    pass_stage(stage, stage_.emplace());
  }
  if (!stage_) throw Unreadable("a picture like the one before, and there is none before");
  last_ = take_draws(in, find_mesh);
  render::Frame picture = *stage_;
  picture.draws.reserve(last_.size());
  for (const Placed& placed : last_) {
    if (placed.looks >= looks.size()) throw Unreadable("a look that there is not");
    picture.draws.push_back({placed.mesh, placed.world_from_body, looks[placed.looks], placed.scalars,
                             placed.colour_index, placed.casts_shadow, placed.id});
  }
  return picture;
}

std::vector<Placed> PictureReader::take_draws(ByteReader& in, const FindMesh& find_mesh) const {
  const std::uint64_t total = in.count();
  if (total > kMostDraws) throw Unreadable("too many bodies in one picture");
  std::vector<Placed> draws;
  std::size_t next = 0;  // of the last picture's
  while (draws.size() < total) {
    const std::uint64_t word = in.count(), count = word >> 2U;
    const auto run = static_cast<Run>(word & 3U);
    const bool is_known = run != Run::fresh;
    if (count == 0 || (is_known && count > last_.size() - next) ||
        (run != Run::gone && count > total - draws.size()))
      throw Unreadable("bodies that are not there");
    for (std::uint64_t i = 0; i < count; ++i) {
      if (run == Run::fresh) draws.push_back(take_fresh(in, find_mesh));
      if (run == Run::same || run == Run::moved) draws.push_back(last_[next]);
      if (run == Run::moved) pass_pose(in, draws.back().world_from_body);
      if (is_known) ++next;
    }
  }
  return draws;
}

void PictureReader::forget() {
  stage_.reset();
  last_.clear();
}

}  // namespace shatterbox::sandbox::recording
