// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is the module of image files (film/detail/image_module.h). Only this file uses OpenImageIO.
// It links no room.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "film/detail/image_module.h"
#include "film/transfer.h"

namespace caplet::image_module {

namespace {

using image_files::Pixels;
using image_files::SizeCheck;
using image_files::StoredPixels;

/// Returns the exponent that linearises a file's values: 0 stands for the sRGB curve, 1 for none.
float decoding_exponent(const OIIO::ImageSpec& spec) {
  const std::string space = spec.get_string_attribute("oiio:ColorSpace");
  if (space.rfind("Gamma", 0) == 0) {
    const float gamma = spec.get_float_attribute("oiio:Gamma", 2.2f);
    return std::isfinite(gamma) && gamma > 0 ? gamma : 2.2f;
  }
  if (space == "Linear" || space == "linear" || space == "lin_srgb" || space == "scene_linear")
    return 1;
  return spec.format.is_floating_point() ? 1.0f : 0.0f;
}

/// Failure is thrown within the module, and returned as a text by all that it exports.
struct Failure {
  std::string why;
};

/// MemoryFile is a file in memory: the libraries of image formats write files by name, and not all
/// of them report that a disk is full.
class MemoryFile {
 public:
  MemoryFile() : number_(::memfd_create("caplet picture", MFD_CLOEXEC)) {
    if (number_ < 0) throw Failure{fmt::format("no file in memory: {}", std::strerror(errno))};
  }
  ~MemoryFile() { ::close(number_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return fmt::format("/proc/self/fd/{}", number_); }
  std::string bytes() const {
    std::string out(static_cast<std::size_t>(std::max<off_t>(0, ::lseek(number_, 0, SEEK_END))),
                    '\0');
    for (std::size_t at = 0; at < out.size();) {
      const ssize_t count =
          ::pread(number_, out.data() + at, out.size() - at, static_cast<off_t>(at));
      if (count <= 0)
        throw Failure{fmt::format("a file in memory cannot be read: {}", std::strerror(errno))};
      at += static_cast<std::size_t>(count);
    }
    return out;
  }

 private:
  int number_;
};

/// These formats' libraries refuse larger sides only when the picture is written, libjpeg by ending
/// the program: JPEG_MAX_DIMENSION, PNG_USER_WIDTH_MAX, WEBP_MAX_DIMENSION, and the 16 bits that
/// the other formats have for them.
struct Limit {
  std::string_view extension;
  int side;
};
constexpr Limit limits[] = {{".jpg", 65500},  {".jpeg", 65500}, {".jpe", 65500},   {".jif", 65500},
                            {".jfif", 65500}, {".jfi", 65500},  {".png", 1000000}, {".webp", 16383},
                            {".gif", 65535},  {".tga", 65535},  {".tpic", 65535},  {".sgi", 65535},
                            {".rgb", 65535},  {".rgba", 65535}, {".ico", 256}};

OIIO::ImageSpec spec_of_8bit(int width, int height, int channels = 3) {
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  if (channels == 4) spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("CompressionQuality", 95);
  return spec;
}

std::string error_text(const std::string& text) {
  return text.empty() ? "unknown reason" : text.substr(0, text.find('\n'));
}

std::string lower_case_extension(const std::filesystem::path& path) {
  std::string out = path.extension().string();
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// Opens a file and requests alpha unassociated.
std::unique_ptr<OIIO::ImageInput> opened(const std::filesystem::path& path) {
  OIIO::attribute(
      "limits:imagesize_MB",
      1 << 12);  // 2^28 pixels of 16 bytes: the caller's own limit (film/detail/limits.h)
  OIIO::ImageSpec wanted;
  wanted.attribute("oiio:UnassociatedAlpha", 1);
  std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string(), &wanted);
  if (!input) {
    const std::string why = OIIO::geterror();
    throw Failure{"not a readable image: " + error_text(why)};
  }
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.deep || spec.depth > 1 || spec.nchannels < 1) throw Failure{"not a flat image"};
  return input;
}

/// Sets the size of `out`, its channels, at most four, and which of these is alpha. `check` throws
/// where that is too large with so many bytes a value.
template <class Out>
void measure(const OIIO::ImageSpec& spec, std::uint64_t value_bytes, const SizeCheck& check,
             Out& out) {
  out.channels = std::min(spec.nchannels, 4);
  check(spec.width, spec.height, static_cast<std::uint64_t>(out.channels) * value_bytes);
  out.width = spec.width;
  out.height = spec.height;
  if (spec.alpha_channel >= 0 && spec.alpha_channel < out.channels) out.alpha = spec.alpha_channel;
}

template <class Out>
std::size_t value_count(const Out& of) {
  return static_cast<std::size_t>(of.width) * static_cast<std::size_t>(of.height) *
         static_cast<std::size_t>(of.channels);
}

void read_values(OIIO::ImageInput& input, int channels, OIIO::TypeDesc type, void* to) {
  if (!input.read_image(0, 0, 0, channels, type, to))
    throw Failure{"broken image: " + error_text(input.geterror())};
}

StoredPixels read_stored(const std::filesystem::path& path, const SizeCheck& check) {
  const std::unique_ptr<OIIO::ImageInput> input = opened(path);
  const OIIO::ImageSpec& spec = input->spec();
  const bool is_bytes = spec.format == OIIO::TypeDesc::UINT8;
  StoredPixels out;
  measure(spec, is_bytes ? 1 : sizeof(float), check, out);
  out.is_whole = !spec.format.is_floating_point();
  if (is_bytes) {
    out.bytes.resize(value_count(out));
    read_values(*input, out.channels, OIIO::TypeDesc::UINT8, out.bytes.data());
  } else {
    out.floats.resize(value_count(out));
    read_values(*input, out.channels, OIIO::TypeDesc::FLOAT, out.floats.data());
  }
  return out;
}

Pixels read_linear(const std::filesystem::path& path, const SizeCheck& check) {
  const std::unique_ptr<OIIO::ImageInput> input = opened(path);
  const OIIO::ImageSpec& spec = input->spec();

  Pixels out;
  measure(spec, sizeof(float), check, out);
  out.values.resize(value_count(out));
  read_values(*input, out.channels, OIIO::TypeDesc::FLOAT, out.values.data());

  const bool premultiplied = spec.get_int_attribute("oiio:UnassociatedAlpha", 0) == 0;
  const float exponent = decoding_exponent(spec);
  const std::size_t channels = static_cast<std::size_t>(out.channels);
  for (std::size_t i = 0; i < out.values.size(); ++i)
    if (static_cast<int>(i % channels) != out.alpha)
      out.values[i] = linear_from(out.values[i], exponent);
  // Associated alpha is already in the values.
  if (out.alpha >= 0 && premultiplied)
    for (std::size_t i = static_cast<std::size_t>(out.alpha); i < out.values.size(); i += channels)
      out.values[i] = 1;
  return out;
}

bool can_write(const std::filesystem::path& path) {
  if (path.extension().empty()) return false;
  const bool known = OIIO::ImageOutput::create(path.string()) != nullptr;
  if (!known) OIIO::geterror();  // fetched, or OpenImageIO would print it at the end of the program
  return known;
}

bool can_hold(const std::filesystem::path& path, int width, int height) {
  const std::string extension = lower_case_extension(path);
  for (const Limit& limit : limits)
    if (limit.extension == extension) return width <= limit.side && height <= limit.side;
  // The other formats report this when a file is begun. PNG's writer cannot be tested so: it prints
  // an error when nothing follows.
  const MemoryFile file;
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path.string());
  const bool opened = output && output->open(file.path(), spec_of_8bit(width, height));
  if (!output) OIIO::geterror();
  if (output && !opened) (void)output->geterror();
  return opened;
}

bool can_write_alpha(const std::filesystem::path& path) {
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path.string());
  if (!output) OIIO::geterror();
  return output && output->supports("alpha");
}

std::string encode_8bit(const std::filesystem::path& path, int width, int height, int channels,
                        const std::vector<std::uint8_t>& values) {
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path.string());
  if (!output) throw Failure{error_text(OIIO::geterror())};
  const auto write_to = [&](const std::string& name) {
    if (!output->open(name, spec_of_8bit(width, height, channels)) ||
        !output->write_image(OIIO::TypeDesc::UINT8, values.data()) || !output->close())
      throw Failure{"cannot be written: " + error_text(output->geterror())};
  };
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  // TIFF's proxy, in OpenImageIO 2.4, loses what is written on closing.
  if (output->supports("ioproxy") && std::string_view(output->format_name()) != "tiff" &&
      output->set_ioproxy(&memory)) {
    write_to(path.filename().string());
    return {bytes.begin(), bytes.end()};
  }
  const MemoryFile file;
  write_to(file.path());
  return file.bytes();
}

template <class Function>
std::string failure_of(const Function& function) {
  try {
    function();
    return {};
  } catch (const Failure& failure) {
    return failure.why;
  }
}

}  // namespace

}  // namespace caplet::image_module

extern "C" __attribute__((visibility("default"))) const caplet::image_files::Module*
caplet_image_module() {
  using namespace caplet::image_module;
  using caplet::image_files::Module;
  static const Module module = {
      .version = Module::current,
      .read_linear =
          [](const std::filesystem::path& path, const SizeCheck& check, Pixels& out) {
            return failure_of([&] { out = read_linear(path, check); });
          },
      .read_stored =
          [](const std::filesystem::path& path, const SizeCheck& check, StoredPixels& out) {
            return failure_of([&] { out = read_stored(path, check); });
          },
      .can_write = &can_write,
      .can_hold =
          [](const std::filesystem::path& path, int width, int height, bool& out) {
            return failure_of([&] { out = can_hold(path, width, height); });
          },
      .can_write_alpha = &can_write_alpha,
      .encode_8bit =
          [](const std::filesystem::path& path, int width, int height, int channels,
             const std::vector<std::uint8_t>& values, std::string& out) {
            return failure_of([&] { out = encode_8bit(path, width, height, channels, values); });
          },
  };
  return &module;
}
