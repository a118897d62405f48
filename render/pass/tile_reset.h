// Clears a target: wholly, or only rectangles of it, which costs more by the pixel.
#pragma once
#include "render/gpu/program.h"
#include "render/pass/changes.h"
#include "render/pass/tiles.h"

namespace shatterbox::render::pass {

class TileReset {
 public:
  TileReset();
  // Of the target that is bound: where `marks` say so, whose rectangles are `changed`.
  void reset_depth(const Changes::Marks& marks, Tiles::Range changed) const;                  // to 1
  void reset_value(const Changes::Marks& marks, Tiles::Range changed, unsigned value) const;  // one channel

 private:
  gpu::Program depth_, value_;
};

}  // namespace shatterbox::render::pass
