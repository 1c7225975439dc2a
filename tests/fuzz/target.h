// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the fuzz targets share: how one is run, bytes as a file, and what must hold for every scene
// that an importer returns.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet::test {

/// Names its place and aborts when something does not hold, which libFuzzer reports with the input.
inline void require(bool condition, const char* file = __builtin_FILE(),
                    int line = __builtin_LINE()) {
  if (condition) return;
  std::fprintf(stderr, "%s:%d: this does not hold\n", file, line);
  std::abort();
}

/// Runs a target on one input; InputError is the only way in which it may refuse it.
template <class Target>
int run_target(Target target) {
  set_log_level(LogLevel::none);
  try {
    target();
  } catch (const InputError&) {
  }
  return 0;
}

/// A file in memory with the fuzzer's bytes, for importers that take a path.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : descriptor_(::memfd_create("fuzz", 0)) {
    for (std::size_t done = 0; done < size;) {
      const ssize_t count = ::write(descriptor_, data + done, size - done);
      if (count <= 0) std::abort();
      done += static_cast<std::size_t>(count);
    }
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

/// Every image is one grey pixel.
class OnePixel : public ImageReader {
 public:
  EnvironmentImage read_rgb(const std::filesystem::path&) const override {
    return {1, 1, {1, 1, 1}};
  }
  TextureImage read_texture(const std::filesystem::path&, const ImageEncoding&) const override {
    TextureImage image;
    image.width = image.height = 1;
    image.channels = 3;
    image.floats = {1, 1, 1};
    return image;
  }
};

/// What holds for every scene that was imported and validated: indices in range, sizes positive (a
/// tapered capsule may end in a point), all of it finite.
inline void check_scene(const Scene& scene) {
  const auto check_shapes = [&scene](const std::vector<Shape>& shapes) {
    for (const Shape& shape : shapes) {
      require(shape.material < scene.materials.size());
      if (const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry)) {
        const std::size_t count = capsules->p0.size();
        require(count > 0 && capsules->p1.size() == count && capsules->radius0.size() == count);
        require(capsules->radius1.empty() || capsules->radius1.size() == count);
        require(capsules->materials.empty() || capsules->materials.size() == count);
        require(capsules->u.empty() || capsules->u.size() == count);
        for (const glm::vec2& u : capsules->u) require(std::isfinite(u.x) && std::isfinite(u.y));
        for (std::size_t i = 0; i < count; ++i) {
          const float radius0 = capsules->radius0[i],
                      radius1 = capsules->radius1.empty() ? radius0 : capsules->radius1[i];
          require(radius0 >= 0 && radius1 >= 0 && std::max(radius0, radius1) > 0);
          require(std::isfinite(radius0) && std::isfinite(radius1));
        }
        for (const std::uint32_t material : capsules->materials)
          require(material < scene.materials.size());
      } else if (const auto* mesh = std::get_if<TriangleMeshShape>(&shape.geometry)) {
        for (const auto& triangle : mesh->triangles)
          for (const std::uint32_t vertex : triangle) require(vertex < mesh->positions.size());
      } else if (const auto* sphere = std::get_if<SphereShape>(&shape.geometry)) {
        require(sphere->radius > 0 && std::isfinite(sphere->radius));
      }
    }
  };
  check_shapes(scene.shapes);
  for (const Object& object : scene.objects) check_shapes(object.shapes);
  for (const Instance& instance : scene.instances) require(instance.object < scene.objects.size());
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      require(std::isfinite(scene.view.camera.world_from_camera[column][row]));
  bounds_of(scene);
  count_primitives(scene);
}

}  // namespace caplet::test
