// The picture does not depend on how many threads llvmpipe uses. The number is read once a process, so this
// program is run again for each.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

#include "render/output/image_file.h"
#include "render/renderer.h"

using namespace shatterbox::render;

TEST_CASE("draws one picture to $SHATTERBOX_PICTURE", "[.draw-one]") {
  Frame frame;
  frame.camera.position = {0.0F, 1.0F, 3.0F};
  Draw draw;
  draw.mesh = make_sphere(1, 0.5F);
  draw.looks = {ornament({0.6F, 0.1F, 0.1F})};
  frame.draws = {draw};
  Renderer renderer({320, 180}, Quality::full);
  REQUIRE(write_png(std::getenv("SHATTERBOX_PICTURE"), renderer.render(frame)).ok());
}

TEST_CASE("any number of threads draws the same picture") {
  std::vector<Image> images;
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  for (const char* threads : {"0", "3"}) {
    const std::string path =
        (std::filesystem::temp_directory_path() / (std::string("shatterbox_threads_") + threads + ".png"))
            .string();
    const std::string command = std::string("MESA_SHADER_CACHE_DISABLE=true LP_NUM_THREADS=") + threads +
                                " SHATTERBOX_PICTURE='" + path + "' '" + program +
                                "' '[.draw-one]' > /dev/null";
    REQUIRE(std::system(command.c_str()) == 0);
    const auto image = read_image(path);
    REQUIRE(image);
    images.push_back(*image);
    std::filesystem::remove(path);
  }
  CHECK(images[0] == images[1]);
}
