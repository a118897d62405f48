// Pictures of one exposure, one upon the other: the mean of their light, not of their codes.
#pragma once
#include <vector>

#include "render/output/image.h"

namespace shatterbox::render {

class LightSum {
 public:
  // All of one size and kind.
  void add(const Image& image);
  // Of one picture, or of equal ones, those very bytes.
  Image mean() const;

 private:
  Image first_;
  std::vector<float> sums_;  // linear light
  int count_ = 0;
};

}  // namespace shatterbox::render
