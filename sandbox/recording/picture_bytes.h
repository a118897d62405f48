// Pictures as bytes: of each only what is new in it since the picture before. Bodies that rest cost nothing,
// one that moves a pose; meshes and looks are told once and named by number.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/frame/frame.h"
#include "sandbox/recording/bytes.h"

namespace shatterbox::sandbox::recording {

/// Draws in all pictures of one frame of the film: more is an error on both sides, so that no file of a few
/// bytes can ask for all the memory there is.
inline constexpr std::size_t kMostDraws = std::size_t{1} << 21U;

void put_mesh(const render::Mesh& mesh, ByteWriter& out);
/// Throws Unreadable also for a mesh whose triangles name vertices that are not there.
std::shared_ptr<const render::Mesh> take_mesh(ByteReader& in);

void put_looks(const std::vector<render::Look>& looks, ByteWriter& out);
std::vector<render::Look> take_looks(ByteReader& in);

/// The numbers of looks, in the order in which they were first seen.
class LookNumbers {
 public:
  std::uint64_t number_of(const std::vector<render::Look>& looks);
  const std::vector<std::string>& all() const { return all_; }

 private:
  std::map<std::string, std::uint64_t> numbers_;
  std::vector<std::string> all_;
};

/// One draw with its looks by number.
struct Placed {
  std::shared_ptr<const render::Mesh> mesh;
  std::shared_ptr<const std::vector<float>> scalars;
  std::uint64_t looks = 0;
  std::uint32_t colour_index = 0, id = 0;
  bool casts_shadow = true;
  glm::mat4 world_from_body{1.0F};
};

/// The pictures of one panel, one after the other.
class PictureWriter {
 public:
  void put(const render::Frame& picture, LookNumbers& looks, ByteWriter& out);
  /// The next picture is told wholly.
  void forget();

 private:
  void put_draws(const std::vector<Placed>& draws, ByteWriter& out) const;

  std::string stage_;         // everything but the draws, as it was told last
  std::vector<Placed> last_;  // the draws
};

class PictureReader {
 public:
  using FindMesh = std::function<std::shared_ptr<const render::Mesh>(std::uint64_t id)>;

  render::Frame take(ByteReader& in, const std::vector<std::vector<render::Look>>& looks,
                     const FindMesh& find_mesh);
  void forget();

 private:
  std::vector<Placed> take_draws(ByteReader& in, const FindMesh& find_mesh) const;

  std::optional<render::Frame> stage_;
  std::vector<Placed> last_;
};

}  // namespace shatterbox::sandbox::recording
