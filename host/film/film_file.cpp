// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/film_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/threads.h"
#include "film/image.h"
#include "scene/spectrum.h"

namespace caplet {

namespace {

constexpr const char* format_name = "caplet.film";
constexpr const char* exposure_name = "caplet.film.exposure";
constexpr const char* f_number_name = "caplet.film.fnumber";  // older films have none
constexpr const char* format_version = "4";

using Notes = std::map<std::string, std::string>;

std::string text_of(std::vector<FilmPart> parts) {
  // The same samples have the same text, in whatever order they came.
  std::ranges::sort(parts, {}, [](const FilmPart& part) {
    return std::array{std::int64_t{part.sample_begin}, std::int64_t{part.window.y},
                      std::int64_t{part.window.x}};
  });
  std::string out;
  for (const FilmPart& part : parts)
    out += fmt::format("{}{} {} {} {} {} {}", out.empty() ? "" : ",", part.window.x, part.window.y,
                       part.window.width, part.window.height, part.sample_begin, part.sample_count);
  return out;
}

std::string text_of(const std::optional<Backdrop>& backdrop) {
  if (!backdrop) return "none";
  const glm::dvec3& c = backdrop->color;
  switch (backdrop->kind) {
    case Backdrop::Kind::transparent:
      return "transparent";
    case Backdrop::Kind::color:
      return fmt::format("{} {} {}", c.x, c.y, c.z);
    case Backdrop::Kind::image:
      break;
  }
  const std::string& file = backdrop->image->file;
  return "file " + (file.empty() ? file : std::filesystem::absolute(file).string());
}

/// Takes the next whole number from `text`, with the space or comma behind it.
bool take_number(std::string_view& text, std::int64_t low, std::int64_t high, std::int64_t& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc() || out < low || out > high) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (text.empty()) return true;
  const bool separated = text.front() == ' ' || text.front() == ',';
  text.remove_prefix(1);
  return separated;
}

/// Returns the next number of a text, with the space behind it taken; no value where there is none.
std::optional<double> take_real(std::string_view& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return {};
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (text.starts_with(' ')) text.remove_prefix(1);
  return value;
}

/// Reads the attributes of a film's file.
class Reader {
 public:
  Reader(const std::filesystem::path& path, const LayeredImage& image)
      : path_(path), image_(image) {
    if (text(format_name) != format_version)
      fail(fmt::format("its version is {}, not {}", text(format_name), format_version));
  }

  std::string text(const std::string& name) const {
    const auto found = image_.metadata.find(name);
    if (found == image_.metadata.end()) fail(fmt::format("it has no '{}'", name));
    return found->second;
  }
  /// Files do not have attributes of empty texts.
  std::string text_or_none(const std::string& name) const {
    const auto found = image_.metadata.find(name);
    return found == image_.metadata.end() ? std::string() : found->second;
  }
  std::int64_t whole(const std::string& name, std::int64_t low, std::int64_t high) const {
    const std::string all = text(name);
    std::string_view left = all;
    std::int64_t value = 0;
    if (!take_number(left, low, high, value) || !left.empty())
      fail(fmt::format("'{}' is not a number from {} to {}", name, low, high));
    return value;
  }
  double real(const std::string& name) const {
    const std::string all = text(name);
    std::string_view left = all;
    const std::optional<double> value = take_real(left);
    if (!value || !left.empty()) fail(fmt::format("'{}' is not a number", name));
    return *value;
  }

  FilmLayout layout() const {
    const auto exponent = [&](const char* name) {
      return static_cast<int>(whole(name, -largest_film_exponent, largest_film_exponent));
    };
    FilmLayout out;
    out.width = image_.width;
    out.height = image_.height;
    out.window = {image_.x, image_.y, image_.data_width, image_.data_height};
    out.layers = Layers::of_bits(static_cast<std::uint32_t>(
        whole("caplet.film.layers", 0, std::int64_t{Layers::every().bits()})));
    out.color_exponent = exponent("caplet.film.color_exponent");
    out.length_exponent = exponent("caplet.film.length_exponent");
    return out;
  }

  std::vector<FilmPart> parts(const FilmLayout& layout) const {
    std::vector<FilmPart> out;
    const std::string all = text("caplet.film.samples");
    for (std::string_view left = all; !left.empty();) {
      std::array<std::int64_t, 6> numbers{};
      for (std::int64_t& number : numbers)
        if (!take_number(left, 0, std::numeric_limits<std::uint32_t>::max(), number))
          fail("its list of samples is broken");
      const auto as_int = [](std::int64_t number) {
        return static_cast<int>(std::min<std::int64_t>(number, 1 << 30));
      };
      const FilmPart part{
          {as_int(numbers[0]), as_int(numbers[1]), as_int(numbers[2]), as_int(numbers[3])},
          static_cast<std::uint32_t>(numbers[4]),
          static_cast<std::uint32_t>(numbers[5])};
      if (!layout.window.holds(part.window)) fail("its list of samples is broken");
      add_part(out, part);
    }
    return out;
  }

  std::vector<std::uint64_t> words(const FilmLayout& layout) const {
    const std::size_t pixels = layout.window.pixels(), count = layout.words_per_pixel();
    std::vector<std::uint64_t> out(pixels * count);
    for (std::size_t w = 0; w < count; ++w) {
      const Channel* low = image_.find(fmt::format("word{:02}.low", w));
      const Channel* high = image_.find(fmt::format("word{:02}.high", w));
      if (!low || !high || low->uints.size() != pixels || high->uints.size() != pixels)
        fail(fmt::format("word {} is missing", w));
      for (std::size_t i = 0; i < pixels; ++i)
        out[i * count + w] = low->uints[i] | std::uint64_t{high->uints[i]} << 32;
    }
    return out;
  }

  FilmSettings settings() const {
    FilmSettings out;
    out.width = image_.width;
    out.height = image_.height;
    out.iso = real("caplet.film.iso");
    out.exposure_time = real("caplet.film.exposure_time");
    if (image_.metadata.contains(f_number_name)) out.f_number = real(f_number_name);
    out.white_balance = real("caplet.film.white_balance");
    const std::string space = text("caplet.film.space");
    const auto found = std::ranges::find(color_space_names, space);
    if (found == color_space_names.end())
      fail(fmt::format("'{}' is no colour space of this program", space));
    out.space = static_cast<ColorSpace>(found - color_space_names.begin());
    out.denoise = text("caplet.film.denoise") == "yes";
    out.exposure = exposure();
    out.matte_levels = static_cast<int>(whole("caplet.film.matte_levels", 1, CAPLET_SLOTS));
    out.backdrop = backdrop();
    return out;
  }

  Notes notes() const {
    Notes out;
    for (const auto& [name, value] : image_.metadata)
      if (name == "software" || name.starts_with("cryptomatte/") ||
          (name.starts_with("caplet.") && !name.starts_with(format_name)))
        out.emplace(name, value);
    return out;
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(SourceLocation{path_.string()}, "this is no film of caplet: " + why);
  }

 private:
  PreviewExposure exposure() const {
    PreviewExposure out;
    if (!image_.metadata.contains(exposure_name)) return out;  // older films
    if (text(exposure_name) == "auto")
      out.is_automatic = true;
    else
      out.stops = real(exposure_name);
    return out;
  }

  std::optional<Backdrop> backdrop() const {
    const std::string all = text("caplet.film.backdrop");
    std::string_view left = all;
    if (left == "none") return {};
    Backdrop out;
    if (left == "transparent") return out;
    constexpr std::string_view file = "file ";
    if (left.starts_with(file)) {
      out.kind = Backdrop::Kind::image;
      out.image =
          std::make_shared<EnvironmentImage>(FileImageReader().read_rgb(left.substr(file.size())));
      return out;
    }
    out.kind = Backdrop::Kind::color;
    for (const int c : {0, 1, 2}) {
      const std::optional<double> value = take_real(left);
      if (!value) fail(fmt::format("'{}' is no backdrop", all));
      out.color[c] = *value;
    }
    if (!left.empty()) fail(fmt::format("'{}' is no backdrop", all));
    return out;
  }

  std::filesystem::path path_;
  const LayeredImage& image_;
};

}  // namespace

void save_film(const std::filesystem::path& path, const SavedFilm& saved, double seconds) {
  const FilmLayout& layout = saved.film.layout();
  const std::size_t words = layout.words_per_pixel(),
                    width = static_cast<std::size_t>(layout.window.width);
  BandedImage image;
  image.whole = image_of(layout);
  image.whole.metadata = saved.notes;
  image.whole.metadata.insert(
      {{format_name, format_version},
       {"caplet.film.layers", std::to_string(layout.layers.bits())},
       {"caplet.film.color_exponent", std::to_string(layout.color_exponent)},
       {"caplet.film.length_exponent", std::to_string(layout.length_exponent)},
       {"caplet.film.samples", text_of(saved.film.parts())},
       {"caplet.film.samples_wanted", std::to_string(saved.samples_wanted)},
       {"caplet.film.scene", saved.scene},
       {"caplet.film.view", saved.view},
       {"caplet.film.iso", fmt::format("{}", saved.settings.iso)},
       {"caplet.film.exposure_time", fmt::format("{}", saved.settings.exposure_time)},
       {f_number_name, fmt::format("{}", saved.settings.f_number)},
       {"caplet.film.white_balance", fmt::format("{}", saved.settings.white_balance)},
       {"caplet.film.space", color_space_names[static_cast<std::size_t>(saved.settings.space)]},
       {"caplet.film.matte_levels", std::to_string(saved.settings.matte_levels)},
       {"caplet.film.denoise", saved.settings.denoise ? "yes" : "no"},
       {exposure_name, saved.settings.exposure.is_automatic
                           ? "auto"
                           : fmt::format("{}", saved.settings.exposure.stops)},
       {"caplet.film.backdrop", text_of(saved.settings.backdrop)}});
  image.rows = band_rows(layout.window.width, 2 * words);
  image.band = [&](int first, int rows) {
    FilmLayout part = layout;
    part.window.y += first;
    part.window.height = rows;
    LayeredImage band = image_of(part);
    const std::uint64_t* from =
        saved.film.words().data() + static_cast<std::size_t>(first) * width * words;
    const std::size_t pixels = part.window.pixels();
    for (std::size_t w = 0; w < words; ++w)
      for (const int half : {0, 1}) {
        Channel channel{fmt::format("word{:02}.{}", w, half == 0 ? "low" : "high"),
                        {},
                        std::vector<std::uint32_t>(pixels)};
        for (std::size_t i = 0; i < pixels; ++i)
          channel.uints[i] = static_cast<std::uint32_t>(from[i * words + w] >> (32 * half));
        band.channels.push_back(std::move(channel));
      }
    return band;
  };
  write_exr(path, image,
            compression_for(layout.window.pixels() * words * sizeof(std::uint64_t), seconds,
                            usable_threads()));
}

SavedFilm load_film(const std::filesystem::path& path) {
  const LayeredImage image = read_exr(path);
  const Reader reader(path, image);
  SavedFilm out;
  const FilmLayout layout = reader.layout();
  out.film = Film(layout, reader.words(layout), reader.parts(layout));
  out.scene = reader.text_or_none("caplet.film.scene");
  out.view = reader.text_or_none("caplet.film.view");
  out.samples_wanted = static_cast<std::uint32_t>(
      reader.whole("caplet.film.samples_wanted", 0, std::numeric_limits<std::uint32_t>::max()));
  out.settings = reader.settings();
  out.notes = reader.notes();
  return out;
}

std::vector<std::string> options_of(Layers layers) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < layer_rows.size(); ++i)
    if (layers.has(static_cast<Layer>(i)) && *layer_rows[i].option != '\0')
      out.emplace_back(layer_rows[i].option);
  return out;
}

namespace {

std::string text_of(Layers layers) {
  const std::vector<std::string> options = options_of(layers);
  return options.empty() ? "none" : fmt::format("{}", fmt::join(options, ","));
}

std::string text_of(const Window& window) {
  return fmt::format("{},{},{},{}", window.x, window.y, window.x + window.width,
                     window.y + window.height);
}

/// Returns whether both are known and not the same.
bool differ(const std::string& a, const std::string& b) {
  return !a.empty() && !b.empty() && a != b;
}

}  // namespace

std::string difference(const FilmOrigin& film, const FilmOrigin& other) {
  const FilmLayout &a = film.layout, &b = other.layout;
  if (a.width != b.width || a.height != b.height)
    return fmt::format("its size is {} x {}, not {} x {}", a.width, a.height, b.width, b.height);
  if (!(a.window == b.window))
    return fmt::format("its crop is {}, not {}", text_of(a.window), text_of(b.window));
  if (!(a.layers == b.layers))
    return fmt::format("its layers are {}, not {}", text_of(a.layers), text_of(b.layers));
  if (differ(film.scene, other.scene) || !(a == b))
    return "it is of another scene, or the scene was changed";
  if (differ(film.view, other.view))
    return "its camera, pixel filter, sampler, seed or integrator are others";
  return {};
}

namespace {

/// Returns the texts between ", " of a note, in order, each once; before them those of `first`.
std::string each_once(std::string_view note, std::string_view first = {}) {
  std::vector<std::string_view> seen;
  for (std::string_view left : {first, note})
    while (!left.empty()) {
      const std::size_t end = std::min(left.find(", "), left.size());
      const std::string_view one = left.substr(0, end);
      if (std::ranges::find(seen, one) == seen.end()) seen.push_back(one);
      left.remove_prefix(std::min(end + 2, left.size()));
    }
  return fmt::format("{}", fmt::join(seen, ", "));
}

}  // namespace

std::string made_on(const Notes& notes) {
  const auto note = [&](const char* name) {
    const auto found = notes.find(name);
    return found == notes.end() ? std::string("unknown") : each_once(found->second);
  };
  return fmt::format("'{}' ({}) by {}", note("caplet.device"), note("caplet.driver"),
                     note("software"));
}

Notes notes_together(const Notes& before, Notes now) {
  for (const char* name :
       {"software", "caplet.version", "caplet.device", "caplet.driver", "caplet.platform"})
    if (const auto found = before.find(name); found != before.end())
      now[name] = each_once(now[name], found->second);
  double seconds = 0;
  for (const Notes& notes : {std::cref(before), std::cref(now)})
    if (const auto found = notes.find("caplet.render_seconds"); found != notes.end()) {
      std::string_view text = found->second;
      seconds += take_real(text).value_or(0);
    }
  now["caplet.render_seconds"] = fmt::format("{:.3f}", seconds);
  return now;
}

void add(SavedFilm& to, const SavedFilm& other) {
  if (const std::string why = difference(other.origin(), to.origin()); !why.empty())
    throw InputError(why);
  to.film.add(other.film);
  if (to.scene.empty()) to.scene = other.scene;
  if (to.view.empty()) to.view = other.view;
  to.samples_wanted = std::max(to.samples_wanted, other.samples_wanted);
  to.notes = notes_together(to.notes, other.notes);
  to.notes["caplet.samples_per_pixel"] = fmt::format("{}", std::lround(to.film.mean_samples()));
}

std::vector<SampleSpan> samples_of(const Film& film) {
  std::vector<SampleSpan> out;
  for (const FilmPart& part : film.parts())
    if (part.window == film.layout().window && part.sample_count > 0)
      out.push_back({part.sample_begin, part.sample_begin + part.sample_count});
  std::ranges::sort(out, {}, &SampleSpan::begin);
  return out;
}

std::string text_of(const std::vector<SampleSpan>& samples) {
  std::string out;
  for (const SampleSpan& span : samples)
    out += fmt::format("{}{}:{}", out.empty() ? "" : ", ", span.begin, span.end);
  return out.empty() ? "none" : out;
}

std::vector<SampleSpan> missing(const std::vector<SampleSpan>& samples, std::uint32_t wanted) {
  std::vector<SampleSpan> out;
  if (!samples.empty()) wanted = std::max(wanted, samples.back().end);
  std::uint32_t next = 0;
  for (const SampleSpan& span : samples) {
    if (span.begin > next && next < wanted) out.push_back({next, std::min(span.begin, wanted)});
    next = std::max(next, span.end);
  }
  if (next < wanted) out.push_back({next, wanted});
  return out;
}

}  // namespace caplet
