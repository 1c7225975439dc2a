// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/reading.h"
#include "base/spelling.h"
#include "import/detail/pbrt/spectrum_file.h"
#include "import/detail/pbrt/v3.h"

namespace caplet::pbrt {

namespace {

/// Returns a texture's refusal without its place.
std::string kind_of(const std::string& refusal) { return refusal.substr(0, refusal.find(" (")); }

/// Returns whether values without a stated type fit this one. A spectrum of one number is a float,
/// of three numbers an rgb.
bool suits(const Parameter& parameter, std::string_view type) {
  const std::size_t count = parameter.numbers.size();
  if (!parameter.bools.empty()) return type == "bool";
  if (!parameter.strings.empty())
    return type == "string" || type == "spectrum" || type == "texture";
  if (type == "bool" || type == "string" || type == "texture" || type == "blackbody" || count == 0)
    return false;
  if (type == "spectrum") return count > 3 && count % 2 == 0;
  if (type == "integer")
    return std::ranges::all_of(parameter.numbers, [](double x) {
      return x == std::floor(x) && std::abs(x) <= 2147483647.0;
    });
  return count % values_each(type) == 0;
}

/// Describes the given values for messages.
std::string values_of(const Parameter& parameter) {
  const auto some = [](std::size_t count, const char* what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
  };
  if (!parameter.bools.empty()) return some(parameter.bools.size(), "bool");
  if (!parameter.strings.empty()) return in_quotes(parameter.strings[0]);
  return some(parameter.numbers.size(), "number");
}

/// Says why a parameter given without a type is of none of these.
std::string mismatch(const Parameter& parameter, const std::string& wanted) {
  if (wanted == "integer")
    for (const double x : parameter.numbers)
      if (x != std::floor(x)) return fmt::format("must be a whole number, not {}", x);
  return "must be of type " + wanted + ", not " + values_of(parameter);
}

/// Reads the spectrum that a parameter states. Each way to state one has its function.
struct SpectrumOf {
  Parameters& parameters;
  const Parameter& given;
  SpectrumUse use;

  std::optional<Spectrum> read(const TextureTable* textures) {
    if (given.type == "texture") return texture(*textures);
    if (given.type == "float") return constant();
    if (given.type == "rgb") return rgb();
    if (given.type == "blackbody") return blackbody();
    return sampled();
  }

 private:
  std::nullopt_t wrong(const std::string& message) {
    parameters.error(given.name, message);
    return std::nullopt;
  }
  std::nullopt_t wrong_count(std::size_t count) {
    return wrong("takes " + std::to_string(count) +
                 (count == 1 ? " value, not " : " values, not ") +
                 std::to_string(given.numbers.size()));
  }
  std::optional<Spectrum> texture(const TextureTable& textures) {
    const TextureValue* found = textures.find(given.strings[0], false);
    if (!found || found->is_float)
      return wrong((found ? "needs a spectrum texture, not the float texture "
                          : "names an unknown texture, ") +
                   in_quotes(given.strings[0]));
    if (!found->refusal.empty()) {
      parameters.error(given.name, "uses " + found->refusal, kind_of(found->refusal));
      return std::nullopt;
    }
    if (found->texture) return wrong("takes no texture other than constants here");
    return found->spectrum;
  }
  std::optional<Spectrum> constant() {
    if (given.numbers.size() != 1) return wrong_count(1);
    if (given.numbers[0] < 0) return wrong("must not be negative");
    if (use == SpectrumUse::albedo && given.numbers[0] > 1)
      return wrong("is a reflectance above 1");
    return ConstantSpectrum{given.numbers[0]};
  }
  std::optional<Spectrum> rgb() {
    if (given.numbers.size() != 3) return wrong_count(3);
    const RgbSpectrum out{{given.numbers[0], given.numbers[1], given.numbers[2]}, given.space};
    if (std::min({out.rgb.x, out.rgb.y, out.rgb.z}) < 0) return wrong("has a negative component");
    if (use == SpectrumUse::albedo && std::max({out.rgb.x, out.rgb.y, out.rgb.z}) > 1)
      return wrong("is a reflectance and has a component above 1");
    return out;
  }
  std::optional<Spectrum> blackbody() {
    if (given.numbers[0] <= 0) return wrong("must be a positive temperature in kelvin");
    return BlackbodySpectrum{given.numbers[0]};
  }
  std::optional<Spectrum> sampled() {
    SampledSpectrum out;
    if (!given.strings.empty()) {
      if (auto named = named_spectrum(given.strings[0])) return named;
      const std::string file = resolve_file(given.strings[0], given.where, parameters.main_file());
      if (!is_there(file, given.where))
        return wrong("names neither a known spectrum nor a file, " + in_quotes(given.strings[0]) +
                     (parameters.diagnostics().is_full()
                          ? ""
                          : "; the nearest known name is \"" +
                                nearest_name(given.strings[0], named_spectrum_names()) + "\""));
      try {
        out = read_spectrum_file(file, given.where);
      } catch (const InputError& problem) {
        add_errors(problem, given.where, parameters.diagnostics());
        return std::nullopt;
      }
    }
    for (std::size_t i = 0; i < given.numbers.size(); i += 2) {
      out.wavelengths.push_back(given.numbers[i]);
      out.values.push_back(given.numbers[i + 1]);
    }
    if (*std::ranges::min_element(out.values) < 0) return wrong("has a negative value");
    if (use == SpectrumUse::albedo && *std::ranges::max_element(out.values) > 1)
      return wrong("is a reflectance and has a value above 1");
    return out;
  }
};

}  // namespace

void add_errors(const InputError& problem, const SourceLocation& where, Diagnostics& diagnostics) {
  const std::string place = where.to_string();
  for (const std::string& message : problem.messages())
    if (message.starts_with(place + ": "))
      diagnostics.error({}, message);
    else
      diagnostics.error(where, message);
}

std::string resolve_file(const std::string& name, const SourceLocation& where,
                         const std::string& main_file) {
  namespace fs = std::filesystem;
  const fs::path path(name);
  check_may_read(path.is_absolute() ? path : fs::path(where.file).parent_path() / path, where);
  if (path.is_absolute()) return name;
  const fs::path beside = fs::path(where.file).parent_path() / path;
  if (is_there(beside, where)) return beside.string();
  const fs::path main = fs::path(main_file).parent_path() / path;
  return is_there(main, where) ? main.string() : beside.string();
}

Parameters::Parameters(std::vector<Parameter> own, SharedParameters attributes, std::string owner,
                       SourceLocation where, const std::string& main_file, ColorSpace space,
                       Diagnostics& diagnostics)
    : own_(std::move(own)),
      attributes_(std::move(attributes)),
      owner_(std::move(owner)),
      where_(std::move(where)),
      main_file_(&main_file),
      space_(space),
      diagnostics_(&diagnostics) {}

SourceLocation Parameters::where(std::string_view name) const {
  for (const Parameter& parameter : own_)
    if (parameter.name == name) return parameter.where;
  for (auto it = attributes_.rbegin(); it != attributes_.rend(); ++it)
    if ((*it)->name == name) return (*it)->where;
  return where_;
}

Parameter* Parameters::find(std::string_view name) {
  if (asked_.empty()) asked_.reserve(16);
  asked_.push_back(name);
  Parameter* found = nullptr;
  for (const auto& attribute : attributes_)
    if (attribute->name == name) {
      attribute->used = true;
      found = attribute.get();
    }
  for (Parameter& parameter : own_)
    if (parameter.name == name) {
      parameter.used = true;
      found = &parameter;
    }
  return found;
}

void Parameters::error(std::string_view name, const std::string& message, const std::string& kind) {
  diagnostics_->error(where(name), owner_ + ": \"" + std::string(name) + "\" " + message, kind);
}

bool Parameters::has(std::string_view name) { return find(name) != nullptr; }

const Parameter* Parameters::values(std::string_view name,
                                    std::initializer_list<std::string_view> types) {
  Parameter* parameter = find(name);
  if (!parameter || parameter->broken) return nullptr;
  if (parameter->type.empty()) {
    for (const std::string_view type : types) {
      // Where a spectrum is allowed too, only three numbers are an rgb.
      if (type == "rgb" && types.size() > 1 && parameter->numbers.size() != 3) continue;
      if (!suits(*parameter, type)) continue;
      parameter->type = type;
      break;
    }
    if (parameter->type.empty()) {
      std::string wanted;
      for (const std::string_view type : types)
        wanted += (wanted.empty() ? "" : " or ") + std::string(type);
      error(name, mismatch(*parameter, wanted));
      parameter->broken = true;
      return nullptr;
    }
  }
  if (std::find(types.begin(), types.end(), parameter->type) != types.end()) return parameter;
  std::string wanted;
  for (std::string_view type : types) wanted += (wanted.empty() ? "" : " or ") + std::string(type);
  error(name, "must be of type " + wanted + ", not " + parameter->type);
  return nullptr;
}

double Parameters::number(std::string_view name, double fallback) {
  const Parameter* parameter = values(name, {"float"});
  if (!parameter) return fallback;
  if (parameter->numbers.size() == 1) return parameter->numbers[0];
  error(name, "takes 1 value, not " + std::to_string(parameter->numbers.size()));
  return fallback;
}

int Parameters::integer(std::string_view name, int fallback) {
  const Parameter* parameter = values(name, {"integer"});
  if (!parameter) return fallback;
  if (parameter->numbers.size() == 1) return static_cast<int>(parameter->numbers[0]);
  error(name, "takes 1 value, not " + std::to_string(parameter->numbers.size()));
  return fallback;
}

bool Parameters::boolean(std::string_view name, bool fallback) {
  const Parameter* parameter = values(name, {"bool"});
  if (!parameter) return fallback;
  if (parameter->bools.size() == 1) return parameter->bools[0];
  error(name, "takes 1 value, not " + std::to_string(parameter->bools.size()));
  return fallback;
}

std::string Parameters::text(std::string_view name, const std::string& fallback) {
  const Parameter* parameter = values(name, {"string"});
  if (!parameter) return fallback;
  if (parameter->strings.size() == 1) return parameter->strings[0];
  error(name, "takes 1 value, not " + std::to_string(parameter->strings.size()));
  return fallback;
}

glm::dvec3 Parameters::point(std::string_view name, const glm::dvec3& fallback) {
  const Parameter* parameter = values(name, {"point3"});
  if (!parameter) return fallback;
  if (parameter->numbers.size() == 3)
    return {parameter->numbers[0], parameter->numbers[1], parameter->numbers[2]};
  error(name, "takes 1 point, not " + std::to_string(parameter->numbers.size() / 3));
  return fallback;
}

glm::dvec3 Parameters::vector(std::string_view name, const glm::dvec3& fallback) {
  const Parameter* parameter = values(name, {"vector3"});
  if (!parameter) return fallback;
  if (parameter->numbers.size() == 3)
    return {parameter->numbers[0], parameter->numbers[1], parameter->numbers[2]};
  error(name, "takes 1 vector, not " + std::to_string(parameter->numbers.size() / 3));
  return fallback;
}

std::optional<Spectrum> Parameters::spectrum(std::string_view name, SpectrumUse use,
                                             const TextureTable* textures) {
  const Parameter* parameter =
      textures ? values(name, {"rgb", "spectrum", "blackbody", "float", "texture"})
               : values(name, {"rgb", "spectrum", "blackbody", "float"});
  return parameter ? SpectrumOf{*this, *parameter, use}.read(textures) : std::nullopt;
}

double Parameters::number_or_texture(std::string_view name, double fallback,
                                     const TextureTable& textures) {
  const Parameter* parameter = values(name, {"float", "texture"});
  if (!parameter) return fallback;
  if (parameter->type == "float") return number(name, fallback);
  const TextureValue* found = textures.find(parameter->strings[0], true);
  if (!found)
    error(name, "names an unknown texture, " + in_quotes(parameter->strings[0]));
  else if (!found->is_float)
    error(name,
          "needs a float texture, not the spectrum texture " + in_quotes(parameter->strings[0]));
  else if (!found->refusal.empty())
    error(name, "uses " + found->refusal, kind_of(found->refusal));
  else if (found->texture)
    error(name, "takes no texture other than constants here");
  else
    return found->number;
  return fallback;
}

std::optional<std::uint32_t> Parameters::texture(std::string_view name, bool is_float,
                                                 const TextureTable& textures) {
  const Parameter* parameter = find(name);
  if (!parameter || parameter->type != "texture") return std::nullopt;
  if (parameter->strings.empty()) return std::nullopt;  // which the parser has told
  const TextureValue* found = textures.find(parameter->strings[0], is_float);
  return found && found->is_float == is_float && found->refusal.empty() ? found->texture
                                                                        : std::nullopt;
}

void Parameters::ignore(std::string_view name) { find(name); }

void Parameters::finish() {
  for (const auto& attribute : attributes_) attribute->consulted = true;
  for (const Parameter& parameter : own_) {
    if (parameter.used) continue;
    const std::string directive = owner_.substr(0, owner_.find(' ')),
                      unknown = ": unknown parameter " + in_quotes(parameter.name);
    std::string message = owner_ + unknown;
    if (const std::string old = v3_parameter(directive, parameter.name); !old.empty())
      message += ": that is " + old;
    else if (!asked_.empty() && !diagnostics_->is_full())
      message += "; the nearest known name is \"" +
                 nearest_name(parameter.name, {asked_.begin(), asked_.end()}) + "\"";
    diagnostics_->error(parameter.where, message, directive + unknown);
  }
}

}  // namespace caplet::pbrt
