// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Image files other than EXR through OpenImageIO: the one file that knows it.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "film/image_files.h"
#include "film/limits.h"
#include "film/transfer.h"

namespace caplet::image_files {

namespace {

/// The exponent that linearises a file's values: 0 stands for the sRGB curve, 1 for none.
float decoding_exponent(const OIIO::ImageSpec& spec) {
  const std::string space = spec.get_string_attribute("oiio:ColorSpace");
  if (space.rfind("Gamma", 0) == 0) {
    const float gamma = spec.get_float_attribute("oiio:Gamma", 2.2f);
    return std::isfinite(gamma) && gamma > 0 ? gamma : 2.2f;
  }
  if (space == "Linear" || space == "linear" || space == "lin_srgb" || space == "scene_linear") return 1;
  return spec.format.is_floating_point() ? 1.0f : 0.0f;
}

float linear(float value, float exponent) {
  if (exponent == 1) return value;
  return exponent == 0 ? linear_from_srgb(value) : std::copysign(std::pow(std::abs(value), exponent), value);
}

std::string error_text(const std::string& text) { return text.empty() ? "unknown reason" : first_line(text); }

}  // namespace

bool available() { return true; }

Pixels read_linear(const std::filesystem::path& path) {
  const std::uintmax_t file_bytes = readable_file_bytes(path);
  OIIO::attribute("limits:imagesize_MB", static_cast<int>((max_image_pixels * 16) >> 20));
  OIIO::ImageSpec wanted;
  wanted.attribute("oiio:UnassociatedAlpha", 1);
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string(), &wanted);
  if (!input) {
    const std::string why = OIIO::geterror();
    throw InputError(fmt::format("{}: not a readable image: {}", path.string(), error_text(why)));
  }
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.deep || spec.depth > 1 || spec.nchannels < 1) throw InputError(fmt::format("{}: not a flat image", path.string()));

  Pixels out;
  out.channels = std::min(spec.nchannels, 4);
  check_image_size(path, spec.width, spec.height, static_cast<std::uint64_t>(out.channels) * sizeof(float), file_bytes);
  out.width = spec.width;
  out.height = spec.height;
  if (spec.alpha_channel >= 0 && spec.alpha_channel < out.channels) out.alpha = spec.alpha_channel;
  out.values.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) *
                    static_cast<std::size_t>(out.channels));
  if (!input->read_image(0, 0, 0, out.channels, OIIO::TypeDesc::FLOAT, out.values.data()))
    throw InputError(fmt::format("{}: broken image: {}", path.string(), error_text(input->geterror())));

  const bool premultiplied = spec.get_int_attribute("oiio:UnassociatedAlpha", 0) == 0;
  const float exponent = decoding_exponent(spec);
  const std::size_t channels = static_cast<std::size_t>(out.channels);
  for (std::size_t i = 0; i < out.values.size(); ++i)
    if (static_cast<int>(i % channels) != out.alpha) out.values[i] = linear(out.values[i], exponent);
  // Associated alpha is in the values already.
  if (out.alpha >= 0 && premultiplied)
    for (std::size_t i = static_cast<std::size_t>(out.alpha); i < out.values.size(); i += channels) out.values[i] = 1;
  return out;
}

bool can_write(const std::filesystem::path& path) {
  if (path.extension().empty()) return false;
  const bool known = OIIO::ImageOutput::create(path.string()) != nullptr;
  if (!known) OIIO::geterror();  // taken, or it would surface at the end of the program
  return known;
}

void write_rgb8(const std::filesystem::path& path, int width, int height, const std::vector<std::uint8_t>& rgb) {
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path.string());
  if (!output) throw RunError(fmt::format("{}: {}", path.string(), error_text(OIIO::geterror())));
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("CompressionQuality", 95);
  if (!output->open(path.string(), spec) || !output->write_image(OIIO::TypeDesc::UINT8, rgb.data()) || !output->close())
    throw RunError(fmt::format("{}: cannot be written: {}", path.string(), error_text(output->geterror())));
}

}  // namespace caplet::image_files
