// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Writes every stage's OpenCL C, as a renderer gives it to a driver, for a scene that has certain
// kinds of shapes: what tools/budgets.py compiles for devices that are not there.
#include <array>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "device/row_masks.h"
#include "render/kernels.h"
#include "shared/shapes.h"

namespace {

constexpr std::array stage_names = {
#define STAGE(name, launch, is_used, groups) std::string_view(#name),
#include "shared/queries.def"
#include "shared/stages.def"
#undef STAGE
};

constexpr std::array shape_names = {
#define SHAPE(name, traits) std::string_view(#name),
#include "shared/shapes.def"
#undef SHAPE
};

/// Bit k: shape kind k. "all", or names with commas between them.
std::uint64_t mask_of(std::string_view shapes) {
  if (shapes == "all") return (std::uint64_t{1} << shape_names.size()) - 1;
  std::uint64_t mask = 0;
  while (!shapes.empty()) {
    const std::string_view name = shapes.substr(0, shapes.find(','));
    shapes.remove_prefix(name.size() < shapes.size() ? name.size() + 1 : name.size());
    std::uint32_t kind = 0;
    while (kind < shape_names.size() && shape_names[kind] != name) ++kind;
    if (kind == shape_names.size())
      throw std::invalid_argument("no shape is called '" + std::string(name) + "'");
    mask |= caplet::shape_bit(kind);
  }
  return mask;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: caplet_stage_texts FOLDER SHAPES    SHAPES: all, or names of shapes.def "
                 "with commas between them\n";
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    const caplet::RowMasks rows{{"shapes", mask_of(argv[2])}};
    for (std::size_t i = 0; i < stage_names.size(); ++i) {
      std::ofstream out(folder / (std::string(stage_names[i]) + ".cl"));
      out << caplet::stage_source(static_cast<caplet::Stage>(i), rows);
      if (!out) throw std::runtime_error("cannot write into " + folder.string());
    }
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
