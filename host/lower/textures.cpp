// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/textures.h"

#include <map>

#include "base/check.h"
#include "lower/detail/family_data.h"

namespace caplet {

namespace {

template <class Model>
constexpr std::uint32_t kind_of = texture_count;
#define TEXTURE_MODEL(name, Type) \
  template <>                     \
  constexpr std::uint32_t kind_of<Type> = texture_##name;
#include "scene/textures.def"

// Every row of textures.def has its model: `constant` is a constant operand, `extinction` comes after the texture of a metal.
#define TEXTURE_MODEL(name, Type) +1
static_assert(2
#include "scene/textures.def"
              == texture_count);

static_assert(most_texture_steps + 1 <= CAPLET_TEXTURE_MAX_STEPS);

/// Adds the steps of one texture.
class Steps {
 public:
  Steps(const Scene& scene, SpectrumTable& spectra, FlatScene& out)
      : scene_(scene), spectra_(spectra), out_(out), first_(narrow<std::uint32_t>(out.textures.size())) {}

  /// The number of the step, from the first, that is the texture's value.
  std::uint32_t add(std::uint32_t texture, TextureUse use);
  /// A step of `kind` whose field "tex" is that of number `of`.
  void add_last(uint kind, std::uint32_t of);
  std::uint32_t finish() {
    out_.textures[first_].steps = narrow<uint>(out_.textures.size() - first_);
    return first_;
  }

 private:
  struct Writer;

  /// `put` writes the data.
  template <class Put>
  std::uint32_t add_step(uint kind, Put put) {
    TextureRecord record{};
    record.kind = kind;
    record.data = narrow<uint>(out_.texture_data.size());
    std::vector<float> floats(texture_floats[kind]);
    FamilyData data(texture_fields[kind], floats.data());
    put(data);
    data.finish();
    out_.texture_data.insert(out_.texture_data.end(), floats.begin(), floats.end());
    out_.textures.push_back(record);
    return narrow<std::uint32_t>(out_.textures.size() - 1 - first_);
  }
  std::uint32_t operand(const TextureOperand& of, TextureUse use);

  const Scene& scene_;
  SpectrumTable& spectra_;
  FlatScene& out_;
  std::uint32_t first_;
  std::map<std::uint32_t, std::uint32_t> done_;  // the steps of textures: what is used twice is evaluated once
};

/// Writes what scene/textures.def visits, once the operands are there.
struct Steps::Writer {
  FamilyData& data;
  const std::map<std::string_view, std::uint32_t>& operands;

  void operand(const char* name, const TextureOperand&) { data.put_index(name, operands.at(name)); }
  void factor(const char* name, const TextureOperand&) { data.put_index(name, operands.at(name)); }
  void number(const char* name, double value) { data.put(name, value); }
  void fixed(const char*, int) {}
  void mapping(double uscale, double vscale, double udelta, double vdelta) {
    number("uscale", uscale);
    number("vscale", vscale);
    number("udelta", udelta);
    number("vdelta", vdelta);
  }
};

std::uint32_t Steps::operand(const TextureOperand& of, TextureUse use) {
  if (of.texture) return add(*of.texture, use);
  return add_step(texture_constant, [&](FamilyData& data) {
    data.put_index("value", use == TextureUse::number   ? spectra_.add_number(std::get<ConstantSpectrum>(of.value).value)
                            : use == TextureUse::albedo ? spectra_.add_reflectance(of.value)
                                                        : spectra_.add_unbounded(of.value));
  });
}

/// Calls visit(name, operand, whether it is of floats whatever the texture is of).
template <class Visit>
struct Operands {
  Visit visit;
  void operand(const char* name, const TextureOperand& of) { visit(name, of, false); }
  void factor(const char* name, const TextureOperand& of) { visit(name, of, true); }
  void number(const char*, double) {}
  void fixed(const char*, int) {}
  void mapping(double, double, double, double) {}
};
template <class Visit>
Operands(Visit) -> Operands<Visit>;  // clang before 17 does not deduce aggregates

std::uint32_t Steps::add(std::uint32_t texture, TextureUse use) {
  if (const auto found = done_.find(texture); found != done_.end()) return found->second;
  const std::uint32_t step = std::visit(
      [&](const auto& model) {
        std::map<std::string_view, std::uint32_t> operands;
        model.fields(model, Operands{[&](const char* name, const TextureOperand& of, bool is_factor) {
                       operands[name] = operand(of, is_factor ? TextureUse::number : use);
                     }});
        return add_step(kind_of<std::decay_t<decltype(model)>>, [&](FamilyData& data) {
          model.fields(model, Writer{data, operands});
        });
      },
      scene_.textures[texture].model);
  done_[texture] = step;
  return step;
}

void Steps::add_last(uint kind, std::uint32_t of) {
  add_step(kind, [&](FamilyData& data) { data.put_index("tex", of); });
}

}  // namespace

std::uint32_t lower_texture(const Scene& scene, std::uint32_t texture, TextureUse use, std::optional<uint> last,
                            SpectrumTable& spectra, FlatScene& out) {
  Steps steps(scene, spectra, out);
  const std::uint32_t value = steps.add(texture, use);
  if (last) steps.add_last(*last, value);
  return steps.finish();
}

}  // namespace caplet
