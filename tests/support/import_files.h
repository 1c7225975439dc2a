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
