// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Any bytes as an SWC file: refused with InputError, or a scene of finite shapes with positive radii and a finite camera.
#include <spdlog/spdlog.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <variant>

#include "base/error.h"
#include "import/importers.h"
#include "memory_file.h"

namespace {

class NoImages : public caplet::ImageReader {
 public:
  caplet::EnvironmentImage read_rgb(const std::filesystem::path& path) const override { throw caplet::InputError(path.string()); }
};

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const caplet::Scene& scene) {
  for (const caplet::Shape& shape : scene.shapes) {
    require(shape.material < scene.materials.size());
    if (const auto* capsules = std::get_if<caplet::CapsulesShape>(&shape.geometry)) {
      for (const float radius : capsules->radius0) require(radius > 0 && std::isfinite(radius));
      for (const float radius : capsules->radius1) require(radius > 0 && std::isfinite(radius));
      for (const std::uint32_t material : capsules->materials) require(material < scene.materials.size());
    }
  }
  require(!scene.shapes.empty());
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) require(std::isfinite(scene.camera.world_from_camera[column][row]));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  spdlog::set_level(spdlog::level::off);
  const caplet::test::MemoryFile file(data, size);
  try {
    check(caplet::import_swc(file.path(), NoImages()));
  } catch (const caplet::InputError&) {
  }
  return 0;
}
