// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/detail/message_fields.h"

namespace caplet::view::message {

namespace {

constexpr std::size_t longest_text = 100;
constexpr std::size_t most_numbers = 16;

Spectrum spectrum(const json& of) {
  if (of.size() != 1) refuse("to", "is not one of constant, rgb, blackbody, name and texture");
  if (of.contains("constant"))
    return ConstantSpectrum{number(of["constant"], "to.constant", 0, 1e30)};
  if (of.contains("blackbody"))
    return BlackbodySpectrum{number(of["blackbody"], "to.blackbody", 1, 1e6)};
  if (of.contains("rgb")) return RgbSpectrum{point(of, "rgb"), ColorSpace::srgb};
  if (!of.contains("name"))
    refuse("to", "is not one of constant, rgb, blackbody, name and texture");
  const std::string name = text(of, "name", longest_text);
  const auto known = named_spectrum(name);
  if (!known) refuse("to", fmt::format("there is no spectrum \"{}\"", name));
  return *known;
}

Value value(const json& to) {
  if (to.is_null()) return std::monostate();
  if (to.is_boolean()) return to.get<bool>();
  if (to.is_number()) return number(to, "to", -1e30, 1e30);
  if (to.is_string()) return to.get<std::string>();
  if (to.is_array()) {
    if (to.size() > most_numbers)
      refuse("to", fmt::format("is a list of more than {} numbers", most_numbers));
    std::vector<double> out;
    for (std::size_t i = 0; i < to.size(); ++i)
      out.push_back(number(to[i], fmt::format("to[{}]", i), -1e30, 1e30));
    return out;
  }
  if (to.size() == 1 && to.contains("texture")) return TextureChoice{id(to, "texture")};
  return spectrum(to);
}

FormSubject::Kind kind_of(const std::string& name, const char* field) {
  for (std::size_t i = 0; i < form_subject_names.size(); ++i)
    if (name == form_subject_names[i]) return static_cast<FormSubject::Kind>(i);
  refuse(field, fmt::format("is none of {}", fmt::join(form_subject_names, ", ")));
}

Add add(const json& of) {
  Add out;
  out.what = kind_of(text(of, "of", longest_text), "of");
  if (out.what != FormSubject::Kind::material && out.what != FormSubject::Kind::texture &&
      out.what != FormSubject::Kind::light && out.what != FormSubject::Kind::shape)
    refuse("of", "is none of material, texture, light and shape");
  if (out.what == FormSubject::Kind::material && of.contains("like")) {
    out.like = id(of, "like");
    return out;
  }
  out.kind = text(of, "kind", longest_text);
  if (out.what == FormSubject::Kind::texture) out.is_float = truth(of, "of_floats");
  if (out.what == FormSubject::Kind::shape) out.material = id(of, "material");
  if (out.what != FormSubject::Kind::shape && out.what != FormSubject::Kind::light) return out;
  out.at = point(of, "at");
  out.size = number(field(of, "size"), "size", 1e-30, 1e30);
  if (out.what == FormSubject::Kind::light) out.towards = point(of, "towards");
  return out;
}

}  // namespace

FormSubject part(const json& object) {
  return {kind_of(text(object, "of", longest_text), "of"),
          object.contains("part") ? id(object, "part") : 0};
}

std::optional<FormChange> form_change(const json& of) {
  const json& what = field(of, "what");
  if (what == "set") return Set{part(of), text(of, "field", longest_text), value(field(of, "to"))};
  if (what == "add") return add(of);
  if (what == "remove") {
    const FormSubject which = part(of);
    if (which.kind != FormSubject::Kind::light) refuse("of", "is not light");
    return Remove{which};
  }
  if (what == "hide") return Hide{ids(of), truth(of, "others")};
  if (what == "show")
    return Show{field(of, "hidden").is_null() ? std::nullopt : std::optional(id(of, "hidden"))};
  return {};
}

}  // namespace caplet::view::message
