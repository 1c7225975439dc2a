// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts metallic-roughness materials of glTF to `principled`, with the KHR_materials extensions
// that it has parameters for.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/check.h"
#include "base/reading.h"
#include "import/detail/gltf.h"
#include "import/detail/mesh_file.h"

namespace caplet::gltf {

namespace {

/// A file that exists only while it is read: embedded images have no file names.
class TemporaryFile {
 public:
  TemporaryFile(std::string_view bytes, const std::string& extension) {
    std::string name =
        (std::filesystem::temp_directory_path() / "caplet-image-XXXXXX").string() + extension;
    const int descriptor = ::mkstemps(name.data(), static_cast<int>(extension.size()));
    if (descriptor < 0) throw InputError(name + ": no temporary file can be made for an image");
    ::close(descriptor);
    path_ = name;
    std::ofstream(path_, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  ~TemporaryFile() {
    std::error_code error;
    std::filesystem::remove(path_, error);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

float value_of(const TextureImage& image, std::size_t texel, int channel) {
  const std::size_t at =
      texel * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(channel);
  if (!image.floats.empty()) return image.floats[at];
  return channel == 3 ? static_cast<float>(image.bytes[at]) / 255.0F
                      : image.decoded[image.bytes[at]];
}

/// Applies `change` to one channel of an image, and returns floats.
template <class Change>
std::shared_ptr<const TextureImage> channel_of(const TextureImage& image, int channel,
                                               const Change& change) {
  auto out = std::make_shared<TextureImage>();
  out->width = image.width;
  out->height = image.height;
  const std::size_t texels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  out->floats.reserve(texels);
  const int from = std::min(channel, image.channels - 1);
  for (std::size_t i = 0; i < texels; ++i)
    out->floats.push_back(static_cast<float>(change(value_of(image, i, from))));
  return out;
}

/// Multiplies the image's colours by a factor.
std::shared_ptr<const TextureImage> tinted(std::shared_ptr<const TextureImage> image,
                                           const glm::dvec3& factor) {
  if (factor == glm::dvec3(1) && image->channels == 3) return image;
  auto out = std::make_shared<TextureImage>();
  out->width = image->width;
  out->height = image->height;
  out->channels = 3;
  const std::size_t texels =
      static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height);
  out->floats.reserve(3 * texels);
  for (std::size_t i = 0; i < texels; ++i)
    for (int k = 0; k < 3; ++k)
      out->floats.push_back(value_of(*image, i, image->channels >= 3 ? k : 0) *
                            static_cast<float>(factor[k]));
  return out;
}

/// Scales the tangential components of a normal map, stored as colours, by `scale`.
std::shared_ptr<const TextureImage> bent(const TextureImage& image, double scale) {
  auto out = std::make_shared<TextureImage>();
  out->width = image.width;
  out->height = image.height;
  out->channels = 3;
  const std::size_t texels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  for (std::size_t i = 0; i < texels; ++i) {
    glm::dvec3 n;
    for (int k = 0; k < 3; ++k)
      n[k] = (2.0 * static_cast<double>(value_of(image, i, k)) - 1) * (k < 2 ? scale : 1);
    const double length = glm::length(n);
    n = length > 0 ? n / length : glm::dvec3(0, 0, 1);
    for (int k = 0; k < 3; ++k) out->floats.push_back(static_cast<float>((n[k] + 1) / 2));
  }
  return out;
}

double within(double value, double low, double high) { return std::clamp(value, low, high); }

}  // namespace

const MeshMaterial& Materials::look(std::optional<std::size_t> material) {
  const auto known = looks_.find(material);
  if (known != looks_.end()) return known->second;
  MeshMaterial look;
  if (material)
    look = make(file_.list("materials")[*material]);
  else
    look.material = add_plain_material(scene_);
  return looks_[material] = look;
}

std::shared_ptr<const TextureImage> Materials::image(std::size_t index, bool is_srgb) {
  std::shared_ptr<const TextureImage>& out = images_[{index, is_srgb}];
  if (out) return out;
  const Json& of = file_.list("images")[index];
  const ImageEncoding encoding{is_srgb ? ImageEncoding::Kind::srgb : ImageEncoding::Kind::linear,
                               1};
  const std::string uri = file_.text(of, "uri", "");
  std::optional<std::string> data = uri.empty() ? std::nullopt : file_.data_uri(uri);
  if (!data && uri.empty()) {
    const auto view =
        file_.index(of, "bufferView", file_.list("bufferViews").size(), "buffer view");
    if (!view) file_.fail(fmt::format("image {} has neither an address nor a buffer view", index));
    data = std::string(file_.view(*view));
  }
  try {
    if (data) {
      const ReadingAnywhere own_file;
      const TemporaryFile file(*data, data->starts_with("\x89PNG") ? ".png" : ".jpg");
      TextureImage read = reader_.read_texture(file.path(), encoding);
      read.file.clear();
      out = std::make_shared<const TextureImage>(std::move(read));
    } else {
      out = std::make_shared<const TextureImage>(reader_.read_texture(file_.beside(uri), encoding));
    }
  } catch (const InputError& error) {
    file_.fail(fmt::format("image {}: {}", index, error.what()));
  }
  return out;
}

std::optional<std::pair<std::size_t, Materials::Sampler>> Materials::lookup(const Json& of,
                                                                            const char* name) {
  const Json& reference = file_.object(of, name);
  const auto texture = file_.index(reference, "index", file_.list("textures").size(), "texture");
  if (!texture) return std::nullopt;
  const Json& found = file_.list("textures")[*texture];
  const auto source = file_.index(found, "source", file_.list("images").size(), "image");
  if (!source) return std::nullopt;
  Sampler sampler;
  if (const auto which = file_.index(found, "sampler", file_.list("samplers").size(), "sampler")) {
    constexpr double clamp_to_edge = 33071;
    if (file_.number(file_.list("samplers")[*which], "wrapS", 0) == clamp_to_edge) sampler.wrap = 2;
  }
  const Json& transform = file_.extension(reference, "KHR_texture_transform");
  const auto scale = file_.vector(transform, "scale", glm::dvec2(1)),
             offset = file_.vector(transform, "offset", glm::dvec2(0));
  // In glTF, v counts from the top.
  sampler.mapping.uscale = scale.x;
  sampler.mapping.udelta = offset.x;
  sampler.mapping.vscale = scale.y;
  sampler.mapping.vdelta = 1 - scale.y - offset.y;
  return std::pair{*source, sampler};
}

std::uint32_t Materials::add_texture(std::shared_ptr<const TextureImage> image,
                                     const Sampler& sampler, bool is_float) {
  ImagemapTexture model;
  model.image = std::move(image);
  model.wrap = sampler.wrap;
  model.mapping = sampler.mapping;
  scene_.textures.push_back({model,
                             is_float,
                             fmt::format("image {}", scene_.textures.size()),
                             {file_.path.string(), 0, 0}});
  return narrow<std::uint32_t>(scene_.textures.size() - 1);
}

MeshMaterial Materials::make(const Json& from) {
  MeshMaterial out;
  const Json& pbr = file_.object(from, "pbrMetallicRoughness");
  Material material;
  material.name = file_.text(from, "name", "material");
  material.where = {file_.path.string(), 0, 0};
  PrincipledMaterial model;
  const auto factor = glm::clamp(file_.vector(pbr, "baseColorFactor", glm::dvec4(1)), 0.0, 1.0);
  model.base_color = RgbSpectrum{glm::dvec3(factor)};
  model.metallic = within(file_.number(pbr, "metallicFactor", 1), 0, 1);
  model.roughness = within(file_.number(pbr, "roughnessFactor", 1), 0, 1);
  model.eta = within(file_.number(file_.extension(from, "KHR_materials_ior"), "ior", 1.5), 1.01, 4);
  model.spec_trans = within(
      file_.number(file_.extension(from, "KHR_materials_transmission"), "transmissionFactor", 0), 0,
      1);
  const Json& coat = file_.extension(from, "KHR_materials_clearcoat");
  model.coat = within(file_.number(coat, "clearcoatFactor", 0), 0, 1);
  model.coat_roughness = within(file_.number(coat, "clearcoatRoughnessFactor", 0), 0, 1);
  const auto sheen =
      file_.vector(file_.extension(from, "KHR_materials_sheen"), "sheenColorFactor", glm::dvec3(0));
  model.sheen = within(std::max({sheen.x, sheen.y, sheen.z}), 0, 1);
  model.anisotropic = within(
      file_.number(file_.extension(from, "KHR_materials_anisotropy"), "anisotropyStrength", 0), 0,
      1);
  const std::string mode = file_.text(from, "alphaMode", "OPAQUE");
  const double cutoff = file_.number(from, "alphaCutoff", 0.5);
  const auto alpha = [&](double value) {
    return mode == "MASK" ? (value < cutoff ? 0.0 : 1.0) : within(value, 0, 1);
  };
  if (mode != "OPAQUE" && factor.w < 1) out.alpha = TextureOperand(alpha(factor.w));
  if (const auto base = lookup(pbr, "baseColorTexture")) {
    const std::shared_ptr<const TextureImage> image = this->image(base->first, true);
    material.textures.push_back(
        {"base_color", add_texture(tinted(image, glm::dvec3(factor)), base->second, false)});
    if (mode != "OPAQUE" && image->channels == 4) {
      TextureOperand by_texture(1);
      by_texture.texture = add_texture(
          channel_of(*image, 3, [&](float a) { return alpha(static_cast<double>(a) * factor.w); }),
          base->second, true);
      out.alpha = by_texture;
    }
  }
  if (const auto both = lookup(pbr, "metallicRoughnessTexture")) {
    const std::shared_ptr<const TextureImage> image = this->image(both->first, false);
    const auto scaled = [](double by) {
      return [by](float value) { return within(static_cast<double>(value) * by, 0, 1); };
    };
    material.textures.push_back(
        {"roughness",
         add_texture(channel_of(*image, 1, scaled(model.roughness)), both->second, true)});
    material.textures.push_back(
        {"metallic",
         add_texture(channel_of(*image, 2, scaled(model.metallic)), both->second, true)});
  }
  if (const auto map = lookup(from, "normalTexture")) {
    const std::shared_ptr<const TextureImage> image = this->image(map->first, false);
    const double scale = file_.number(file_.object(from, "normalTexture"), "scale", 1);
    if (image->channels < 3)
      file_.fail("a normal texture is an image in grey, which has no normals");
    const TextureMapping& to = map->second.mapping;
    if (to.uscale != 1 || to.vscale != 1 || to.udelta != 0 || to.vdelta != 0)
      Diagnostics().warning(material.where, "the normal texture of '" + material.name +
                                                "' is left out, since it is transformed");
    else if (scale != 0) {
      material.normalmap = narrow<std::uint32_t>(scene_.textures.size());
      scene_.textures.push_back({NormalmapTexture{scale == 1 ? image : bent(*image, scale)}, false,
                                 fmt::format("image {}", scene_.textures.size()), material.where});
    }
  }
  const double strength =
      file_.number(file_.extension(from, "KHR_materials_emissive_strength"), "emissiveStrength", 1);
  const auto emissive =
      glm::max(file_.vector(from, "emissiveFactor", glm::dvec3(0)), glm::dvec3(0)) *
      std::max(0.0, strength);
  if (std::max({emissive.x, emissive.y, emissive.z}) > 0) {
    AreaEmission emission;
    emission.radiance = RgbSpectrum{emissive};
    emission.two_sided = true;
    if (const auto image = lookup(from, "emissiveTexture")) {
      const std::shared_ptr<const TextureImage> read =
          tinted(this->image(image->first, true), emissive);
      auto shown = std::make_shared<EnvironmentImage>();
      shown->width = read->width;
      shown->height = read->height;
      for (std::size_t i = 0;
           i < static_cast<std::size_t>(read->width) * static_cast<std::size_t>(read->height); ++i)
        for (int k = 0; k < 3; ++k) shown->rgb.push_back(value_of(*read, i, k));
      emission.image = shown;
    }
    out.emission = emission;
  }
  material.model = model;
  out.material = narrow<std::uint32_t>(scene_.materials.size());
  scene_.materials.push_back(std::move(material));
  return out;
}

}  // namespace caplet::gltf
