// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Textures of MJCF: built-in images, image files, and cubes of six faces.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "import/detail/mjcf.h"
#include "import/detail/text_file.h"

namespace caplet::mjcf {

namespace {

enum Builtin : std::size_t { none, gradient, checker, flat };
enum Mark : std::size_t { no_mark, edge, cross, dots };

using Rgb = std::array<std::uint8_t, 3>;
constexpr int kLargest = 4096;

struct Recipe {
  std::size_t builtin = none, mark = no_mark;
  glm::dvec3 rgb1{0.8}, rgb2{0.5}, mark_rgb{0};
  double random = 0.01;
};

Rgb bytes_of(const glm::dvec3& color) {
  Rgb out{};
  for (int k = 0; k < 3; ++k)
    out[static_cast<std::size_t>(k)] =
        static_cast<std::uint8_t>(255 * std::clamp(color[k], 0.0, 1.0));
  return out;
}

/// Returns rgb2 at -1, rgb1 at 1; the slope is greatest at 0.
Rgb between(const Recipe& recipe, double at) {
  const double share =
      std::clamp(0.5 * (1 + at / std::sqrt(1 + at * at) * std::numbers::sqrt2), 0.0, 1.0);
  return bytes_of(share * recipe.rgb1 + (1 - share) * recipe.rgb2);
}

Recipe recipe_of(const Element& of) {
  Recipe out;
  out.builtin = of.choice("builtin", {"none", "gradient", "checker", "flat"}, none);
  out.mark = of.choice("mark", {"none", "edge", "cross", "random"}, no_mark);
  out.rgb1 = of.vector("rgb1", out.rgb1);
  out.rgb2 = of.vector("rgb2", out.rgb2);
  out.mark_rgb = of.vector("markrgb", out.mark_rgb);
  out.random = of.number("random", out.random);
  return out;
}

int size_of(const Element& of, const char* name, int otherwise) {
  const double value = of.number(name, otherwise);
  if (!(value >= 1) || value > kLargest || value != std::floor(value))
    of.fail(fmt::format("{}: a whole number from 1 to {} is needed", name, kLargest));
  return static_cast<int>(value);
}

std::uint8_t* texel(Pixels& pixels, int row, int column) {
  return &pixels.rgb[3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(pixels.width) +
                          static_cast<std::size_t>(column))];
}
const std::uint8_t* texel(const Pixels& pixels, int row, int column) {
  return texel(const_cast<Pixels&>(pixels), row, column);
}
void set(Pixels& pixels, int row, int column, const Rgb& color) {
  std::ranges::copy(color, texel(pixels, row, column));
}

Pixels blank(int width, int height) {
  Pixels out;
  out.width = width;
  out.height = height;
  out.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  return out;
}

/// Sets every texel to `color(row, column)`.
template <class Color>
Pixels painted(int width, int height, Color&& color) {
  Pixels out = blank(width, height);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) set(out, row, column, color(row, column));
  return out;
}

void put_marks(Pixels& pixels, const Recipe& recipe, std::mt19937& numbers) {
  const Rgb color = bytes_of(recipe.mark_rgb);
  if (recipe.mark == edge || recipe.mark == cross) {
    for (int row = 0; row < pixels.height; ++row)
      for (int column = 0; column < pixels.width; ++column) {
        const bool outer =
            row == 0 || column == 0 || row == pixels.height - 1 || column == pixels.width - 1;
        const bool middle = row == pixels.height / 2 || column == pixels.width / 2;
        if (recipe.mark == edge ? outer : middle) set(pixels, row, column, color);
      }
  } else if (recipe.mark == dots) {
    const double most = static_cast<double>(std::mt19937::max());
    for (int row = 0; row < pixels.height; ++row)
      for (int column = 0; column < pixels.width; ++column)
        if (static_cast<double>(numbers()) < recipe.random * most) set(pixels, row, column, color);
  }
}

Pixels made(const Recipe& recipe, int width, int height) {
  if (recipe.builtin == checker)
    return painted(width, height, [&](int row, int column) {
      return bytes_of((row < height / 2) == (column < width / 2) ? recipe.rgb1 : recipe.rgb2);
    });
  return painted(width, height, [&](int, int) { return bytes_of(recipe.rgb1); });
}

/// MuJoCo's checkers continue across the edges of a cube, and its flat cubes have the second colour
/// on the bottom face.
Recipe of_face(Recipe recipe, std::size_t face) {
  constexpr std::size_t down = 3, front = 4;
  if ((recipe.builtin == checker && face >= front) || (recipe.builtin == flat && face == down))
    std::swap(recipe.rgb1, recipe.rgb2);
  return recipe;
}

Pixels read(const Element& of, const ImageReader& images, const std::string& name) {
  const std::filesystem::path path = of.model().file(of, name, of.model().compiler().textures);
  TextureImage image;
  try {
    image = images.read_texture(path, {ImageEncoding::Kind::srgb, 1});
  } catch (const InputError& error) {
    of.fail(error.what());
  }
  Pixels out = blank(image.width, image.height);
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < out.rgb.size() / 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t from = i * channels + (channels >= 3 ? k : 0);
      const double linear =
          image.floats.empty() ? 0 : std::clamp(static_cast<double>(image.floats[from]), 0.0, 1.0);
      const double screen =
          linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
      out.rgb[3 * i + k] = image.floats.empty()
                               ? image.bytes[from]
                               : static_cast<std::uint8_t>(std::lround(255 * screen));
    }
  const bool across = of.yes("hflip", false), upside = of.yes("vflip", false);
  if (!across && !upside) return out;
  return painted(out.width, out.height, [&](int row, int column) {
    const std::uint8_t* from =
        texel(out, upside ? out.height - 1 - row : row, across ? out.width - 1 - column : column);
    return Rgb{from[0], from[1], from[2]};
  });
}

/// Returns the direction at `theta` from z and `phi` around it from x.
glm::dvec3 direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Looks up a cube map by OpenGL's convention: x is right, y up, z front.
Rgb seen(const Cube& cube, const glm::dvec3& d) {
  const glm::dvec3 a = glm::abs(d);
  std::size_t face = 0;
  double s = 0, t = 0, most = 0;  // s runs right, t down
  if (a.x >= a.y && a.x >= a.z) {
    face = d.x > 0 ? 0 : 1;
    s = d.x > 0 ? -d.z : d.z;
    t = -d.y;
    most = a.x;
  } else if (a.y >= a.z) {
    face = d.y > 0 ? 2 : 3;
    s = d.x;
    t = d.y > 0 ? d.z : -d.z;
    most = a.y;
  } else {
    face = d.z > 0 ? 4 : 5;
    s = d.z > 0 ? d.x : -d.x;
    t = -d.y;
    most = a.z;
  }
  const Pixels& from = cube.faces[face];
  const auto at = [](double v, int size) {
    return std::clamp(static_cast<int>(0.5 * (v + 1) * size), 0, size - 1);
  };
  const std::uint8_t* value = texel(from, at(t / most, from.height), at(s / most, from.width));
  return {value[0], value[1], value[2]};
}

}  // namespace

Pixels flat_texture(const Element& of, const ImageReader& images) {
  const Recipe recipe = recipe_of(of);
  if (recipe.builtin == none) return read(of, images, of.text("file"));
  const int width = size_of(of, "width", 0), height = size_of(of, "height", 0);
  std::mt19937 numbers;
  Pixels out;
  if (recipe.builtin == gradient)
    out = painted(width, height, [&](int row, int column) {
      // Coordinates run from the centre outwards, 1 to -1 and beyond.
      const double x = 2.0 * column / std::max(1, width - 1) - 1,
                   y = 1 - 2.0 * row / std::max(1, height - 1);
      return between(recipe, 1 - 2 * std::hypot(x, y));
    });
  else
    out = made(recipe, width, height);
  put_marks(out, recipe, numbers);
  return out;
}

Cube cube_texture(const Element& of, const ImageReader& images) {
  const Recipe recipe = recipe_of(of);
  Cube out;
  std::mt19937 numbers;
  if (recipe.builtin != none) {
    const int size = std::min(size_of(of, "width", 0), 2048);
    for (std::size_t face = 0; face < 6; ++face) {
      Pixels& to = out.faces[face];
      if (recipe.builtin == gradient)
        to = painted(size, size, [&](int row, int column) {
          const double x = 2.0 * column / std::max(1, size - 1) - 1,
                       y = 1 - 2.0 * row / std::max(1, size - 1);
          const double reach = std::sqrt(1 + x * x + y * y);
          if (face == 2 || face == 3) {
            const double up = 1 - std::acos(1 / reach) * 2 * std::numbers::inv_pi;
            return between(recipe, face == 2 ? up : -up);
          }
          return between(recipe, std::asin(y / reach) * 2 * std::numbers::inv_pi);
        });
      else
        to = made(of_face(recipe, face), size, size);
      put_marks(to, recipe, numbers);
    }
    return out;
  }
  constexpr const char* files[] = {"fileright", "fileleft",  "fileup",
                                   "filedown",  "filefront", "fileback"};
  if (of.text("file").empty()) {
    for (std::size_t face = 0; face < 6; ++face)
      out.faces[face] =
          of.text(files[face]).empty() ? blank(1, 1) : read(of, images, of.text(files[face]));
  } else {
    const Pixels all = read(of, images, of.text("file"));
    const std::vector<double> grid = of.numbers("gridsize", 2, {1, 1});
    const std::string layout = of.text("gridlayout", "............");
    if (!(grid[0] >= 1 && grid[1] >= 1) || grid[0] * grid[1] > 12 ||
        grid[0] != std::floor(grid[0]) || grid[1] != std::floor(grid[1]))
      of.fail("gridsize: two whole numbers are needed, of a product of at most 12");
    const int rows = static_cast<int>(grid[0]), columns = static_cast<int>(grid[1]);
    const int width = all.width / columns, height = all.height / rows;
    if (width == 0 || height == 0) of.fail("the image is smaller than its grid");
    if (rows * columns == 1) {
      out.faces.fill(all);
    } else {
      if (layout.size() < static_cast<std::size_t>(rows * columns))
        of.fail("gridlayout: a letter for each part of the grid is needed");
      out.faces.fill(blank(1, 1));
      for (int part = 0; part < rows * columns; ++part) {
        const std::size_t face =
            std::string_view("RLUDFB").find(layout[static_cast<std::size_t>(part)]);
        if (face == std::string_view::npos) continue;
        out.faces[face] = painted(width, height, [&](int row, int column) {
          const std::uint8_t* from =
              texel(all, part / columns * height + row, part % columns * width + column);
          return Rgb{from[0], from[1], from[2]};
        });
      }
    }
  }
  for (Pixels& face : out.faces) put_marks(face, recipe, numbers);
  return out;
}

Pixels around(const Cube& cube, int height) {
  const int width = 2 * height;
  return painted(width, height, [&](int row, int column) {
    const glm::dvec3 d = direction(std::numbers::pi * (row + 0.5) / height,
                                   2 * std::numbers::pi * (column + 0.5) / width);
    return seen(cube, {d.x, d.z, -d.y});
  });
}

Pixels by_angles(const Cube& cube, int width) {
  const int height = 2 * width;
  return painted(width, height, [&](int row, int column) {
    return seen(cube, direction(std::numbers::pi * (column + 0.5) / width,
                                2 * std::numbers::pi * (1 - (row + 0.5) / height)));
  });
}

std::shared_ptr<const TextureImage> texture_image(const Pixels& pixels) {
  auto out = std::make_shared<TextureImage>();
  out->width = pixels.width;
  out->height = pixels.height;
  out->channels = 3;
  out->bytes = pixels.rgb;
  for (std::size_t i = 0; i < 256; ++i)
    out->decoded[i] = static_cast<float>(decoded_value({}, static_cast<double>(i) / 255));
  return out;
}

}  // namespace caplet::mjcf
