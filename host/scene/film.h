// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The film: its image and the filter of its pixels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "scene/backdrop.h"
#include "scene/field.h"
#include "scene/spectrum.h"
#include "shared/limits.h"

namespace caplet {

/// The most pixels of an image, a film or a texture.
inline constexpr std::int64_t most_image_pixels = std::int64_t{1} << 28;

/// Lists the names in scene files and pbrt-v4's default radii, in the order of PixelFilter::Kind.
inline constexpr std::array filter_names = {"box", "triangle", "gaussian", "mitchell", "sinc"};
inline constexpr std::array filter_radii = {0.5, 2.0, 1.5, 2.0, 4.0};

struct PixelFilter {
  enum class Kind { box, triangle, gaussian, mitchell, sinc } kind = Kind::gaussian;
  double radius_x = 1.5, radius_y = 1.5;  // pixels
  double sigma = 0.5;                     // gaussian
  double b = 1.0 / 3, c = 1.0 / 3;        // mitchell
  double tau = 3;                         // sinc: cycles until the window's zero

  void set_kind(Kind of) {
    *this = {};
    kind = of;
    radius_x = radius_y = filter_radii[static_cast<std::size_t>(of)];
  }
  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.number({"xradius", "half the width", 0, no_limit, "pixels", true}, self.radius_x);
    visit.number({"yradius", "half the height", 0, no_limit, "pixels", true}, self.radius_y);
    if (self.kind == Kind::gaussian)
      visit.number({"sigma", "standard deviation", 0, no_limit, "pixels", true}, self.sigma);
    if (self.kind == Kind::mitchell) {
      visit.number({"B", "share of the B-spline"}, self.b);
      visit.number({"C", "share of the cardinal spline"}, self.c);
    }
    if (self.kind == Kind::sinc)
      visit.number({"tau", "cycles until the window's zero", 0, no_limit, "", true}, self.tau);
  }
};

/// Lists where rolling shutters go: the rows or columns that begin later lie there.
inline constexpr std::array readout_orders = {"down", "up", "right", "left"};
inline constexpr Field readout_field = {
    "readout", "from the first row's exposure to the last one's: a rolling shutter", 0, no_limit,
    "seconds"};
inline constexpr Field readout_order_field = {"readoutorder",
                                              "where the rows, or columns, lie that come later"};

struct FilmSettings {
  int width = 1280, height = 720;
  std::optional<std::array<int, 4>> crop;  // x0, x1, y0, y1 in pixels, half open
  std::string filename;                    // as the scene file states it
  double iso = 100, exposure_time = 1;     // seconds
  double f_number = 0;                     // of the lens; 0: exposure does not know it
  double shutter_open = 0;                 // seconds; it closes exposure_time later
  double readout = 0;              // seconds between the first row's exposure and the last one's
  int readout_order = 0;           // of readout_orders
  double diagonal = 35;            // mm; realistic cameras alone know it
  double max_component_value = 0;  // largest exposed XYZ value of a sample; 0: unlimited
  double white_balance =
      0;  // kelvin: this daylight maps to the colour space's white; 0: no balancing
  ColorSpace space = ColorSpace::srgb;
  std::optional<Backdrop> backdrop = {};
  PreviewExposure exposure = {};
  bool denoise = false;    // the picture (film/denoise.h)
  int matte_levels = 6;    // the most things that mattes tell in a pixel
  double least_width = 0;  // pixels: capsules and spheres are drawn at least this thick
                           // (present/least_width.h); 0: no minimum

  /// Returns what multiplies light. With an f-number N a luminance of 120 N^2 / (iso
  /// exposure_time) candela per square metre becomes 1: what exposes to the speed that saturates a
  /// sensor, 78 / iso lux seconds, through a lens that passes 0.65 of its axial light (ISO
  /// 12232:2006, 6.2).
  double exposure_factor() const {
    const double seen = exposure_time * iso / 100;
    return f_number > 0 ? seen / (1.2 * f_number * f_number) : seen;
  }

  /// Returns for how long, in seconds, the shutter is open for some row.
  double open_time() const { return exposure_time + readout; }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.integer({"xresolution", "width", 1, most_image_pixels, "pixels"}, self.width);
    visit.integer({"yresolution", "height", 1, most_image_pixels, "pixels"}, self.height);
    visit.number({"iso", "sensitivity; 100 changes nothing", 0, no_limit, "", true}, self.iso);
    visit.number({"fnumber", "of the lens: 120 N^2 / (iso seconds) is white; 0: any", 0},
                 self.f_number);
    visit.number(
        {"diagonal", "of the film, of which realistic cameras alone know", 0, no_limit, "mm", true},
        self.diagonal);
    visit.number({"maxcomponentvalue", "the most that a sample adds; 0: any", 0},
                 self.max_component_value);
    visit.number({"whitebalance", "this daylight becomes white: 1000 to 25000, or 0 for none", 0,
                  25000, "kelvin"},
                 self.white_balance);
    visit.number({"exposure", "previews are brighter by so much", -most_stops, most_stops, "stops"},
                 self.exposure.stops);
    visit.flag({"autoexposure", "the picture tells how bright its previews are"},
               self.exposure.is_automatic);
    visit.flag({"denoise", "Open Image Denoise removes the noise of the picture"}, self.denoise);
    visit.integer({"mattelevels", "the most things that mattes tell in a pixel", 1, CAPLET_SLOTS},
                  self.matte_levels);
    visit.number({"leastwidth", "capsules and spheres are drawn no thinner", 0, 64, "pixels"},
                 self.least_width);
  }
};

}  // namespace caplet
