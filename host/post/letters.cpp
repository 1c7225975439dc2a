// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Draws text in DejaVu Sans, which is embedded in the program, by stb_truetype.
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "base/check.h"
#include "base/embedded_file.h"
#include "base/utf8.h"
#include "post/detail/canvas.h"

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb/stb_truetype.h>

namespace caplet {
std::span<const EmbeddedFile> embedded_fonts();
}

namespace caplet::post {

namespace {

struct Font {
  Font() {
    const auto* data = reinterpret_cast<const unsigned char*>(embedded_fonts().front().text.data());
    CHECK_LT_(0, stbtt_InitFont(&info, data, stbtt_GetFontOffsetForIndex(data, 0)));
    int left, below, right;
    stbtt_GetCodepointBox(&info, 'H', &left, &below, &right, &capital);
  }
  stbtt_fontinfo info{};
  int capital = 0;  // height of capitals, in units of the font
};

const Font& font() {
  static const Font one;
  return one;
}

/// Calls draw(glyph, x) for each letter, x in units of the font from the first one's start. Returns
/// where the last one ends.
template <class Draw>
double for_each_glyph(std::string_view utf8, const Draw& draw) {
  const stbtt_fontinfo* info = &font().info;
  double x = 0;
  int last = 0;
  for (bool is_first = true; !utf8.empty(); is_first = false) {
    const int glyph = stbtt_FindGlyphIndex(info, static_cast<int>(take_character(utf8)));
    if (!is_first) x += stbtt_GetGlyphKernAdvance(info, last, glyph);
    draw(glyph, x);
    int advance, bearing;
    stbtt_GetGlyphHMetrics(info, glyph, &advance, &bearing);
    x += advance;
    last = glyph;
  }
  return x;
}

}  // namespace

double text_width(std::string_view utf8, double size) {
  return for_each_glyph(utf8, [](int, double) {}) * size / font().capital;
}

void text(Mask& mask, const glm::dvec2& at, std::string_view utf8, double size) {
  const double scale = size / font().capital, whole_y = std::floor(at.y);
  const auto scale_of_font = static_cast<float>(scale);
  std::vector<unsigned char> shares;
  for_each_glyph(utf8, [&](int glyph, double x_in_font) {
    const double x = at.x + scale * x_in_font, whole_x = std::floor(x);
    const auto shift_x = static_cast<float>(x - whole_x),
               shift_y = static_cast<float>(at.y - whole_y);
    int left, top, right, bottom;
    stbtt_GetGlyphBitmapBoxSubpixel(&font().info, glyph, scale_of_font, scale_of_font, shift_x,
                                    shift_y, &left, &top, &right, &bottom);
    const int width = right - left, height = bottom - top;
    if (width <= 0 || height <= 0) return;
    shares.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    stbtt_MakeGlyphBitmapSubpixel(&font().info, shares.data(), width, height, width, scale_of_font,
                                  scale_of_font, shift_x, shift_y, glyph);
    for (int row = 0; row < height; ++row)
      for (int column = 0; column < width; ++column) {
        const double px = whole_x + left + column, py = whole_y + top + row;
        if (px < 0 || px >= mask.width() || py < 0 || py >= mask.height()) continue;
        float& share = mask.at(static_cast<int>(px), static_cast<int>(py));
        const auto of = static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                        static_cast<std::size_t>(column);
        share = std::max(share, static_cast<float>(shares[of]) / 255.0f);
      }
  });
}

}  // namespace caplet::post
