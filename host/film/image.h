// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds images in memory and on disk. OpenEXR reads and writes EXR, libpng PNG, and
// OpenImageIO every other file type, in a module that is loaded when it is needed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "film/chromaticities.h"
#include "scene/backdrop.h"
#include "scene/image_reader.h"
#include "scene/image_writer.h"
#include "scene/spectrum.h"

namespace caplet {

/// Channel is one channel of a layered image: 32-bit floats or unsigned integers, row-major from
/// the top, of the data window's size.
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
  std::optional<Chromaticities>
      chromaticities;  // as a file states them; written in place of the space's own
  std::map<std::string, std::string> metadata;  // attributes that are text or numbers
  std::vector<std::string> views =
      {};  // of a multi-view picture, the one by default first (name_in_view)
  std::optional<Backdrop> backdrop = {};  // that lies under R G B by A
  PreviewExposure exposure = {};

  /// Returns the channel of that name, or null.
  const Channel* find(const std::string& name) const;
};

/// Returns the name of a channel of one view among those of all `views`, by the rules of multi-view
/// OpenEXR: plain channels of the first have their own names, and in all others the view's name is
/// put before the last part ("right.R", "albedo.left.R").
std::string name_in_view(const std::string& channel, const std::vector<std::string>& views,
                         std::size_t view);

/// BandedImage is a picture that is made in bands of whole rows, so that it is never in memory as a
/// whole.
struct BandedImage {
  LayeredImage whole;  // windows, space and metadata; no channels
  int rows = 1;        // of a band; the last one may have fewer
  /// Returns the rows from `first` on, counted from the data window's top, with the same channels
  /// each time. It is called once for each band, in order.
  std::function<LayeredImage(int first, int rows)> band;
};

/// Both are lossless. ZIP halves 32-bit float layers of noisy pictures, and takes ten times as long
/// as RLE, whose files are 1.2 to 1.3 times as large as ZIP's (docs/output.md).
enum class ExrCompression { zip, rle };

/// Returns ZIP where it takes at most a tenth of `seconds`, the time of the picture itself, on this
/// machine's cores; else RLE. `bytes`: of all layers.
ExrCompression compression_for(std::uint64_t bytes, double seconds, unsigned cores);

/// Writes a scanline EXR (chromaticities, metadata as attributes) as write_atomically does. Throws
/// RunError.
void write_exr(const std::filesystem::path& path, const LayeredImage& image,
               ExrCompression compression = ExrCompression::zip);
void write_exr(const std::filesystem::path& path, const BandedImage& image,
               ExrCompression compression = ExrCompression::zip);
/// Returns a good BandedImage::rows for that many 32-bit layers: some 32 MiB, and for each core one
/// of the 16 rows that ZIP packs.
int band_rows(int width, std::size_t channels);
/// Throws InputError naming `flag` when no EXR of `channels` 32-bit layers can have a data window
/// of that size.
void check_exr_size(int width, int height, std::size_t channels, const std::string& flag);
/// Reads an EXR. Throws InputError when missing or broken. Half and float channels are returned as
/// floats, uint as uints.
LayeredImage read_exr(const std::filesystem::path& path);

struct Shown;  // film/preview.h

/// Tone-maps the R G B channels (film/preview.h) and writes the data window with 8 bits a channel,
/// in the format of the extension, atomically; before a transparent backdrop with alpha. Throws
/// RunError or InputError.
void write_preview(const std::filesystem::path& path, const LayeredImage& image);
void write_preview(const std::filesystem::path& path, const Shown& shown);
/// Does the same from bytes as bytes_of (film/preview.h) makes them, 3 or 4 a pixel.
void write_preview(const std::filesystem::path& path, int width, int height,
                   const std::vector<std::uint8_t>& bytes);
/// Throws InputError naming `flag` when files of that extension have no alpha.
void check_preview_alpha(const std::filesystem::path& path, const std::string& flag);
/// Throws InputError naming `flag` when write_preview could not write a file of that name's
/// extension.
void check_preview_format(const std::filesystem::path& path, const std::string& flag);
/// Throws InputError naming `flag` when that format cannot hold a picture of this size.
void check_preview_size(const std::filesystem::path& path, int width, int height,
                        const std::string& flag);
/// Returns true when the build has the module of OpenImageIO.
bool has_image_io();

/// Reads EXR through OpenEXR, PNG through libpng and the rest (hdr, jpg...) through OpenImageIO.
/// Files of integers are linearised from sRGB unless they say otherwise; floats are linear. One
/// channel is grey; alpha is multiplied in (over black); an EXR's chromaticities are kept when they
/// are a space of ours and converted to sRGB otherwise. Negative values become 0; NaN and infinity
/// are errors.
class FileImageReader : public ImageReader {
 public:
  EnvironmentImage read_rgb(const std::filesystem::path& path) const override;
  /// Returns bytes for files that hold bytes, floats for all others. `encoding` is that of
  /// integers. One channel, or one and alpha, is grey; alpha of colours is kept unless it is 1
  /// everywhere. Negative values stay.
  TextureImage read_texture(const std::filesystem::path& path,
                            const ImageEncoding& encoding) const override;
};

/// Writes bytes in sRGB as PNG, and everything else as EXR of 32-bit floats, both atomically.
class FileImageWriter : public ImageWriter {
 public:
  File write(const std::filesystem::path& stem, const TextureImage& image) const override;
  File write(const std::filesystem::path& stem, const EnvironmentImage& image) const override;
};

}  // namespace caplet
