// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads and writes layered images as OpenEXR files.
#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfCompression.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiView.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "base/atomic_file.h"
#include "base/check.h"
#include "base/error.h"
#include "base/threads.h"
#include "base/utf8.h"
#include "film/chromaticities.h"
#include "film/detail/checked_file.h"
#include "film/detail/limits.h"
#include "film/exr_bytes.h"
#include "film/image.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

/// Compression and decompression use all cores; OpenEXR starts with none of its own.
int thread_count() {
  static const int count = [] {
    const int cores = static_cast<int>(usable_threads());
    Imf::setGlobalThreadCount(cores);
    return cores;
  }();
  return count;
}

Imf::Chromaticities to_imf(const Chromaticities& c) {
  const auto v = [](const std::array<double, 2>& xy) {
    return Imath::V2f(static_cast<float>(xy[0]), static_cast<float>(xy[1]));
  };
  return {v(c.red), v(c.green), v(c.blue), v(c.white)};
}

Chromaticities from_imf(const Imf::Chromaticities& c) {
  const auto a = [](const Imath::V2f& v) { return std::array<double, 2>{v.x, v.y}; };
  return {a(c.red), a(c.green), a(c.blue), a(c.white)};
}

/// Returns the slice of a channel stored row-major over a data window whose corner is (x, y):
/// OpenEXR addresses pixels absolutely.
template <class T>
Imf::Slice slice(Imf::PixelType type, T* data, std::int64_t x, std::int64_t y, std::int64_t width) {
  const std::int64_t corner = y * width + x;
  char* base = reinterpret_cast<char*>(data) - corner * static_cast<std::int64_t>(sizeof(T));
  return Imf::Slice(type, base, sizeof(T), sizeof(T) * static_cast<std::size_t>(width));
}

std::string attribute_text(const Imf::Attribute& attribute) {
  if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute))
    return text->value();
  if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(&attribute))
    return fmt::format("{}", whole->value());
  if (const auto* real = dynamic_cast<const Imf::FloatAttribute*>(&attribute))
    return fmt::format("{}", real->value());
  if (const auto* real = dynamic_cast<const Imf::DoubleAttribute*>(&attribute))
    return fmt::format("{}", real->value());
  return {};
}

/// Returns whether a codec can shrink smooth data further than zlib's 1:1032 allows.
bool is_lossy_block_codec(Imf::Compression compression) {
  return compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION ||
         compression == Imf::B44A_COMPRESSION;
}

LayeredImage read_part(const fs::path& path, std::uintmax_t file_bytes,
                       Imf::MultiPartInputFile& file) {
  const Imf::Header& header = file.header(0);
  if (header.hasType() && !Imf::isImage(header.type()))
    throw InputError(path.string() + ": deep EXR images are not supported");
  const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
  const std::int64_t width = std::int64_t{data.max.x} - data.min.x + 1,
                     height = std::int64_t{data.max.y} - data.min.y + 1;

  LayeredImage image;
  std::uint64_t channel_count = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c, ++channel_count)
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
      throw InputError(fmt::format("{}: channel '{}' is subsampled, which is not supported",
                                   path.string(), c.name()));
  if (channel_count == 0) throw InputError(path.string() + ": has no channels");
  const bool lossy = is_lossy_block_codec(header.compression());
  check_image_size(path, width, height, channel_count * sizeof(float),
                   lossy ? 64 * file_bytes : file_bytes);
  if (header.hasTileDescription()) {
    const Imf::TileDescription& tile = header.tileDescription();
    if (tile.xSize > max_image_side || tile.ySize > max_image_side ||
        std::uint64_t{tile.xSize} * tile.ySize > max_tile_pixels)
      throw InputError(fmt::format("{}: tiles of {} x {} pixels are larger than supported",
                                   path.string(), tile.xSize, tile.ySize));
  }

  image.width = narrow<int>(std::int64_t{display.max.x} - display.min.x + 1);
  image.height = narrow<int>(std::int64_t{display.max.y} - display.min.y + 1);
  image.x = narrow<int>(std::int64_t{data.min.x} - display.min.x);
  image.y = narrow<int>(std::int64_t{data.min.y} - display.min.y);
  image.data_width = static_cast<int>(width);
  image.data_height = static_cast<int>(height);
  for (auto a = header.begin(); a != header.end(); ++a)
    if (const std::string text = attribute_text(a.attribute()); !text.empty())
      image.metadata[a.name()] = text;
  if (Imf::hasChromaticities(header)) {
    image.chromaticities = from_imf(Imf::chromaticities(header));
    if (const auto known = color_space_of(*image.chromaticities)) image.space = *known;
  }

  const std::size_t pixels = static_cast<std::size_t>(width * height);
  image.channels.reserve(channel_count);
  Imf::FrameBuffer frame;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    Channel& channel = image.channels.emplace_back();
    channel.name = c.name();
    if (c.channel().type == Imf::UINT) {
      channel.uints.resize(pixels);
      frame.insert(channel.name,
                   slice(Imf::UINT, channel.uints.data(), data.min.x, data.min.y, width));
    } else {
      channel.floats.resize(pixels);
      frame.insert(channel.name,
                   slice(Imf::FLOAT, channel.floats.data(), data.min.x, data.min.y, width));
    }
  }
  Imf::InputPart part(file, 0);
  part.setFrameBuffer(frame);
  part.readPixels(data.min.y, data.max.y);
  return image;
}

/// MemoryFile keeps what OpenEXR writes.
class MemoryFile : public Imf::OStream {
 public:
  MemoryFile() : Imf::OStream("an EXR in memory") {}

  void write(const char* bytes, int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (bytes_.size() < at_ + size) bytes_.resize(at_ + size);
    std::memcpy(bytes_.data() + at_, bytes, size);
    at_ += size;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t to) override { at_ = to; }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

void check_channels(const std::vector<Channel>& channels, int width, int rows) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(rows);
  CHECK_LT_(std::size_t{0}, pixels);
  for (const Channel& channel : channels)
    CHECK_EQ_(channel.uints.empty() ? channel.floats.size() : channel.uints.size(), pixels);
}

Imf::Header header_of(const LayeredImage& whole, const std::vector<Channel>& channels,
                      ExrCompression compression) {
  const Imath::Box2i display({0, 0}, {whole.width - 1, whole.height - 1});
  const Imath::Box2i data({whole.x, whole.y},
                          {whole.x + whole.data_width - 1, whole.y + whole.data_height - 1});
  Imf::Header header(display, data);
  header.compression() =
      compression == ExrCompression::zip ? Imf::ZIP_COMPRESSION : Imf::RLE_COMPRESSION;
  Imf::addChromaticities(header, to_imf(whole.chromaticities ? *whole.chromaticities
                                                             : chromaticities_of(whole.space)));
  if (!whole.views.empty()) Imf::addMultiView(header, whole.views);
  // Readers take texts for UTF-8, and Python's bindings of OpenEXR refuse others.
  for (const auto& [name, value] : whole.metadata)
    header.insert(name, Imf::StringAttribute(valid_utf8(value)));
  for (const Channel& channel : channels)
    header.channels().insert(channel.name,
                             Imf::Channel(channel.uints.empty() ? Imf::FLOAT : Imf::UINT));
  return header;
}

/// Returns the frame buffer of a band whose first row is `y` of the picture.
Imf::FrameBuffer frame_of(const LayeredImage& whole, const std::vector<Channel>& channels,
                          std::int64_t y) {
  Imf::FrameBuffer frame;
  // OpenEXR's slices are not const; writing only reads them.
  for (const Channel& channel : channels)
    frame.insert(channel.name,
                 channel.uints.empty()
                     ? slice(Imf::FLOAT, const_cast<float*>(channel.floats.data()), whole.x, y,
                             whole.data_width)
                     : slice(Imf::UINT, const_cast<std::uint32_t*>(channel.uints.data()), whole.x,
                             y, whole.data_width));
  return frame;
}

using BandOf = std::function<const LayeredImage&(int first, int rows)>;

void write_bands(Imf::OStream& stream, const LayeredImage& whole, int step,
                 ExrCompression compression, const BandOf& band_of) {
  std::optional<Imf::OutputFile> file;
  for (int first = 0; first < whole.data_height; first += step) {
    const int rows = std::min(step, whole.data_height - first);
    const std::vector<Channel>& channels = band_of(first, rows).channels;
    check_channels(channels, whole.data_width, rows);
    if (!file) file.emplace(stream, header_of(whole, channels, compression), thread_count());
    file->setFrameBuffer(frame_of(whole, channels, std::int64_t{whole.y} + first));
    file->writePixels(rows);
  }
}

void write_bands(const fs::path& path, const LayeredImage& whole, int step,
                 ExrCompression compression, const BandOf& band_of) {
  try {
    write_atomically(path, [&](const fs::path& temporary) {
      CheckedFile stream(temporary, path);
      write_bands(stream, whole, step, compression, band_of);
      stream.close();
    });
  } catch (const Iex::BaseExc& error) {
    throw RunError(
        fmt::format("{}: cannot be written: {}", path.string(), first_line(error.what())));
  }
}

}  // namespace

std::string name_in_view(const std::string& channel, const std::vector<std::string>& views,
                         std::size_t view) {
  return Imf::insertViewName(channel, views, narrow<int>(view));
}

ExrCompression compression_for(std::uint64_t bytes, double seconds, unsigned cores) {
  // OpenEXR 3.1 packs some 60 MB/s of such layers on each core of a server of 2020.
  constexpr double zip_bytes_per_second = 6e7, share = 0.1;
  const double zip_seconds =
      static_cast<double>(bytes) / (zip_bytes_per_second * std::max(1u, cores));
  return zip_seconds <= share * seconds ? ExrCompression::zip : ExrCompression::rle;
}

int band_rows(int width, std::size_t channels) {
  constexpr std::size_t wanted_bytes = std::size_t{1} << 25, block_rows = 16;
  const std::size_t row_bytes =
      std::max<std::size_t>(1, static_cast<std::size_t>(width) * channels * sizeof(float));
  const std::size_t blocks = std::max(wanted_bytes / (row_bytes * block_rows),
                                      std::min<std::size_t>(16, usable_threads()));
  return narrow<int>(block_rows * blocks);
}

void check_exr_size(int width, int height, std::size_t channels, const std::string& flag) {
  // OpenEXR counts the bytes of ZIP's 16 rows in an int, and no picture is written that read_exr
  // would not read.
  const std::uint64_t block_bytes =
      static_cast<std::uint64_t>(width) * channels * sizeof(float) * 16;
  if (width > max_image_side || height > max_image_side ||
      block_bytes > std::numeric_limits<int>::max())
    throw InputError(
        SourceLocation{flag},
        fmt::format("an EXR of {} x {} pixels in {} layers cannot be written (at most {} a side)",
                    width, height, channels, max_image_side));
}

void write_exr(const fs::path& path, const BandedImage& image, ExrCompression compression) {
  CHECK_LT_(0, image.rows);
  LayeredImage band;
  write_bands(path, image.whole, image.rows, compression,
              [&](int first, int rows) -> const LayeredImage& {
                band = LayeredImage();  // before the next one is made
                return band = image.band(first, rows);
              });
}

void write_exr(const fs::path& path, const LayeredImage& image, ExrCompression compression) {
  check_channels(image.channels, image.data_width, image.data_height);
  write_bands(path, image, image.data_height, compression,
              [&](int, int) -> const LayeredImage& { return image; });
}

std::string exr_bytes(const LayeredImage& image) try {
  check_channels(image.channels, image.data_width, image.data_height);
  MemoryFile stream;
  const auto all = [&](int, int) -> const LayeredImage& { return image; };
  write_bands(stream, image, image.data_height, ExrCompression::zip, all);
  return stream.take();
} catch (const Iex::BaseExc& error) {
  throw RunError(fmt::format("an EXR cannot be made: {}", first_line(error.what())));
}

LayeredImage read_exr(const fs::path& path) {
  const std::uintmax_t file_bytes = readable_file_bytes(path);
  Imf::Header::setMaxImageSize(max_image_side, max_image_side);
  try {
    Imf::MultiPartInputFile file(path.c_str(), thread_count());
    return read_part(path, file_bytes, file);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(
        fmt::format("{}: not a readable EXR file: {}", path.string(), first_line(error.what())));
  }
}

}  // namespace caplet
