// Any bytes as the contents of a recording's parts, the first of which says of which: meshes, pictures one
// after the other, or looks, that are as the renderer wants them, or a sentence. The hash of each part stands
// before all this in a file (tests/sandbox/recording changes every byte of one).
#include "render/frame/expand.h"
#include "sandbox/recording/picture_bytes.h"
#include "tests/fuzz/target.h"

using namespace shatterbox;
using namespace shatterbox::sandbox::recording;

namespace {

std::shared_ptr<const render::Mesh> find_box(std::uint64_t id) {
  static const std::shared_ptr<const render::Mesh> kBox = render::make_box(1, glm::vec3(1.0F));
  if (id > 3) throw Unreadable("a body without a mesh");
  return kBox;
}

void read_mesh(ByteReader& in) {
  const auto mesh = take_mesh(in);
  render::check(*mesh);
  ByteWriter out;
  put_mesh(*mesh, out);
  ByteReader again(out.bytes());
  fuzz::require(take_mesh(again)->triangles == mesh->triangles, "a mesh is read as it is written");
}

void read_pictures(ByteReader& in) {
  const std::vector<std::vector<render::Look>> looks{{render::Look{}}, {render::glass(), render::Look{}}};
  PictureReader reader;
  PictureWriter writer;
  while (!in.is_at_end()) {
    const render::Frame picture = reader.take(in, looks, find_box);
    for (const render::Draw& draw : picture.draws) {
      fuzz::require(draw.mesh != nullptr && !draw.looks.empty(), "a body has a mesh and a look");
      fuzz::require(!draw.scalars || draw.scalars->size() == draw.mesh->positions.size(), "a value a vertex");
    }
    LookNumbers numbers;
    ByteWriter out;
    writer.put(picture, numbers, out);
  }
}

}  // namespace

int fuzz::run_one(std::string_view bytes) {
  if (bytes.empty()) return 0;
  ByteReader in(bytes.substr(1));
  try {
    if (bytes[0] == 'm') read_mesh(in);
    if (bytes[0] == 'p') read_pictures(in);
    if (bytes[0] == 'l') (void)take_looks(in);
  } catch (const Unreadable& fault) {
    require(*fault.what() != '\0', "a sentence");
  }
  return 0;
}
