// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/ies.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <map>
#include <numbers>

#include "base/error.h"
#include "import/detail/text_file.h"

namespace caplet {

namespace {

constexpr double radians = std::numbers::pi / 180;
constexpr double most_numbers = 16'000'000;  // limit of intensities

bool starts_with_word(std::string_view line, std::string_view word) {
  while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  return line.starts_with(word);
}

class IesReader {
 public:
  IesReader(const std::string& name, std::string_view text) : name_(name), text_(text) {}

  IesProfile run() {
    header();
    number("the number of lamps");
    number("the lumens a lamp");
    double factor = positive("the candela multiplier");
    const std::size_t polar_count = count("the number of vertical angles", 2);
    const std::size_t azimuth_count = count("the number of horizontal angles", 1);
    if (static_cast<double>(polar_count) * static_cast<double>(azimuth_count) > most_numbers)
      fail(fmt::format("more than {:.0f} intensities", most_numbers));
    if (const double type = number("the photometric type"); type != 1)
      fail(type == 2 || type == 3 ? "only photometry of type C (1) is read"
                                  : "the photometric type must be 1, 2 or 3");
    if (const double units = number("the units"); units != 1 && units != 2)
      fail("the units must be 1 (feet) or 2 (metres)");
    for (const char* what : {"the width", "the length", "the height"}) number(what);
    factor *= positive("the ballast factor");
    // In LM-63-1986 and 1991 it is a factor; later versions use the field for another number.
    const double photometric = number("the ballast-lamp photometric factor");
    if (!is_late_) {
      if (!(photometric > 0)) fail("the ballast-lamp photometric factor must be above 0");
      factor *= photometric;
    }
    number("the input watts");
    if (!std::isfinite(factor)) fail("the factors are out of range");

    IesProfile profile;
    profile.polar = angles("a vertical angle", polar_count, 180);
    const std::vector<double> azimuths = angles("a horizontal angle", azimuth_count, 360);
    const double first = azimuths.front(), last = azimuths.back();
    const bool is_turned = first == 90 && last == 270;
    if (!is_turned && (first != 0 || (last != 0 && last != 90 && last != 180 && last != 360)))
      fail("the horizontal angles must go from 0 to 0, 90, 180 or 360, or from 90 to 270");
    std::map<double, std::vector<double>> columns;
    for (const double azimuth : azimuths) {
      std::vector<double> column;
      for (std::size_t i = 0; i < polar_count; ++i) {
        const double value = number("an intensity");
        if (!(value >= 0)) fail("an intensity must not be negative");
        column.push_back(value * factor);
      }
      for (const double same : by_symmetry(azimuth, last, is_turned)) columns[same] = column;
    }
    next();
    if (!token_.empty()) fail(fmt::format("{} after the last intensity", quoted(token_)));
    for (double& angle : profile.polar) angle *= radians;
    if (last != 0) close(columns);
    for (const auto& [azimuth, column] : columns) {
      profile.azimuths.push_back(azimuth * radians);
      profile.candela.insert(profile.candela.end(), column.begin(), column.end());
    }
    return profile;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(SourceLocation{name_, line_, column_}, message);
  }

  /// Reads up to the line that begins with TILT=.
  void header() {
    while (take()) {
      if (line_ == 1) {
        const std::string_view year = line_text_.substr(0, line_text_.find_last_not_of(" \t") + 1);
        is_late_ = year.starts_with("IES") && !year.ends_with("86") && !year.ends_with("91");
      }
      if (!starts_with_word(line_text_, "TILT=")) continue;
      std::string_view tilt = line_text_.substr(line_text_.find('=') + 1);
      while (!tilt.empty() && is_blank(tilt.front())) tilt.remove_prefix(1);
      while (!tilt.empty() && is_blank(tilt.back())) tilt.remove_suffix(1);
      column_ = 1;
      if (tilt != "NONE") fail(fmt::format("TILT={}: only TILT=NONE is read", tilt.substr(0, 32)));
      line_text_ = {};
      return;
    }
    fail("no line begins with TILT=: this is no photometric file of LM-63");
  }

  bool take() {
    if (text_.empty()) return false;
    line_text_ = take_line(text_);
    line_begin_ = line_text_.data();
    ++line_;
    column_ = 0;
    return true;
  }

  static bool is_between(char c) { return is_blank(c) || c == ',' || c == '\x1a'; }

  /// Reads the next token; empty at the end of the file.
  void next() {
    for (;;) {
      while (!line_text_.empty() && is_between(line_text_.front())) line_text_.remove_prefix(1);
      if (!line_text_.empty()) break;
      if (!take()) {
        token_ = {};
        return;
      }
    }
    std::size_t end = 0;
    while (end < line_text_.size() && !is_between(line_text_[end])) ++end;
    token_ = line_text_.substr(0, end);
    column_ = static_cast<int>(line_text_.data() - line_begin_) + 1;
    line_text_.remove_prefix(end);
  }

  double number(const char* what) {
    next();
    if (token_.empty()) fail(fmt::format("the file ends where {} should be", what));
    float value = 0;
    if (const NumberError error = parse_float(token_, value); error != NumberError::none)
      fail(fmt::format("{}: {}", what, describe(error, token_)));
    return static_cast<double>(value);
  }

  double positive(const char* what) {
    const double value = number(what);
    if (!(value > 0)) fail(fmt::format("{} must be above 0", what));
    return value;
  }

  std::size_t count(const char* what, int least) {
    const double value = number(what);
    if (!(value >= least && value <= most_numbers) || value != std::floor(value))
      fail(fmt::format("{} must be a whole number from {} up", what, least));
    return static_cast<std::size_t>(value);
  }

  std::vector<double> angles(const char* what, std::size_t n, double most) {
    std::vector<double> out;
    for (std::size_t i = 0; i < n; ++i) {
      const double value = number(what);
      if (!(value >= 0 && value <= most))
        fail(fmt::format("{} must lie between 0 and {}", what, most));
      if (!out.empty() && !(value > out.back()))
        fail(fmt::format("{} must be above the one before", what));
      out.push_back(value);
    }
    return out;
  }

  /// Returns all azimuths, within 0 and 360, that have the intensities of `azimuth` by symmetry.
  static std::vector<double> by_symmetry(double azimuth, double last, bool is_turned) {
    if (is_turned) {
      if (azimuth == 180) return {0, 180, 360};
      return {azimuth, azimuth < 180 ? 180 - azimuth : 540 - azimuth};
    }
    if (last == 90) return {azimuth, 180 - azimuth, 180 + azimuth, 360 - azimuth};
    if (last == 180) return {azimuth, 360 - azimuth};
    return {azimuth};
  }

  /// Adds 0 and 360 if they are missing, interpolated between the last and the first azimuth.
  static void close(std::map<double, std::vector<double>>& columns) {
    if (columns.begin()->first == 0) return;
    const auto& [low, after] = *columns.begin();
    const auto& [high, before] = *std::prev(columns.end());
    const double part = (360 - high) / (360 - high + low);
    std::vector<double> seam;
    for (std::size_t i = 0; i < after.size(); ++i)
      seam.push_back(before[i] + part * (after[i] - before[i]));
    columns[0] = columns[360] = std::move(seam);
  }

  const std::string& name_;
  std::string_view text_, line_text_, token_;
  const char* line_begin_ = nullptr;
  int line_ = 0, column_ = 0;
  bool is_late_ = false;
};

}  // namespace

IesProfile parse_ies(const std::string& name, std::string_view text) {
  return IesReader(name, text).run();
}

IesProfile read_ies(const std::filesystem::path& path) {
  IesProfile profile = parse_ies(path.string(), TextFile(path).text());
  profile.file = path.string();
  return profile;
}

}  // namespace caplet
