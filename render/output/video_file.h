// A video written while frames arrive, encoded on a thread of its own. Until close() it is NAME.part, which
// plays as far as it was written even if the run is killed; close() renames it.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "render/output/image.h"
#include "render/output/status.h"

namespace shatterbox::render {

struct VideoSettings {
  int width = 640, height = 360;
  int frames_per_second = 60;
  double crf = 20;                  // constant quality, lower is better
  std::string preset = "veryfast";  // x264's name for how hard to try
  int queue = 3;                    // frames that may wait; add() blocks beyond
  long keep = 0;  // first frames that an earlier run of these settings has written: count_kept_frames
};

class VideoFile {
 public:
  // By extension: .mp4 and .mkv (H.264), .webm (VP9), .gif. Never throws: status() says what is wrong, and
  // add() and close() then return the same.
  VideoFile(std::filesystem::path path, const VideoSettings& settings);
  ~VideoFile();  // closes; a failure there is lost, so call close()
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  Status add(Image image);  // of the size in the settings; shown for 1/frames_per_second s
  Status close();           // waits for the encoder, ends the file, renames it; later calls return the same
  Status status() const;

  long frames() const;           // given to add() so far
  double encode_cpu_ms() const;  // of the encoding thread so far
  double waiting_bytes() const;  // of pictures that waited for it at once, at most

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

// Frames of a video, or of its NAME.part, that a run which was cut short has left and another one can go on
// from, if of so many it is known that they are right.
long count_kept_frames(const std::filesystem::path& path, long most);

// Whether this build can write such a file; the error names the endings it knows.
Status can_write_video(const std::filesystem::path& path);

}  // namespace shatterbox::render
