// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/matte_names.h"

#include <algorithm>
#include <bit>
#include <filesystem>

namespace caplet {

namespace {

/// MurmurHash3_x86_32 of Appleby, which is in the public domain. Blocks are little-endian.
std::uint32_t murmur3(std::string_view bytes) {
  constexpr std::uint32_t c1 = 0xcc9e2d51u, c2 = 0x1b873593u;
  const auto mixed = [](std::uint32_t k) { return std::rotl(k * c1, 15) * c2; };
  const auto byte = [&](std::size_t i) {
    return std::uint32_t{static_cast<unsigned char>(bytes[i])};
  };
  std::uint32_t hash = 0;
  const std::size_t whole = bytes.size() / 4 * 4;
  for (std::size_t i = 0; i < whole; i += 4) {
    hash ^= mixed(byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24);
    hash = std::rotl(hash, 13) * 5 + 0xe6546b64u;
  }
  std::uint32_t tail = 0;
  for (std::size_t i = bytes.size(); i-- > whole;) tail = tail << 8 | byte(i);
  if (whole < bytes.size()) hash ^= mixed(tail);
  hash ^= static_cast<std::uint32_t>(bytes.size());
  hash = (hash ^ hash >> 16) * 0x85ebca6bu;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
  return hash ^ hash >> 16;
}

std::string named(const std::string& name, const char* kind, std::size_t index) {
  return name.empty() ? kind + std::string(" ") + std::to_string(index) : name;
}

void sort_once(std::vector<std::string>& names) {
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
}

}  // namespace

std::uint32_t matte_hash(std::string_view name) {
  const std::uint32_t hash = murmur3(name), exponent = hash >> 23 & 255;
  return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

std::string matte_name(const Shape& shape, std::size_t index) {
  return named(shape.name, geometry_name(shape), index);
}

std::string matte_name(const Object& object, std::size_t index) {
  return named(object.name, "object", index);
}

std::string matte_name(const Material& material, std::size_t index) {
  return named(material.name, "material", index);
}

std::string matte_asset(const Shape& shape) {
  const std::string stem = std::filesystem::path(shape.where.file).stem().string();
  return stem.empty() ? "scene" : stem;
}

MatteNames matte_names(const Scene& scene) {
  MatteNames out;
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    out.objects.push_back(matte_name(scene.shapes[i], i));
    out.assets.push_back(matte_asset(scene.shapes[i]));
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    out.objects.push_back(matte_name(scene.objects[i], i));
    for (const Shape& shape : scene.objects[i].shapes) out.assets.push_back(matte_asset(shape));
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    out.materials.push_back(matte_name(scene.materials[i], i));
  for (auto* names : {&out.objects, &out.materials, &out.assets}) sort_once(*names);
  return out;
}

}  // namespace caplet
