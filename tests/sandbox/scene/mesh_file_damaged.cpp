// Files that are no meshes: each is refused in a sentence that says where; none brings the program down.
#include <bit>

#include "engine/core/random.h"
#include "sandbox/scene/mesh_file.h"
#include "tests/sandbox/scene/mesh_file_folder.h"

namespace shatterbox::sandbox::scene {
namespace {

std::string fault_of(const std::filesystem::path& path) {
  const auto mesh = read_mesh(path);
  return mesh.ok() ? "(read)" : mesh.error();
}

void check_says(const std::string& sentence, const std::string& words) {
  INFO(sentence);
  CHECK(sentence.find(words) != std::string::npos);
}

const std::string kPlyHead =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

}  // namespace

TEST_CASE("what is no file is refused") {
  const MeshFileFolder folder;
  check_says(fault_of(folder.path() / "none.obj"), "no such file");
  check_says(fault_of(folder.path()), "folder");
  for (const char* name : {"empty.obj", "empty.ply", "empty.stl"})
    check_says(fault_of(folder.write(name, "")), "empty");
  check_says(fault_of(folder.write("mesh.docx", "hello")), ".obj, .ply, .stl, .glb");
}

TEST_CASE("faults of an OBJ are told with their line") {
  const MeshFileFolder folder;
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  check_says(fault_of(folder.write("a.obj", three + "v 1 2\nf 1 2 3\n")), "a.obj:4: a vertex needs three");
  check_says(fault_of(folder.write("a.obj", "v 0 0 zero\n")), "a.obj:1: the coordinate \"zero\"");
  check_says(fault_of(folder.write("a.obj", "v 0 1.2.3 0\n")), "a.obj:1: the coordinate \"1.2.3\"");
  check_says(fault_of(folder.write("a.obj", three + "v nan 0 0\nf 1 2 4\n")),
             "a.obj:4: the coordinate \"nan\"");
  check_says(fault_of(folder.write("a.obj", three + "v 0 inf 0\nf 1 2 4\n")), "a.obj:4:");
  check_says(fault_of(folder.write("a.obj", three + "v 0 1e999 0\nf 1 2 4\n")), "a.obj:4:");
  check_says(fault_of(folder.write("a.obj", three + "\nf 1 2 4\n")), "a.obj:5: this face names vertex 4");
  check_says(fault_of(folder.write("a.obj", three + "f 1 2 99999999999\n")), "a.obj:4:");
  check_says(fault_of(folder.write("a.obj", three + "f 1 2 99999999999999999999\n")), "a.obj:4:");
  check_says(fault_of(folder.write("a.obj", three + "f 0 1 2\n")), "a.obj:4: vertices count from 1");
  check_says(fault_of(folder.write("a.obj", three + "f -1 -2 -4\n")), "a.obj:4:");
  check_says(fault_of(folder.write("a.obj", three + "f 1 2\n")), "a.obj:4: a face needs at least three");
  check_says(fault_of(folder.write("a.obj", three + "f 1 a 2\n")), "a.obj:4: the corner \"a\"");
  std::string fan = three + "f";
  for (int i = 0; i < 100000; ++i) fan += " 1";
  check_says(fault_of(folder.write("a.obj", fan + "\n")), "a.obj:4: a face of 100000 corners is more than");
  check_says(fault_of(folder.write("a.obj", three)), "no face");
  check_says(fault_of(folder.write("a.obj", "hello, this is a letter\n")), "no vertex");
  check_says(fault_of(folder.write("a.obj", std::string("\x7f"
                                                        "ELF\0\0\1\2",
                                                        8))),
             "binary");
}

TEST_CASE("faults of PLY and STL are told before memory is asked for") {
  const MeshFileFolder folder;
  check_says(fault_of(folder.write("a.ply", kPlyHead + "0 0 0\n1 0 0\n")), "cut short");
  check_says(fault_of(folder.write("a.ply", kPlyHead + "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")), "a.ply");
  check_says(fault_of(folder.write("a.ply", kPlyHead + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n")), "a.ply");
  std::string huge = kPlyHead;
  huge.replace(huge.find("vertex 3"), 8, "vertex 4000000000");
  check_says(fault_of(folder.write("a.ply", huge)), "4000000000");
  huge.replace(huge.find("4000000000"), 10, "99999999999999999999999");
  check_says(fault_of(folder.write("a.ply", huge)), "no number");
  check_says(fault_of(folder.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n")), "end_header");
  check_says(fault_of(folder.write("a.ply", std::string(300, '\x9c'))), "no PLY");
  check_says(fault_of(folder.write("a.stl", std::string(300, '\x9c'))), "cut short, or no STL");
  check_says(fault_of(folder.write("a.stl", "solid x\nfacet normal 0 0 1\nouter loop\n")), "endsolid");
  check_says(fault_of(folder.write("a.stl", std::string(84, '\0'))), "no triangles");
}

TEST_CASE("a PLY whose header or lists promise what is not there is refused at once") {
  const MeshFileFolder folder;
  std::string odd = kPlyHead + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  odd.replace(odd.find("property float y"), 16, "proper[y float y");
  check_says(fault_of(folder.write("a.ply", odd)), "none of a PLY's");  // Assimp reads it for ever
  check_says(fault_of(folder.write("a.ply", kPlyHead + "0 0 0\n1 0 0\n0 1 0\n3333333330 0 1 2\n")),
             "face 1 lacks a number");
  check_says(fault_of(folder.write("a.ply", kPlyHead + "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n")), "no length");
  check_says(fault_of(folder.write("a.ply", kPlyHead + "0 0 0\n1 0 zero\n0 1 0\n3 0 1 2\n")),
             "vertex 2 lacks a number");
  check_says(fault_of(folder.write("a.ply", kPlyHead + "0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n")), "not there");
  check_says(fault_of(folder.write("a.stl",
                                   "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0\nendloop\nendsolid")),
             "a.stl:4: a vertex is not three numbers");
  check_says(
      fault_of(folder.write("a.stl", "solid x\nfacet normal 0 0 1\nouter lop\nvortex 0 0 0\nendsolid")),
      "a.stl:4");
}

TEST_CASE("a PLY is read from bytes of either order, with more than it needs, in double precision") {
  const MeshFileFolder folder;
  const double corners[3][3] = {{0.1, 0.0, 0.0}, {1e100, 0.0, 0.0}, {0.0, -2.5, 0.0}};
  for (const bool is_little : {true, false}) {
    std::string bytes =
        std::string("ply\nformat binary_") + (is_little ? "little" : "big") +
        "_endian 1.0\ncomment c\nelement vertex 3\nproperty double x\nproperty uchar red\n"
        "property double y\nproperty double z\nelement face 1\nproperty char flag\n"
        "property list ushort short vertex_index\nelement edge 1\nproperty int a\nend_header\n";
    const auto put = [&](std::uint64_t bits, int size) {
      for (int i = 0; i < size; ++i)
        bytes += static_cast<char>(bits >> (8 * (is_little ? i : size - 1 - i)) & 255U);
    };
    for (const auto& corner : corners) {
      put(std::bit_cast<std::uint64_t>(corner[0]), 8);
      put(200, 1);
      put(std::bit_cast<std::uint64_t>(corner[1]), 8);
      put(std::bit_cast<std::uint64_t>(corner[2]), 8);
    }
    for (const auto& [bits, size] : {std::pair{255, 1}, {3, 2}, {0, 2}, {1, 2}, {2, 2}, {7, 4}})
      put(static_cast<std::uint64_t>(bits), size);
    const auto mesh = read_mesh(folder.write("b.ply", bytes));
    INFO((mesh.ok() ? "" : mesh.error()));
    REQUIRE(mesh.ok());
    CHECK(mesh.value().positions[1] == Vec3(1e100, 0.0, 0.0));
    CHECK(mesh.value().positions[2] == Vec3(0.0, -2.5, 0.0));
    CHECK(mesh.value().triangles == std::vector<geometry::Triangle>{{0, 1, 2}});
  }
}

TEST_CASE("faults of glTF and 3DS are told, and no number of theirs is believed") {
  const MeshFileFolder folder;
  const auto gltf = [&](const std::string& text) { return fault_of(folder.write("a.gltf", text)); };
  const auto three_of = [](const std::string& uri) {
    return R"({"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
               "accessors":[{"bufferView":0,"componentType":5126,"count":3}],
               "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"uri":)" +
           uri + "}]}";
  };
  check_says(gltf("hello"), "no JSON");
  check_says(gltf("{}"), "no triangles");
  check_says(gltf(R"({"scenes":[{"nodes":[0]}],"nodes":[{"children":[0]}]})"), "in itself");
  check_says(gltf(R"({"scenes":[{"nodes":[7]}]})"), "no number 7 in \"nodes\"");
  check_says(gltf(R"({"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
                     "accessors":[{"bufferView":0,"componentType":5126,"count":4000000000}],
                     "bufferViews":[{"buffer":0,"byteLength":9}],"buffers":[{"uri":"data:;base64,AAAA"}]})"),
             "makes no sense");
  check_says(gltf(three_of(R"("data:;base64,AAAA")")), "beyond its buffer");
  check_says(gltf(R"({"meshes":[{"primitives":[{"attributes":{"POSITION":0},
                     "extensions":{"KHR_draco_mesh_compression":{}}}]}]})"),
             "Draco");
  check_says(gltf(three_of(R"("none.bin")")), "none.bin is not there");
  check_says(gltf(three_of(R"(3)")), "\"uri\" is no text");
  check_says(gltf(R"({"scenes":[{"nodes":[0]}],"nodes":[{"rotation":[0,0,0,0]}]})"),
             "\"rotation\" is all zeros");
  check_says(fault_of(folder.write("a.glb", "glTF\2")), "no glTF 2.0");
  check_says(fault_of(folder.write("a.3ds", "hello, this is a letter")), "no 3DS");
  std::string studio("MM\x20\0\0\0<=\xff\0\0\0", 12);
  studio.resize(32, ' ');
  check_says(fault_of(folder.write("a.3ds", studio)), "beyond what it is in");
}

TEST_CASE("files damaged at random never bring the reader down") {
  const MeshFileFolder folder;
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4 1\n";
  const std::string ply = kPlyHead + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::string stl =
      "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\nendsolid x\n";
  core::Random random(7);
  int refused = 0;
  for (int round = 0; round < 1500; ++round) {
    const int kind = round % 3;
    std::string bytes = kind == 0 ? obj : kind == 1 ? ply : stl;
    for (std::uint64_t n = 1 + random.index(4); n > 0; --n) {
      const std::size_t place = random.index(bytes.size());
      bytes[place] = static_cast<char>(random.index(4) == 0 ? random.index(256) : 32 + random.index(90));
    }
    if (random.index(4) == 0) bytes.resize(random.index(bytes.size()));
    const auto mesh = read_mesh(folder.write(kind == 0 ? "r.obj" : kind == 1 ? "r.ply" : "r.stl", bytes));
    if (!mesh) {
      ++refused;
      CHECK(!mesh.error().empty());
      continue;
    }
    for (const auto& t : mesh.value().triangles)
      for (const int v : t) REQUIRE((v >= 0 && static_cast<std::size_t>(v) < mesh.value().positions.size()));
  }
  CHECK(refused > 100);
}

}  // namespace shatterbox::sandbox::scene
