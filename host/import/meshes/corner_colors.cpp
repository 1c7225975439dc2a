// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Stores colours of corners in a texture. Every triangle has four texels: with a, b and c in three
// of them and b + c - a in the fourth, bilinear interpolation between their centres is the linear
// interpolation of the corners, exactly. Near triangles have near texels (along a Morton curve), so
// that the coarse levels used for small triangles mix neighbours.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/check.h"
#include "import/detail/mesh_file.h"

namespace caplet {

namespace {

/// Interleaves the bits of three numbers of 21 bits.
std::uint64_t interleaved(const glm::dvec3& part) {
  std::uint64_t out = 0;
  for (int k = 0; k < 3; ++k) {
    const auto x = static_cast<std::uint64_t>(std::clamp(part[k], 0.0, 1.0) * 2097151.0);
    for (unsigned bit = 0; bit < 21; ++bit)
      out |= (x >> bit & 1) << (3 * bit + static_cast<unsigned>(k));
  }
  return out;
}

std::vector<std::uint32_t> along_curve(const TriangleMeshShape& mesh) {
  glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
  std::vector<glm::dvec3> middles;
  for (const auto& t : mesh.triangles) {
    glm::dvec3 middle(0);
    for (const std::uint32_t i : t) middle += glm::dvec3(mesh.positions[i]) / 3.0;
    middles.push_back(middle);
    low = glm::min(low, middle);
    high = glm::max(high, middle);
  }
  const glm::dvec3 size = glm::max(high - low, glm::dvec3(std::numeric_limits<double>::min()));
  std::vector<std::uint64_t> codes;
  for (const glm::dvec3& middle : middles) codes.push_back(interleaved((middle - low) / size));
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return codes[i]; });
  return order;
}

struct Block {
  std::uint32_t x = 0, y = 0;
};
Block block_of(std::uint32_t number) {
  Block out;
  for (unsigned bit = 0; bit < 16; ++bit) {
    out.x |= (number >> (2 * bit) & 1U) << bit;
    out.y |= (number >> (2 * bit + 1) & 1U) << bit;
  }
  return out;
}

/// Returns the colour that a texture replaces, and the field's name; null for other materials.
std::pair<Spectrum*, const char*> color_of(Material& material) {
  if (auto* diffuse = std::get_if<DiffuseMaterial>(&material.model))
    return {&diffuse->reflectance, "reflectance"};
  if (auto* principled = std::get_if<PrincipledMaterial>(&material.model))
    return {&principled->base_color, "base_color"};
  return {nullptr, ""};
}

std::optional<glm::vec3> plain_color(const Spectrum& spectrum) {
  if (const auto* rgb = std::get_if<RgbSpectrum>(&spectrum)) return glm::vec3(rgb->rgb);
  if (const auto* constant = std::get_if<ConstantSpectrum>(&spectrum))
    return glm::vec3(static_cast<float>(constant->value));
  return std::nullopt;
}

}  // namespace

float linear_of_srgb(float value) {
  return static_cast<float>(decoded_value({}, std::clamp(static_cast<double>(value), 0.0, 1.0)));
}

glm::vec3 decoded_color(const glm::vec3& numbers, float most) {
  const glm::vec3 part = most > 1 ? numbers / 255.0F : numbers;
  return {linear_of_srgb(part.x), linear_of_srgb(part.y), linear_of_srgb(part.z)};
}

ImagemapTexture texture_of_corners(TriangleMeshShape& mesh, const std::vector<glm::vec3>& colors) {
  const std::size_t count = mesh.triangles.size();
  CHECK_EQ_(colors.size(), 3 * count);
  const auto bits = static_cast<unsigned>(std::bit_width(std::max<std::size_t>(count, 1) - 1));
  auto image = std::make_shared<TextureImage>();
  const std::size_t width = std::size_t{2} << (bits + 1) / 2, height = std::size_t{2} << bits / 2;
  image->width = narrow<int>(width);
  image->height = narrow<int>(height);
  image->channels = 3;
  image->floats.assign(3 * width * height, 0.0F);
  const auto put = [&](std::size_t x, std::size_t y, const glm::vec3& color) {
    for (std::size_t k = 0; k < 3; ++k)
      image->floats[3 * (y * width + x) + k] = color[static_cast<glm::length_t>(k)];
  };
  TriangleMeshShape out;
  const std::size_t keys = std::max<std::size_t>(1, mesh.times.size());
  out.positions.resize(keys * 3 * count);
  out.uvs.resize(3 * count);
  if (!mesh.normals.empty()) out.normals.resize(keys * 3 * count);
  out.triangles.resize(count);
  out.times = mesh.times;
  const std::vector<std::uint32_t> order = along_curve(mesh);
  for (std::uint32_t number = 0; number < count; ++number) {
    const std::uint32_t triangle = order[number];
    const Block block = block_of(number);
    const std::size_t x = 2 * std::size_t{block.x}, y = 2 * std::size_t{block.y};
    const glm::vec3 a = colors[3 * triangle], b = colors[3 * triangle + 1],
                    c = colors[3 * triangle + 2];
    put(x, y, a);
    put(x + 1, y, b);
    put(x, y + 1, c);
    put(x + 1, y + 1, b + c - a);
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[triangle][k], to = 3 * triangle + k;
      for (std::size_t key = 0; key < keys; ++key) {
        const std::size_t old = key * vertex_count(mesh) + from, now = key * 3 * count + to;
        out.positions[now] = mesh.positions[old];
        if (!mesh.normals.empty()) out.normals[now] = mesh.normals[old];
      }
      // Rows of the image run down, its coordinates up.
      out.uvs[to] = {
          (static_cast<float>(x) + (k == 1 ? 1.5F : 0.5F)) / static_cast<float>(width),
          1 - (static_cast<float>(y) + (k == 2 ? 1.5F : 0.5F)) / static_cast<float>(height)};
      out.triangles[triangle][k] = to;
    }
  }
  mesh = std::move(out);
  ImagemapTexture texture;
  texture.image = std::move(image);
  texture.wrap = 2;  // clamp
  return texture;
}

bool color_corners(Scene& scene, Shape& shape, std::vector<glm::vec3> colors) {
  Material material = scene.materials.at(shape.material);
  const auto [color, field] = color_of(material);
  if (!color || !material.textures.empty() || (shape.alpha && shape.alpha->texture)) return false;
  const std::optional<glm::vec3> own = plain_color(*color);
  if (!own) return false;
  for (glm::vec3& one : colors) one = glm::min(glm::max(one * *own, glm::vec3(0)), glm::vec3(1));
  auto& mesh = std::get<TriangleMeshShape>(shape.geometry);
  const auto texture = narrow<std::uint32_t>(scene.textures.size());
  scene.textures.push_back(
      {texture_of_corners(mesh, colors), false, "colours of " + shape.name, shape.where});
  material.textures.push_back({field, texture});
  material.name += (material.name.empty() ? "colours of " : " with colours of ") + shape.name;
  shape.material = narrow<std::uint32_t>(scene.materials.size());
  scene.materials.push_back(std::move(material));
  return true;
}

}  // namespace caplet
