// Pictures on disk, by stb. PNG only: it keeps every bit.
#pragma once
#include <filesystem>
#include <optional>

#include "render/output/image.h"
#include "render/output/status.h"

namespace shatterbox::render {

// Written beside the name and renamed, so that no half a picture is ever found under it.
Status write_png(const std::filesystem::path& path, const Image& image);

// RGB or RGBA as stored; nothing when it cannot be read, with the reason in *error if given.
std::optional<Image> read_image(const std::filesystem::path& path, std::string* error = nullptr);

}  // namespace shatterbox::render
