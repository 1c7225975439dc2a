// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Writes deep pictures as OpenEXR files.
#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfHeader.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/threads.h"
#include "base/utf8.h"
#include "film/deep.h"
#include "film/detail/checked_file.h"
#include "film/detail/limits.h"
#include "film/image.h"

namespace caplet {

namespace {

Imf::Header header_of(const FilmLayout& layout,
                      const std::map<std::string, std::string>& attributes) {
  const Window& window = layout.window;
  Imf::Header header(Imath::Box2i({0, 0}, {layout.width - 1, layout.height - 1}),
                     Imath::Box2i({window.x, window.y},
                                  {window.x + window.width - 1, window.y + window.height - 1}));
  header.setType(Imf::DEEPSCANLINE);
  header.compression() = Imf::ZIPS_COMPRESSION;
  header.channels().insert("A", Imf::Channel(Imf::FLOAT));
  header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  for (const auto& [name, value] : attributes)
    if (!name.starts_with("cryptomatte/"))  // it has no mattes
      header.insert(name, Imf::StringAttribute(valid_utf8(value)));
  return header;
}

/// The samples of some rows, as OpenEXR takes them.
class Rows {
 public:
  explicit Rows(const Film& film) : window_(film.layout().window) {
    const std::size_t pixels = window_.pixels();
    std::vector<std::size_t> first;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      const std::vector<DeepSample> samples = deep_samples(film, pixel);
      first.push_back(alpha_.size());
      counts_.push_back(static_cast<unsigned>(samples.size()));
      for (const DeepSample& sample : samples) {
        alpha_.push_back(sample.alpha);
        depth_.push_back(sample.depth);
      }
    }
    for (const std::size_t at : first) {
      alphas_.push_back(alpha_.data() + at);
      depths_.push_back(depth_.data() + at);
    }
  }

  Imf::DeepFrameBuffer frame() {
    Imf::DeepFrameBuffer out;
    out.insertSampleCountSlice(
        Imf::Slice(Imf::UINT, base(counts_), sizeof(unsigned), sizeof(unsigned) * width()));
    for (auto [name, samples] : {std::pair{"A", &alphas_}, std::pair{"Z", &depths_}})
      out.insert(name, Imf::DeepSlice(Imf::FLOAT, base(*samples), sizeof(float*),
                                      sizeof(float*) * width(), sizeof(float)));
    return out;
  }

 private:
  std::size_t width() const { return static_cast<std::size_t>(window_.width); }
  /// Returns where the pixel (0, 0) of the picture would be: OpenEXR addresses pixels absolutely.
  template <class T>
  char* base(std::vector<T>& values) {
    const std::int64_t corner = std::int64_t{window_.y} * window_.width + window_.x;
    return reinterpret_cast<char*>(values.data()) - corner * static_cast<std::int64_t>(sizeof(T));
  }

  Window window_;
  std::vector<unsigned> counts_;
  std::vector<float> alpha_, depth_;
  std::vector<float*> alphas_, depths_;  // by pixel: its first sample
};

}  // namespace

void write_deep_exr(const std::filesystem::path& path, const FilmLayout& layout,
                    const std::function<Film(int first, int count)>& rows,
                    const std::map<std::string, std::string>& attributes) {
  try {
    write_atomically(path, [&](const std::filesystem::path& temporary) {
      CheckedFile stream(temporary, path);
      {
        Imf::DeepScanLineOutputFile file(stream, header_of(layout, attributes),
                                         static_cast<int>(usable_threads()));
        const int step = band_rows(layout.window.width, 2 * layout.words_per_pixel());
        for (int first = 0; first < layout.window.height; first += step) {
          const int count = std::min(step, layout.window.height - first);
          Rows some(rows(first, count));
          file.setFrameBuffer(some.frame());
          file.writePixels(count);
        }
      }
      stream.close();
    });
  } catch (const Iex::BaseExc& error) {
    throw RunError(
        fmt::format("{}: cannot be written: {}", path.string(), first_line(error.what())));
  }
}

}  // namespace caplet
