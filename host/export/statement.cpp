// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "export/detail/statement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace caplet::pbrt_text {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t longest_line = 120;
constexpr std::size_t few_values = 8;              // a list of so few stays on one line
constexpr std::size_t values_at_a_time = 1 << 14;  // after which cancellation is checked

/// Returns the name of these samples in scene files; empty: none.
std::string name_of(const SampledSpectrum& spectrum) {
  static const auto named = [] {
    std::map<std::vector<double>, std::pair<std::vector<double>, std::string>> by_values;
    for (const std::string& name : named_spectrum_names())
      if (const auto known = named_spectrum(name))
        if (const auto* sampled = std::get_if<SampledSpectrum>(&*known))
          by_values.emplace(sampled->values, std::pair(sampled->wavelengths, name));
    return by_values;
  }();
  const auto found = named.find(spectrum.values);
  return found != named.end() && found->second.first == spectrum.wavelengths ? found->second.second
                                                                             : std::string();
}

/// Returns the path relative to `folder` if both share a folder other than the root, else as it is.
std::string name_from(const fs::path& folder, const std::string& file) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(fs::absolute(file, error), error);
  if (error || folder.empty()) return fs::absolute(file, error).string();
  const auto first = [](const fs::path& path) {
    const fs::path below = path.relative_path();
    return below.empty() ? fs::path() : *below.begin();
  };
  if (first(whole).empty() || first(whole) != first(folder)) return whole.string();
  return whole.lexically_relative(folder).string();
}

}  // namespace

void set_space(Stream& stream, ColorSpace space) {
  if (std::exchange(stream.space, space) != space)
    stream.text << "ColorSpace \"" << color_space_names[static_cast<std::size_t>(space)] << "\"\n";
}

void Statement::finite(double value, const std::string& name) const {
  if (!std::isfinite(value))
    throw InputError(where_, "\"" + name + "\" is not finite: it cannot be written");
}

void Statement::add(const char* type, const std::string& name, std::string value,
                    std::optional<ColorSpace> space) {
  parameters_.push_back({"\"" + std::string(type) + " " + name + "\" ", std::move(value), space});
}

void Statement::number(const std::string& name, double value) {
  finite(value, name);
  add("float", name, number_text(value));
}

void Statement::texts(const std::string& name, const std::vector<std::string>& values) {
  std::string all = "[";
  for (const std::string& value : values)
    all += (all.size() > 1 ? " " : "") + quoted(value, where_);
  add("string", name, all + "]");
}

void Statement::numbers(const char* type, const std::string& name,
                        std::initializer_list<double> values) {
  std::string all = "[";
  for (const double value : values) {
    finite(value, name);
    all += (all.size() > 1 ? " " : "") + number_text(value);
  }
  add(type, name, all + "]");
}

void Statement::spectrum(const std::string& name, const Spectrum& value) {
  if (const auto* constant = std::get_if<ConstantSpectrum>(&value))
    return number(name, constant->value);
  if (const auto* rgb = std::get_if<RgbSpectrum>(&value)) {
    numbers("rgb", name, {rgb->rgb.x, rgb->rgb.y, rgb->rgb.z});
    parameters_.back().space = rgb->space;
    return;
  }
  if (const auto* black = std::get_if<BlackbodySpectrum>(&value))
    return numbers("blackbody", name, {black->kelvin});
  const auto& sampled = std::get<SampledSpectrum>(value);
  if (const std::string known = name_of(sampled); !known.empty())
    return add("spectrum", name, quoted(known, where_));
  std::string all = "[";
  for (std::size_t i = 0; i < sampled.values.size(); ++i) {
    finite(sampled.values[i], name);
    all += (i > 0 ? " " : "") + number_text(sampled.wavelengths[i]) + " " +
           number_text(sampled.values[i]);
  }
  add("spectrum", name, all + "]");
}

void ImageFiles::remove() noexcept {
  std::error_code ignored;
  for (const std::filesystem::path& file : new_) std::filesystem::remove(file, ignored);
}

void Statement::file(const std::string& name, const std::string& path, const char* what,
                     const Stream& stream) {
  if (path.empty())
    throw InputError(where_, std::string(what) + " was read from no file: it cannot be written");
  text(name, name_from(stream.folder, path));
}

void Statement::list(const char* type, const std::string& name, std::size_t count,
                     std::function<void(Text&, std::size_t)> write,
                     std::optional<ColorSpace> space) {
  if (count == 0) return;
  if (count <= few_values) {
    add(type, name, text_of([&](Text& text) {
          for (std::size_t i = 0; i < count; ++i) write(text << (i == 0 ? "[" : " "), i);
          text << "]";
        }),
        space);
    return;
  }
  add(type, name, {}, space);
  parameters_.back().count = count;
  parameters_.back().list = std::move(write);
}

void Statement::write(const Parameter& parameter, Stream& stream) {
  stream.text << parameter.declaration << parameter.value;
  if (!parameter.list) return;
  stream.text << "[";
  for (std::size_t i = 0; i < parameter.count; ++i) {
    if (i > 0) stream.text << (i % 8 == 0 ? "\n" : " ");
    if (i % values_at_a_time == 0) stream.go_on();
    parameter.list(stream.text, i);
  }
  stream.text << "]";
}

void Statement::write(Stream& stream) {
  stream.go_on();
  // The statement uses the stream's colour space if a parameter has it, else the first parameter's.
  std::optional<ColorSpace> own;
  for (const Parameter& one : parameters_)
    if (one.space && (!own || *one.space == stream.space)) own = one.space;
  std::vector<const Parameter*> others;
  for (const Parameter& one : parameters_)
    if (one.space && one.space != own) others.push_back(&one);
  const ColorSpace outer = stream.space;
  const bool is_block = !before_.empty() || !others.empty();
  if (own && !is_block) set_space(stream, *own);
  if (is_block) stream.text << "AttributeBegin\n";
  for (const Parameter* one : others) {
    set_space(stream, *one->space);
    stream.text << "Attribute \"" << target_ << "\" ";
    write(*one, stream);
    stream.text << "\n";
  }
  if (own && is_block) set_space(stream, *own);
  stream.text << before_ << head_;
  std::size_t length = head_.size();
  for (const Parameter& one : parameters_) {
    if (one.space && one.space != own) continue;
    const std::size_t more = one.declaration.size() + one.value.size() + 1;
    const bool fits = !one.list && length + more <= longest_line;
    stream.text << (fits ? " " : "\n  ");
    length = fits ? length + more : more;
    write(one, stream);
  }
  stream.text << "\n";
  if (!is_block) return;
  stream.text << "AttributeEnd\n";
  stream.space = outer;
}

}  // namespace caplet::pbrt_text
