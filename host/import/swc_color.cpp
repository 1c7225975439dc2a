// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/swc_color.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <unordered_map>

#include "base/check.h"
#include "base/error.h"
#include "base/quotes.h"
#include "base/reading.h"
#include "import/color_map.h"
#include "import/detail/option_files.h"
#include "import/detail/text_file.h"
#include "present/present.h"

namespace caplet {

namespace {

constexpr int kMostOrders = 256;  // integers up to here have a colour each
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// Computes `value(sample, parent's value)` for each sample, parents before children.
template <class Value>
std::vector<double> values_along_branches(const std::vector<SwcSample>& samples,
                                          const Value& value) {
  std::vector<double> out(samples.size(), kNoValue);
  std::vector<std::size_t> path;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    path.clear();
    for (auto k = static_cast<std::int32_t>(i);
         k >= 0 && std::isnan(out[static_cast<std::size_t>(k)]);
         k = samples[static_cast<std::size_t>(k)].parent)
      path.push_back(static_cast<std::size_t>(k));
    for (auto it = path.rbegin(); it != path.rend(); ++it) {
      const std::int32_t parent = samples[*it].parent;
      out[*it] = samples[*it].type == kSoma || parent < 0
                     ? 0
                     : value(*it, out[static_cast<std::size_t>(parent)]);
    }
  }
  return out;
}

struct Palette {
  const char* name;
  glm::dvec3 reflectance;  // linear sRGB
};

Palette palette_of_type(int type) {
  switch (type) {
    case 0:
      return {"undefined", {0.55, 0.56, 0.52}};
    case kSoma:
      return {"soma", {0.86, 0.62, 0.22}};
    case 2:
      return {"axon", {0.20, 0.62, 0.95}};
    case 3:
      return {"basal dendrite", {0.95, 0.36, 0.18}};
    case 4:
      return {"apical dendrite", {0.66, 0.22, 0.66}};
    default:
      return {"", palette_color(static_cast<std::size_t>(type))};
  }
}

// --- Files of values ---

struct ColorRow {
  std::string_view key;  // empty: the line is a number alone
  double value = 0;
  int line = 0;
};

std::vector<ColorRow> rows_of(std::string_view text, const std::string& file, std::string& name) {
  std::vector<ColorRow> rows;
  Diagnostics diagnostics;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  for (int line = 1; !text.empty(); ++line) {
    std::string_view one = take_line(text);
    if (const std::size_t comment = one.find('#'); comment != std::string_view::npos) {
      const std::string_view said = trimmed(one.substr(comment + 1));
      if (rows.empty() && name.empty()) name = said.substr(0, 80);
      one = one.substr(0, comment);
    }
    one = trimmed(one);
    if (one.empty()) continue;
    ColorRow row;
    row.line = line;
    const std::size_t before = one.find_last_of(", \t");
    const std::string_view number = before == std::string_view::npos ? one : one.substr(before + 1);
    if (before != std::string_view::npos) {
      row.key = trimmed(one.substr(0, before));
      if (row.key.ends_with(',')) row.key = trimmed(row.key.substr(0, row.key.size() - 1));
    }
    if (!parse_number(number, row.value) || std::isinf(row.value))
      diagnostics.error(
          {file, line, static_cast<int>(before == std::string_view::npos ? 0 : before + 1) + 1},
          caplet::quoted(number) +
              " is not a number (a line is a value, or an id or a file's name and a value)");
    if (!rows.empty() && row.key.empty() != rows.front().key.empty())
      diagnostics.error({file, line, 0}, "lines of one column and of two are mixed");
    rows.push_back(row);
  }
  diagnostics.finish();
  if (rows.empty()) throw InputError({file, 0, 0}, "holds no values");
  return rows;
}

std::vector<double> by_ids(const std::vector<ColorRow>& rows, const std::vector<SwcSample>& samples,
                           const std::string& file) {
  std::unordered_map<std::int64_t, std::size_t> index;
  for (std::size_t i = 0; i < samples.size(); ++i) index.emplace(samples[i].id, i);
  std::vector<double> out(samples.size(), kNoValue);
  Diagnostics diagnostics;
  std::vector<bool> said(samples.size());
  for (const ColorRow& row : rows) {
    std::int64_t id = 0;
    const auto found = parse_number(row.key, id) ? index.find(id) : index.end();
    if (found == index.end()) {
      diagnostics.error({file, row.line, 1},
                        caplet::quoted(row.key) + " is no sample of the neuron");
    } else if (said[found->second]) {
      diagnostics.error({file, row.line, 1}, caplet::quoted(row.key) + " has a value already");
    } else {
      said[found->second] = true;
      out[found->second] = row.value;
    }
  }
  diagnostics.finish();
  return out;
}

}  // namespace

std::vector<double> branch_orders(const std::vector<SwcSample>& samples) {
  std::vector<std::uint32_t> children(samples.size(), 0);
  for (const SwcSample& sample : samples)
    if (sample.parent >= 0) ++children[static_cast<std::size_t>(sample.parent)];
  return values_along_branches(samples, [&](std::size_t i, double of_parent) {
    const auto p = static_cast<std::size_t>(samples[i].parent);
    const bool forks = children[p] > 1 && samples[p].type != kSoma && samples[p].parent >= 0;
    return of_parent + (forks ? 1 : 0);
  });
}

std::vector<double> path_depths(const std::vector<SwcSample>& samples) {
  return values_along_branches(samples, [&](std::size_t i, double of_parent) {
    const SwcSample& parent = samples[static_cast<std::size_t>(samples[i].parent)];
    return of_parent + glm::length(glm::dvec3(samples[i].position) - glm::dvec3(parent.position));
  });
}

std::vector<double> read_values(const std::filesystem::path& path,
                                const std::vector<SwcSample>& samples,
                                const std::filesystem::path& neuron, const ImportOptions& options,
                                std::string& name) {
  const std::string file = path.string();
  const TextFile text(path);
  Unproven in_file;  // a number does not reveal the format
  if (!options.are_of_scene) in_file.prove();
  const std::vector<ColorRow> rows = rows_of(text.text(), file, name);
  if (name.empty()) name = path.filename().string();
  std::int64_t id = 0;
  if (!rows.front().key.empty()) {
    if (std::ranges::all_of(rows, [&](const ColorRow& row) { return parse_number(row.key, id); }))
      return by_ids(rows, samples, file);
    const std::string stem = neuron.stem().string(), whole = neuron.filename().string();
    const auto found = std::ranges::find_if(
        rows, [&](const ColorRow& row) { return row.key == stem || row.key == whole; });
    if (found == rows.end())
      throw InputError({file, 0, 0}, "has no line for " + caplet::quoted(stem));
    return std::vector<double>(samples.size(), found->value);
  }
  std::vector<double> out;
  if (rows.size() == samples.size()) {
    for (const ColorRow& row : rows) out.push_back(row.value);
    return out;
  }
  if (options.files == rows.size())
    return std::vector<double>(samples.size(), rows[options.file].value);
  throw InputError(
      {file, rows.back().line, 0},
      fmt::format("{} values: {} has {} samples, and there {} (one a sample, or one a file)",
                  rows.size(), neuron.filename().string(), samples.size(),
                  options.files == 1 ? "is 1 file" : fmt::format("are {} files", options.files)));
}

SwcColors::SwcColors(Scene& scene, const std::vector<SwcSample>& samples,
                     const std::filesystem::path& path, const ImportOptions& options)
    : scene_(scene), samples_(samples), file_name_(path.stem().string()), file_(options.file) {
  const std::string by = options.text("color").value_or("type");
  if (by == "file") by_ = By::file;
  if (by == "type" || by == "file") {
    if (options.text("range"))
      throw InputError({"--range"}, "goes with --color order, depth or a file of values");
    return;
  }
  by_ = By::value;
  what_ = by;
  if (by == "order") {
    values_ = branch_orders(samples);
  } else if (by == "depth") {
    values_ = path_depths(samples);
  } else {
    std::string file = by;
    if (const std::size_t hole = file.find("{}"); hole != std::string::npos)
      file.replace(hole, 2, file_name_);
    const OptionFiles may_be_read(options);
    if (!may_read(file) || !is_there(file, {"--color"}))
      throw InputError(
          {"--color"},
          fmt::format("'{}' is none of type, file, order and depth, and no file of values", file));
    what_.clear();
    values_ = read_values(file, samples, path, options, what_);
  }
  const ValueRange range = range_of(values_);
  if (!range.is_there)
    throw InputError({"--color"},
                     fmt::format("'{}': there is no value for {}", by, path.filename().string()));
  const auto [low, high] = options.range("range").value_or(std::pair(range.low, range.high));
  int steps = map_steps;
  if (by == "order" && high - low < kMostOrders && std::floor(low) == low &&
      std::floor(high) == high)
    steps = static_cast<int>(high - low) + 1;
  by_value_ = ValueColors(scene, what_, low, high, steps);
  if (options.seen) {
    *options.seen = range;
    options.seen->is_length = by == "depth";
    options.seen->what = by == "depth"   ? "Path length from the soma"
                         : by == "order" ? "Branch order"
                                         : what_;
  }
}

std::uint32_t SwcColors::add(const std::string& name, const glm::dvec3& color, int line) {
  scene_.materials.push_back({DiffuseMaterial{RgbSpectrum{color}}, name, {scene_.source, line, 0}});
  return narrow<std::uint32_t>(scene_.materials.size() - 1);
}

std::uint32_t SwcColors::of(const SwcSample& sample) {
  if (by_ == By::value)
    return by_value_.of(values_[static_cast<std::size_t>(&sample - samples_.data())], sample.line);
  if (by_ == By::type) return of_type(sample);
  if (of_file_ < 0) of_file_ = add(file_name_, palette_color(file_), sample.line);
  return static_cast<std::uint32_t>(of_file_);
}

std::optional<Legend> SwcColors::legend() const {
  if (by_ == By::value) return std::nullopt;
  std::vector<std::uint32_t> materials;
  for (const auto& [type, material] : types_) materials.push_back(material);
  if (of_file_ >= 0) materials.push_back(static_cast<std::uint32_t>(of_file_));
  return names_legend(by_ == By::type ? "Type" : "File", scene_.materials, materials);
}

std::uint32_t SwcColors::of_type(const SwcSample& sample) {
  if (sample.type == last_type_) return last_index_;
  const auto found = types_.find(sample.type);
  if (found == types_.end()) {
    const Palette palette = palette_of_type(sample.type);
    const std::string name = *palette.name ? palette.name : fmt::format("type {}", sample.type);
    last_index_ = types_[sample.type] = add(name, palette.reflectance, sample.line);
  } else {
    last_index_ = found->second;
  }
  last_type_ = sample.type;
  return last_index_;
}

}  // namespace caplet
