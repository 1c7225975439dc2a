// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/images.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <string_view>

#include "base/check.h"
#include "base/error.h"
#include "scene/field.h"
#include "shared/octahedron.h"

namespace caplet {

namespace {

struct Level {
  std::size_t width, height;
  std::vector<float> values;  // linear
};

/// Returns a level of half the sides, both of which are powers of two.
Level halved(const Level& from, std::size_t channels) {
  Level to{std::max<std::size_t>(1, from.width / 2), std::max<std::size_t>(1, from.height / 2), {}};
  to.values.resize(to.width * to.height * channels);
  const std::size_t across = from.width / to.width, down = from.height / to.height;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, to.height, 16),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t y = range.begin(); y < range.end(); ++y)
          for (std::size_t x = 0; x < to.width; ++x)
            for (std::size_t c = 0; c < channels; ++c) {
              double sum = 0;
              for (std::size_t j = 0; j < down; ++j)
                for (std::size_t i = 0; i < across; ++i)
                  sum += static_cast<double>(
                      from.values[((down * y + j) * from.width + across * x + i) * channels + c]);
              to.values[(y * to.width + x) * channels + c] =
                  static_cast<float>(sum / static_cast<double>(across * down));
            }
      });
  return to;
}

/// Returns sin(pi x) / (pi x).
double sinc_pi(double x) {
  return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
}

/// Taps are, along one axis, the four texels about a new one's centre, by Lanczos' filter.
struct Taps {
  Taps(std::size_t i, std::size_t from, std::size_t to) {
    const double center =
        (static_cast<double>(i) + 0.5) * static_cast<double>(from) / static_cast<double>(to);
    first = static_cast<int>(std::floor(center - 1.5));
    double sum = 0;
    for (int j = 0; j < 4; ++j) {
      const double x = first + j + 0.5 - center;
      weights[j] = std::abs(x) < 2 ? sinc_pi(x) * sinc_pi(x / 2) : 0;
      sum += weights[j];
    }
    for (double& weight : weights) weight /= sum;
  }
  int first;
  double weights[4];
};

/// Returns the texel that (x, y) stands for, or none (kernels/textures/images.cl).
std::optional<std::size_t> wrapped(int x, int y, int width, int height, int wrap) {
  const auto repeated = [](int v, int n) { return (v % n + n) % n; };
  const auto beyond = [&] { return x < 0 || y < 0 || x >= width || y >= height; };
  if (wrap == CAPLET_WRAP_BLACK && beyond()) return std::nullopt;
  if (wrap == CAPLET_WRAP_REPEAT) {
    x = repeated(x, width);
    y = repeated(y, height);
  } else if (wrap == CAPLET_WRAP_OCTAHEDRAL) {
    fold_over_edges(&x, &y, width, height);
  }
  x = std::clamp(x, 0, width - 1);
  y = std::clamp(y, 0, height - 1);
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
         static_cast<std::size_t>(x);
}

Level resampled(const Level& from, std::size_t channels, int wrap) {
  Level to{std::bit_ceil(from.width), std::bit_ceil(from.height), {}};
  to.values.resize(to.width * to.height * channels);
  const int width = narrow<int>(from.width), height = narrow<int>(from.height);
  std::vector<Taps> columns;
  for (std::size_t x = 0; x < to.width; ++x) columns.emplace_back(x, from.width, to.width);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, to.height, 16),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t y = range.begin(); y < range.end(); ++y) {
                        const Taps rows(y, from.height, to.height);
                        for (std::size_t x = 0; x < to.width; ++x) {
                          double sums[4] = {};
                          for (int j = 0; j < 4; ++j)
                            for (int i = 0; i < 4; ++i)
                              if (const auto at = wrapped(columns[x].first + i, rows.first + j,
                                                          width, height, wrap))
                                for (std::size_t c = 0; c < channels; ++c)
                                  sums[c] += rows.weights[j] * columns[x].weights[i] *
                                             static_cast<double>(from.values[*at * channels + c]);
                          for (std::size_t c = 0; c < channels; ++c)
                            to.values[(y * to.width + x) * channels + c] =
                                static_cast<float>(std::max(0.0, sums[c]));
                        }
                      }
                    });
  return to;
}

bool has_powers_of_two(const TextureImage& image) {
  return std::has_single_bit(static_cast<unsigned>(image.width)) &&
         std::has_single_bit(static_cast<unsigned>(image.height));
}

struct Uses : IgnoresFields {
  ImageNumbers found = {};
  const TextureImage* last = nullptr;

  void image(const Field&, const std::shared_ptr<const TextureImage>& of) { last = of.get(); }
  template <class Names>
  void choice(const Field& field, int value, const Names&) {
    if (std::string_view(field.name) == "wrap") add(image_use(*last, value));
  }
  void vectors(const Field&, const std::shared_ptr<const TextureImage>& of) {
    add(image_use(*of, std::nullopt));
  }
  void add(const ImageUse& use) { found.try_emplace(use, narrow<std::uint32_t>(found.size())); }
};

/// Returns the byte whose decoded value is nearest.
std::uint8_t encoded(const std::array<float, 256>& decoded, float value) {
  const auto above = std::ranges::lower_bound(decoded, value);
  if (above == decoded.begin()) return 0;
  const auto at = static_cast<std::size_t>(above - decoded.begin());
  return static_cast<std::uint8_t>(
      at == 256 || value - decoded[at - 1] <= decoded[at] - value ? at - 1 : at);
}

/// FewValues holds the values of a level if 16 bits can number them, as for images of 16 bits and
/// of halves.
class FewValues {
 public:
  static constexpr std::size_t most = 65536;

  /// Returns false where there are more than `most`.
  bool take(const std::vector<float>& values) {
    for (const float value : values) {
      const auto bits = std::bit_cast<std::uint32_t>(value);
      std::uint32_t& slot = slot_of(bits);
      if (slot != 0) continue;
      if (all_.size() == most) return false;
      all_.push_back(bits);
      slot = narrow<std::uint32_t>(all_.size());
    }
    return true;
  }
  const std::vector<std::uint32_t>& all() const { return all_; }
  std::uint16_t number_of(float value) {
    return static_cast<std::uint16_t>(slot_of(std::bit_cast<std::uint32_t>(value)) - 1);
  }

 private:
  /// Returns the entry of a hash table for these bits: the number of the value + 1, or 0.
  std::uint32_t& slot_of(std::uint32_t bits) {
    std::size_t at = (bits * 0x9e3779b1u) >> 14;
    while (slots_[at] != 0 && all_[slots_[at] - 1] != bits) at = (at + 1) % slots_.size();
    return slots_[at];
  }
  std::vector<std::uint32_t> all_, slots_ = std::vector<std::uint32_t>(std::size_t{1} << 18, 0);
};

class ImageLowering {
 public:
  ImageLowering(const ImageUse& use, FlatScene& out)
      : image_(*use.image),
        wrap_(use.wrap),
        out_(out),
        channels_(static_cast<std::size_t>(use.image->channels)) {}

  ImageRecord run() {
    ImageRecord record{};
    record.channels = narrow<uint>(channels_);
    record.decode = CAPLET_NONE;
    if (!image_.bytes.empty()) {
      record.decode = narrow<uint>(out_.texels.size());
      for (const float value : image_.decoded) out_.texels.push_back(std::bit_cast<uint>(value));
    }
    Level level{
        static_cast<std::size_t>(image_.width), static_cast<std::size_t>(image_.height), {}};
    if (wrap_) level.values = linear();
    const bool is_new = wrap_ && !has_powers_of_two(image_);
    if (is_new) level = resampled(level, channels_, *wrap_);
    record.levels = wrap_ ? narrow<uint>(std::bit_width(std::max(level.width, level.height))) : 1;
    record.levels_begin = narrow<uint>(out_.texels.size());
    out_.texels.resize(out_.texels.size() + 4 * std::size_t{record.levels});
    for (uint i = 0; i < record.levels; ++i) {
      if (i > 0) level = halved(level, channels_);
      const std::vector<float>& floats = i > 0 || is_new ? level.values : image_.floats;
      uint how = image_.bytes.empty() ? CAPLET_TEXELS_FLOATS : CAPLET_TEXELS_BYTES;
      // An image has one table: that of the first level, which is most of it.
      if (FewValues few; i == 0 && how == CAPLET_TEXELS_FLOATS && floats.size() > 1024 &&
                         few.take(floats) && few.all().size() + floats.size() / 2 < floats.size()) {
        how = CAPLET_TEXELS_NUMBERS;
        record.decode = narrow<uint>(out_.texels.size());
        out_.texels.insert(out_.texels.end(), few.all().begin(), few.all().end());
        put_level(record, i, level, how);
        add_numbers(floats, few);
        continue;
      }
      put_level(record, i, level, how);
      if (how == CAPLET_TEXELS_FLOATS)
        add_floats(floats);
      else
        i > 0 || is_new ? add(level) : add_bytes(image_.bytes);
    }
    return record;
  }

 private:
  bool is_alpha(std::size_t i) const { return channels_ == 4 && i % 4 == 3; }

  std::vector<float> linear() const {
    if (image_.bytes.empty()) return image_.floats;
    std::vector<float> out(image_.bytes.size());
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = is_alpha(i) ? static_cast<float>(image_.bytes[i]) / 255.f
                           : image_.decoded[image_.bytes[i]];
    return out;
  }

  /// Writes the header of a level before its texels.
  void put_level(const ImageRecord& record, uint i, const Level& level, uint how) {
    uint* const of = &out_.texels[record.levels_begin + 4 * i];
    of[0] = narrow<uint>(out_.texels.size());
    of[1] = narrow<uint>(level.width);
    of[2] = narrow<uint>(level.height);
    of[3] = how;
  }

  void add(const Level& level) {
    std::vector<std::uint8_t> bytes(level.values.size());
    for (std::size_t i = 0; i < bytes.size(); ++i)
      bytes[i] =
          is_alpha(i)
              ? static_cast<std::uint8_t>(std::lround(std::min(level.values[i], 1.f) * 255.f))
              : encoded(image_.decoded, level.values[i]);
    add_bytes(bytes);
  }

  void add_floats(const std::vector<float>& values) {
    for (const float value : values) out_.texels.push_back(std::bit_cast<uint>(value));
  }

  void add_numbers(const std::vector<float>& values, FewValues& few) {
    std::vector<std::uint16_t> numbers;
    numbers.reserve(values.size());
    for (const float value : values) numbers.push_back(few.number_of(value));
    const std::size_t at = out_.texels.size();
    out_.texels.resize(at + (numbers.size() + 1) / 2);
    // Numbers lie two to a word, in the order of memory.
    std::memcpy(&out_.texels[at], numbers.data(), numbers.size() * sizeof numbers[0]);
  }

  void add_bytes(const std::vector<std::uint8_t>& bytes) {
    const std::size_t at = out_.texels.size();
    out_.texels.resize(at + (bytes.size() + 3) / 4);
    // Bytes lie four to a word, in the order of memory: devices read them as bytes.
    std::ranges::copy(bytes, reinterpret_cast<std::uint8_t*>(&out_.texels[at]));
  }

  const TextureImage& image_;
  std::optional<int> wrap_;
  FlatScene& out_;
  std::size_t channels_;
};

}  // namespace

ImageUse image_use(const TextureImage& image, std::optional<int> wrap) {
  return {&image, wrap && has_powers_of_two(image) ? std::optional(0) : wrap};
}

ImageNumbers image_numbers(const std::vector<Texture>& textures) {
  Uses uses;
  for (const Texture& texture : textures)
    std::visit([&](const auto& model) { model.fields(model, uses); }, texture.model);
  return uses.found;
}

void lower_images(const Scene& scene, const ImageNumbers& numbers, FlatScene& out) {
  std::vector<ImageUse> uses(numbers.size());
  for (const auto& [use, number] : numbers) uses[number] = use;
  // This is an upper bound: sides at most double; mip levels add a third, for long images as much
  // again as the first level.
  double words = 0;
  for (const ImageUse& use : uses)
    words +=
        512 + 8 * static_cast<double>(use.image->values() + 4) / (use.image->bytes.empty() ? 1 : 4);
  if (words > static_cast<double>(std::numeric_limits<uint>::max()))
    throw InputError(SourceLocation{scene.source},
                     "the images of textures have more texels than 32 bits number");
  for (const ImageUse& use : uses) out.images.push_back(ImageLowering(use, out).run());
}

}  // namespace caplet
