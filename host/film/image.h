// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Images in memory and on disk. EXR goes through OpenEXR; every other file type through OpenImageIO, which only image_oiio.cpp
// knows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scene/image_reader.h"
#include "scene/spectrum.h"

namespace caplet {

/// One channel of a layered image: 32-bit floats or unsigned integers, row-major from the top, of the data window's size.
struct Channel {
  std::string name;                  // "R", "albedo.R", "N.X", "Z", "object.id"
  std::vector<float> floats;         // either
  std::vector<std::uint32_t> uints;  // or
};

struct LayeredImage {
  int width = 0, height = 0;                          // display window
  int x = 0, y = 0, data_width = 0, data_height = 0;  // data window (the crop) within it
  std::vector<Channel> channels;
  ColorSpace space = ColorSpace::srgb;  // its chromaticities are written
  std::map<std::string, std::string> metadata;
};

/// Writes a scanline EXR (ZIP, chromaticities, metadata as attributes) atomically. Throws RunError.
void write_exr(const std::filesystem::path& path, const LayeredImage& image);
/// Throws InputError when missing or broken. Half and float channels come as floats, uint as uints.
LayeredImage read_exr(const std::filesystem::path& path);

/// Tone-maps the R G B channels (exposure 1, a filmic shoulder that keeps hues, sRGB transfer) and writes 8-bit, by the
/// extension. Throws RunError or InputError.
void write_preview(const std::filesystem::path& path, const LayeredImage& image);
/// True when OpenImageIO is built in.
bool has_image_io();

/// Reads EXR through OpenEXR and the rest (hdr, png...) through OpenImageIO; PNG and other 8-bit files are linearised from sRGB.
class FileImageReader : public ImageReader {
 public:
  EnvironmentImage read_rgb(const std::filesystem::path& path) const override;
};

}  // namespace caplet
