// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "table/ray_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

#include "base/atomic_file.h"

namespace caplet {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t block_bytes = std::size_t{1} << 20;  // read at a time; no line is longer

/// Quotes a token: shortened, unprintable bytes as \xNN.
std::string quoted(std::string_view token) {
  constexpr std::size_t longest = 32;
  std::string out = "'";
  for (const char c : token.substr(0, longest)) {
    const auto byte = static_cast<unsigned char>(c);
    out += byte < 0x20 || byte >= 0x7f ? fmt::format("\\x{:02x}", byte) : std::string(1, c);
  }
  return out + (token.size() > longest ? "...'" : "'");
}

bool is_separator(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

}  // namespace

std::optional<BadRay> to_ray(const std::array<double, 6>& numbers, RayNumbers& ray) {
  for (std::size_t i = 0; i < 6; ++i) {
    if (!std::isfinite(numbers[i]))
      return BadRay{i, fmt::format("the ray's {} is not finite", i < 3 ? "origin" : "direction")};
    if (std::abs(numbers[i]) > largest_ray_number)
      return BadRay{i, fmt::format("{:.3g} is out of range (largest: 2^60 = {:.3g})", numbers[i],
                                   largest_ray_number)};
    ray[i] = static_cast<float>(numbers[i]);
  }
  const double length = std::hypot(static_cast<double>(ray[3]), static_cast<double>(ray[4]),
                                   static_cast<double>(ray[5]));
  if (length == 0) return BadRay{3, "the ray has no direction"};
  if (length < 1 / largest_ray_number || length > largest_ray_number)
    return BadRay{
        3, fmt::format("the direction's length, {:.3g}, is not between 2^-60 and 2^60", length)};
  return std::nullopt;
}

namespace {

std::optional<BadRay> to_listed(std::span<const double> numbers, ListedRay& out) {
  std::array<double, 6> six{};
  std::copy_n(numbers.begin(), 6, six.begin());
  if (auto bad = to_ray(six, out.numbers)) return bad;
  if (numbers.size() == 6) return std::nullopt;
  if (!(numbers[6] >= 0) || numbers[6] > largest_ray_number)
    return BadRay{6, fmt::format("t_min, {:.3g}, is not from 0 to 2^60", numbers[6])};
  if (!(numbers[7] > numbers[6]))
    return BadRay{7,
                  fmt::format("t_max, {:.3g}, is not above t_min, {:.3g}", numbers[7], numbers[6])};
  out.t_min = static_cast<float>(numbers[6]);
  out.t_max = static_cast<float>(
      std::min(numbers[7], static_cast<double>(std::numeric_limits<float>::max())));
  if (numbers[7] > largest_ray_number) out.t_max = std::numeric_limits<float>::infinity();
  return std::nullopt;
}

}  // namespace

std::optional<std::string> parse_number(std::string_view token, double& value) {
  const bool plus = token.size() > 1 && token[0] == '+' && token[1] != '-';
  const char* begin = token.data() + (plus ? 1 : 0);
  const char* end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (stop != end || error == std::errc::invalid_argument)
    return fmt::format("{} is not a number", quoted(token));
  if (error != std::errc()) return fmt::format("{} is out of range", quoted(token));
  if (!std::isfinite(value)) return fmt::format("{} is not finite", quoted(token));
  return std::nullopt;
}

RayFile::RayFile(const fs::path& named) : path_(named == "-" ? fs::path("/dev/stdin") : named) {
  const fs::path& path = path_;
  note_input(path);
  if (path.extension() == ".npy") {
    npy_.emplace(path, std::vector<std::size_t>{6, 8});
    return;
  }
  const auto refuse = [&](const char* why) {
    throw InputError(SourceLocation{path.string()}, fmt::format("cannot read: {}", why));
  };
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) refuse("it is a folder");
  if (!fs::exists(status)) refuse("there is no such file");
  text_.open(path, std::ios::binary);
  if (!text_) refuse("permission denied");
}

std::vector<ListedRay> RayFile::next(std::size_t most) {
  if (npy_) return next_rows(most);
  std::vector<ListedRay> out;
  Diagnostics diagnostics;
  while (out.size() < most) {
    const auto line = take_line();
    if (!line) break;
    ++line_;
    if (const auto ray = parse_line(*line, diagnostics)) out.push_back(*ray);
  }
  diagnostics.finish();
  return out;
}

std::vector<ListedRay> RayFile::next_rows(std::size_t most) {
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(most, npy_->rows() - row_));
  const std::size_t columns = npy_->columns();
  std::vector<double> numbers(columns * count);
  npy_->read(numbers);
  std::vector<ListedRay> out(count);
  Diagnostics diagnostics;
  for (std::size_t i = 0; i < count; ++i, ++row_)
    if (const auto bad = to_listed(std::span(numbers).subspan(columns * i, columns), out[i]))
      diagnostics.error(SourceLocation{path_.string()},
                        fmt::format("row {}: {}", row_, bad->message));
  diagnostics.finish();
  return out;
}

std::optional<std::string_view> RayFile::take_line() {
  std::size_t end = buffer_.find('\n', at_);
  if (end == std::string::npos && text_) {
    buffer_.erase(0, at_);
    at_ = 0;
    const std::size_t kept = buffer_.size();
    buffer_.resize(kept + block_bytes);
    text_.read(buffer_.data() + kept, static_cast<std::streamsize>(block_bytes));
    buffer_.resize(kept + static_cast<std::size_t>(text_.gcount()));
    if (text_.bad()) throw RunError(fmt::format("{}: cannot be read any further", path_.string()));
    end = buffer_.find('\n', kept);
    if (end == std::string::npos && text_)
      throw InputError(SourceLocation{path_.string(), line_ + 1},
                       "the line is longer than a million characters: this is no list of rays");
  }
  if (at_ >= buffer_.size()) return std::nullopt;
  end = std::min(end, buffer_.size());
  const std::string_view line = std::string_view(buffer_).substr(at_, end - at_);
  at_ = end + 1;
  return line;
}

std::optional<ListedRay> RayFile::parse_line(std::string_view line,
                                             Diagnostics& diagnostics) const {
  line = line.substr(0, line.find('#'));
  const auto fail = [&](std::size_t column, const std::string& message) {
    diagnostics.error(SourceLocation{path_.string(), line_, static_cast<int>(column) + 1}, message);
    return std::nullopt;
  };
  std::array<double, 8> numbers{};
  std::array<std::size_t, 8> columns{};
  std::size_t count = 0, i = 0;
  const auto skip = [&] {
    while (i < line.size() && is_separator(line[i])) ++i;
  };
  for (skip(); i < line.size(); skip()) {
    if (count > 0 && line[i] == ',') {
      ++i;
      skip();
    }
    const std::size_t start = i;
    while (i < line.size() && !is_separator(line[i]) && line[i] != ',') ++i;
    if (i == start) return fail(start, "a number is missing");
    if (count == 8)
      return fail(start, "there are more than eight numbers (origin, direction, t_min and t_max)");
    columns[count] = start;
    const std::string_view word = line.substr(start, i - start);
    if (count == 7 && (word == "inf" || word == "infinity"))
      numbers[count] = std::numeric_limits<double>::infinity();
    else if (const auto wrong = parse_number(word, numbers[count]))
      return fail(start, *wrong);
    ++count;
  }
  if (count == 0) return std::nullopt;
  if (count < 6)
    return fail(line.size(), fmt::format("{} of six numbers (origin and direction)", count));
  if (count == 7) return fail(line.size(), "seven numbers: t_max is missing after t_min");
  ListedRay ray;
  if (const auto bad = to_listed(std::span(numbers).first(count), ray))
    return fail(columns[bad->number], bad->message);
  return ray;
}

}  // namespace caplet
