// Draws and writes frames on a thread of its own while the world steps on: a frame is a value. The renderer
// lives and dies on that thread; the video is encoded on a third one.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/hash.h"
#include "engine/world/inventory.h"
#include "render/frame/frame.h"
#include "render/renderer.h"
#include "sandbox/report/run_record.h"

namespace shatterbox::sandbox::run {

/// A picture that is written.
struct Picture {
  int number = 0;  // of the frame
  std::uint64_t hash = 0;
};

struct PainterSettings {
  render::Size size;
  render::Quality quality = render::Quality::preview;
  render::BackEnd back_end = render::BackEnd::usual;
  int panels = 1;  // pictures of that size beside each other; four: in two rows
  int frames_per_second = 60;
  std::string video;            // empty: none
  std::string frames_folder;    // empty: none
  std::string truth_folder;     // empty: none
  bool has_pass_times = false;  // times each pass, which then waits for the one before it
  std::vector<Picture> kept;    // what an earlier run has drawn and written already
};

/// What became of the frames that were added, after those that were kept; times in ms, in the order of the
/// frames, negative for what was kept.
struct Painted {
  std::vector<int> numbers;  // of the frames
  std::vector<std::uint64_t> hashes;
  std::vector<double> frame, render, encode;
  report::TimesByName passes;  // of drawing, if they were timed; 0 in frames that had none of it
  double start = 0.0;          // making the renderer and the warm-up picture
  std::string gl_renderer;
  std::vector<world::PartCount> parts;  // shadow maps and the encoder
};

class Painter {
 public:
  explicit Painter(PainterSettings settings);
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  /// Hands frame `number` of the film over: of each panel the pictures of whose light it is the mean. Waits
  /// while eight are waiting. False once something failed: see error().
  bool add(std::vector<std::vector<render::Frame>> panels, int number);
  /// Waits for the last frame, closes the video. False if something failed.
  bool finish();

  int finished_frames() const;
  /// All that are written so far, those that were kept with them.
  std::vector<Picture> pictures() const;
  std::string error() const;
  /// Why the video cannot be begun; empty if it can. Known from the start, unlike what fails in drawing.
  const std::string& opening_fault() const;
  /// After finish().
  const Painted& painted() const;

 private:
  struct Room;
  std::unique_ptr<Room> room_;
};

/// Where frame `number` lies in the folder of pictures, and in that of truth.
std::string picture_file(const std::string& folder, int number);
std::string truth_file(const std::string& folder, int number);

/// A hash of a picture's bytes and size.
std::uint64_t hash_image(const render::Image& image);

}  // namespace shatterbox::sandbox::run
