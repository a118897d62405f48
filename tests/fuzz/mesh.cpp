// Any bytes as a mesh file, the first of which says of which kind: triangles within their vertices that
// mending either refuses in words or makes fit for contact, or a sentence.
#include "engine/geometry/mesh_diagnosis.h"
#include "sandbox/scene/mesh_text.h"
#include "tests/fuzz/target.h"

using namespace shatterbox;
using namespace shatterbox::sandbox;

int fuzz::run_one(std::string_view bytes) {
  if (bytes.empty()) return 0;
  const auto reader = bytes[0] == 'p'                      ? scene::read_ply
                      : bytes[0] == 's'                    ? scene::read_stl
                      : bytes[0] == 'g' || bytes[0] == '{' ? scene::read_gltf
                      : bytes[0] == 'M'                    ? scene::read_3ds
                                                           : scene::read_obj;
  // All but OBJ say themselves what they are; that may begin with anything.
  const std::string text(bytes);
  try {
    const auto mesh = reader(text, "fuzz", nullptr);
    if (!mesh) {
      require(!mesh.error().empty(), "a sentence");
      return 0;
    }
    const auto count = static_cast<int>(mesh.value().positions.size());
    for (const geometry::Triangle& t : mesh.value().triangles)
      for (const int v : t) require(v >= 0 && v < count, "triangles name vertices that are there");
    const geometry::MendedMesh mended = geometry::mend(mesh.value());
    if (mended.diagnosis.refused())
      require(!mended.diagnosis.sentences(geometry::Severity::refused).empty(), "a refusal says why");
    else
      require(!geometry::diagnose(mended.mesh).refused(), "what was mended is good");
  } catch (const std::exception&) {  // read_mesh tells it as a sentence
  }
  return 0;
}
