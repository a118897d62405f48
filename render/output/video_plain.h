// A finished mp4 without its fragments.
#pragma once
#include <filesystem>

#include "render/output/status.h"

namespace shatterbox::render {

// Copies the one stream of `fragmented` as it was encoded to `plain`: an mp4 whose index comes first, so that
// every player can seek in it at once. What could not be written is removed again.
Status write_plain_mp4(const std::filesystem::path& fragmented, const std::filesystem::path& plain);

}  // namespace shatterbox::render
