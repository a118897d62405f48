// Reads the frames of a recording, from any of them on.
#pragma once

#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sandbox/recording/picture_bytes.h"
#include "sandbox/recording/recording.h"
#include "sandbox/recording/recording_writer.h"

namespace shatterbox::sandbox::recording {

class RecordingReader {
 public:
  /// Reads the index. Throws Unreadable, in words that say what is wrong and how to mend it, for what is no
  /// recording, is not whole, or is damaged; so does read().
  explicit RecordingReader(const std::string& file);

  const Settings& settings() const { return settings_; }
  int frame_count() const { return static_cast<int>(frames_.size()); }

  /// Frame `number`. One after the other each is read once; another one costs up to sixty before it.
  Panels read(int number);

 private:
  void read_index();
  /// The contents of the part there, whose hash is right.
  std::string read_part(std::uint64_t place, PartKind kind);
  Panels read_next(std::size_t number);
  std::shared_ptr<const render::Mesh> find_mesh(std::uint64_t id);

  std::ifstream stream_;
  std::uint64_t size_ = 0;  // of the file
  Settings settings_;
  std::vector<std::vector<render::Look>> looks_;
  std::map<std::uint64_t, std::uint64_t> places_;                        // of meshes, by id
  std::map<std::uint64_t, std::shared_ptr<const render::Mesh>> meshes_;  // those that pictures show
  std::vector<FrameEntry> frames_;
  std::vector<PictureReader> readers_;  // of each panel
  std::size_t next_ = 0;                // the frame that they are ready for
};

}  // namespace shatterbox::sandbox::recording
