#include "sandbox/run/recorder.h"

#include <catch2/catch.hpp>

using namespace shatterbox::sandbox;

TEST_CASE("a still's time is its own, not that of the frames before it, which were not drawn") {
  run::Recorder recorder;
  for (const double simulate : {10.0, 30.0, 20.0, 40.0}) {
    report::FrameRecord frame;
    frame.frame = frame.simulate = simulate;
    recorder.record.frames.push_back(frame);
  }
  run::Painted painted;
  painted.numbers = {5, 7, 8};
  painted.hashes = {1, 2, 3};
  painted.frame = {12.0, 53.0, 44.0};  // since the picture before
  painted.render = {1.0, 18.0, 2.0};
  painted.encode = {0.5, 7.0, 0.5};
  recorder.note_pictures(painted, 5);
  const std::vector<report::FrameRecord>& frames = recorder.record.frames;
  CHECK(frames[0].frame == 12.0);
  CHECK(frames[1].frame == 30.0);  // not drawn
  CHECK(frames[2].frame == 25.0);  // drawing it took longer than its steps
  CHECK(frames[3].frame == 44.0);
}
