// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/mesh_file.h"

#include "base/check.h"
#include "import/detail/text_file.h"
#include "present/picture_options.h"

namespace caplet {

LineWords::LineWords(std::string_view line, const std::string& file, int number, char comment)
    : line_(line.substr(0, line.find(comment))),
      file_(file),
      number_(number),
      words_(words_of(line_)) {}

std::string_view LineWords::rest(std::size_t i) const {
  if (i >= words_.size()) return {};
  return trimmed(line_.substr(static_cast<std::size_t>(words_[i].data() - line_.data())));
}

float LineWords::number(std::size_t i) const {
  if (i >= words_.size()) fail(i, "a number is missing");
  float value = 0;
  const NumberError error = parse_float(words_[i], value);
  if (error != NumberError::none) fail(i, describe(error, words_[i]));
  return value;
}

std::int64_t LineWords::whole(std::size_t i) const {
  if (i >= words_.size()) fail(i, "a whole number is missing");
  const std::string_view text = words_[i];
  std::int64_t value = 0;
  if (!parse_number(text, value)) fail(i, quoted(text) + " is no whole number");
  return value;
}

void LineWords::fail(std::size_t i, const std::string& message) const {
  const std::size_t column = i < words_.size()
                                 ? static_cast<std::size_t>(words_[i].data() - line_.data()) + 1
                                 : line_.size() + 1;
  throw InputError({file_, number_, static_cast<int>(column)}, message);
}

glm::dmat4 world_from_file(const ImportOptions& options, const char* usual) {
  return glm::dmat4(turned_up(parse_axis(options.text("up").value_or(usual), "--up")));
}

std::uint32_t MeshImages::texture(const std::filesystem::path& path, bool is_float, bool is_srgb,
                                  const SourceLocation& where) {
  const auto [known, fresh] =
      textures_.try_emplace({path.string(), (is_float ? 1 : 0) + (is_srgb ? 2 : 0)},
                            narrow<std::uint32_t>(scene_.textures.size()));
  if (!fresh) return known->second;
  std::shared_ptr<const TextureImage>& image = images_[{path.string(), is_srgb}];
  if (!image) {
    const ImageEncoding encoding{is_srgb ? ImageEncoding::Kind::srgb : ImageEncoding::Kind::linear,
                                 1};
    try {
      image = std::make_shared<const TextureImage>(reader_.read_texture(path, encoding));
    } catch (const InputError& error) {
      throw InputError(where, error.what());
    }
  }
  ImagemapTexture model;
  model.image = image;
  scene_.textures.push_back({model, is_float, path.filename().string(), where});
  return known->second;
}

std::uint32_t add_plain_material(Scene& scene) {
  constexpr double kGrey = 0.6;
  scene.materials.push_back(
      {DiffuseMaterial{ConstantSpectrum{kGrey}}, "default", {scene.source, 0, 0}});
  return narrow<std::uint32_t>(scene.materials.size() - 1);
}

Shape mesh_shape(TriangleMeshShape mesh, std::string name, std::uint32_t material,
                 const SourceLocation& where) {
  Shape shape;
  shape.geometry = std::move(mesh);
  shape.name = std::move(name);
  shape.material = material;
  shape.where = where;
  return shape;
}

}  // namespace caplet
