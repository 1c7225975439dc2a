// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Layered images as OpenEXR files.
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfCompression.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include <thread>

#include "base/atomic_file.h"
#include "base/check.h"
#include "base/error.h"
#include "film/chromaticities.h"
#include "film/image.h"
#include "film/limits.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

/// Compression and decompression use all cores; OpenEXR starts with none of its own.
int thread_count() {
  static const int count = [] {
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    Imf::setGlobalThreadCount(cores);
    return cores;
  }();
  return count;
}

Imf::Chromaticities to_imf(const Chromaticities& c) {
  const auto v = [](const std::array<double, 2>& xy) { return Imath::V2f(static_cast<float>(xy[0]), static_cast<float>(xy[1])); };
  return {v(c.red), v(c.green), v(c.blue), v(c.white)};
}

Chromaticities from_imf(const Imf::Chromaticities& c) {
  const auto a = [](const Imath::V2f& v) { return std::array<double, 2>{v.x, v.y}; };
  return {a(c.red), a(c.green), a(c.blue), a(c.white)};
}

/// The slice of a channel stored row-major over a data window whose corner is (x, y): OpenEXR addresses pixels absolutely.
template <class T>
Imf::Slice slice(Imf::PixelType type, T* data, std::int64_t x, std::int64_t y, std::int64_t width) {
  const std::int64_t corner = y * width + x;
  char* base = reinterpret_cast<char*>(data) - corner * static_cast<std::int64_t>(sizeof(T));
  return Imf::Slice(type, base, sizeof(T), sizeof(T) * static_cast<std::size_t>(width));
}

void check_channels(const LayeredImage& image) {
  const std::size_t pixels = static_cast<std::size_t>(image.data_width) * static_cast<std::size_t>(image.data_height);
  CHECK_LT_(std::size_t{0}, pixels);
  for (const Channel& channel : image.channels)
    CHECK_EQ_(channel.uints.empty() ? channel.floats.size() : channel.uints.size(), pixels);
}

std::string attribute_text(const Imf::Attribute& attribute) {
  if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute)) return text->value();
  if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(&attribute)) return fmt::format("{}", whole->value());
  if (const auto* real = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) return fmt::format("{}", real->value());
  if (const auto* real = dynamic_cast<const Imf::DoubleAttribute*>(&attribute)) return fmt::format("{}", real->value());
  return {};
}

/// Whether a codec can shrink smooth data further than zlib's 1:1032 allows.
bool is_lossy_block_codec(Imf::Compression compression) {
  return compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION || compression == Imf::B44A_COMPRESSION;
}

LayeredImage read_part(const fs::path& path, std::uintmax_t file_bytes, Imf::MultiPartInputFile& file) {
  const Imf::Header& header = file.header(0);
  if (header.hasType() && !Imf::isImage(header.type())) throw InputError(path.string() + ": deep EXR images are not supported");
  const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
  const std::int64_t width = std::int64_t{data.max.x} - data.min.x + 1, height = std::int64_t{data.max.y} - data.min.y + 1;

  LayeredImage image;
  std::uint64_t channel_count = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c, ++channel_count)
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
      throw InputError(fmt::format("{}: channel '{}' is subsampled, which is not supported", path.string(), c.name()));
  if (channel_count == 0) throw InputError(path.string() + ": has no channels");
  const bool lossy = is_lossy_block_codec(header.compression());
  check_image_size(path, width, height, channel_count * sizeof(float), lossy ? 64 * file_bytes : file_bytes);
  if (header.hasTileDescription()) {
    const Imf::TileDescription& tile = header.tileDescription();
    if (tile.xSize > max_image_side || tile.ySize > max_image_side || std::uint64_t{tile.xSize} * tile.ySize > max_tile_pixels)
      throw InputError(
          fmt::format("{}: tiles of {} x {} pixels are larger than supported", path.string(), tile.xSize, tile.ySize));
  }

  image.width = narrow<int>(std::int64_t{display.max.x} - display.min.x + 1);
  image.height = narrow<int>(std::int64_t{display.max.y} - display.min.y + 1);
  image.x = narrow<int>(std::int64_t{data.min.x} - display.min.x);
  image.y = narrow<int>(std::int64_t{data.min.y} - display.min.y);
  image.data_width = static_cast<int>(width);
  image.data_height = static_cast<int>(height);
  for (auto a = header.begin(); a != header.end(); ++a)
    if (const std::string text = attribute_text(a.attribute()); !text.empty()) image.metadata[a.name()] = text;
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
      frame.insert(channel.name, slice(Imf::UINT, channel.uints.data(), data.min.x, data.min.y, width));
    } else {
      channel.floats.resize(pixels);
      frame.insert(channel.name, slice(Imf::FLOAT, channel.floats.data(), data.min.x, data.min.y, width));
    }
  }
  Imf::InputPart part(file, 0);
  part.setFrameBuffer(frame);
  part.readPixels(data.min.y, data.max.y);
  return image;
}

}  // namespace

void write_exr(const fs::path& path, const LayeredImage& image) {
  check_channels(image);
  const Imath::Box2i display({0, 0}, {image.width - 1, image.height - 1});
  const Imath::Box2i data({image.x, image.y}, {image.x + image.data_width - 1, image.y + image.data_height - 1});
  Imf::Header header(display, data);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::addChromaticities(header, to_imf(image.chromaticities ? *image.chromaticities : chromaticities_of(image.space)));
  for (const auto& [name, value] : image.metadata) header.insert(name, Imf::StringAttribute(value));

  Imf::FrameBuffer frame;
  for (const Channel& channel : image.channels) {
    const bool whole = !channel.uints.empty();
    header.channels().insert(channel.name, Imf::Channel(whole ? Imf::UINT : Imf::FLOAT));
    // OpenEXR's slices are not const; writing only reads them.
    frame.insert(channel.name,
                 whole ? slice(Imf::UINT, const_cast<std::uint32_t*>(channel.uints.data()), image.x, image.y, image.data_width)
                       : slice(Imf::FLOAT, const_cast<float*>(channel.floats.data()), image.x, image.y, image.data_width));
  }
  try {
    write_atomically(path, [&](const fs::path& temporary) {
      Imf::OutputFile file(temporary.c_str(), header, thread_count());
      file.setFrameBuffer(frame);
      file.writePixels(image.data_height);
    });
  } catch (const RunError&) {
    throw;
  } catch (const std::exception& error) {
    throw RunError(fmt::format("{}: cannot be written: {}", path.string(), error.what()));
  }
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
    throw InputError(fmt::format("{}: not a readable EXR file: {}", path.string(), first_line(error.what())));
  }
}

}  // namespace caplet
