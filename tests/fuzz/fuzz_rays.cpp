// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Any bytes as a list of rays, as text and as .npy: finite rays with a direction.
#include "table/ray_file.h"
#include "target.h"

namespace {

using caplet::test::require;

constexpr std::size_t piece = 7;  // rays read at a time

void read_text(const std::filesystem::path& path) {
  caplet::RayFile file(path);
  for (;;) {
    const std::vector<caplet::ListedRay> rays = file.next(piece);
    for (const auto& [ray, t_min, t_max] : rays) {
      require(t_min >= 0 && t_max > t_min);
      for (const float number : ray) require(std::abs(number) <= caplet::largest_ray_number);
      const float squared = ray[3] * ray[3] + ray[4] * ray[4] + ray[5] * ray[5];
      require(squared > 0 && std::isfinite(squared));
    }
    if (rays.size() < piece) return;
  }
}

void read_array(const std::filesystem::path& path) {
  caplet::NpyReader file(path, {6, 8});
  const std::size_t columns = file.columns();
  std::vector<double> numbers;
  for (std::uint64_t left = file.rows(); left > 0; left -= numbers.size() / columns) {
    numbers.resize(columns * std::min<std::uint64_t>(left, piece));
    file.read(numbers);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const caplet::test::MemoryFile file(data, size);
  caplet::test::run_target([&] { read_text(file.path()); });
  return caplet::test::run_target([&] { read_array(file.path()); });
}
