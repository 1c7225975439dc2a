// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Convex solids that the model tells by their surfaces and fields (scene/shapes/family.h), on trial
// without a word of their own. What kernels read of them are the fields in order.
#pragma once

#include <cmath>
#include <string_view>
#include <type_traits>

#include "lower/flat_primitive.h"
#include "reference/primitive.h"
#include "support/kinds.h"

namespace caplet::test {

/// Calls `call` with the model's type of a kind; false where it is not such a one.
template <class Call>
bool for_faced(std::uint32_t kind, Call call) {
  const std::string_view own = all_shapes[kind].name;
#define GEOMETRY(Type, name)                            \
  if constexpr (FacedSolid<Type> && FieldedShape<Type>) \
    if (own == #name) {                                 \
      call(std::type_identity<Type>{});                 \
      return true;                                      \
    }
#include "scene/geometries.def"
  return false;
}

/// Fields from data and back.
struct FromData : Fields {
  explicit FromData(const float* data) : at(data) {}
  void corners(const char*, const char*, glm::dvec3& p0, glm::dvec3& p1) override {
    p0 = {at[0], at[1], at[2]};
    p1 = {at[3], at[4], at[5]};
    at += 6;
  }
  void positive(const char*, double& value) override { value = *at++; }
  const float* at;
};

/// How many of the data are points' coordinates, before the first that is none, and how many there
/// are.
struct CountFields : Fields {
  void corners(const char*, const char*, glm::dvec3&, glm::dvec3&) override {
    if (coordinates == all) coordinates += 6;
    all += 6;
  }
  void positive(const char*, double&) override { ++all; }
  int coordinates = 0, all = 0;
};
template <class Type>
CountFields count_fields() {
  CountFields each;
  Type shape;
  fields(shape, each);
  return each;
}

template <class Type>
reference::Primitive faced_reference(const float* data) {
  Type shape;
  FromData each(data);
  fields(shape, each);
  return reference::Solid<Type>{shape};
}

/// The point of the surface that lies on the ray from a point inside.
template <class Type>
glm::dvec3 surface_beyond(const Type& solid, const glm::dvec3& inside, const glm::dvec3& along,
                          int* surface) {
  double low = 0, high = 1;
  while (beyond(solid, inside + high * along).most < 0) high *= 2;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (beyond(solid, inside + middle * along).most > 0 ? high : low) = middle;
  }
  const glm::dvec3 p = inside + low * along;
  double most = -HUGE_VAL;
  for (int i = 0; i < static_cast<int>(surfaces_of(solid)); ++i)
    if (const double value = outside(solid, i, p); value > most) {
      most = value;
      *surface = i;
    }
  return p;
}

}  // namespace caplet::test
