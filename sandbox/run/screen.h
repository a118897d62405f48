// Who takes the frames of a film: a painter, a recording, both, or nobody.
#pragma once

#include <string>
#include <vector>

#include "sandbox/recording/recording_writer.h"
#include "sandbox/run/painter.h"

namespace shatterbox::sandbox::run {

struct Screen {
  Painter* painter = nullptr;
  recording::RecordingWriter* recording = nullptr;

  /// Whether somebody takes a frame that is to be painted, or not.
  bool takes(bool is_painted) const { return is_painted || recording != nullptr; }
  /// Hands frame `number` of the film over to the recording and, if it is painted, to the painter. A sentence
  /// if that failed, else empty.
  std::string add(recording::Panels panels, int number, bool is_painted) const;
};

}  // namespace shatterbox::sandbox::run
