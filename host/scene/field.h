// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Parameters of models. The `fields` function of each model passes its members to a visitor, each
// with a Field (materials.def, textures.def, lights.def, media.def). Readers, writers, checks,
// forms and lists of parameters all use these calls.
#pragma once

#include <cstddef>
#include <limits>
#include <utility>
#include <variant>

namespace caplet {

inline constexpr double no_limit = std::numeric_limits<double>::infinity();
inline constexpr double most_integer = 2147483647;

/// A parameter. name: its name in scene files. doc: its description, a phrase without a full stop.
/// low, high: the range of a number, both ends included (above_low: `low` is excluded). unit: the
/// unit of a number, as people write it.
struct Field {
  const char* name;
  const char* doc;
  double low = -no_limit, high = no_limit;
  const char* unit = "";
  bool above_low = false;
};

/// Returns a variant's alternative of this index as it is by default; the first where there is
/// none.
template <class Model, std::size_t index = 0>
Model model_of(std::size_t which) {
  if (which == index) return Model(std::in_place_index<index>);
  if constexpr (index + 1 < std::variant_size_v<Model>) return model_of<Model, index + 1>(which);
  return Model();
}

/// The names of GGX's two roughnesses in scene files, before any remapping.
struct RoughnessFields {
  Field alpha_u, alpha_v;
  const char *roughness, *uroughness, *vroughness;
};
/// A complex index of refraction, or the reflectance that replaces it.
struct MetalFields {
  Field eta, k, reflectance;
};
/// An absorption of hair, or the colour that replaces it.
struct PigmentFields {
  Field sigma_a, reflectance;
};

/// Ignores every call of every family. Visitors that need only some calls derive from it.
struct IgnoresFields {
  template <class Value>
  void albedo(const Field&, const Value&) const {}
  template <class Value>
  void unbounded(const Field&, const Value&) const {}
  template <class Value>
  void index(const Field&, const Value&) const {}
  template <class Value>
  void emission(const Field&, const Value&) const {}
  template <class Value>
  void operand(const Field&, const Value&) const {}
  template <class Value>
  void factor(const Field&, const Value&) const {}
  template <class Value>
  void number(const Field&, const Value&) const {}
  template <class Value>
  void integer(const Field&, const Value&) const {}
  template <class Value>
  void flag(const Field&, const Value&) const {}
  template <class Value, class Names>
  void choice(const Field&, const Value&, const Names&) const {}
  template <class Value>
  void position(const Field&, const Value&) const {}
  template <class Value>
  void direction(const Field&, const Value&) const {}
  template <class Value>
  void direction(const Field&, const Field&, const Value&) const {}
  template <class Value>
  void image(const Field&, const Value&) const {}
  template <class Value>
  void directions(const Field&, const Value&) const {}
  template <class Value>
  void vectors(const Field&, const Value&) const {}
  template <class Value>
  void profile(const Field&, const Value&) const {}
  template <class Value>
  void parts(const Field&, const Value&) const {}
  template <class Value>
  void roughness(const RoughnessFields&, const Value&, const Value&) const {}
  template <class Value, class Maybe>
  void metal(const MetalFields&, const Value&, const Value&, const Maybe&) const {}
  template <class Value, class Maybe>
  void pigment(const PigmentFields&, const Value&, const Maybe&) const {}
  template <class Value>
  void mapping(const Value&) const {}
  template <class Value>
  void board(const Value&) const {}
  void field_of_view(const double&) const {}
  template <class Value>
  void lens(const Field&, const Value&) const {}
  template <class Value>
  void aperture(const Field&, const Value&) const {}
  template <class... Values>
  void place(const Values&...) const {}
  void only(bool) const {}
  void colors() const {}
  template <class Value>
  void cone(const Value&, const Value&) const {}
  template <class Value>
  void sky(const Value&) const {}
};

/// Calls the visitor's `number`, `albedo` and `unbounded` for the parts of composite parameters.
template <class Visitor>
struct CompositesInParts {
  template <class Value>
  void roughness(const RoughnessFields& fields, Value& alpha_u, Value& alpha_v) {
    self().number(fields.alpha_u, alpha_u);
    self().number(fields.alpha_v, alpha_v);
  }
  template <class Value, class Maybe>
  void metal(const MetalFields& fields, Value& eta, Value& k, Maybe& reflectance) {
    if (reflectance) return self().albedo(fields.reflectance, *reflectance);
    self().unbounded(fields.eta, eta);
    self().unbounded(fields.k, k);
  }
  template <class Value, class Maybe>
  void pigment(const PigmentFields& fields, Value& sigma_a, Maybe& reflectance) {
    if (reflectance)
      self().albedo(fields.reflectance, *reflectance);
    else
      self().unbounded(fields.sigma_a, sigma_a);
  }

 private:
  Visitor& self() { return static_cast<Visitor&>(*this); }
};

}  // namespace caplet
