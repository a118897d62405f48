// Depth, normals and ids whose values geometry foretells.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>

#include "render/output/npz_file.h"
#include "render/renderer.h"
#include "tests/render/frames.h"

using namespace shatterbox::render;
using namespace shatterbox::render::testing;
namespace fs = std::filesystem;

namespace {

/// A box turned about y, a pane of glass before it, over the floor.
Frame boxes() {
  Frame frame = plain_frame();
  frame.ground->height = -0.25F;
  frame.ground->id = 900;
  frame.draws.push_back(at(make_box(1, {1.0F, 1.0F, 1.0F}), {0.5F, 0.5F, 0.0F}));
  frame.draws.back().world_from_body =
      glm::rotate(frame.draws.back().world_from_body, 0.6F, glm::vec3(0, 1, 0));
  frame.draws.back().id = 70000;
  frame.draws.push_back(at(make_box(2, {1.0F, 1.0F, 0.01F}), {-1.0F, 0.5F, 1.0F}, glass()));
  frame.draws.back().id = 8;
  frame.draws.push_back(at(make_box(3, {0.2F, 0.2F, 0.2F}), {0.0F, 1.5F, 0.0F}));  // a mark, of no body
  return frame;
}

/// Where the ray from `from` along `way` enters a box about the origin, and the normal there; negative if it
/// does not.
float enter(glm::vec3 from, glm::vec3 way, glm::vec3 half, glm::vec3& normal) {
  float first = -1e30F, last = 1e30F;
  for (int k = 0; k < 3; ++k) {
    const float a = (-half[k] - from[k]) / way[k], b = (half[k] - from[k]) / way[k];
    if (std::min(a, b) > first) {
      first = std::min(a, b);
      normal = glm::vec3(0.0F);
      normal[k] = way[k] < 0.0F ? 1.0F : -1.0F;
    }
    last = std::min(last, std::max(a, b));
  }
  return first < last ? first : -1.0F;
}

}  // namespace

TEST_CASE("depth, normal and id of each pixel are those of the ray through its middle") {
  const Frame frame = boxes();
  for (const Quality quality : {Quality::preview, Quality::full}) {
    Renderer renderer(kSize, quality);
    static_cast<void>(renderer.render(frame));
    const Truth truth = renderer.find_truth();
    REQUIRE(truth.width == kSize.width);
    REQUIRE(truth.depths.size() == 320U * 180U);
    CHECK(glm::distance(glm::vec3(truth.world_from_camera[3]), frame.camera.position) < 1e-6F);
    int wrong_ids = 0, hits[3] = {};
    for (int y = 0; y < truth.height; ++y) {
      for (int x = 0; x < truth.width; ++x) {
        const glm::vec3 way_camera((static_cast<float>(x) + 0.5F - 160.0F) / truth.focal,
                                   (90.0F - static_cast<float>(y) - 0.5F) / truth.focal, -1.0F);
        const glm::vec3 eye = frame.camera.position;
        const glm::vec3 way = glm::mat3(truth.world_from_camera) * way_camera;
        float depth = std::numeric_limits<float>::infinity();
        glm::vec3 normal(0.0F);
        std::uint32_t id = 0;
        if (way.y < 0.0F) {
          depth = (-0.25F - eye.y) / way.y;
          normal = {0.0F, 1.0F, 0.0F};
          id = 900;
        }
        for (const std::size_t i : {0U, 1U}) {
          const glm::mat4 inverse = glm::inverse(frame.draws[i].world_from_body);
          const glm::vec3 half = i == 0 ? glm::vec3(0.5F) : glm::vec3(0.5F, 0.5F, 0.005F);
          glm::vec3 normal_body(0.0F);
          const float t =
              enter(glm::vec3(inverse * glm::vec4(eye, 1.0F)), glm::mat3(inverse) * way, half, normal_body);
          if (t < 0.0F || t >= depth) continue;
          depth = t;
          normal = glm::mat3(frame.draws[i].world_from_body) * normal_body;
          id = frame.draws[i].id;
        }
        const auto pixel = static_cast<std::size_t>(y * truth.width + x);
        if (truth.ids[pixel] != id) {
          ++wrong_ids;  // on an edge
          continue;
        }
        ++hits[id == 900 ? 0 : id == 8 ? 1 : 2];
        if (id == 0) {
          CHECK(std::isinf(truth.depths[pixel]));
          continue;
        }
        if (glm::distance(truth.normals[pixel], normal) > 0.1F) {
          ++wrong_ids;  // on an edge of its own
          continue;
        }
        // Near the horizon the rounding of a ray's slope tells.
        CHECK(truth.depths[pixel] == Approx(depth).epsilon(1e-5 + 1e-6 * depth));
        CHECK(glm::distance(truth.normals[pixel], normal) < 1e-4F);
      }
    }
    CHECK(wrong_ids < 20);
    for (const int count : hits) CHECK(count > 1000);
  }
}

TEST_CASE("asking for the truth changes no picture") {
  Renderer asked(kSize, Quality::preview), other(kSize, Quality::preview);
  Frame frame = busy_frame();
  for (std::size_t i = 0; i < frame.draws.size(); ++i) frame.draws[i].id = static_cast<std::uint32_t>(i) + 1;
  for (int i = 0; i < 4; ++i) {
    frame.draws[0].world_from_body =
        glm::translate(glm::mat4(1.0F), glm::vec3(0.1F * static_cast<float>(i / 2), 0.4F, 0.0F));
    const Image image = asked.render(frame);
    const Truth truth = asked.find_truth();
    CHECK(image == other.render(frame));
    CHECK(truth.ids == asked.find_truth().ids);
  }
}

TEST_CASE("an npz file is a zip archive of numpy's arrays") {
  const fs::path path = fs::temp_directory_path() / "shatterbox_truth.npz";
  const std::vector<float> numbers{0.5F, -1.0F, 3.0F, 1e30F, 0.0F, 7.0F};
  const std::vector<std::uint32_t> ids{1, 70000};
  const std::vector<NpzArray> arrays{make_array<float>("depth", "<f4", {2, 3}, numbers),
                                     make_array<std::uint32_t>("id", "<u4", {2}, ids)};
  REQUIRE(write_npz(path, arrays).ok());
  const fs::path script = fs::temp_directory_path() / "shatterbox_truth.py";
  std::ofstream(script)
      << "import ast, struct, sys, zipfile\n"
         "archive = zipfile.ZipFile(sys.argv[1])\n"
         "assert archive.testzip() is None\n"
         "def load(name, kind):\n"
         "    bytes = archive.read(name + '.npy')\n"
         "    assert bytes[:8] == b'\\x93NUMPY\\x01\\x00'\n"
         "    length = 10 + struct.unpack('<H', bytes[8:10])[0]\n"
         "    assert length % 64 == 0\n"
         "    head = ast.literal_eval(bytes[10:length].decode())\n"
         "    return head, struct.unpack('<%d%s' % ((len(bytes) - length) // 4, kind), bytes[length:])\n"
         "head, values = load('depth', 'f')\n"
         "assert head == {'descr': '<f4', 'fortran_order': False, 'shape': (2, 3)}\n"
         "assert values[:3] == (0.5, -1.0, 3.0) and values[5] == 7.0\n"
         "head, values = load('id', 'I')\n"
         "assert head['shape'] == (2,) and values == (1, 70000)\n";
  CHECK(std::system(("python3 " + script.string() + " " + path.string()).c_str()) == 0);
  fs::remove(path);
  fs::remove(script);
  CHECK(write_npz("/no/such/folder/x.npz", arrays).error.find("cannot be written") != std::string::npos);
}
