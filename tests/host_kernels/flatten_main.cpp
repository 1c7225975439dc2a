// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Build tool: flatten_kernels ROOT FILE OUTPUT writes FILE with its includes put in, which are
// looked for in ROOT, then beside FILE.
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

#include "device/detail/flatten.h"

namespace fs = std::filesystem;

namespace {

std::optional<std::string> read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || fs::is_directory(path)) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: flatten_kernels ROOT FILE OUTPUT\n";
    return 2;
  }
  try {
    const fs::path root = argv[1], file = argv[2];
    const caplet::FileReader reader = [&](const std::string& path) {
      const std::optional<std::string> text = read(root / path);
      return text ? text : read(file.parent_path() / path);
    };
    std::ofstream(argv[3]) << caplet::flatten(reader(file.filename().string()).value(),
                                              file.string(), reader);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
