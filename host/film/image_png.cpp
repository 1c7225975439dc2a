// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/detail/image_png.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>

#include "film/transfer.h"

namespace caplet::image_files {

namespace fs = std::filesystem;

namespace {

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

/// Failure holds the error that this file's own functions throw.
struct Failure {
  std::string why;
};

/// Errors holds libpng's last message; libpng leaves a function that failed by longjmp.
struct Errors {
  char text[128] = "";
};

[[noreturn]] void fail(png_structp png, png_const_charp message) {
  auto* const errors = static_cast<Errors*>(png_get_error_ptr(png));
  std::strncpy(errors->text, message, sizeof errors->text - 1);
  png_longjmp(png, 1);
}
void warn(png_structp, png_const_charp) {}

/// Calls a function that calls libpng, and throws libpng's message where it fails. The function
/// holds nothing that has a destructor.
template <class Function>
void guarded(png_structp png, const Errors& errors, const Function& function) {
  if (setjmp(png_jmpbuf(png)) != 0) throw Failure{errors.text};
  function();
}

struct Reader {
  explicit Reader(std::FILE* file)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &errors, &fail, &warn)) {
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) throw Failure{"libpng has no memory"};
    png_init_io(png, file);
    // The caller's own limits apply (film/detail/limits.h).
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  }
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  Errors errors;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

struct Writer {
  Writer() : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &errors, &fail, &warn)) {
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) throw Failure{"libpng has no memory"};
  }
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  Errors errors;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

struct Decoded {
  int width = 0, height = 0, channels = 0, alpha = -1;
  bool is_wide = false;             // 16 bits a value, else 8
  float exponent = 0;               // that linearises the values; 0: the sRGB curve
  std::vector<std::uint8_t> bytes;  // native order
};

/// Returns the exponent by which a file's values are linear: 1 over gAMA, to two places, unless the
/// file says sRGB or nothing (0).
float exponent_of(const Reader& reader) {
  int intent = 0;
  double gamma = 0;
  if (png_get_sRGB(reader.png, reader.info, &intent) != 0 ||
      png_get_gAMA(reader.png, reader.info, &gamma) == 0)
    return 0;
  return gamma > 0 ? static_cast<float>(std::round(100 / gamma) / 100) : 0;
}

/// Turns palettes, keys of transparency and fewer than eight bits into plain channels.
void ask_for_channels(const Reader& reader, Decoded& out) {
  png_structp png = reader.png;
  const png_byte type = png_get_color_type(png, reader.info),
                 depth = png_get_bit_depth(png, reader.info);
  const bool has_key = png_get_valid(png, reader.info, PNG_INFO_tRNS) != 0;
  if (type == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png);
  if (type == PNG_COLOR_TYPE_GRAY && depth < 8) png_set_expand_gray_1_2_4_to_8(png);
  if (has_key) png_set_tRNS_to_alpha(png);
  if (depth == 16 && std::endian::native == std::endian::little) png_set_swap(png);
  const bool is_grey = type == PNG_COLOR_TYPE_GRAY || type == PNG_COLOR_TYPE_GRAY_ALPHA;
  const bool has_alpha = has_key || (type & PNG_COLOR_MASK_ALPHA) != 0;
  out.channels = (is_grey ? 1 : 3) + (has_alpha ? 1 : 0);
  if (has_alpha) out.alpha = out.channels - 1;
  out.is_wide = depth == 16;
  out.width = static_cast<int>(png_get_image_width(png, reader.info));
  out.height = static_cast<int>(png_get_image_height(png, reader.info));
}

Decoded decode(const fs::path& path, const SizeCheck& check, bool as_floats) {
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) throw Failure{std::strerror(errno)};
  const Reader reader(file.get());
  Decoded out;
  guarded(reader.png, reader.errors, [&] {
    png_read_info(reader.png, reader.info);
    ask_for_channels(reader, out);
  });
  out.exponent = exponent_of(reader);
  check(out.width, out.height,
        static_cast<std::uint64_t>(out.channels) * (out.is_wide || as_floats ? sizeof(float) : 1));
  const auto height = static_cast<std::size_t>(out.height);
  const std::size_t row = static_cast<std::size_t>(out.width) *
                          static_cast<std::size_t>(out.channels) * (out.is_wide ? 2 : 1);
  out.bytes.resize(row * height);
  guarded(reader.png, reader.errors, [&] {
    const int passes = png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
    if (png_get_rowbytes(reader.png, reader.info) != row)
      png_error(reader.png, "an unknown kind of PNG");
    for (int pass = 0; pass < passes; ++pass)
      for (std::size_t y = 0; y < height; ++y)
        png_read_row(reader.png, out.bytes.data() + y * row, nullptr);
  });
  return out;
}

std::vector<float> floats_of(const Decoded& decoded) {
  if (!decoded.is_wide) {
    std::vector<float> out(decoded.bytes.size());
    std::ranges::transform(decoded.bytes, out.begin(),
                           [](std::uint8_t v) { return static_cast<float>(v) / 255.0f; });
    return out;
  }
  std::vector<float> out(decoded.bytes.size() / 2);
  for (std::size_t i = 0; i < out.size(); ++i) {
    std::uint16_t value = 0;
    std::memcpy(&value, decoded.bytes.data() + 2 * i, 2);
    out[i] = static_cast<float>(value) / 65535.0f;
  }
  return out;
}

template <class Out>
void describe(const Decoded& decoded, Out& out) {
  out.width = decoded.width;
  out.height = decoded.height;
  out.channels = decoded.channels;
  out.alpha = decoded.alpha;
}

template <class Function>
std::string failure_of(const char* what, const Function& function) {
  try {
    function();
    return {};
  } catch (const Failure& failure) {
    return what + (": " + failure.why);
  }
}

/// Format says what the rows of a PNG hold; those of 8 bits are sRGB.
struct Format {
  int width = 0, height = 0, type = PNG_COLOR_TYPE_RGB, bits = 8;
  std::size_t row_bytes = 0;
};

/// Encodes rows from the top; `out`: the file's bytes.
void encode(const Format& format, const std::uint8_t* rows, std::string& out) {
  const Writer writer;
  png_structp png = writer.png;
  out.clear();
  png_set_write_fn(
      png, &out,
      [](png_structp to, png_bytep data, png_size_t count) {
        static_cast<std::string*>(png_get_io_ptr(to))
            ->append(reinterpret_cast<const char*>(data), count);
      },
      nullptr);
  guarded(png, writer.errors, [&] {
    png_set_IHDR(png, writer.info, static_cast<png_uint_32>(format.width),
                 static_cast<png_uint_32>(format.height), format.bits, format.type,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (format.bits == 8) png_set_sRGB(png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, writer.info);
    for (std::size_t y = 0; y < static_cast<std::size_t>(format.height); ++y)
      png_write_row(png, rows + y * format.row_bytes);
    png_write_end(png, writer.info);
  });
}

}  // namespace

bool is_png(const fs::path& path) {
  const File file(std::fopen(path.c_str(), "rb"));
  std::array<png_byte, 8> begin{};
  return file && std::fread(begin.data(), 1, begin.size(), file.get()) == begin.size() &&
         png_sig_cmp(begin.data(), 0, begin.size()) == 0;
}

std::string read_png_stored(const fs::path& path, const SizeCheck& check, StoredPixels& out) {
  return failure_of("broken image", [&] {
    Decoded decoded = decode(path, check, false);
    describe(decoded, out);
    out.is_whole = true;
    if (decoded.is_wide)
      out.floats = floats_of(decoded);
    else
      out.bytes = std::move(decoded.bytes);
  });
}

std::string read_png_linear(const fs::path& path, const SizeCheck& check, Pixels& out) {
  return failure_of("broken image", [&] {
    const Decoded decoded = decode(path, check, true);
    describe(decoded, out);
    out.values = floats_of(decoded);
    const auto channels = static_cast<std::size_t>(out.channels);
    for (std::size_t i = 0; i < out.values.size(); ++i)
      if (static_cast<int>(i % channels) != out.alpha)
        out.values[i] = linear_from(out.values[i], decoded.exponent);
  });
}

std::string encode_png(int width, int height, int channels, const std::vector<std::uint8_t>& values,
                       std::string& out) {
  return failure_of("cannot be written", [&] {
    encode({.width = width,
            .height = height,
            .type = channels == 4   ? PNG_COLOR_TYPE_RGB_ALPHA
                    : channels == 3 ? PNG_COLOR_TYPE_RGB
                                    : PNG_COLOR_TYPE_GRAY,
            .bits = 8,
            .row_bytes = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels)},
           values.data(), out);
  });
}

std::string encode_grey_png(int width, int height, const std::vector<std::uint16_t>& values,
                            std::string& out) {
  std::vector<std::uint8_t> bytes;  // the higher one first
  bytes.reserve(2 * values.size());
  for (const std::uint16_t value : values) {
    bytes.push_back(static_cast<std::uint8_t>(value >> 8));
    bytes.push_back(static_cast<std::uint8_t>(value & 255));
  }
  return failure_of("cannot be written", [&] {
    encode({.width = width,
            .height = height,
            .type = PNG_COLOR_TYPE_GRAY,
            .bits = 16,
            .row_bytes = 2 * static_cast<std::size_t>(width)},
           bytes.data(), out);
  });
}

}  // namespace caplet::image_files
