// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the import tests share: a stub for images, scenes from text, expected complaints.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "import/detail/pbrt/pbrt.h"
#include "import/import.h"
#include "support/data.h"

namespace caplet::test {

/// Images by name: "square" is 4x4, "wide" 4x2, all else 3x2.
class StubImages : public ImageReader {
 public:
  EnvironmentImage read_rgb(const std::filesystem::path& path) const override {
    const std::string name = path.stem().string();
    EnvironmentImage image;
    image.width = name == "square" || name == "wide" ? 4 : 3;
    image.height = name == "square" ? 4 : 2;
    image.rgb.assign(static_cast<std::size_t>(3 * image.width * image.height), 0.5f);
    return image;
  }
  /// Floats from 0 up, as large: of three channels, but of one called "grey".
  TextureImage read_texture(const std::filesystem::path& path,
                            const ImageEncoding& encoding) const override {
    ++textures_read;
    const std::string name = path.stem().string();
    if (name == "broken") throw InputError(path.string() + ": broken image");
    TextureImage image;
    image.width = image.height = 4;
    image.channels = name == "grey" ? 1 : 3;
    for (std::size_t i = 0; i < image.values(); ++i)
      image.floats.push_back(
          static_cast<float>(decoded_value(encoding, static_cast<double>(i) / 64)));
    return image;
  }
  mutable int textures_read = 0;
};

inline void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline Scene scene_of(const std::string& text) {
  return pbrt::import_text("scene.pbrt", text, StubImages());
}

/// The text after WorldBegin, with a camera before it.
inline Scene world_of(const std::string& text) {
  return scene_of("Camera \"perspective\"\nWorldBegin\n" + text);
}

/// The complaints about what `read` reads (validation included); empty when there are none.
template <class Read>
std::vector<std::string> complaints_when(Read read) {
  try {
    const Scene scene = read();
    Diagnostics diagnostics;
    validate(scene, diagnostics);
    diagnostics.finish();
  } catch (const InputError& error) {
    return error.messages();
  }
  return {};
}

inline std::vector<std::string> complaints(const std::string& text) {
  return complaints_when([&] { return scene_of(text); });
}

/// The first complaint of whatever `run` does.
template <class Run>
std::string complaint_of(Run run) {
  try {
    run();
  } catch (const InputError& error) {
    return error.messages().front();
  }
  return {};
}

}  // namespace caplet::test
