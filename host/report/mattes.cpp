// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/mattes.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/utf8.h"
#include "scene/matte_names.h"

namespace caplet::report {

namespace {

const std::vector<std::string>& names_of(Layer layer, const MatteNames& names) {
  if (layer == Layer::crypto_object) return names.objects;
  return layer == Layer::crypto_material ? names.materials : names.assets;
}

/// Returns how the keys of a matte's attributes begin: the first seven digits of its name's hash
/// tell mattes apart.
std::string prefix_of(Layer layer) {
  return fmt::format("cryptomatte/{:.7}/",
                     fmt::format("{:08x}", matte_hash(row_of(layer).channels)));
}

std::string manifest(const std::vector<std::string>& names) {
  auto out = nlohmann::json::object();
  for (const std::string& name : names) out[name] = fmt::format("{:08x}", matte_hash(name));
  return json_dump(out);
}

}  // namespace

std::map<std::string, std::string> matte_attributes(const Scene& scene, Layers layers) {
  std::map<std::string, std::string> out;
  if (std::ranges::none_of(matte_layers, [&](Layer layer) { return layers.has(layer); }))
    return out;
  const MatteNames names = matte_names(scene);
  for (const Layer layer : matte_layers) {
    if (!layers.has(layer)) continue;
    const std::string prefix = prefix_of(layer);
    out[prefix + "name"] = row_of(layer).channels;
    out[prefix + "hash"] = "MurmurHash3_32";
    out[prefix + "conversion"] = "uint32_to_float32";
    out[prefix + "manifest"] = manifest(names_of(layer, names));
  }
  return out;
}

std::vector<std::string> names_in_matte(const std::map<std::string, std::string>& attributes,
                                        Layer matte) {
  std::vector<std::string> out;
  const auto found = attributes.find(prefix_of(matte) + "manifest");
  if (found == attributes.end()) return out;
  const auto manifest = nlohmann::json::parse(found->second, nullptr, false);
  for (const auto& item : manifest.items()) out.push_back(item.key());
  return out;
}

void drop_other_mattes(std::map<std::string, std::string>& attributes, Layers layers) {
  for (const Layer layer : matte_layers)
    if (!layers.has(layer))
      std::erase_if(attributes, [prefix = prefix_of(layer)](const auto& attribute) {
        return attribute.first.starts_with(prefix);
      });
}

}  // namespace caplet::report
