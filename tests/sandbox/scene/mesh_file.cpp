#include "sandbox/scene/mesh_file.h"

#include <cstring>

#include "engine/geometry/mass_properties.h"
#include "tests/sandbox/scene/mesh_file_folder.h"

namespace shatterbox::sandbox::scene {
namespace {

const char* const kTetrahedronObj =
    "# a comment\nmtllib missing.mtl\no thing\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    "usemtl red\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

std::string number_bytes(const void* data, std::size_t size) {
  return std::string(static_cast<const char*>(data), size);
}

/// A tetrahedron as binary STL.
std::string tetrahedron_stl() {
  const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  std::string bytes(80, ' ');
  const std::uint32_t count = 4;
  bytes += number_bytes(&count, 4);
  for (const auto& face : faces) {
    const float normal[3] = {0, 0, 0};
    bytes += number_bytes(normal, 12);
    for (const int v : face) bytes += number_bytes(corners[v], 12);
    bytes += std::string(2, '\0');
  }
  return bytes;
}

}  // namespace

TEST_CASE("an OBJ comes in with its numbers to the bit") {
  const MeshFileFolder folder;
  const auto path = folder.write("exact.obj",
                                 "v 0.1 1e-3 -12345.678901234567\r\nv +2.5 0.30000000000000004 7\n"
                                 "v 3 1.7976931348623157e300 9 1.0 0.5 0.5 0.5\nf 1/1 2//2 3/3/3\n");
  const auto mesh = read_mesh(path);
  REQUIRE(mesh.ok());
  REQUIRE(mesh.value().positions.size() == 3);
  CHECK(mesh.value().positions[0] == Vec3(0.1, 1e-3, -12345.678901234567));
  CHECK(mesh.value().positions[1] == Vec3(2.5, 0.30000000000000004, 7.0));
  CHECK(mesh.value().positions[2] == Vec3(3.0, 1.7976931348623157e300, 9.0));
  CHECK(mesh.value().triangles == std::vector<geometry::Triangle>{{0, 1, 2}});
}

TEST_CASE("OBJ, STL and PLY of one tetrahedron have its volume and four vertices") {
  const MeshFileFolder folder;
  const std::string ply =
      "ply\nformat ascii 1.0\ncomment none\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
      "float z\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
      "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
  std::string ascii_stl = "solid thing\n";
  for (const char* facet :
       {"0 0 0,0 1 0,1 0 0", "0 0 0,1 0 0,0 0 1", "1 0 0,0 1 0,0 0 1", "0 0 0,0 0 1,0 1 0"}) {
    ascii_stl += "facet normal 0 0 0\nouter loop\nvertex ";
    for (const char* c = facet; *c != '\0'; ++c)
      ascii_stl += *c == ',' ? std::string("\nvertex ") : std::string(1, *c);
    ascii_stl += "\nendloop\nendfacet\n";
  }
  ascii_stl += "endsolid thing\n";
  for (const auto& path : {folder.write("t.obj", kTetrahedronObj), folder.write("t.PLY", ply),
                           folder.write("t.stl", tetrahedron_stl()), folder.write("text.STL", ascii_stl)}) {
    INFO(path);
    std::vector<std::string> notes;
    const auto mesh = read_mesh(path, &notes);
    REQUIRE((mesh.ok() ? "" : mesh.error()) == std::string());
    CHECK(mesh.value().positions.size() == 4);
    CHECK(mesh.value().triangles.size() == 4);
    CHECK(geometry::enclosed_volume(mesh.value()) == Approx(1.0 / 6.0).epsilon(1e-12));
    if (path.extension() == ".stl") {
      REQUIRE(notes.size() == 1);
      CHECK(notes[0].find("8 vertices welded") != std::string::npos);
    }
  }
}

TEST_CASE("glTF and 3DS of one tetrahedron have its volume, where their nodes put it") {
  const MeshFileFolder folder;
  // A node mirrors it, another one, about that, moves it.
  const std::string head =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
          "nodes":[{"children":[1],"translation":[1,2,3]},{"mesh":0,"scale":[1,1,-2]}],
          "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
          "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
                       {"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}],
          "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},
                         {"buffer":0,"byteOffset":48,"byteLength":24}],
          "buffers":[{"byteLength":72)";
  const float corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::uint16_t faces[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  const std::string buffer = number_bytes(corners, 48) + number_bytes(faces, 24);
  const auto whole = [](std::size_t number) {
    const auto small = static_cast<std::uint32_t>(number);
    return number_bytes(&small, 4);
  };
  std::string text = head + "}]}";
  text += std::string((4 - text.size() % 4) % 4, ' ');
  const std::string glb = "glTF" + whole(2) + whole(28 + text.size() + buffer.size()) + whole(text.size()) +
                          "JSON" + text + whole(buffer.size()) + std::string("BIN\0", 4) + buffer;
  folder.write("a b.bin", buffer);
  const auto chunk = [&](std::uint16_t kind, const std::string& content) {
    return number_bytes(&kind, 2) + whole(6 + content.size()) + content;
  };
  const std::uint16_t four = 4, no_flags = 0;
  std::string list = number_bytes(&four, 2);
  for (int f = 0; f < 4; ++f) list += number_bytes(faces + 3 * f, 6) + number_bytes(&no_flags, 2);
  const std::string mesh_chunk =
      chunk(0x4100, chunk(0x4110, number_bytes(&four, 2) + number_bytes(corners, 48)) + chunk(0x4120, list));
  const std::string studio = chunk(
      0x4d4d, chunk(0x0002, whole(3)) + chunk(0x3d3d, chunk(0x4000, std::string("tetra\0", 6) + mesh_chunk)));
  const std::string inside =
      "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"
      "AAACAAEAAAABAAMAAQACAAMAAAADAAIA";
  for (const auto& path :
       {folder.write("t.glb", glb), folder.write("beside.gltf", head + R"(,"uri":"a%20b.bin"}]})"),
        folder.write("in.GLTF", head + ",\"uri\":\"" + inside + "\"}]}"), folder.write("t.3ds", studio)}) {
    INFO(path);
    const auto mesh = read_mesh(path);
    REQUIRE((mesh.ok() ? "" : mesh.error()) == std::string());
    CHECK(mesh.value().positions.size() == 4);
    CHECK(mesh.value().triangles.size() == 4);
    const bool is_moved = path.extension() != ".3ds";
    CHECK(geometry::enclosed_volume(mesh.value()) == Approx(is_moved ? 2.0 / 6.0 : 1.0 / 6.0).epsilon(1e-12));
    if (is_moved) CHECK(mesh.value().positions[3] == Vec3(1.0, 2.0, 1.0));
  }
}

TEST_CASE("polygons are cut into triangles that cover them") {
  const MeshFileFolder folder;
  // A quad, a concave arrow head and a hexagon, with negative numbers and a continued line.
  const auto path =
      folder.write("polygons.obj",
                   "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf -4 -3 \\\n -2 -1\n"
                   "v 10 0 0\nv 12 1 0\nv 10 2 0\nv 11 1 0\nf 5 6 7 8\n"
                   "v 21 0 0\nv 22 1 0\nv 22 2 0\nv 21 3 0\nv 20 2 0\nv 20 1 0\nf 9 10 11 12 13 14\n");
  std::vector<std::string> notes;
  const auto mesh = read_mesh(path, &notes);
  REQUIRE(mesh.ok());
  CHECK(mesh.value().triangles.size() == 2 + 2 + 4);
  CHECK(geometry::surface_area(mesh.value()) == Approx(2.0 + 1.0 + 4.0).epsilon(1e-12));
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].find("3 polygons") != std::string::npos);
}

}  // namespace shatterbox::sandbox::scene
