// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A stroke font of one weight, without files or libraries.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "base/utf8.h"
#include "post/detail/canvas.h"

namespace caplet::post {

namespace {

/// Capitals are 12 high and small letters 8, above a baseline at 0. Strokes are p, a polyline; c,
/// an open curve from the first point to the last (a quadratic B-spline of the points); o, a closed
/// one.
struct Letter {
  double width;
  const char* strokes;
};

constexpr double gap = 3.2, capital = 12, weight = 1.35;

const std::map<char32_t, Letter>& letters() {
  static const std::map<char32_t, Letter> all = {
      {U' ', {3, ""}},
      {U'0', {8, "o 0,0 8,0 8,12 0,12"}},
      {U'1', {5, "p 0.5,9.5 3.5,12 3.5,0"}},
      {U'2', {8, "c 0.5,9 0.5,12.6 7.7,12.6 7.7,7.5 4,4.5 0.3,0 p 0.3,0 8,0"}},
      {U'3',
       {8, "c 0.6,10.5 1.2,12.4 7.4,12.8 7.4,6.6 3,6.6 c 3,6.6 8.4,6.6 8.4,-0.6 1,-0.4 0.3,2"}},
      {U'4', {8, "p 6.2,0 6.2,12 0,3.6 8,3.6"}},
      {U'5', {8, "p 7.2,12 1.2,12 0.7,6.6 c 0.7,6.6 3,8 8,8 8,-0.4 1.2,-0.8 0.3,2"}},
      {U'6', {8, "c 7.2,10.8 5.6,12.6 0,12.8 0,3.7 o 0,0 8,0 8,7.4 0,7.4"}},
      {U'7', {8, "p 0,12 8,12 3,0"}},
      {U'8', {8, "o 0.6,6.3 7.4,6.3 7.4,12 0.6,12 o 0,0 8,0 8,6.3 0,6.3"}},
      {U'9', {8, "c 0.8,1.2 2.4,-0.6 8,-0.8 8,8.3 o 0,4.6 8,4.6 8,12 0,12"}},
      {U'.', {1.5, "p 0.75,0 0.75,0"}},
      {U',', {1.5, "p 1,0 0.2,-2"}},
      {U':', {1.5, "p 0.75,1 0.75,1 p 0.75,7 0.75,7"}},
      {U'-', {6, "p 0.5,5 5.5,5"}},
      {U'+', {7, "p 0.5,5 6.5,5 p 3.5,2 3.5,8"}},
      {U'=', {7, "p 0.5,3.6 6.5,3.6 p 0.5,6.8 6.5,6.8"}},
      {U'/', {6, "p 0,-1 6,13"}},
      {U'_', {7, "p 0,-1 7,-1"}},
      {U'(', {3, "c 3,13.5 0,10 0,2.5 3,-1.5"}},
      {U')', {3, "c 0,13.5 3,10 3,2.5 0,-1.5"}},
      {U'[', {3, "p 3,13 0,13 0,-1.5 3,-1.5"}},
      {U']', {3, "p 0,13 3,13 3,-1.5 0,-1.5"}},
      {U'%', {10, "p 1.5,0 8.5,12 o 0,7.5 4,7.5 4,12.3 0,12.3 o 6,-0.3 10,-0.3 10,4.5 6,4.5"}},
      {U'\u00b0', {4, "o 0,8.5 4,8.5 4,12.5 0,12.5"}},
      {U'\u00b2', {4.4, "c 0.2,11 0.2,13.4 4.2,13.4 4.2,10.6 0,7.4 p 0,7.4 4.4,7.4"}},
      {U'\u00b3',
       {4.4, "c 0.3,12.4 0.6,13.6 4,13.6 4,10.7 1.6,10.7 c 1.6,10.7 4.6,10.7 4.6,7 0.4,7 0.1,8.4"}},
      {U'\u00b5', {6.5, "p 0,8 0,-4 c 0,3 0,-0.6 6,-0.8 6,4 p 6,8 6,0"}},
      {U'\u03bc', {6.5, "p 0,8 0,-4 c 0,3 0,-0.6 6,-0.8 6,4 p 6,8 6,0"}},
      {U'\u00c5', {8, "p 0,0 4,10.4 8,0 p 1.4,3.6 6.6,3.6 o 2.4,10.6 5.6,10.6 5.6,14 2.4,14"}},
      {U'A', {8, "p 0,0 4,12 8,0 p 1.4,4 6.6,4"}},
      {U'B',
       {7.6,
        "p 4,0 0,0 0,12 3.8,12 c 3.8,12 7.2,12 7.2,6.4 3.8,6.4 p 0,6.4 4,6.4 c 4,6.4 8.2,6.4 8.2,0 "
        "4,0"}},
      {U'C', {8, "c 8,9.4 7,12.8 0,13 0,-1 7,-0.8 8,2.6"}},
      {U'D', {8, "p 3,0 0,0 0,12 3,12 c 3,12 8.4,12 8.4,0 3,0"}},
      {U'E', {7, "p 7,12 0,12 0,0 7,0 p 0,6.4 6,6.4"}},
      {U'F', {7, "p 7,12 0,12 0,0 p 0,6.4 6,6.4"}},
      {U'G', {8, "c 8,9.4 7,12.8 0,13 0,-1 8,-1 8,5.4 p 8,5.4 5,5.4"}},
      {U'H', {8, "p 0,0 0,12 p 8,0 8,12 p 0,6.4 8,6.4"}},
      {U'I', {2, "p 1,0 1,12"}},
      {U'J', {6, "p 5.5,12 5.5,3.6 c 5.5,3.6 5.5,-1 0.2,-0.8 0,2.8"}},
      {U'K', {7.5, "p 0,0 0,12 p 7.2,12 0,4.6 p 2.6,7.2 7.5,0"}},
      {U'L', {6.5, "p 0,12 0,0 6.5,0"}},
      {U'M', {9.5, "p 0,0 0,12 4.75,4 9.5,12 9.5,0"}},
      {U'N', {8, "p 0,0 0,12 8,0 8,12"}},
      {U'O', {9, "o 0,-0.2 9,-0.2 9,12.2 0,12.2"}},
      {U'P', {7.5, "p 0,0 0,12 4,12 c 4,12 8,12 8,5.6 4,5.6 p 4,5.6 0,5.6"}},
      {U'Q', {9, "o 0,-0.2 9,-0.2 9,12.2 0,12.2 p 5.4,3.4 9,-1"}},
      {U'R', {8, "p 0,0 0,12 4,12 c 4,12 8,12 8,5.8 4,5.8 p 0,5.8 4,5.8 8,0"}},
      {U'S', {8, "c 7.5,10 6.8,12.6 0.2,13 0.2,8.6 1.6,6.6 6.8,6.4 8,3.2 8,-1 0.8,-0.8 0,2.4"}},
      {U'T', {8, "p 0,12 8,12 p 4,12 4,0"}},
      {U'U', {8, "p 0,12 0,4.4 c 0,4.4 0,-1.4 8,-1.4 8,4.4 p 8,4.4 8,12"}},
      {U'V', {8, "p 0,12 4,0 8,12"}},
      {U'W', {11, "p 0,12 2.75,0 5.5,9 8.25,0 11,12"}},
      {U'X', {8, "p 0,0 8,12 p 0,12 8,0"}},
      {U'Y', {8, "p 0,12 4,6 8,12 p 4,6 4,0"}},
      {U'Z', {8, "p 0,12 8,12 0,0 8,0"}},
      {U'a', {6.5, "o 0,-0.3 6.5,-0.3 6.5,8.3 0,8.3 p 6.5,8 6.5,0"}},
      {U'b', {6.5, "p 0,12 0,0 o 0,-0.3 6.5,-0.3 6.5,8.3 0,8.3"}},
      {U'c', {6, "c 6,6.4 5,8.7 0,8.7 0,-0.7 5,-0.7 6,1.6"}},
      {U'd', {6.5, "o 0,-0.3 6.5,-0.3 6.5,8.3 0,8.3 p 6.5,12 6.5,0"}},
      {U'e', {6.5, "p 0.2,4.1 6.4,4.1 c 6.4,4.1 6.4,8.7 0,8.7 0,-0.7 5.2,-0.7 6.2,1.5"}},
      {U'f', {4.5, "c 4.5,11.8 1.7,12.6 1.7,8.6 p 1.7,9 1.7,0 p 0,8 4,8"}},
      {U'g',
       {6.5, "o 0,-0.3 6.5,-0.3 6.5,8.3 0,8.3 p 6.5,8 6.5,-1 c 6.5,-1 6.5,-4.6 1,-4.4 0.4,-2.6"}},
      {U'h', {6, "p 0,12 0,0 c 0,4.6 0.8,8.4 6,9.4 6,4.6 p 6,4.6 6,0"}},
      {U'i', {2, "p 1,8 1,0 p 1,11 1,11"}},
      {U'j', {2.5, "p 1.8,8 1.8,-1.6 c 1.8,-1.6 1.8,-4.2 -0.6,-4 p 1.8,11 1.8,11"}},
      {U'k', {6, "p 0,12 0,0 p 5.5,8 0,3.2 p 2,5 6,0"}},
      {U'l', {3, "p 1,12 1,2 c 1,2 1,-0.3 3,0.2"}},
      {U'm',
       {9.6,
        "p 0,8 0,0 c 0,4.6 0.6,8.4 4.8,9.4 4.8,4.6 p 4.8,4.8 4.8,0 c 4.8,4.6 5.4,8.4 9.6,9.4 "
        "9.6,4.6 p 9.6,4.6 9.6,0"}},
      {U'n', {6, "p 0,8 0,0 c 0,4.6 0.8,8.4 6,9.4 6,4.6 p 6,4.6 6,0"}},
      {U'o', {6.5, "o 0,-0.3 6.5,-0.3 6.5,8.3 0,8.3"}},
      {U'p', {6.5, "p 0,8 0,-4 o 0,-0.3 6.5,-0.3 6.5,8.3 0,8.3"}},
      {U'q', {6.5, "o 0,-0.3 6.5,-0.3 6.5,8.3 0,8.3 p 6.5,8 6.5,-4"}},
      {U'r', {4, "p 0,8 0,0 c 0,4.6 0.8,8 4,8"}},
      {U's', {5.6, "c 5.3,6.6 4.8,8.6 0,8.7 0.2,5.2 1.6,4.2 5,4 5.8,1.8 5.6,-0.8 0.6,-0.6 0,1.6"}},
      {U't', {4.5, "p 1.7,11 1.7,2.6 c 1.7,2.6 1.7,-0.6 4.5,0.2 p 0,8 4,8"}},
      {U'u', {6, "p 0,8 0,3.4 c 0,3.4 0,-1.4 5.2,-0.4 6,3.4 p 6,8 6,0"}},
      {U'v', {6, "p 0,8 3,0 6,8"}},
      {U'w', {8.4, "p 0,8 2.1,0 4.2,6.4 6.3,0 8.4,8"}},
      {U'x', {6, "p 0,8 6,0 p 0,0 6,8"}},
      {U'y', {6, "p 0,8 3,0 p 6,8 3,0 1.5,-4"}},
      {U'z', {6, "p 0,8 6,8 0,0 6,0"}},
  };
  return all;
}

const Letter& letter_of(char32_t code) {
  static const Letter unknown{7, "p 0,0 7,0 7,12 0,12 0,0"};
  const auto found = letters().find(code);
  return found == letters().end() ? unknown : found->second;
}

std::vector<char32_t> codes_of(std::string_view utf8) {
  std::vector<char32_t> out;
  while (!utf8.empty()) out.push_back(take_character(utf8));
  return out;
}

std::vector<glm::dvec2> points_of(std::string_view& text) {
  std::vector<glm::dvec2> out;
  while (!text.empty() && text.front() == ' ') {
    const char* end = text.data() + text.size();
    glm::dvec2 p(0);
    const auto x = std::from_chars(text.data() + 1, end, p.x);
    if (x.ec != std::errc()) {
      text.remove_prefix(1);  // blanks before the next stroke
      break;
    }
    const auto y = std::from_chars(x.ptr + 1, end, p.y);
    out.push_back(p);
    text.remove_prefix(static_cast<std::size_t>(y.ptr - text.data()));
  }
  return out;
}

/// Evaluates a quadratic B-spline by corner cutting (Chaikin 1974), which keeps the ends of an open
/// one.
std::vector<glm::dvec2> curve(std::vector<glm::dvec2> points, bool is_closed) {
  for (int round = 0; round < 4; ++round) {
    std::vector<glm::dvec2> cut;
    const std::size_t count = points.size(), sides = is_closed ? count : count - 1;
    if (!is_closed) cut.push_back(points.front());
    for (std::size_t i = 0; i < sides; ++i) {
      const glm::dvec2 a = points[i], b = points[(i + 1) % count];
      if (is_closed || i > 0) cut.push_back(0.75 * a + 0.25 * b);
      if (is_closed || i + 1 < sides) cut.push_back(0.25 * a + 0.75 * b);
    }
    if (!is_closed) cut.push_back(points.back());
    points = std::move(cut);
  }
  if (is_closed) points.push_back(points.front());
  return points;
}

}  // namespace

double text_width(std::string_view utf8, double size) {
  double width = 0;
  for (const char32_t code : codes_of(utf8)) width += letter_of(code).width + gap;
  return std::max(0.0, width - gap) * size / capital;
}

void text(Mask& mask, const glm::dvec2& at, std::string_view utf8, double size) {
  const double scale = size / capital;
  double x = at.x;
  for (const char32_t code : codes_of(utf8)) {
    const Letter& letter = letter_of(code);
    for (std::string_view rest = letter.strokes; !rest.empty();) {
      const char kind = rest.front();
      rest.remove_prefix(1);
      std::vector<glm::dvec2> points = points_of(rest);
      if (kind != 'p') points = curve(std::move(points), kind == 'o');
      for (std::size_t i = 0; i + 1 < points.size(); ++i)
        mask.line({x + scale * points[i].x, at.y - scale * points[i].y},
                  {x + scale * points[i + 1].x, at.y - scale * points[i + 1].y}, weight * scale);
    }
    x += scale * (letter.width + gap);
  }
}

}  // namespace caplet::post
