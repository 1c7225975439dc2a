// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Renders a scene and prints the device's compute units and a hash of the film's bits; run in its
// own process by determinism_test, since PoCL reads its number of threads once. render_digest SCENE
// SAMPLES
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <span>

#include "render_scene.h"

int main(int argc, char** argv) {
  if (argc != 3) return std::cerr << "usage: render_digest SCENE SAMPLES\n", 2;
  const caplet::test::Rendered rendered = caplet::test::render_file(argv[1], std::atoi(argv[2]));
  const std::span<const std::uint64_t> words = rendered.result.film.words();
  std::vector<unsigned char> bytes(words.size_bytes());
  std::memcpy(bytes.data(), words.data(), bytes.size());
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
  std::cout << caplet::test::test_device().info().compute_units << " " << hash << "\n";
  return 0;
}
