// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "lower/lower.h"

namespace caplet::test {

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}
/// Sizes, and where the first byte differs.
template <class T>
std::string how(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size())
    return "(" + std::to_string(a.size()) + " and " + std::to_string(b.size()) + ") ";
  std::size_t at = 0;
  const auto *x = reinterpret_cast<const char*>(a.data()),
             *y = reinterpret_cast<const char*>(b.data());
  while (x[at] == y[at]) ++at;
  return "(from " + std::to_string(at / sizeof(T)) + " on, byte " + std::to_string(at % sizeof(T)) +
         ") ";
}
template <class T>
std::string how(const T&, const T&) {
  return {};
}

template <class T>
bool same_bytes(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

/// A lowered scene without what mattes know things by: exported things without names get some.
inline FlatScene nameless(const Scene& scene) {
  FlatScene out = lower(scene);
  for (GeometryRecord& geometry : out.geometries) geometry.object_name = geometry.asset_name = 0;
  for (MaterialRecord& material : out.materials) material.name = 0;
  return out;
}

/// The names of the device buffers that differ: what a picture is made of.
inline std::string different_buffers(const Scene& one, const Scene& other) {
  const FlatScene a = nameless(one), b = nameless(other);
  const FlatView v = lower_view(one), w = lower_view(other);
  std::string out;
#define GROUP_BEGIN(Type, group)
#define GROUP_END(Type)
#define BUFFER(name, type, access) \
  if (!same_bytes(a.name, b.name)) out += #name " " + how(a.name, b.name);
  SCENE_GROUPS
#undef BUFFER
#define BUFFER(name, type, access) \
  if (!same_bytes(v.name, w.name)) out += #name " " + how(v.name, w.name);
  VIEW_GROUPS
#undef GROUP_BEGIN
#undef GROUP_END
#undef BUFFER
  return out;
}

}  // namespace caplet::test
