// What a recording is: the pictures of a run as values, before they are drawn. A file of parts, each with its
// length and a hash; the index of them comes last, so that a file without its end is known at once.
//
//   "\x89SBREC\r\n", version                         kMagic, kVersion
//   part: kind, length of contents, contents, hash   meshes where they are first seen, frames in their order
//   part: index                                      settings, looks, where frames and meshes are
//   place of the index, "SBRECEND"                   kEnd
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/renderer.h"
#include "sandbox/recording/bytes.h"

namespace shatterbox::sandbox::recording {

using namespace std::string_view_literals;

inline constexpr std::string_view kMagic = "\x89SBREC\r\n"sv, kEnd = "SBRECEND"sv;
inline constexpr std::uint32_t kVersion = 2;
inline constexpr std::size_t kHeadSize = 12, kTailSize = 16;           // of the file, bytes
inline constexpr std::size_t kPartHeadSize = 9, kPartTailSize = 8;     // of a part
inline constexpr int kMostPanels = 16, kMostFramesPerSecond = 100000;  // far beyond what a run takes

enum class PartKind : std::uint8_t { mesh, frame, index };

/// What the run that was recorded would have drawn.
struct Settings {
  std::string program;  // its version
  std::string scene, goal;
  std::uint32_t frames_per_second = 60;
  std::uint32_t width = 640, height = 360;  // of a panel
  render::Quality quality = render::Quality::preview;
  std::uint32_t panels = 1;
};

/// Where a frame is.
struct FrameEntry {
  std::uint64_t place = 0;  // from the file's begin
  bool is_whole = false;    // told without the frame before
};

template <class Archive, class Values>
void pass_settings(Archive& archive, Values& settings) {
  archive(settings.program), archive(settings.scene), archive(settings.goal);
  archive(settings.frames_per_second), archive(settings.width), archive(settings.height);
  archive.choice(settings.quality, render::Quality::full);
  archive(settings.panels);
}

/// The hash that ends a part.
inline std::uint64_t hash_of_part(PartKind kind, std::string_view contents) {
  core::Hash hash;
  hash.add(static_cast<std::uint64_t>(kind)).add(static_cast<std::uint64_t>(contents.size()));
  add_bytes(hash, contents.data(), contents.size());
  return hash.value();
}

}  // namespace shatterbox::sandbox::recording
