// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Images in memory and on disk. EXR goes through OpenEXR; every other file type through OpenImageIO, which only image_oiio.cpp
// knows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "film/chromaticities.h"
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
  ColorSpace space = ColorSpace::srgb;           // its chromaticities are written
  std::optional<Chromaticities> chromaticities;  // as a file states them; written in place of the space's own
  std::map<std::string, std::string> metadata;   // attributes that are text or numbers

  /// The channel of that name, or null.
  const Channel* find(const std::string& name) const;
};

/// Writes a scanline EXR (ZIP, chromaticities, metadata as attributes) atomically. Throws RunError.
void write_exr(const std::filesystem::path& path, const LayeredImage& image);
/// Throws InputError when missing or broken. Half and float channels come as floats, uint as uints.
LayeredImage read_exr(const std::filesystem::path& path);

/// Tone-maps the R G B channels (film/preview.h) and writes the data window with 8 bits a channel, in the format of the
/// extension, atomically. Throws RunError or InputError.
void write_preview(const std::filesystem::path& path, const LayeredImage& image);
/// Throws InputError naming `flag` when write_preview could not write a file of that name's extension.
void check_preview_format(const std::filesystem::path& path, const std::string& flag);
/// True when OpenImageIO is built in.
bool has_image_io();

/// Reads EXR through OpenEXR and the rest (hdr, png...) through OpenImageIO. Files of integers are linearised from sRGB unless
/// they say otherwise; floats are linear. One channel is grey; alpha is multiplied in (over black); an EXR's chromaticities are
/// kept when they are a space of ours and converted to sRGB otherwise. Negative values become 0; NaN and infinity are errors.
class FileImageReader : public ImageReader {
 public:
  EnvironmentImage read_rgb(const std::filesystem::path& path) const override;
};

}  // namespace caplet
