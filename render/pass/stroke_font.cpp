#include "render/pass/stroke_font.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <utility>
#include <vector>

namespace shatterbox::render::pass {
namespace {

// One glyph from ' ' to '~', then a box for anything else. Strokes are parted by spaces; a point is two
// characters, x 0-4 and y 0-7 or a, b for 1 and 2 below the baseline. '~' starts a curve, '@' a closed one.
constexpr std::string_view kGlyphs[] = {
    "", "0602 0000", "0604 2624", "1016 3036 0242 0444", "~453616050413334241301001 272a",
    "0046 @05061615 @31304041", "~4014152635340201102043", "0604", "~1705011a", "~0715110a", "2622 0543 0345",
    "2125 0343", "110a", "0333", "0000", "0036",
    // 0-9
    "@1636454130100105", "152620 0040", "~051636454400 0040", "~05163645443313 ~334241301001", "30360242",
    "460603 ~0314344341301001", "~453616050110304142331302", "064610", "@1636454433130405 @1333424130100102",
    "~011030414536160504133344",
    // : ; < = > ? @
    "0404 0101", "1414 110a", "450341", "0242 0444", "054301", "~05163645443322 2020",
    "~4010010516364542 @14343212",
    // A-Z
    "002640 1232", "0006 ~063645443303 ~033342413000", "~4536160501103041", "0006 ~062645412000",
    "46060040 0333", "460600 0333", "~4536160501103041 414323", "0006 4046 0343", "0626 1610 0020",
    "~3631201001", "0006 4602 1340", "060040", "0006234640", "00064046", "@1636454130100105",
    "0006 ~063645443303", "@1636454130100105 2240", "0006 ~063645443303 2340", "~453616050413334241301001",
    "0646 2620", "~060110304146", "062046", "0610243046", "0046 0640", "062346 2320", "06460040",
    // [ \ ] ^ _ `
    "17070a1a", "0630", "07171a0a", "042644", "0a4a", "0615",
    // a-z
    "@3324140301102031 3430", "0600 @0314243331201001", "~3324140301102031", "3630 @3324140301102031",
    "0232 ~323324140301102031", "~36261510 0434", "@3324140301102031 ~343a2b1b0a", "0600 ~0314243330",
    "0400 0606", "~141a0b 1616", "0600 3401 1230", "~060110", "0400 ~03142320 ~23344340", "0400 ~0314243330",
    "@1424333120100103", "040b @0314243331201001", "343b @3324140301102031", "0400 ~031424",
    "~33241403122231201001", "~16112030 0434", "~0401102031 3430", "042044", "0410233044", "0034 0430",
    "0420 441b", "04340030",
    // { | } ~ and the box
    "~2716140312102a", "070b", "~0716142312100a", "~03142334", "0006464000"};
static_assert(std::size(kGlyphs) == 96);

struct Segment {
  glm::vec2 a, b;
};
struct Glyph {
  std::vector<Segment> segments;  // grid steps, y up
  float width = 1.5F;
};

float coordinate(char c) {
  return c >= 'a' ? static_cast<float>('a' - c - 1) : static_cast<float>(c - '0');
}

// Cuts corners twice: a curve that keeps its ends.
std::vector<glm::vec2> smooth(std::vector<glm::vec2> points, bool is_closed) {
  for (int round = 0; round < 2; ++round) {
    std::vector<glm::vec2> next;
    const std::size_t n = points.size();
    if (!is_closed) next.push_back(points.front());
    for (std::size_t i = 0; i + (is_closed ? 0 : 1) < n; ++i) {
      const glm::vec2 a = points[i], b = points[(i + 1) % n];
      if (is_closed || i > 0) next.push_back(glm::mix(a, b, 0.25F));
      if (is_closed || i + 2 < n) next.push_back(glm::mix(a, b, 0.75F));
    }
    if (!is_closed) next.push_back(points.back());
    points = std::move(next);
  }
  return points;
}

Glyph parse(std::string_view text) {
  Glyph glyph;
  float right = text.empty() ? 1.5F : 0.0F;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    std::string_view stroke = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const bool is_closed = stroke.front() == '@', is_curve = is_closed || stroke.front() == '~';
    if (is_curve) stroke.remove_prefix(1);
    std::vector<glm::vec2> points;
    for (std::size_t i = 0; i + 1 < stroke.size(); i += 2) {
      points.emplace_back(coordinate(stroke[i]), coordinate(stroke[i + 1]));
      right = std::max(right, points.back().x);
    }
    if (is_curve) points = smooth(std::move(points), is_closed);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) glyph.segments.push_back({points[i], points[i + 1]});
    if (is_closed) glyph.segments.push_back({points.back(), points.front()});
  }
  glyph.width = right;
  return glyph;
}

const Glyph& glyph_of(char c) {
  static const std::vector<Glyph> glyphs = [] {
    std::vector<Glyph> out;
    for (const std::string_view text : kGlyphs) out.push_back(parse(text));
    return out;
  }();
  const bool is_known = c >= ' ' && c <= '~';
  return glyphs[is_known ? static_cast<std::size_t>(c - ' ') : glyphs.size() - 1];
}

constexpr float kGap = 1.9F;  // grid steps between glyphs

float distance_to(const Glyph& glyph, glm::vec2 p) {
  float least = 1e9F;
  for (const Segment& s : glyph.segments) {
    const glm::vec2 along = s.b - s.a;
    const float length_squared = glm::dot(along, along);
    const float t =
        length_squared > 0.0F ? std::clamp(glm::dot(p - s.a, along) / length_squared, 0.0F, 1.0F) : 0.0F;
    least = std::min(least, glm::distance(p, s.a + t * along));
  }
  return least;
}

void blend(std::uint8_t* pixel, const std::array<std::uint8_t, 3>& colour, float share) {
  for (std::size_t k = 0; k < 3; ++k) {
    pixel[k] = static_cast<std::uint8_t>(std::lround((1.0F - share) * pixel[k] + share * colour[k]));
  }
}

// How far the pixels around a glyph are from its strokes. Glyphs start at whole pixels, so that each is
// measured once.
struct Field {
  int left = 0, top = 0, width = 0, height = 0;  // pixels from the pen, y down
  std::vector<float> distance;                   // pixels to the ink's edge, less than 0 inside
};

float half_stroke(float unit) {
  return std::max(0.34F * unit, 0.5F);
}
float edge_reach(float unit) {
  return 1.1F * unit + 1.0F;
}

Field measure(const Glyph& glyph, float unit) {
  const float half = half_stroke(unit), pad = half + edge_reach(unit) + 1.0F;
  Field field;
  field.left = static_cast<int>(std::floor(-pad));
  field.top = static_cast<int>(std::floor(-7.0F * unit - pad));
  field.width = static_cast<int>(std::ceil(glyph.width * unit + pad)) - field.left;
  field.height = static_cast<int>(std::ceil(2.0F * unit + pad)) - field.top;
  for (int y = 0; y < field.height; ++y) {
    for (int x = 0; x < field.width; ++x) {
      const glm::vec2 p((static_cast<float>(field.left + x) + 0.5F) / unit,
                        -(static_cast<float>(field.top + y) + 0.5F) / unit);
      field.distance.push_back(distance_to(glyph, p) * unit - half);
    }
  }
  return field;
}

const Field& field_of(char c, float unit) {
  static thread_local std::map<std::pair<char, float>, Field> fields;
  const auto [place, is_new] = fields.try_emplace({c, unit});
  if (is_new) place->second = measure(glyph_of(c), unit);
  return place->second;
}

// First the dark edges of the whole line, then the ink, so that no edge falls on a neighbour's ink.
void draw_glyph(Image& image, const Field& field, glm::ivec2 pen, float unit,
                const std::array<std::uint8_t, 3>& colour, bool is_edge, float opacity) {
  const int left = std::max(pen.x + field.left, 0),
            right = std::min(pen.x + field.left + field.width, image.width);
  const int top = std::max(pen.y + field.top, 0),
            bottom = std::min(pen.y + field.top + field.height, image.height);
  for (int y = top; y < bottom; ++y) {
    const auto row = static_cast<std::size_t>((y - pen.y - field.top) * field.width);
    for (int x = left; x < right; ++x) {
      const float d = field.distance[row + static_cast<std::size_t>(x - pen.x - field.left)];
      const float share = opacity * (is_edge ? 0.42F * std::clamp(1.0F - d / edge_reach(unit), 0.0F, 1.0F)
                                             : std::clamp(0.5F - d, 0.0F, 1.0F));
      if (share > 0.0F) blend(image.at(x, y), is_edge ? std::array<std::uint8_t, 3>{} : colour, share);
    }
  }
}

}  // namespace

void draw_text(Image& image, float x, float y, float unit, std::array<std::uint8_t, 3> colour,
               std::string_view text, float opacity) {
  const bool is_light = colour[0] + colour[1] + colour[2] > 384;
  for (const bool is_edge : {true, false}) {
    if (is_edge && !is_light) continue;
    float pen = x;
    for (const char c : text) {
      const Glyph& glyph = glyph_of(c);
      const glm::ivec2 at(static_cast<int>(std::lround(pen)), static_cast<int>(std::lround(y)));
      draw_glyph(image, field_of(c, unit), at, unit, colour, is_edge, opacity);
      pen += (glyph.width + kGap) * unit;
    }
  }
}

float text_width(std::string_view text, float unit) {
  float width = 0.0F;
  for (const char c : text) width += (glyph_of(c).width + kGap) * unit;
  return std::max(width - kGap * unit, 0.0F);
}

}  // namespace shatterbox::render::pass
