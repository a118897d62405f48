// Writes a recording, frame by frame, while the run goes on.
#pragma once

#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "sandbox/recording/picture_bytes.h"
#include "sandbox/recording/recording.h"

namespace shatterbox::sandbox::recording {

/// Of each panel of a frame of the film the pictures of whose light it is the mean.
using Panels = std::vector<std::vector<render::Frame>>;

class RecordingWriter {
 public:
  /// Until close() the file is called FILE.part.
  RecordingWriter(std::string file, Settings settings);

  /// The next frame. A sentence if it cannot be written, else empty.
  std::string add(const Panels& panels);
  /// After the last frame: the file is whole, under its name. A sentence if that failed, else empty.
  std::string close();

 private:
  void put_new_meshes(const Panels& panels);
  void put_part(PartKind kind, std::string_view contents);
  /// Empty while all is written.
  std::string fault() const;

  std::string file_, part_file_;
  Settings settings_;
  std::ofstream stream_;
  std::uint64_t size_ = 0;  // of the file so far
  LookNumbers looks_;
  std::vector<PictureWriter> writers_;             // of each panel
  std::map<std::uint64_t, std::uint64_t> meshes_;  // where each is, by id
  std::vector<FrameEntry> frames_;
};

}  // namespace shatterbox::sandbox::recording
