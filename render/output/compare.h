// How far two pictures are apart, in numbers and as a picture.
#pragma once
#include "render/output/image.h"

namespace shatterbox::render {

struct Difference {
  bool same_size = false;
  double psnr = 0;           // dB over all channels; infinity when equal
  double ssim = 0;           // mean structural similarity of the luma, 1 when equal
  double mean = 0;           // mean |difference|, levels
  int most = 0;              // greatest |difference| of any channel, levels
  long pixels_beyond = 0;    // pixels with a channel further apart than the tolerance
  double share_beyond = 0;   // of all pixels
  long largest_cluster = 0;  // of these pixels: the most that touch each other, corners included
};

// Levels up to `tolerance` apart count as equal in pixels_beyond, share_beyond and largest_cluster. Pictures
// of different size or channels are told apart by same_size alone.
Difference compare(const Image& a, const Image& b, int tolerance = 2);

// `a` in dim grey, and over it how far `b` is from it: blue for pixels within the tolerance that differ at
// all, then red, yellow and white with the distance (white from 64 levels on). The pictures have one size.
Image difference_picture(const Image& a, const Image& b, int tolerance = 2);

}  // namespace shatterbox::render
