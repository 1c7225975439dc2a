// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <variant>
#include <vector>

#include "scene/image_reader.h"
#include "scene/scene.h"
#include "support/data.h"

namespace caplet::test {

class NoImages : public ImageReader {
 public:
  EnvironmentImage read_rgb(const std::filesystem::path& path) const override {
    throw InputError(path.string() + ": no images");
  }
};

/// Every image is one texel; "two" are two texels with alpha, "grey" is one number, "broken" is
/// refused.
class OneTexel : public NoImages {
 public:
  TextureImage read_texture(const std::filesystem::path& path,
                            const ImageEncoding& encoding) const override {
    if (path.stem() == "broken") throw InputError("these bytes are no picture");
    const bool is_grey = path.stem() == "grey", is_two = path.stem() == "two";
    TextureImage image;
    image.width = is_two ? 2 : 1;
    image.height = 1;
    image.channels = is_grey ? 1 : is_two ? 4 : 3;
    image.bytes = {10, 20, 30, 100, 40, 50, 60, 200};
    if (!is_two) image.bytes = {10, 20, 30};
    if (is_grey) image.bytes = {10};
    for (std::size_t i = 0; i < image.decoded.size(); ++i)
      image.decoded.at(i) = static_cast<float>(i) / 255.0F;
    image.file = path.string();
    image.encoding = encoding;
    return image;
  }
};

/// Writes to one folder, so that the files find each other.
inline std::filesystem::path write_beside(const std::string& name, const std::string& text) {
  static const std::filesystem::path folder = temporary_folder();
  std::ofstream(folder / name, std::ios::binary) << text;
  return folder / name;
}

inline std::filesystem::path write_file(const std::string& name, const std::string& text) {
  const std::filesystem::path path = temporary_folder() / name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

/// The file's capsules (the first CapsulesShape); none: empty.
inline CapsulesShape capsules_of(const Scene& scene) {
  for (const Shape& shape : scene.shapes)
    if (const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry)) return *capsules;
  return {};
}

inline std::vector<Shape> spheres_of(const Scene& scene) {
  std::vector<Shape> spheres;
  for (const Shape& shape : scene.shapes)
    if (std::holds_alternative<SphereShape>(shape.geometry)) spheres.push_back(shape);
  return spheres;
}

/// What importing says is wrong, one message a line; empty: nothing.
template <class Import>
std::string complaint(Import import) {
  try {
    import();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace caplet::test
