#include "render/output/palette.h"

#include <algorithm>
#include <limits>

namespace shatterbox::render {
namespace {

constexpr int kBits = 5, kLevels = 1 << kBits, kCells = kLevels * kLevels * kLevels;
constexpr double kWeights[3] = {0.55, 1.0, 0.45};  // how far apart a step in each channel looks

struct Cell {
  std::array<int, 3> level;
  double count;
};

int cell_of(const std::array<int, 3>& rgb) {
  return ((rgb[0] >> (8 - kBits)) * kLevels + (rgb[1] >> (8 - kBits))) * kLevels + (rgb[2] >> (8 - kBits));
}

std::vector<Cell> find_cells(const Image& image) {
  std::vector<int> counts(kCells, 0);
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < image.pixels.size(); i += channels) {
    ++counts[static_cast<std::size_t>(cell_of({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]}))];
  }
  std::vector<Cell> cells;
  for (int c = 0; c < kCells; ++c) {
    const int count = counts[static_cast<std::size_t>(c)];
    if (count == 0) continue;
    cells.push_back(
        {{c / (kLevels * kLevels), c / kLevels % kLevels, c % kLevels}, static_cast<double>(count)});
  }
  return cells;
}

struct Box {
  std::size_t first, last;  // of cells
  std::size_t axis = 0;
  double spread = 0;  // weighted variance along its widest channel
};

Box measure(std::size_t first, std::size_t last, const std::vector<Cell>& cells) {
  Box box{first, last};
  for (std::size_t k = 0; k < 3; ++k) {
    double n = 0, sum = 0, squares = 0;
    for (std::size_t i = first; i < last; ++i) {
      n += cells[i].count;
      sum += cells[i].count * cells[i].level[k];
      squares += cells[i].count * cells[i].level[k] * cells[i].level[k];
    }
    const double spread = (squares - sum * sum / n) * kWeights[k] * kWeights[k];
    if (spread > box.spread) {
      box.spread = spread;
      box.axis = k;
    }
  }
  return box;
}

// Where to part the box: the weighted mean along its widest channel, with cells on both sides.
std::size_t part(const Box& box, std::vector<Cell>& cells) {
  const auto first = cells.begin() + static_cast<std::ptrdiff_t>(box.first);
  const auto last = cells.begin() + static_cast<std::ptrdiff_t>(box.last);
  double n = 0, sum = 0;
  std::for_each(first, last, [&](const Cell& c) {
    n += c.count;
    sum += c.count * c.level[box.axis];
  });
  const double mean = sum / n;
  const auto middle =
      std::stable_partition(first, last, [&](const Cell& c) { return c.level[box.axis] <= mean; });
  return static_cast<std::size_t>(middle - cells.begin());
}

std::vector<std::array<int, 3>> find_colours(std::vector<Cell>& cells) {
  std::vector<Box> boxes = {measure(0, cells.size(), cells)};
  while (boxes.size() < 255) {
    const auto widest = std::max_element(boxes.begin(), boxes.end(),
                                         [](const Box& a, const Box& b) { return a.spread < b.spread; });
    if (widest->spread <= 0) break;
    const Box whole = *widest;
    const std::size_t middle = part(whole, cells);
    if (middle == whole.first || middle == whole.last) {
      widest->spread = 0;
      continue;
    }
    *widest = measure(whole.first, middle, cells);
    boxes.push_back(measure(middle, whole.last, cells));
  }
  std::vector<std::array<int, 3>> colours;
  for (const Box& box : boxes) {
    std::array<double, 3> sum{};
    double n = 0;
    for (std::size_t i = box.first; i < box.last; ++i) {
      n += cells[i].count;
      for (std::size_t k = 0; k < 3; ++k) sum[k] += cells[i].count * cells[i].level[k];
    }
    std::array<int, 3> colour{};
    for (std::size_t k = 0; k < 3; ++k)
      colour[k] = static_cast<int>(sum[k] / n * 255.0 / (kLevels - 1) + 0.5);
    colours.push_back(colour);
  }
  return colours;
}

std::uint8_t find_nearest(const std::array<int, 3>& rgb, const std::vector<std::array<int, 3>>& colours) {
  double least = std::numeric_limits<double>::max();
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    double d = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double step = kWeights[k] * (rgb[k] - colours[i][k]);
      d += step * step;
    }
    if (d < least) {
      least = d;
      nearest = i;
    }
  }
  return static_cast<std::uint8_t>(nearest);
}

// 0..63, each once in every 8 x 8 square, neighbours far apart.
int ordered(int x, int y) {
  int out = 0;
  for (int bit = 0; bit < 3; ++bit) {
    const int a = (x >> bit) & 1, b = (y >> bit) & 1;
    out = (out << 2) | ((a ^ b) << 1) | b;
  }
  return out;
}

}  // namespace

Paletted find_palette(const Image& image) {
  std::vector<Cell> cells = find_cells(image);
  Paletted out;
  if (cells.empty()) return out;
  const std::vector<std::array<int, 3>> colours = find_colours(cells);
  for (std::size_t i = 0; i < out.argb.size(); ++i) {
    const std::array<int, 3> c = colours[std::min(i, colours.size() - 1)];
    out.argb[i] = 0xff000000U | static_cast<std::uint32_t>(c[0] << 16 | c[1] << 8 | c[2]);
  }
  std::vector<int> known(kCells * 8, -1);  // six bits a channel, found when first asked
  out.indices.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.at(x, y);
      std::array<int, 3> rgb{};
      for (std::size_t k = 0; k < 3; ++k) {
        const int moved = std::clamp(int{p[k]} + (ordered(x, y) - 32) / 6, 0, 255);
        rgb[k] = std::min((moved & ~3) + 2, 255);
      }
      int& index = known[static_cast<std::size_t>((rgb[0] >> 2) * 4096 + (rgb[1] >> 2) * 64 + (rgb[2] >> 2))];
      if (index < 0) index = find_nearest(rgb, colours);
      out.indices[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                  static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(index);
    }
  }
  return out;
}

}  // namespace shatterbox::render
