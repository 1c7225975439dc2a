// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/textures.h"

#include <algorithm>
#include <bit>
#include <glm/matrix.hpp>
#include <map>

#include "base/check.h"
#include "lower/detail/family_data.h"
#include "lower/detail/images.h"
#include "scene/field.h"

namespace caplet {

namespace {

template <class Model>
constexpr std::uint32_t texture_kinds = texture_count;
#define TEXTURE_MODEL(name, Type) \
  template <>                     \
  constexpr std::uint32_t texture_kinds<Type> = texture_##name;
#include "scene/textures.def"

// Every row of textures.def has its model: `constant` is a constant operand, `extinction`,
// `displacement` and `alpha` come after textures.
#define TEXTURE_MODEL(name, Type) +1
static_assert(4
#include "scene/textures.def"
              == texture_count);

static_assert(most_texture_steps + 1 <= CAPLET_TEXTURE_MAX_STEPS);

/// Steps adds the steps of one texture.
class Steps {
 public:
  Steps(const Scene& scene, const ImageNumbers& images, SpectrumTable& spectra, FlatScene& out)
      : scene_(scene),
        images_(images),
        spectra_(spectra),
        out_(out),
        first_(narrow<std::uint32_t>(out.textures.size())) {}

  /// Returns the number of the step, from the first, that is the texture's value.
  std::uint32_t add(std::uint32_t texture, TextureUse use);
  /// Adds a step of `kind` whose field "tex" is that of number `of`.
  void add_last(uint kind, std::uint32_t of);
  std::uint32_t finish() {
    out_.textures[first_].steps = narrow<uint>(out_.textures.size() - first_);
    return first_;
  }

  /// Adds a step of a constant, or those of a texture.
  std::uint32_t operand(const TextureOperand& of, TextureUse use);

 private:
  struct Writer;

  /// Adds a step; `put` writes its data.
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

  const Scene& scene_;
  const ImageNumbers& images_;
  SpectrumTable& spectra_;
  FlatScene& out_;
  std::uint32_t first_;
  std::map<std::uint32_t, std::uint32_t>
      done_;  // the steps of textures: what is used twice is evaluated once
};

/// Writes the fields that scene/textures.def visits, once the operands are there.
struct Steps::Writer : IgnoresFields {
  Writer(FamilyData& to, const std::map<std::string_view, std::uint32_t>& steps, Steps& all,
         TextureUse what)
      : data(to), operands(steps), of(all), use(what) {}
  FamilyData& data;
  const std::map<std::string_view, std::uint32_t>& operands;
  Steps& of;
  TextureUse use;
  const TextureImage* last = nullptr;  // the image before "wrap"

  void operand(const Field& field, const TextureOperand&) {
    data.put_index(field.name, operands.at(field.name));
  }
  void factor(const Field& field, const TextureOperand& of_texture) { operand(field, of_texture); }
  void number(const Field& field, double value) { data.put(field.name, value); }
  template <class Names>
  void choice(const Field& field, int value, const Names&) {
    data.put_index(field.name, narrow<std::uint32_t>(value));
    if (std::string_view(field.name) == "wrap")
      data.put_index("image", of.images_.at(image_use(*last, value)));
  }
  void flag(const Field& field, bool value) { data.put_index(field.name, value ? 1 : 0); }
  void image(const Field&, const std::shared_ptr<const TextureImage>& image) {
    last = image.get();
    data.put_index("use", use == TextureUse::number      ? CAPLET_USE_NUMBER
                          : use == TextureUse::unbounded ? CAPLET_USE_UNBOUNDED
                                                         : CAPLET_USE_ALBEDO);
    data.put_index("uplift", use == TextureUse::number || image->channels == 1
                                 ? 0
                                 : of.spectra_.uplift_table(image->space));
  }
  void mapping(const TextureMapping& of_texture) {
    std::array<float, 13> out{};
    using Kind = TextureMapping::Kind;
    static_assert(
        int(Kind::uv) == CAPLET_MAPPING_UV && int(Kind::spherical) == CAPLET_MAPPING_SPHERICAL &&
        int(Kind::cylindrical) == CAPLET_MAPPING_CYLINDRICAL &&
        int(Kind::planar) == CAPLET_MAPPING_PLANAR && int(Kind::solid) == CAPLET_MAPPING_SOLID);
    out[0] = std::bit_cast<float>(static_cast<std::uint32_t>(of_texture.kind));
    glm::dmat4 m = of_texture.texture_from_world;
    if (of_texture.kind == Kind::planar) {
      const glm::dvec3 &a = of_texture.v1, &b = of_texture.v2;
      m = glm::transpose(glm::dmat4(glm::dvec4(a, of_texture.udelta),
                                    glm::dvec4(b, of_texture.vdelta), glm::dvec4(0),
                                    glm::dvec4(0, 0, 0, 1))) *
          m;
    }
    if (of_texture.kind == Kind::uv) {
      const double values[] = {of_texture.uscale, of_texture.vscale, of_texture.udelta,
                               of_texture.vdelta};
      std::ranges::transform(values, out.begin() + 1,
                             [](double value) { return static_cast<float>(value); });
    } else {
      rows_of(m, &out[1]);
    }
    data.put_floats("mapping", out);
  }
  void board(const TextureMapping& of_texture) { mapping(of_texture); }
  void place(const glm::dmat4& m) {
    std::array<float, 12> out;
    rows_of(m, out.data());
    data.put_floats("place", out);
  }
  void direction(const Field& field, const glm::dvec3& v) { data.put(field.name, v); }
  void integer(const Field& field, int value) {
    data.put_index(field.name, narrow<std::uint32_t>(value));
  }
  void colors() { data.put_index("uplift", of.spectra_.uplift_table(ColorSpace::srgb)); }
  void vectors(const Field&, const std::shared_ptr<const TextureImage>& image) {
    data.put_index("image", of.images_.at(image_use(*image, std::nullopt)));
  }

  static void rows_of(const glm::dmat4& m, float* to) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) *to++ = static_cast<float>(m[c][r]);
  }
};

std::uint32_t Steps::operand(const TextureOperand& of, TextureUse use) {
  if (of.texture) return add(*of.texture, use);
  return add_step(texture_constant, [&](FamilyData& data) {
    data.put_index("value", use == TextureUse::number
                                ? spectra_.add_number(std::get<ConstantSpectrum>(of.value).value)
                            : use == TextureUse::albedo ? spectra_.add_reflectance(of.value)
                                                        : spectra_.add_unbounded(of.value));
  });
}

/// Calls visit(name, operand, whether it is of floats whatever the texture is of).
template <class Visit>
struct Operands : IgnoresFields {
  explicit Operands(Visit calls) : visit(std::move(calls)) {}
  Visit visit;
  void operand(const Field& field, const TextureOperand& of) { visit(field.name, of, false); }
  void factor(const Field& field, const TextureOperand& of) { visit(field.name, of, true); }
};

std::uint32_t Steps::add(std::uint32_t texture, TextureUse use) {
  if (const auto found = done_.find(texture); found != done_.end()) return found->second;
  const std::uint32_t step = std::visit(
      [&](const auto& model) {
        std::map<std::string_view, std::uint32_t> operands;
        model.fields(model,
                     Operands([&](const char* name, const TextureOperand& of, bool is_factor) {
                       operands[name] = operand(of, is_factor ? TextureUse::number : use);
                     }));
        return add_step(texture_kinds<std::decay_t<decltype(model)>>, [&](FamilyData& data) {
          model.fields(model, Writer(data, operands, *this, use));
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

std::uint32_t lower_alpha(const Scene& scene, const TextureOperand& alpha,
                          const ImageNumbers& images, SpectrumTable& spectra, FlatScene& out) {
  Steps steps(scene, images, spectra, out);
  const std::uint32_t value = steps.operand(alpha, TextureUse::number);
  steps.add_last(texture_alpha, value);
  return steps.finish();
}

std::uint32_t lower_texture(const Scene& scene, std::uint32_t texture, TextureUse use,
                            std::optional<uint> last, const ImageNumbers& images,
                            SpectrumTable& spectra, FlatScene& out) {
  Steps steps(scene, images, spectra, out);
  const std::uint32_t value = steps.add(texture, use);
  if (last) steps.add_last(*last, value);
  return steps.finish();
}

}  // namespace caplet
