// How far two pictures are apart.
#pragma once
#include "render/output/image.h"

namespace shatterbox::render {

struct Difference {
  bool same_size = false;
  double psnr = 0;          // dB over all channels; infinity when equal
  double mean = 0;          // mean |difference|, levels
  int most = 0;             // greatest |difference| of any channel, levels
  long pixels_beyond = 0;   // pixels with a channel further apart than the tolerance
  double share_beyond = 0;  // of all pixels
};

Difference compare(const Image& a, const Image& b, int tolerance = 2);

}  // namespace shatterbox::render
